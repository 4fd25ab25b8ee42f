// Problem: iterative answers stop at 1e-6, and pivoting on badly scaled data at 1e-10; the modes they found
// are right, so solve those exactly.

#include <carom/contact/solvers/newton_polish.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

// Below this pivot ratio a direction of the Newton system is left alone: impulses that are not unique.
constexpr double rank_tolerance = 1e-12;

// Residual at which a step that does not halve it moves noise: the answer is as good as that of improve().
constexpr double rounding_of_steps = 1e-14;

// Steps in a row that do not halve the residual, after which modes change without an end.
constexpr int most_idle_steps = 6;

double group_rho(const ContactProblem& problem, const RowGroup& group) {
  const double trace = group_trace(problem, group);
  return trace > 0.0 ? 1.0 / trace : 0.0;
}

// An impulse of a piece within its bounds.
double within(ModeEquations::Piece piece, double impulse, double lower, double upper) {
  if (piece == ModeEquations::Piece::lower) return lower;
  if (piece == ModeEquations::Piece::upper) return upper;
  return std::clamp(impulse, lower, upper);
}

}  // namespace

Residual NewtonPolish::judge(const ContactProblem& problem, std::span<const double> impulse) {
  problem.velocities(impulse, xi_);
  return residual(problem, impulse, xi_);
}

// Row `tangent` (0 or 1) of a disc that begins at a row, into row_ and its map. With m = P - rho xi, u = m /
// |m|
//   F = P - r u:  dF = dP - mu u dP_n - (r / |m|) (I - u u^T) (dP - rho dxi)   outside, F = rho xi inside.
void NewtonPolish::linearise_disc(const ContactProblem& problem, std::size_t row, std::size_t tangent,
                                  double rho) {
  const std::size_t n = xi_.size();
  const RowSet& set = problem.sets()[row];
  const auto bound = static_cast<std::size_t>(set.bound);
  const double radius = set.coefficient * std::max(trial_[bound], 0.0);
  const double m[2] = {trial_[row] - rho * xi_[row], trial_[row + 1] - rho * xi_[row + 1]};
  const double length = std::hypot(m[0], m[1]);
  const double* const own_w = problem.matrix().data() + (row + tangent) * n;
  if (length <= radius) {
    for (std::size_t j = 0; j < n; ++j) row_[j] = rho * own_w[j];
    map_[row + tangent] = rho * xi_[row + tangent];
    return;
  }
  const double u[2] = {m[0] / length, m[1] / length};
  std::fill(row_.begin(), row_.end(), 0.0);
  for (std::size_t l = 0; l < 2; ++l) {
    const double projector = radius / length * ((tangent == l ? 1.0 : 0.0) - u[tangent] * u[l]);
    const double* const w = problem.matrix().data() + (row + l) * n;
    for (std::size_t j = 0; j < n; ++j) row_[j] += projector * rho * w[j];
    row_[row + l] -= projector;
  }
  row_[row + tangent] += 1.0;
  row_[bound] -= set.coefficient * u[tangent];
  map_[row + tangent] = trial_[row + tangent] - radius * u[tangent];
}

// The map of a row that is none of a disc, at the trial.
NewtonPolish::RowMap NewtonPolish::map_of(const ContactProblem& problem, std::size_t i, double rho) const {
  const RowSet& set = problem.sets()[i];
  if (set.kind == SetKind::proportional) {
    const double given = set.coefficient * trial_[static_cast<std::size_t>(set.bound)];
    return {Piece::given, trial_[i] - given, set.coefficient};
  }
  double lower = set.lower, upper = set.upper, slope = 0.0;
  if (set.kind == SetKind::bounded_interval) {
    slope = set.coefficient;
    upper = slope * std::max(trial_[static_cast<std::size_t>(set.bound)], 0.0);
    lower = -upper;
  } else if (set.kind == SetKind::half_line) {
    lower = 0.0;
    upper = std::numeric_limits<double>::infinity();
  }
  const double moved = trial_[i] - rho * xi_[i];
  if (moved > lower && moved < upper && rho > 0.0) return {Piece::free, rho * xi_[i], 0.0};
  const bool at_upper = moved >= upper && upper > lower;
  if (at_upper) return {Piece::upper, trial_[i] - upper, slope > 0.0 ? slope : 0.0};
  return {Piece::lower, trial_[i] - lower, slope > 0.0 ? -slope : 0.0};
}

// Notes the piece that each row stands in at the trial, and what those at bounds follow.
void NewtonPolish::find_pieces(const ContactProblem& problem) {
  equations_.pieces.assign(xi_.size(), Piece::disc);
  equations_.rows.clear();
  slopes_.assign(xi_.size(), 0.0);
  for (const RowGroup& group : problem.groups()) {
    const double rho = group_rho(problem, group);
    const auto last = static_cast<std::size_t>(group.first + group.size);
    for (auto i = static_cast<std::size_t>(group.first); i < last; ++i) {
      if (problem.sets()[i].kind != SetKind::bounded_disc) {
        const RowMap map = map_of(problem, i, rho);
        equations_.pieces[i] = map.piece;
        slopes_[i] = map.slope;
      }
      const Piece piece = equations_.pieces[i];
      if (piece == Piece::free || piece == Piece::disc) equations_.rows.push_back(i);
    }
  }
}

// Adds row_ to the equations: what follows a bound is put in its place, what stands still is left out.
void NewtonPolish::add_row(const ContactProblem& problem) {
  for (std::size_t i = row_.size(); i-- > 0;) {
    if (slopes_[i] != 0.0) row_[static_cast<std::size_t>(problem.sets()[i].bound)] += slopes_[i] * row_[i];
  }
  for (const std::size_t i : equations_.rows) jacobian_.push_back(row_[i]);
}

// The equations of the pieces, at a trial within them.
void NewtonPolish::linearise(const ContactProblem& problem) {
  const std::size_t n = xi_.size();
  row_.resize(n);
  jacobian_.clear();
  for (const RowGroup& group : problem.groups()) {
    const double rho = group_rho(problem, group);
    const auto last = static_cast<std::size_t>(group.first + group.size);
    for (auto i = static_cast<std::size_t>(group.first); i < last; ++i) {
      if (equations_.pieces[i] == Piece::free) {
        const double* const w = problem.matrix().data() + i * n;
        for (std::size_t j = 0; j < n; ++j) row_[j] = rho * w[j];
        map_[i] = rho * xi_[i];
        add_row(problem);
      } else if (equations_.pieces[i] == Piece::disc) {
        for (std::size_t tangent = 0; tangent < 2; ++tangent) {
          linearise_disc(problem, i, tangent, rho);
          add_row(problem);
        }
        ++i;
      }
    }
  }
  const std::size_t size = equations_.rows.size();
  equations_.factors.factor(jacobian_, size, size, rank_tolerance);
}

// One step of the trial by equations, with the map at hand.
void NewtonPolish::step_by(const ContactProblem& problem, ModeEquations& equations, bool by_factors) {
  of_rows_.clear();
  for (const std::size_t i : equations.rows) of_rows_.push_back(map_[i]);
  step_.resize(of_rows_.size());
  if (by_factors) {
    equations.factors.solve_by_factors(of_rows_, step_);
  } else {
    equations.factors.solve(of_rows_, step_);
  }
  for (std::size_t k = 0; k < step_.size(); ++k) trial_[equations.rows[k]] -= step_[k];
  restore_sets(problem, equations.pieces);
}

// Writes the map at the trial. False where a row has another piece than in the equations that are factored.
bool NewtonPolish::keeps_pieces(const ContactProblem& problem, std::span<const Piece> pieces) {
  for (const RowGroup& group : problem.groups()) {
    const double rho = group_rho(problem, group);
    const auto last = static_cast<std::size_t>(group.first + group.size);
    for (auto i = static_cast<std::size_t>(group.first); i < last; ++i) {
      if (pieces[i] == Piece::disc || problem.sets()[i].kind == SetKind::bounded_disc) return false;
      const RowMap map = map_of(problem, i, rho);
      if (map.piece != pieces[i]) return false;
      map_[i] = map.value;
    }
  }
  return true;
}

// Takes impulses into their sets, and those of rows at bounds to these.
void NewtonPolish::restore_sets(const ContactProblem& problem, std::span<const Piece> pieces) {
  for (std::size_t i = 0; i < trial_.size(); ++i) {
    const RowSet& set = problem.sets()[i];
    switch (set.kind) {
      case SetKind::half_line:
        trial_[i] = pieces[i] == Piece::lower ? 0.0 : std::max(trial_[i], 0.0);
        break;
      case SetKind::interval:
        trial_[i] = within(pieces[i], trial_[i], set.lower, set.upper);
        break;
      case SetKind::bounded_interval: {
        const double limit = set.coefficient * std::max(trial_[static_cast<std::size_t>(set.bound)], 0.0);
        trial_[i] = within(pieces[i], trial_[i], -limit, limit);
        break;
      }
      case SetKind::bounded_disc: {
        const double limit = set.coefficient * std::max(trial_[static_cast<std::size_t>(set.bound)], 0.0);
        const double length = std::hypot(trial_[i], trial_[i + 1]);
        if (length > limit) {
          trial_[i] *= limit / length;
          trial_[i + 1] *= limit / length;
        }
        ++i;
        break;
      }
      case SetKind::proportional:
        trial_[i] = set.coefficient * trial_[static_cast<std::size_t>(set.bound)];
        break;
    }
  }
}

Residual NewtonPolish::improve(const ContactProblem& problem, std::span<double> impulse, int most_steps) {
  const auto n = static_cast<std::size_t>(problem.rows());
  trial_.assign(impulse.begin(), impulse.end());
  best_.assign(impulse.begin(), impulse.end());
  xi_.resize(n);
  map_.resize(n);
  equations_.pieces.clear();
  Residual best = judge(problem, trial_);
  int idle = 0;
  const auto goes_on = [&] { return best.value > round_off && std::isfinite(best.value); };
  for (int k = 0; k < most_steps && idle < most_idle_steps && goes_on(); ++k) {
    find_pieces(problem);
    restore_sets(problem, equations_.pieces);
    problem.velocities(trial_, xi_);
    linearise(problem);
    step_by(problem, equations_, false);
    const Residual now = judge(problem, trial_);
    if (!std::isfinite(now.value)) break;
    idle = now.value < 0.5 * best.value ? 0 : idle + 1;
    if (now.value < best.value) {
      best = now;
      best_ = trial_;
    }
  }
  std::copy(best_.begin(), best_.end(), impulse.begin());
  return best;
}

bool NewtonPolish::refine(const ContactProblem& problem, ModeEquations& equations, std::span<double> impulse,
                          Residual& found) {
  const auto n = static_cast<std::size_t>(problem.rows());
  trial_.assign(impulse.begin(), impulse.end());
  xi_.resize(n);
  map_.resize(n);
  double last = std::numeric_limits<double>::infinity();
  for (;;) {
    problem.velocities(trial_, xi_, slot_velocity_);
    found = residual(problem, trial_, xi_);
    if (found.value <= round_off) break;
    if (!(found.value < 0.5 * last)) {
      if (last > rounding_of_steps) return false;
      break;
    }
    last = found.value;
    best_.assign(trial_.begin(), trial_.end());
    if (!keeps_pieces(problem, equations.pieces)) return false;
    step_by(problem, equations, true);
  }
  if (found.value > last) {
    trial_.swap(best_);
    problem.velocities(trial_, xi_, slot_velocity_);
    found = residual(problem, trial_, xi_);
  }
  std::copy(trial_.begin(), trial_.end(), impulse.begin());
  return true;
}

}  // namespace carom

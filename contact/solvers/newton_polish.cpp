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

}  // namespace

Residual NewtonPolish::judge(const ContactProblem& problem, std::span<const double> impulse) {
  problem.velocities(impulse, xi_);
  return residual(problem, impulse, xi_);
}

// Row of the Jacobian  own * e_row + of_xi * rho * W_row; the map's value is set by the caller.
void NewtonPolish::set_row(const ContactProblem& problem, std::size_t row, double own, double of_xi,
                           double rho) {
  const std::size_t n = xi_.size();
  double* out = jacobian_.data() + row * n;
  const double* const w = problem.matrix().data() + row * n;
  for (std::size_t j = 0; j < n; ++j) out[j] = of_xi * rho * w[j];
  out[row] += own;
}

void NewtonPolish::linearise_disc(const ContactProblem& problem, std::size_t row, double rho) {
  const std::size_t n = xi_.size();
  const RowSet& set = problem.sets()[row];
  const auto bound = static_cast<std::size_t>(set.bound);
  const double radius = set.coefficient * std::max(trial_[bound], 0.0);
  const double m[2] = {trial_[row] - rho * xi_[row], trial_[row + 1] - rho * xi_[row + 1]};
  const double length = std::hypot(m[0], m[1]);
  if (length <= radius) {
    for (std::size_t k = 0; k < 2; ++k) {
      set_row(problem, row + k, 0.0, 1.0, rho);
      map_[row + k] = rho * xi_[row + k];
    }
    return;
  }
  // F = P - r u, u = m / |m|:  dF = dP - mu u dP_n - (r / |m|) (I - u u^T) (dP - rho dxi)
  const double u[2] = {m[0] / length, m[1] / length};
  for (std::size_t k = 0; k < 2; ++k) {
    double* out = jacobian_.data() + (row + k) * n;
    for (std::size_t j = 0; j < n; ++j) out[j] = 0.0;
    for (std::size_t l = 0; l < 2; ++l) {
      const double projector = radius / length * ((k == l ? 1.0 : 0.0) - u[k] * u[l]);
      const double* const w = problem.matrix().data() + (row + l) * n;
      for (std::size_t j = 0; j < n; ++j) out[j] += projector * rho * w[j];
      out[row + l] -= projector;
    }
    out[row + k] += 1.0;
    out[bound] -= set.coefficient * u[k];
    map_[row + k] = trial_[row + k] - radius * u[k];
  }
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

void NewtonPolish::linearise(const ContactProblem& problem) {
  equations_.pieces.assign(xi_.size(), Piece::disc);
  for (const RowGroup& group : problem.groups()) {
    const double rho = group_rho(problem, group);
    const auto last = static_cast<std::size_t>(group.first + group.size);
    for (auto i = static_cast<std::size_t>(group.first); i < last; ++i) {
      if (problem.sets()[i].kind == SetKind::bounded_disc) {
        linearise_disc(problem, i++, rho);
        continue;
      }
      const RowMap map = map_of(problem, i, rho);
      const bool is_free = map.piece == Piece::free;
      set_row(problem, i, is_free ? 0.0 : 1.0, is_free ? 1.0 : 0.0, rho);
      if (map.slope != 0.0) {
        jacobian_[i * xi_.size() + static_cast<std::size_t>(problem.sets()[i].bound)] -= map.slope;
      }
      map_[i] = map.value;
      equations_.pieces[i] = map.piece;
    }
  }
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

// Rounding of a step leaves impulses beside their sets; a row at a bound goes back to the bound exactly.
void NewtonPolish::restore_sets(const ContactProblem& problem, std::span<const Piece> pieces) {
  for (std::size_t i = 0; i < trial_.size(); ++i) {
    const RowSet& set = problem.sets()[i];
    switch (set.kind) {
      case SetKind::half_line:
        trial_[i] = pieces[i] == Piece::lower ? 0.0 : std::max(trial_[i], 0.0);
        break;
      case SetKind::interval:
        trial_[i] = std::clamp(trial_[i], set.lower, set.upper);
        break;
      case SetKind::bounded_interval: {
        const double limit = set.coefficient * std::max(trial_[static_cast<std::size_t>(set.bound)], 0.0);
        trial_[i] = std::clamp(trial_[i], -limit, limit);
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
  step_.resize(n);
  jacobian_.resize(n * n);
  equations_.pieces.clear();
  Residual best = judge(problem, trial_);
  int idle = 0;
  const auto goes_on = [&] { return best.value > round_off && std::isfinite(best.value); };
  for (int k = 0; k < most_steps && idle < most_idle_steps && goes_on(); ++k) {
    linearise(problem);
    equations_.factors.factor(jacobian_, n, n, rank_tolerance);
    equations_.factors.solve(map_, step_);
    for (std::size_t i = 0; i < n; ++i) trial_[i] -= step_[i];
    restore_sets(problem, equations_.pieces);
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
  step_.resize(n);
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
    equations.factors.solve_by_factors(map_, step_);
    for (std::size_t i = 0; i < n; ++i) trial_[i] -= step_[i];
    restore_sets(problem, equations.pieces);
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

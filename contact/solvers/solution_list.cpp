// Problem: prove how many solutions a small contact problem has.

#include <carom/contact/solvers/residual.h>
#include <carom/contact/solvers/solution_list.h>
#include <carom/core/numerics/rank_revealing_qr.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace carom {

namespace {

// Pivots below this part of the largest make the system of a set of modes singular.
constexpr double rank_tolerance = 1e-11;

double group_trace(const ContactProblem& problem, const RowGroup& group) {
  double sum = 0.0;
  for (int i = group.first; i < group.first + group.size; ++i) sum += problem.w(i, i);
  return sum;
}

}  // namespace

SolutionList::SolutionList() : qr_(std::make_unique<RankRevealingQr>()) {}
SolutionList::~SolutionList() = default;
SolutionList::SolutionList(SolutionList&&) noexcept = default;
SolutionList& SolutionList::operator=(SolutionList&&) noexcept = default;

bool SolutionList::build_faces(const ContactProblem& problem) {
  const std::size_t n = problem.groups().size();
  if (n > static_cast<std::size_t>(enumeration_groups)) return false;
  faces_.resize(n);
  for (std::size_t g = 0; g < n; ++g) {
    const RowGroup& group = problem.groups()[g];
    auto& faces = faces_[g];
    faces.clear();
    const RowSet& own = problem.sets()[static_cast<std::size_t>(group.first)];
    if (group.size > 2) return false;
    if (group.size == 2) {
      const RowSet& friction = problem.sets()[static_cast<std::size_t>(group.first) + 1];
      const bool slides = friction.kind == SetKind::proportional;
      if (own.kind != SetKind::half_line) return false;
      if (!slides && friction.kind != SetKind::bounded_interval) return false;
      const double mu = friction.coefficient;
      faces.push_back({});  // open
      if (mu > 0.0 && !slides) {
        faces.push_back({0.0, 2, 0.0, 2, true});   // stick
        faces.push_back({0.0, 1, -mu, 1, true});   // slip+
        faces.push_back({0.0, 1, mu, 1, true});    // slip-
        faces.push_back({0.0, 1, -mu, 2, false});  // friction exhausted without slip
        faces.push_back({0.0, 1, mu, 2, false});
      } else {
        faces.push_back({0.0, 1, mu, 1, true});  // slides, or has no friction
      }
      faces.push_back({0.0, 0, 0.0, 1, false});  // touching without impulse
      continue;
    }
    const bool half_line = own.kind == SetKind::half_line;
    faces.push_back({0.0, 1, 0.0, 1, true});  // no velocity
    for (const double bound : {half_line ? 0.0 : own.lower, half_line ? own.lower : own.upper}) {
      if (!std::isfinite(bound) || (half_line && faces.size() > 1)) continue;
      faces.push_back({bound, 0, 0.0, 0, true});   // at a bound, moving
      faces.push_back({bound, 0, 0.0, 1, false});  // at a bound without velocity
    }
  }
  return true;
}

void SolutionList::set_scales(const ContactProblem& problem) {
  rho_.assign(rows_, 0.0);
  scale_ = 0.0;
  double largest = 0.0;
  for (const RowGroup& group : problem.groups()) largest = std::max(largest, group_trace(problem, group));
  for (const RowGroup& group : problem.groups()) {
    const double trace = group_trace(problem, group);
    const double rho =
        trace > negligible_trace * largest ? 1.0 / trace : (largest > 0.0 ? 1.0 / largest : 1.0);
    for (std::size_t i = static_cast<std::size_t>(group.first), k = 0;
         k < static_cast<std::size_t>(group.size); ++i, ++k) {
      rho_[i] = rho;
      scale_ = std::max(scale_, rho * std::abs(problem.vector()[i]));
    }
  }
}

bool SolutionList::same(std::span<const double> impulse, std::span<const double> xi, std::size_t index,
                        bool velocities_only) const {
  double scale = scale_;
  const double* p = impulses_.data() + index * rows_;
  const double* v = velocities_.data() + index * rows_;
  for (std::size_t i = 0; i < rows_; ++i) scale = std::max({scale, std::abs(impulse[i]), std::abs(p[i])});
  for (std::size_t i = 0; i < rows_; ++i) {
    if (!(rho_[i] * std::abs(xi[i] - v[i]) <= listed_distance * scale)) return false;
    if (!velocities_only && !(std::abs(impulse[i] - p[i]) <= listed_distance * scale)) return false;
  }
  return true;
}

// Takes trial_ into the list if it is a solution and new.
void SolutionList::consider(const ContactProblem& problem) {
  // Rounding may leave an impulse beside its set; the residual is to judge the mode, not that.
  for (std::size_t i = 0; i < rows_; ++i) {
    const RowSet& set = problem.sets()[i];
    const double tiny = listed_residual * scale_;
    if (set.kind == SetKind::half_line && trial_[i] < 0.0 && trial_[i] > -tiny) trial_[i] = 0.0;
    if (set.kind == SetKind::bounded_interval) {
      const double limit = set.coefficient * std::max(trial_[static_cast<std::size_t>(set.bound)], 0.0);
      if (std::abs(trial_[i]) > limit && std::abs(trial_[i]) < limit + tiny) {
        trial_[i] = std::copysign(limit, trial_[i]);
      }
    }
    if (set.kind == SetKind::proportional) {
      trial_[i] = set.coefficient * trial_[static_cast<std::size_t>(set.bound)];
    }
  }
  problem.velocities(trial_, xi_);
  const double error = residual(problem, trial_, xi_).value;
  // The residual is one of the impulses: beside those without bound of a jam everything is small. A near miss
  // is one against the scale of the data, unless rounding of such impulses hides it.
  constexpr double rounding = 1e3 * std::numeric_limits<double>::epsilon();
  double size = scale_;
  for (const double impulse : trial_) size = std::max(size, std::abs(impulse));
  const bool hidden = !(scale_ > 0.0) || error <= rounding;
  least_residual_ = std::min(least_residual_, hidden ? error : error * (size / scale_));
  if (!(error <= listed_residual)) return;
  for (std::size_t k = 0; k < count_; ++k) {
    if (same(trial_, xi_, k, false)) return;
  }
  impulses_.resize((count_ + 1) * rows_);
  velocities_.resize((count_ + 1) * rows_);
  std::copy(trial_.begin(), trial_.end(), impulses_.begin() + static_cast<std::ptrdiff_t>(count_ * rows_));
  std::copy(xi_.begin(), xi_.end(), velocities_.begin() + static_cast<std::ptrdiff_t>(count_ * rows_));
  ++count_;
}

// Adds multiples of direction_ to the solutions found: do they stay solutions?
void SolutionList::follow(const ContactProblem& problem) {
  double length = 0.0;
  for (std::size_t i = 0; i < rows_; ++i) {
    length = std::max(length, std::abs(direction_[i]));
    if (problem.sets()[i].kind == SetKind::half_line && direction_[i] < 0.0) return;
  }
  if (!(length > 0.0)) return;
  for (std::size_t k = 0; k < count_; ++k) {
    double size = scale_;
    for (std::size_t i = 0; i < rows_; ++i) size = std::max(size, std::abs(impulses_[k * rows_ + i]));
    bool stays = true, moves = false;
    for (const double factor : {1.0, 3.0}) {
      for (std::size_t i = 0; i < rows_; ++i) {
        trial_[i] = impulses_[k * rows_ + i] + factor * size / length * direction_[i];
      }
      problem.velocities(trial_, xi_);
      stays = stays && residual(problem, trial_, xi_).value <= listed_residual;
      moves = moves || !same(trial_, xi_, k, true);
    }
    if (!stays) continue;
    unbounded_ = true;
    velocity_varies_ = velocity_varies_ || moves;
  }
}

void SolutionList::visit(const ContactProblem& problem, std::span<const std::size_t> choice, bool rays) {
  const std::size_t n = choice.size();
  std::size_t unknowns = 0, equations = 0;
  bool pure = true;
  for (std::size_t g = 0; g < n; ++g) {
    const Face& face = faces_[g][choice[g]];
    unknowns += static_cast<std::size_t>(face.unknowns);
    equations += static_cast<std::size_t>(face.equations);
    pure = pure && face.pure;
  }
  const auto place = [&](std::span<const double> x) {
    std::size_t k = 0;
    for (std::size_t g = 0; g < n; ++g) {
      const Face& face = faces_[g][choice[g]];
      const auto row = static_cast<std::size_t>(problem.groups()[g].first);
      const bool friction = problem.groups()[g].size == 2;
      trial_[row] = face.unknowns > 0 ? x[k++] : 0.0;
      if (friction) trial_[row + 1] = face.unknowns == 2 ? x[k++] : face.slope * trial_[row];
    }
  };
  const auto add_offsets = [&] {
    for (std::size_t g = 0; g < n; ++g) {
      trial_[static_cast<std::size_t>(problem.groups()[g].first)] += faces_[g][choice[g]].offset;
    }
  };

  if (unknowns == 0 || equations < unknowns) {
    if (unknowns > 0 || rays) return;
    place({});
    add_offsets();
    consider(problem);
    return;
  }

  // Equations scaled by sqrt(rho) of their group and unknowns by the factorisation: masses drop out.
  system_.assign(equations * unknowns, 0.0);
  rhs_.assign(equations, 0.0);
  unknown_.assign(unknowns, 0.0);
  std::size_t equation = 0;
  for (std::size_t g = 0; g < n; ++g) {
    for (int e = 0; e < faces_[g][choice[g]].equations; ++e, ++equation) {
      const auto row = static_cast<std::size_t>(problem.groups()[g].first + e);
      const double weight = std::sqrt(rho_[row]);
      double sum = problem.vector()[row];
      std::size_t k = 0;
      for (std::size_t h = 0; h < n; ++h) {
        const Face& face = faces_[h][choice[h]];
        const auto column = static_cast<std::size_t>(problem.groups()[h].first);
        const double* w = problem.matrix().data() + row * rows_;
        sum += w[column] * face.offset;
        if (face.unknowns == 1) {
          const double tangential = problem.groups()[h].size == 2 ? face.slope * w[column + 1] : 0.0;
          system_[equation * unknowns + k++] = weight * (w[column] + tangential);
        } else if (face.unknowns == 2) {
          system_[equation * unknowns + k++] = weight * w[column];
          system_[equation * unknowns + k++] = weight * w[column + 1];
        }
      }
      rhs_[equation] = -weight * sum;
    }
  }
  qr_->factor(system_, equations, unknowns, rank_tolerance);
  if (rays) {
    if (qr_->rank() + 1 != unknowns) return;
    qr_->null_vector(0, unknown_);
    for (const double sign : {1.0, -1.0}) {
      for (double& x : unknown_) x *= sign;
      place(unknown_);
      direction_ = trial_;
      follow(problem);
    }
    return;
  }
  if (qr_->rank() < unknowns) {
    // Its solutions, if any, are found at its boundaries.
    singular_ = singular_ || pure;
    return;
  }
  qr_->solve(rhs_, unknown_);
  place(unknown_);
  add_offsets();
  consider(problem);
}

void SolutionList::visit_all(const ContactProblem& problem, bool pure_only, bool rays) {
  const std::size_t n = faces_.size();
  std::array<std::size_t, enumeration_groups> choice{};
  for (;;) {
    bool pure = true;
    for (std::size_t g = 0; g < n; ++g) pure = pure && faces_[g][choice[g]].pure;
    if (pure || !pure_only) visit(problem, std::span(choice).first(n), rays);
    std::size_t g = 0;
    while (g < n && ++choice[g] == faces_[g].size()) choice[g++] = 0;
    if (g == n) return;
  }
}

Outcome SolutionList::conclude() {
  order_.resize(count_);
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  const auto sum = [&](std::size_t k) {
    double total = 0.0;
    for (std::size_t i = 0; i < rows_; ++i) total += std::abs(impulses_[k * rows_ + i]);
    return total;
  };
  std::sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
    const double of_a = sum(a), of_b = sum(b);
    return of_a < of_b || (of_a == of_b && a < b);
  });
  for (std::size_t k = 0; k < count_; ++k) {
    bool known = false;
    for (std::size_t j = 0; j < k && !known; ++j) {
      known = same(std::span(impulses_).subspan(k * rows_, rows_),
                   std::span(velocities_).subspan(k * rows_, rows_), j, true);
    }
    if (!known) ++end_velocities_;
  }
  if (count_ == 0) {
    // Without a single finite candidate the data were no numbers.
    const bool refuted = least_residual_ > refuted_residual && std::isfinite(least_residual_);
    return refuted ? Outcome::no_solution : Outcome::not_solved;
  }
  if (end_velocities_ > 1 || velocity_varies_) return Outcome::several_solutions;
  return count_ > 1 || unbounded_ ? Outcome::forces_not_unique : Outcome::solved;
}

Outcome SolutionList::enumerate(const ContactProblem& problem) {
  rows_ = static_cast<std::size_t>(problem.rows());
  count_ = end_velocities_ = 0;
  singular_ = unbounded_ = velocity_varies_ = false;
  least_residual_ = std::numeric_limits<double>::infinity();
  applicable_ = build_faces(problem);
  if (!applicable_) return Outcome::not_solved;
  trial_.assign(rows_, 0.0);
  xi_.assign(rows_, 0.0);
  set_scales(problem);
  visit_all(problem, true, false);
  if (singular_) {
    visit_all(problem, false, false);
    visit_all(problem, false, true);
  }
  return conclude();
}

}  // namespace carom

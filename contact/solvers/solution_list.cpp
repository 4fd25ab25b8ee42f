// Problem: prove how many solutions a small contact problem has.

#include <carom/contact/solvers/mode_faces.h>
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
constexpr double singular_part = 1e-11;

}  // namespace

/// Candidate at hand of an enumeration, and the equations it comes from.
struct SolutionList::Workspace {
  ModeFaces faces;
  std::vector<double> system, rhs, unknown;  // equations of a choice of faces
  RankRevealingQr qr;
  std::vector<double> trial, xi;  // impulses and velocities of a candidate
  std::vector<double> direction;  // null vector
};

SolutionList::SolutionList() : work_(new Workspace) {}
SolutionList::~SolutionList() = default;
SolutionList::SolutionList(SolutionList&&) noexcept = default;
SolutionList& SolutionList::operator=(SolutionList&&) noexcept = default;

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

// Takes the trial into the list if it is a solution and new.
void SolutionList::consider(const ContactProblem& problem) {
  std::vector<double>& trial = work_->trial;
  std::vector<double>& xi = work_->xi;
  // Rounding may leave an impulse beside its set; the residual is to judge the mode, not that.
  for (std::size_t i = 0; i < rows_; ++i) {
    const RowSet& set = problem.sets()[i];
    const double tiny = listed_residual * scale_;
    if (set.kind == SetKind::half_line && trial[i] < 0.0 && trial[i] > -tiny) trial[i] = 0.0;
    if (set.kind == SetKind::bounded_interval) {
      const double limit = set.coefficient * std::max(trial[static_cast<std::size_t>(set.bound)], 0.0);
      if (std::abs(trial[i]) > limit && std::abs(trial[i]) < limit + tiny) {
        trial[i] = std::copysign(limit, trial[i]);
      }
    }
    if (set.kind == SetKind::proportional) {
      trial[i] = set.coefficient * trial[static_cast<std::size_t>(set.bound)];
    }
  }
  problem.velocities(trial, xi);
  const double error = residual(problem, trial, xi).value;
  // The residual is one of the impulses: beside those without bound of a jam everything is small. A near miss
  // is one against the scale of the data, unless rounding of such impulses hides it.
  constexpr double rounding = 1e3 * std::numeric_limits<double>::epsilon();
  double size = scale_;
  for (const double impulse : trial) size = std::max(size, std::abs(impulse));
  const bool hidden = !(scale_ > 0.0) || error <= rounding;
  least_residual_ = std::min(least_residual_, hidden ? error : error * (size / scale_));
  if (!(error <= listed_residual)) return;
  for (std::size_t k = 0; k < count_; ++k) {
    if (same(trial, xi, k, false)) return;
  }
  impulses_.resize((count_ + 1) * rows_);
  velocities_.resize((count_ + 1) * rows_);
  std::copy(trial.begin(), trial.end(), impulses_.begin() + static_cast<std::ptrdiff_t>(count_ * rows_));
  std::copy(xi.begin(), xi.end(), velocities_.begin() + static_cast<std::ptrdiff_t>(count_ * rows_));
  ++count_;
}

// Adds multiples of the direction to the solutions found: do they stay solutions?
void SolutionList::follow(const ContactProblem& problem) {
  std::vector<double>& trial = work_->trial;
  std::vector<double>& xi = work_->xi;
  const std::vector<double>& direction = work_->direction;
  double length = 0.0;
  for (std::size_t i = 0; i < rows_; ++i) {
    length = std::max(length, std::abs(direction[i]));
    if (problem.sets()[i].kind == SetKind::half_line && direction[i] < 0.0) return;
  }
  if (!(length > 0.0)) return;
  for (std::size_t k = 0; k < count_; ++k) {
    double size = scale_;
    for (std::size_t i = 0; i < rows_; ++i) size = std::max(size, std::abs(impulses_[k * rows_ + i]));
    bool stays = true, moves = false;
    for (const double factor : {1.0, 3.0}) {
      for (std::size_t i = 0; i < rows_; ++i) {
        trial[i] = impulses_[k * rows_ + i] + factor * size / length * direction[i];
      }
      problem.velocities(trial, xi);
      stays = stays && residual(problem, trial, xi).value <= listed_residual;
      moves = moves || !same(trial, xi, k, true);
    }
    if (!stays) continue;
    unbounded_ = true;
    velocity_varies_ = velocity_varies_ || moves;
  }
}

void SolutionList::visit(const ContactProblem& problem, std::span<const std::size_t> choice, bool rays) {
  const ModeFaces& faces = work_->faces;
  const ModeFaces::Size size = faces.size(choice);
  std::vector<double>& unknown = work_->unknown;
  std::vector<double>& trial = work_->trial;
  if (size.unknowns == 0 || size.equations < size.unknowns) {
    if (size.unknowns > 0 || rays) return;
    faces.place(choice, {}, trial);
    faces.add_offsets(choice, trial);
    return consider(problem);
  }
  unknown.assign(size.unknowns, 0.0);
  faces.write_equations(problem, choice, rho_, work_->system, work_->rhs);
  work_->qr.factor(work_->system, size.equations, size.unknowns, singular_part);
  if (rays) {
    if (work_->qr.rank() + 1 != size.unknowns) return;
    work_->qr.null_vector(0, unknown);
    for (const double sign : {1.0, -1.0}) {
      for (double& x : unknown) x *= sign;
      faces.place(choice, unknown, trial);
      work_->direction = trial;
      follow(problem);
    }
    return;
  }
  if (work_->qr.rank() < size.unknowns) {
    // Its solutions, if any, are found at its boundaries.
    singular_ = singular_ || size.pure;
    return;
  }
  work_->qr.solve(work_->rhs, unknown);
  faces.place(choice, unknown, trial);
  faces.add_offsets(choice, trial);
  consider(problem);
}

void SolutionList::visit_all(const ContactProblem& problem, bool pure_only, bool rays) {
  const ModeFaces& faces = work_->faces;
  const std::size_t n = faces.groups();
  std::array<std::size_t, enumeration_groups> every{};
  const std::span<std::size_t> choice = std::span(every).first(n);
  for (;;) {
    if (!pure_only || faces.size(choice).pure) visit(problem, choice, rays);
    std::size_t g = 0;
    while (g < n && ++choice[g] == faces.count(g)) choice[g++] = 0;
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
  applicable_ = work_->faces.build(problem);
  if (!applicable_) return Outcome::not_solved;
  work_->trial.assign(rows_, 0.0);
  work_->xi.assign(rows_, 0.0);
  set_scales(problem);
  visit_all(problem, true, false);
  if (singular_) {
    visit_all(problem, false, false);
    visit_all(problem, false, true);
  }
  return conclude();
}

std::span<const double> SolutionList::impulse(std::size_t index) const {
  return std::span(impulses_).subspan(order_[index] * rows_, rows_);
}
std::span<const double> SolutionList::velocity(std::size_t index) const {
  return std::span(velocities_).subspan(order_[index] * rows_, rows_);
}

}  // namespace carom

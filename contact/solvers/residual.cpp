// Problem: judge an answer without trusting whoever gave it.

#include <carom/contact/solvers/residual.h>

#include <carom/contact/solvers/planar_certificate.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// distance() of a planar contact; raises the scale P* by its own. All in one go: a settled pile costs as many
// of these as it has contacts, in each step.
double planar_distance(double friction, const double* p, const double* b, const double* xi, double rho,
                       double& scale) {
  const double limit = friction * std::max(p[0], 0.0);
  const double error_n = std::abs(p[0] - std::max(p[0] - rho * xi[0], 0.0));
  const double error_t = std::abs(p[1] - std::min(std::max(p[1] - rho * xi[1], -limit), limit));
  const double size = std::max(std::max(std::abs(p[0]), std::abs(p[1])),
                               std::max(std::abs(b[0] * rho), std::abs(b[1] * rho)));
  // Sums carry a NaN along where maxima may drop it.
  const double sum = (error_n + error_t) + (p[0] + p[1]) + (b[0] + b[1]);
  scale = std::max(scale, std::isnan(sum) ? infinity : size);
  return std::isnan(sum) ? infinity : std::max(error_n, error_t);
}

// max over the group's rows of |P - proj_C(P - rho xi)| [N s].
double distance(const ContactProblem& problem, const RowGroup& group, std::span<const double> impulse,
                std::span<const double> xi, double rho) {
  const std::span<const RowSet> sets = problem.sets();
  double worst = 0.0;
  const auto last = static_cast<std::size_t>(group.first + group.size);
  for (auto i = static_cast<std::size_t>(group.first); i < last; ++i) {
    const RowSet& set = sets[i];
    const double moved = impulse[i] - rho * xi[i];
    switch (set.kind) {
      case SetKind::half_line:
        worst = larger_magnitude(worst, impulse[i] - std::max(moved, 0.0));
        break;
      case SetKind::interval:
        worst = larger_magnitude(worst, impulse[i] - std::min(std::max(moved, set.lower), set.upper));
        break;
      case SetKind::bounded_interval: {
        const double radius = set.coefficient * std::max(impulse[static_cast<std::size_t>(set.bound)], 0.0);
        worst = larger_magnitude(worst, impulse[i] - std::min(std::max(moved, -radius), radius));
        break;
      }
      case SetKind::bounded_disc: {
        const double radius = set.coefficient * std::max(impulse[static_cast<std::size_t>(set.bound)], 0.0);
        const double second = impulse[i + 1] - rho * xi[i + 1];
        const double length = std::hypot(moved, second);
        const double shrink = length > radius ? radius / length : 1.0;
        worst = larger_magnitude(worst, impulse[i] - shrink * moved);
        worst = larger_magnitude(worst, impulse[i + 1] - shrink * second);
        ++i;
        break;
      }
      case SetKind::proportional:
        worst = larger_magnitude(worst,
                                 impulse[i] - set.coefficient * impulse[static_cast<std::size_t>(set.bound)]);
        break;
    }
  }
  return worst;
}

// rho of the groups of a problem.
class GroupSteps {
public:
  explicit GroupSteps(const ContactProblem& problem) : problem_(problem) {
    const double largest = largest_trace(problem);
    least_trace_ = largest * negligible_trace;
    of_immovable_ = largest > 0.0 ? 1.0 / largest : 1.0;
  }
  [[nodiscard]] double of(const RowGroup& group) const { return of_trace(group_trace(problem_, group)); }
  [[nodiscard]] double of_trace(double own) const { return own > least_trace_ ? 1.0 / own : of_immovable_; }

private:
  const ContactProblem& problem_;
  double least_trace_, of_immovable_;
};

}  // namespace

double largest_trace(const ContactProblem& problem) {
  if (problem.is_factored()) return problem.factors().largest_trace;
  double largest = 0.0;
  for (const RowGroup& group : problem.groups())
    largest = larger_magnitude(largest, group_trace(problem, group));
  return largest;
}

Residual residual(const ContactProblem& problem, std::span<const double> impulse,
                  std::span<const double> xi) {
  const std::span<const RowSet> sets = problem.sets();
  const std::span<const double> b = problem.vector();
  if (problem.rows() == 2 && problem.groups().size() == 1 && sets[0].kind == SetKind::half_line &&
      sets[1].kind == SetKind::bounded_interval) {
    return {planar_residual({problem.diagonal(0) + problem.diagonal(1), b[0], b[1], sets[1].coefficient,
                             impulse[0], impulse[1], xi[0], xi[1]}),
            0};
  }
  const GroupSteps steps(problem);

  // A NaN anywhere makes P* or a distance infinite, or is caught by the comparison below.
  double scale = 0.0;
  Residual worst;
  const std::span<const RowGroup> groups = problem.groups();
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const RowGroup& group = groups[g];
    const auto first = static_cast<std::size_t>(group.first);
    double error = 0.0;
    if (is_planar_contact(sets, group)) {
      const double rho = steps.of_trace(problem.diagonal(group.first) + problem.diagonal(group.first + 1));
      error =
          planar_distance(sets[first + 1].coefficient, &impulse[first], &b[first], &xi[first], rho, scale);
    } else {
      const double rho = steps.of(group);
      for (std::size_t i = first; i < first + static_cast<std::size_t>(group.size); ++i) {
        scale = larger_magnitude(scale, impulse[i]);
        scale = larger_magnitude(scale, b[i] * rho);
      }
      error = distance(problem, group, impulse, xi, rho);
    }
    if (worst.group < 0 || error > worst.value) worst = {error, static_cast<int>(g)};
  }
  if (worst.value == 0.0 && scale < infinity) return worst;
  if (scale == 0.0) return {0.0, worst.group};
  const double relative = worst.value / std::max(scale, least_scale);
  return {std::isfinite(relative) && scale < infinity ? relative : infinity, worst.group};
}

double residual_of_velocities(const ContactProblem& problem, std::span<const double> impulse,
                              std::span<const double> xi) {
  const GroupSteps steps(problem);
  double worst = 0.0, largest = 0.0;
  for (const RowGroup& group : problem.groups()) {
    const double rho = steps.of(group);
    worst = larger_magnitude(worst, distance(problem, group, impulse, xi, rho) / rho);
  }
  for (const double velocity : problem.vector()) largest = larger_magnitude(largest, velocity);
  if (worst == 0.0) return 0.0;
  const double relative = worst / (largest > 0.0 ? std::max(largest, least_scale) : 0.0);
  return std::isfinite(relative) ? relative : infinity;
}

}  // namespace carom

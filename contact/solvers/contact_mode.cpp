// Problem: name the mode of a contact from the numbers of its solution.

#include <carom/contact/solvers/contact_mode.h>

#include <carom/contact/solvers/planar_certificate.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

ContactMode interval_mode(const RowSet& set, double impulse, double xi, double impulse_scale,
                          double velocity_scale) {
  const double margin = mode_threshold * impulse_scale;
  const bool moves = std::abs(xi) > mode_threshold * velocity_scale;
  // Bounds may be small against the impulses around them, so what moves is told from them.
  if (moves && xi > 0.0 && impulse <= set.lower + margin) {
    return set.lower == 0.0 ? ContactMode::open : ContactMode::slip_positive;
  }
  if (moves && xi < 0.0 && impulse >= set.upper - margin) {
    return set.upper == 0.0 ? ContactMode::open : ContactMode::slip_negative;
  }
  return std::abs(impulse) <= margin ? ContactMode::open : ContactMode::stick;
}

// Written where it is called: a settled pile costs as many of these as it has contacts, in each step.
[[gnu::always_inline]] inline ContactMode mode_of_planar(const ContactProblem& problem, const RowGroup& group,
                                                         std::span<const RowSet> sets, const double* vector,
                                                         std::span<const double> impulse,
                                                         std::span<const double> xi) {
  const auto first = static_cast<std::size_t>(group.first);
  const double* const b = vector + first;
  return planar_mode({problem.diagonal(group.first) + problem.diagonal(group.first + 1), b[0], b[1],
                      sets[first + 1].coefficient, impulse[first], impulse[first + 1], xi[first],
                      xi[first + 1]});
}

}  // namespace

ContactMode contact_mode(const ContactProblem& problem, const RowGroup& group,
                         std::span<const double> impulse, std::span<const double> xi) {
  const std::span<const RowSet> sets = problem.sets();
  const std::span<const double> vector = problem.vector();
  if (is_planar_contact(sets, group)) return mode_of_planar(problem, group, sets, vector.data(), impulse, xi);
  double trace = 0.0, largest_impulse = 0.0, largest_b = 0.0, velocity_scale = 0.0;
  const auto first = static_cast<std::size_t>(group.first);
  for (std::size_t i = first; i < first + static_cast<std::size_t>(group.size); ++i) {
    const int row = static_cast<int>(i);
    trace += problem.diagonal(row);
    largest_impulse = std::max(largest_impulse, std::abs(impulse[i]));
    largest_b = std::max(largest_b, std::abs(vector[i]));
    velocity_scale = std::max(velocity_scale, std::abs(xi[i]));
  }
  const double impulse_scale = trace > 0.0 ? std::max(largest_impulse, largest_b / trace) : largest_impulse;
  velocity_scale = std::max(velocity_scale, largest_b);

  const RowSet& own = sets[first];
  if (own.kind == SetKind::interval && group.size == 1) {
    return interval_mode(own, impulse[first], xi[first], impulse_scale, velocity_scale);
  }
  if (impulse[first] <= mode_threshold * impulse_scale) return ContactMode::open;
  if (group.size == 1) return ContactMode::stick;

  const RowSet& friction = sets[first + 1];
  if (friction.kind == SetKind::proportional) return sliding_mode(friction.coefficient);
  const double limit = (1.0 - mode_threshold) * friction.coefficient * impulse[first];
  if (friction.kind == SetKind::bounded_disc) {
    const bool slips = std::hypot(xi[first + 1], xi[first + 2]) > mode_threshold * velocity_scale &&
                       std::hypot(impulse[first + 1], impulse[first + 2]) >= limit;
    return slips ? ContactMode::slip : ContactMode::stick;
  }
  const double slip_speed = xi[first + 1];
  if (std::abs(slip_speed) <= mode_threshold * velocity_scale || std::abs(impulse[first + 1]) < limit) {
    return ContactMode::stick;
  }
  return slip_speed > 0.0 ? ContactMode::slip_positive : ContactMode::slip_negative;
}

void contact_modes(const ContactProblem& problem, std::span<const double> impulse, std::span<const double> xi,
                   std::span<ContactMode> modes) {
  const std::span<const RowGroup> groups = problem.groups();
  const std::span<const RowSet> sets = problem.sets();
  const double* const vector = problem.vector().data();
  for (std::size_t g = 0; g < modes.size(); ++g) {
    const RowGroup& group = groups[g];
    modes[g] = is_planar_contact(sets, group) ? mode_of_planar(problem, group, sets, vector, impulse, xi)
                                              : contact_mode(problem, group, impulse, xi);
  }
}

bool at_mode_boundary(const ContactProblem& problem, std::span<const double> impulse,
                      std::span<const double> xi) {
  const std::span<const RowSet> sets = problem.sets();
  const std::span<const double> vector = problem.vector();
  for (const RowGroup& group : problem.groups()) {
    const auto first = static_cast<std::size_t>(group.first);
    const std::size_t last = first + static_cast<std::size_t>(group.size);
    double trace = 0.0, scale = 0.0;
    for (std::size_t i = first; i < last; ++i) trace += problem.diagonal(static_cast<int>(i));
    const double rho = trace > 0.0 ? 1.0 / trace : 0.0;
    for (std::size_t i = first; i < last; ++i) {
      scale = std::max({scale, std::abs(impulse[i]), rho * std::abs(vector[i])});
    }
    const double near = boundary_threshold * scale;
    for (std::size_t i = first; i < last; ++i) {
      const RowSet& set = sets[i];
      const double moved = impulse[i] - rho * xi[i];
      if (set.kind == SetKind::half_line) {
        if (std::abs(moved) <= near) return true;
      } else if (set.kind == SetKind::interval) {
        if (std::abs(moved - set.lower) <= near || std::abs(moved - set.upper) <= near) return true;
      } else if (set.kind != SetKind::proportional) {
        const double limit = set.coefficient * impulse[static_cast<std::size_t>(set.bound)];
        const bool disc = set.kind == SetKind::bounded_disc;
        const double length = disc ? std::hypot(moved, impulse[i + 1] - rho * xi[i + 1]) : std::abs(moved);
        if (limit > near && std::abs(length - limit) <= near) return true;
        if (disc) ++i;
      }
    }
  }
  return false;
}

}  // namespace carom

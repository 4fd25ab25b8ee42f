#include <carom/core/errors.h>
#include <carom/joints/nonlinear_spring.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace carom::generic {

template <int D>
PartType<ForceKind> NonlinearSpring<D>::part_type() {
  return PartType<ForceKind>::of<ForceElementKind<NonlinearSpring>, NonlinearSpring>();
}

template <int D>
void NonlinearSpring<D>::check(const PartCheck& check) const {
  check_line_ends(check, from, to);
  check.non_negative(damping, "damping", "N s/m");
  if (!force) check.refuse("force", "not given", "a function of the length");
  if (!potential_of) check.refuse("potential_of", "not given", "a function of the length");
  const double length = LineOfAction<D>::described(check.system(), from, to).length;
  if (length == 0.0) return;
  check.finite(force(length), "force at length " + to_text(length) + " m", "N");
  check.finite(potential_of(length), "potential_of at length " + to_text(length) + " m", "J");
  if (!force_by_length) return;
  check.finite(force_by_length(length), "force_by_length at length " + to_text(length) + " m", "N/m");
}

template <int D>
void NonlinearSpring<D>::check_potential(double shortest, double longest, double tolerance) const {
  constexpr int intervals = 64;
  const auto refuse = [](const std::string& what) { throw ModelError(std::string(label) + ": " + what); };
  if (!force) refuse("force is not given; allowed: a function of the length");
  if (!potential_of) refuse("potential_of is not given; allowed: a function of the length");
  if (!(std::isfinite(shortest) && shortest >= 0.0)) {
    refuse("shortest is " + to_text(shortest) + " m; allowed: finite and >= 0");
  }
  if (!(std::isfinite(longest) && longest > shortest)) {
    refuse("longest is " + to_text(longest) + " m; allowed: finite and > shortest");
  }
  if (!(std::isfinite(tolerance) && tolerance > 0.0)) {
    refuse("tolerance is " + to_text(tolerance) + "; allowed: finite and > 0");
  }
  const auto finite = [&](double value, const char* what, double length) {
    if (!std::isfinite(value)) {
      refuse(std::string(what) + " at length " + to_text(length) + " m is " + to_text(value) +
             "; allowed: a finite number");
    }
    return value;
  };
  // Abscissae and weights of Gauss and Legendre on [-1, 1], the weights halved.
  constexpr std::array<double, 5> points{-0.90617984593866399, -0.53846931010568309, 0.0, 0.53846931010568309,
                                         0.90617984593866399};
  constexpr std::array<double, 5> weights{0.11846344252809454, 0.23931433524968324, 0.28444444444444444,
                                          0.23931433524968324, 0.11846344252809454};
  const double width = (longest - shortest) / intervals;
  const auto edge = [&](int i) { return shortest + width * i; };
  std::array<double, intervals> work{}, growth{};
  double largest = 0.0;
  double before = finite(potential_of(edge(0)), "potential_of", edge(0));
  for (int i = 0; i < intervals; ++i) {
    for (std::size_t j = 0; j < points.size(); ++j) {
      const double length = edge(i) + 0.5 * width * (1.0 + points[j]);
      const double value = finite(force(length), "force", length);
      work[static_cast<std::size_t>(i)] += width * weights[j] * value;
      largest = std::max(largest, std::abs(value));
    }
    const double after = finite(potential_of(edge(i + 1)), "potential_of", edge(i + 1));
    growth[static_cast<std::size_t>(i)] = after - before;
    before = after;
  }
  for (int i = 0; i < intervals; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (std::abs(growth[at] - work[at]) <= tolerance * width * largest) continue;
    refuse("growth of potential_of from length " + to_text(edge(i)) + " m to " + to_text(edge(i + 1)) +
           " m is " + to_text(growth[at]) + " J; allowed: the work of force, " + to_text(work[at]) +
           " J, within " + to_text(tolerance * width * largest) + " J");
  }
}

template PartType<ForceKind> NonlinearSpring<2>::part_type();
template PartType<ForceKind> NonlinearSpring<3>::part_type();
template void NonlinearSpring<2>::check(const PartCheck&) const;
template void NonlinearSpring<3>::check(const PartCheck&) const;
template void NonlinearSpring<2>::check_potential(double, double, double) const;
template void NonlinearSpring<3>::check_potential(double, double, double) const;

}  // namespace carom::generic

#pragma once

/// \file
/// Spring given by a function of its length and the potential of that function.

#include <carom/core/difference_derivatives.h>
#include <carom/core/errors.h>
#include <carom/core/force_element.h>
#include <carom/joints/line_of_action.h>
#include <carom/joints/mean_line.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace carom {

namespace generic {

/// Spring between two ends along the line between them, with a linear dashpot in parallel: at the length l
/// it pulls the ends together with T(l) + c dl/dt (T < 0 pushes), T = dV/dl. Where the ends coincide there is
/// no direction and no force.
template <int D>
struct NonlinearSpring {
  static constexpr Role role = Role::force;
  static constexpr int dimension = D;
  static constexpr std::string_view label = "nonlinear spring";
  static constexpr StoredEnergy stored = StoredEnergy::elastic;
  static constexpr bool depends_on_time = false;
  /// Its type, for System::add().
  [[nodiscard]] CAROM_API static PartType<ForceKind> part_type();

  End<D> from{};                                        ///< required
  End<D> to{};                                          ///< required
  std::function<double(double length)> force{};         ///< T, positive where it pulls [N] (required)
  std::function<double(double length)> potential_of{};  ///< V, with dV/dl = T [J] (required)
  double damping = 0.0;                                 ///< c >= 0 [N s/m]
  /// dT/dl [N/m]; if not given, by a central difference of `force` with the step 6e-6 l.
  std::function<double(double length)> force_by_length{};

  /// The bodies that it connects.
  [[nodiscard]] std::vector<BodyId> bodies() const { return {from.body, to.body}; }
  /// Throws ModelError for invalid ends, functions or numbers. The functions are tried at the length
  /// that the bodies are described with, unless it is 0. Whether force and potential fit is not checked here:
  /// see check_potential().
  void check(const PartCheck& check) const {
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
  /// Books spring and dashpot.
  void loads(const ElementView<D>& at, ElementLoads<D>& out) const {
    const LineOfAction<D> line(at, from, to);
    if (line.length == 0.0) return;
    const Vec<D> elastic = force(line.length) * line.direction;
    const Vec<D> viscous = damping * line.rate * line.direction;
    book_pull(out, from, to, elastic, viscous);
  }
  /// Books spring and dashpot over a step.
  void mean_loads(const ElementStep<D>& step, ElementLoads<D>& out) const {
    const MeanLine<D> line(step, from, to);
    if (line.length == 0.0) return;
    const Vec<D> elastic = line.mean_tension(force, potential_of) * line.direction;
    const Vec<D> viscous = damping * (line.growth / step.step) * line.direction;
    book_pull(out, from, to, elastic, viscous);
  }
  /// Derivatives: the law's, the line's in closed form.
  void derivatives(const ElementView<D>& at, ElementDerivatives<D>& out) const {
    const LineOfAction<D> line(at, from, to);
    if (line.length == 0.0) return;
    line.add_pull(out, from, to, force(line.length) + damping * line.rate, slope(line.length), damping);
  }
  /// Whether its ends stand at one place although its force does not vanish there.
  [[nodiscard]] bool lacks_direction(const ElementView<D>& at, double fastest) const {
    return at_one_place(at.context(), at.attach(from), at.attach(to), fastest) && stays_without_length(force);
  }
  /// V(l) [J].
  [[nodiscard]] double potential(const ElementView<D>& at) const {
    return potential_of((at.position(to) - at.position(from)).norm());
  }
  /// Adds ends and damping (a function cannot be hashed).
  void fingerprint(Fingerprint& print) const {
    add_to(print, from);
    add_to(print, to);
    print.add(damping);
  }

  /// Demands that the potential fits the force between two lengths: over each of 64 equal intervals its
  /// increase must be the integral of the force (five Gauss points), within `tolerance` times the width of
  /// the interval times the largest force found. Smooth functions pass at 1e-9; a kink of the force in an
  /// interval adds an error of about 1e-3 of the change of the force over it. Throws ModelError.
  void check_potential(double shortest, double longest, double tolerance = 1e-9) const {
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
    constexpr std::array<double, 5> points{-0.90617984593866399, -0.53846931010568309, 0.0,
                                           0.53846931010568309, 0.90617984593866399};
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

private:
  // dT/dl. The step is relative to l, so that the law is evaluated at lengths > 0 only.
  [[nodiscard]] double slope(double length) const {
    return force_by_length ? force_by_length(length) : difference_quotient(force, length, length);
  }
};

}  // namespace generic

namespace planar {
using NonlinearSpring = generic::NonlinearSpring<2>;  ///< generic::NonlinearSpring in the plane
}
namespace spatial {
using NonlinearSpring = generic::NonlinearSpring<3>;  ///< generic::NonlinearSpring in space
}

}  // namespace carom

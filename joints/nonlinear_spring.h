#pragma once

/// \file
/// Spring given by a function of its length and the potential of that function.

#include <carom/core/difference_derivatives.h>
#include <carom/core/force_element.h>
#include <carom/joints/line_of_action.h>
#include <carom/joints/mean_line.h>

#include <functional>
#include <string_view>
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
  CAROM_API void check(const PartCheck& check) const;
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
  CAROM_API void check_potential(double shortest, double longest, double tolerance = 1e-9) const;

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

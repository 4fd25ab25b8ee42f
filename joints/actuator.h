#pragma once

/// \file
/// Actuators: forces and torques between two ends by laws of time and motion.

#include <carom/core/export.h>
#include <carom/core/force_element.h>
#include <carom/joints/line_of_action.h>

#include <functional>
#include <string>
#include <vector>

namespace carom {

/// The law of an actuator: f(t, x, dx/dt).
using ActuatorLaw = std::function<double(double time, double coordinate, double rate)>;

/// Derivatives of the law of an actuator by its coordinate and rate: as given, else by central differences.
struct CAROM_API ActuatorSlopes {
  /// \param by_coordinate derivative by x, may be empty; then the step is 6e-6 times `size`
  /// \param by_rate derivative by dx/dt, may be empty; then the step is 6e-6 times max(1, |dx/dt|)
  ActuatorSlopes(const ActuatorLaw& law, const ActuatorLaw& by_coordinate, const ActuatorLaw& by_rate,
                 double time, double x, double rate, double size);

  double by_x;      ///< df/dx
  double by_speed;  ///< df/d(dx/dt)
};

/// The laws of an actuator as its check sees them, with their words for messages; a view.
struct CAROM_API ActuatorLaws {
  const ActuatorLaw& law;                      ///< required
  const ActuatorLaw& by_coordinate;            ///< derivative by the coordinate, may be empty
  const ActuatorLaw& by_rate;                  ///< derivative by the rate, may be empty
  std::string name, unit;                      ///< of the law: "force", "N"
  std::string coordinate, unit_of_coordinate;  ///< "length", "m"

  /// Demands that the law is given.
  void demand_given(const PartCheck& check) const;
  /// Demands that the law and the derivatives that are given are finite at time 0. \param x, rate at the
  /// start
  void demand_finite(const PartCheck& check, double x, double rate) const;
};

namespace generic {

/// Linear actuator between two ends: pushes them apart along the line between them with f(t, l, dl/dt), l
/// their distance. Its work is external work. Where the ends coincide there is no direction and no force.
template <int D>
struct LinearActuator {
  static constexpr Role role = Role::force;
  static constexpr int dimension = D;
  static constexpr std::string_view label = "linear actuator";
  /// Its type, for System::add().
  [[nodiscard]] CAROM_API static PartType<ForceKind> part_type();

  End<D> from{};  ///< required
  End<D> to{};    ///< required
  /// f, positive where it pushes apart [N] (required).
  ActuatorLaw force{};
  /// df/dl [N/m] and df/d(dl/dt) [N s/m]; what is not given is found by a central difference of `force` with
  /// the step 6e-6 l, 6e-6 max(1 m/s, |dl/dt|).
  ActuatorLaw force_by_length{};
  ActuatorLaw force_by_rate{};
  std::vector<double> breaks{};  ///< when `force` jumps or has a kink in time, ascending [s]

  /// The bodies that it connects.
  [[nodiscard]] std::vector<BodyId> bodies() const { return {from.body, to.body}; }
  /// Throws ModelError for invalid ends or an invalid law. The law is tried at time 0 with the length and
  /// rate that the bodies are described with, unless the length is 0.
  void check(const PartCheck& check) const {
    check_line_ends(check, from, to);
    const ActuatorLaws laws{force, force_by_length, force_by_rate, "force", "N", "length", "m"};
    laws.demand_given(check);
    const auto start = LineOfAction<D>::described(check.system(), from, to);
    if (start.length != 0.0) laws.demand_finite(check, start.length, start.rate);
  }
  /// Books the loads.
  void loads(const ElementView<D>& at, ElementLoads<D>& out) const {
    const LineOfAction<D> line(at, from, to);
    if (line.length == 0.0) return;
    const Vec<D> push = force(at.time(), line.length, line.rate) * line.direction;
    out.external(from, -push);
    out.external(to, push);
  }
  /// Whether its ends stand at one place although its force, at a rate of zero, does not vanish there.
  [[nodiscard]] bool lacks_direction(const ElementView<D>& at, double fastest) const {
    return at_one_place(at.context(), at.attach(from), at.attach(to), fastest) &&
           stays_without_length([&](double length) { return force(at.time(), length, 0.0); });
  }
  /// Derivatives: the law's, the line's in closed form.
  void derivatives(const ElementView<D>& at, ElementDerivatives<D>& out) const {
    const LineOfAction<D> line(at, from, to);
    if (line.length == 0.0) return;
    const double push = force(at.time(), line.length, line.rate);
    // The step is relative to l, so that the law is evaluated at lengths > 0 only.
    const ActuatorSlopes slopes(force, force_by_length, force_by_rate, at.time(), line.length, line.rate,
                                line.length);
    line.add_pull(out, from, to, -push, -slopes.by_x, -slopes.by_speed);
  }
  /// Adds the ends (a function cannot be hashed).
  void fingerprint(Fingerprint& print) const {
    add_to(print, from);
    add_to(print, to);
  }
};

}  // namespace generic

namespace planar {

using LinearActuator = generic::LinearActuator<2>;  ///< generic::LinearActuator in the plane

/// Rotary actuator between two rigid bodies, or one and the ground: the torque m(t, a, da/dt) on `to`, the
/// opposite on `from`, a: the angle of `to` relative to `from`, full turns counted. Its work is external
/// work.
struct CAROM_API RotaryActuator {
  static constexpr Role role = Role::force;
  static constexpr int dimension = 2;
  static constexpr std::string_view label = "rotary actuator";
  /// Its type, for System::add().
  [[nodiscard]] static PartType<ForceKind> part_type();

  BodyId from{};  ///< a rigid body or ground (required)
  BodyId to{};    ///< a rigid body or ground (required)
  /// m, counter-clockwise on `to` [N m] (required).
  ActuatorLaw torque{};
  /// dm/da [N m/rad] and dm/d(da/dt) [N m s/rad]; what is not given is found by a central difference of
  /// `torque` with the step 6e-6 max(1 rad, |a|), 6e-6 max(1 rad/s, |da/dt|).
  ActuatorLaw torque_by_angle{};
  ActuatorLaw torque_by_rate{};
  std::vector<double> breaks{};  ///< when `torque` jumps or has a kink in time, ascending [s]

  /// The bodies that it connects.
  [[nodiscard]] std::vector<BodyId> bodies() const;
  /// Throws ModelError for invalid bodies or an invalid law. The law is tried at time 0 with the angle and
  /// rate that the bodies are described with.
  void check(const PartCheck& check) const;
  /// Books the loads.
  void loads(const ElementView<2>& at, ElementLoads<2>& out) const;
  /// Derivatives: the law's.
  void derivatives(const ElementView<2>& at, ElementDerivatives<2>& out) const;
  /// Adds nothing to the identities of the bodies (a function cannot be hashed).
  void fingerprint(Fingerprint&) const;
};

}  // namespace planar

namespace spatial {
using LinearActuator = generic::LinearActuator<3>;  ///< generic::LinearActuator in space
}

}  // namespace carom

#pragma once

/// \file
/// Maxwell element: a spring and a dashpot in series.

#include <carom/core/force_element.h>
#include <carom/joints/line_of_action.h>
#include <carom/joints/mean_line.h>

#include <vector>

namespace carom {

namespace generic {

/// Spring and dashpot in series between two ends, along the line between them. With the length l and the
/// extension s of the dashpot (its internal variable [m]) it pulls the ends together with
///     T = k (l - L - s),   ds/dt = T / c.
/// At constant length T decays as exp(-k t / c). Where the ends coincide there is no direction and no force.
/// In a step s follows from the trapezoidal rule in closed form, so a short relaxation time c / k does not
/// limit the step.
template <int D>
struct MaxwellElement {
  static constexpr Role role = Role::force;
  static constexpr int dimension = D;
  static constexpr std::string_view label = "Maxwell element";
  static constexpr StoredEnergy stored = StoredEnergy::elastic;
  static constexpr int internal_size = 1;
  static constexpr bool depends_on_time = false;
  /// Its type, for System::add().
  [[nodiscard]] CAROM_API static PartType<ForceKind> part_type();

  End<D> from{};             ///< required
  End<D> to{};               ///< required
  double stiffness = 0.0;    ///< k > 0 [N/m]
  double damping = 0.0;      ///< c > 0 [N s/m]
  double free_length = 0.0;  ///< L >= 0 [m]
  double lengthening = 0.0;  ///< s at the start [m]

  /// The bodies that it connects.
  [[nodiscard]] std::vector<BodyId> bodies() const { return {from.body, to.body}; }
  /// Throws ModelError for invalid ends or numbers.
  void check(const PartCheck& check) const {
    check_line_ends(check, from, to);
    check.positive(stiffness, "stiffness", "N/m");
    check.positive(damping, "damping", "N s/m");
    check.non_negative(free_length, "free_length", "m");
    check.finite(lengthening, "lengthening", "m");
  }
  /// Books the whole force as conservative: the loss is inside the element.
  void loads(const ElementView<D>& at, ElementLoads<D>& out) const {
    const LineOfAction<D> line(at, from, to);
    if (line.length == 0.0) return;
    pull(tension(line.length, *at.internal()) * line.direction, out);
  }
  /// Books the force over a step.
  void mean_loads(const ElementStep<D>& step, ElementLoads<D>& out) const {
    const MeanLine<D> line(step, from, to);
    pull(mean_tension(step, line) * line.direction, out);
  }
  /// Whether its ends stand at one place although its force does not vanish there.
  [[nodiscard]] bool lacks_direction(const ElementView<D>& at, double fastest) const {
    return tension(0.0, *at.internal()) != 0.0 &&
           at_one_place(at.context(), at.attach(from), at.attach(to), fastest);
  }
  /// T^2 / (2 k) [J].
  [[nodiscard]] double potential(const ElementView<D>& at) const {
    const double pull = tension(length(at), *at.internal());
    return 0.5 * pull * pull / stiffness;
  }
  /// Writes s.
  void initial_internal(double* z) const { z[0] = lengthening; }
  /// Writes ds/dt [m/s].
  void internal_rates(const ElementView<D>& at, double* rates) const {
    rates[0] = tension(length(at), *at.internal()) / damping;
  }
  /// s1 = s0 + (h / 2 c) (T0 + T1), solved for s1.
  void advance_internal(const ElementStep<D>& step, double* z) const {
    const double share = 0.5 * step.step * stiffness / damping;
    const double s = *step.start.internal();
    const double stretches = length(step.start) + length(step.end) - 2.0 * free_length;
    z[0] = s + share / (1.0 + share) * (stretches - 2.0 * s);
  }
  /// T^2 / c [W].
  [[nodiscard]] double internal_loss_rate(const ElementView<D>& at) const {
    const double pull = tension(length(at), *at.internal());
    return pull * pull / damping;
  }
  /// h T^2 / c of the mean tension [J]: the work done on the element minus the change of its spring's energy.
  [[nodiscard]] double internal_loss(const ElementStep<D>& step) const {
    const double pull = mean_tension(step, MeanLine<D>(step, from, to));
    return step.step * pull * pull / damping;
  }
  /// Adds ends and numbers.
  void fingerprint(Fingerprint& print) const {
    add_to(print, from);
    add_to(print, to);
    print.add(stiffness);
    print.add(damping);
    print.add(free_length);
    print.add(lengthening);
  }

private:
  [[nodiscard]] double length(const ElementView<D>& at) const {
    return (at.position(to) - at.position(from)).norm();
  }
  [[nodiscard]] double tension(double length, double s) const {
    return stiffness * (length - free_length - s);
  }
  [[nodiscard]] double mean_tension(const ElementStep<D>& step, const MeanLine<D>& line) const {
    return tension(line.length, 0.5 * (*step.start.internal() + *step.end.internal()));
  }
  void pull(const Vec<D>& force, ElementLoads<D>& out) const {
    out.conservative(from, force);
    out.conservative(to, -force);
  }
};

}  // namespace generic

namespace planar {
using MaxwellElement = generic::MaxwellElement<2>;  ///< generic::MaxwellElement in the plane
}
namespace spatial {
using MaxwellElement = generic::MaxwellElement<3>;  ///< generic::MaxwellElement in space
}

}  // namespace carom

#pragma once

/// \file
/// Springs with a dashpot in parallel that act in one direction only: a cable pulls, a bumper pushes.

#include <carom/core/force_element.h>
#include <carom/joints/length_guard.h>
#include <carom/joints/line_of_action.h>
#include <carom/joints/mean_line.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace carom {

namespace generic {

/// A spring-dashpot between two ends that is slack, without force, on one side of its free length L.
/// With x >= 0 the excess beyond L (extension of a cable, l - L; compression of a bumper, L - l):
///
///     spring  s = k x                      conservative, with the potential k x^2 / 2
///     dashpot p = c dx/dt in [-s, s]       dissipative, p dx/dt >= 0 always
///
/// and the total s + p in [0, 2 s] decreases x. The dashpot force is limited, the spring force is not. The
/// lower limit keeps the sign of the total: while x falls faster than k x/c there is no force, and the
/// dashpot dissipates the energy of the spring. The upper limit avoids a jump of the force where the element
/// goes taut, with which some implicit steps have no solution. Where the ends coincide there is no direction
/// and no force.
template <int D, bool Pulls>
struct OneSidedSpring {
  static constexpr Role role = Role::force;
  static constexpr int dimension = D;
  static constexpr std::string_view label = Pulls ? "cable" : "bumper";
  static constexpr StoredEnergy stored = StoredEnergy::elastic;
  static constexpr bool depends_on_time = false;
  static constexpr int guard_size = 1;
  /// Its type, for System::add().
  [[nodiscard]] CAROM_API static PartType<ForceKind> part_type();

  End<D> from{};             ///< required
  End<D> to{};               ///< required
  double stiffness = 0.0;    ///< k > 0 [N/m]
  double damping = 0.0;      ///< c >= 0 [N s/m]
  double free_length = 0.0;  ///< L >= 0, for a bumper > 0 [m]

  /// The bodies that it connects.
  [[nodiscard]] std::vector<BodyId> bodies() const { return {from.body, to.body}; }
  /// Throws ModelError for invalid ends or numbers.
  void check(const PartCheck& check) const {
    check_line_ends(check, from, to);
    check.positive(stiffness, "stiffness", "N/m");
    check.non_negative(damping, "damping", "N s/m");
    if constexpr (Pulls) {
      check.non_negative(free_length, "free_length", "m");
    } else {
      check.positive(free_length, "free_length", "m");
    }
  }
  /// Books spring and dashpot.
  void loads(const ElementView<D>& at, ElementLoads<D>& out) const {
    const LineOfAction<D> line(at, from, to);
    const double spring = stiffness * excess(line.length);
    if (spring == 0.0) return;
    const double dashpot = std::clamp(wanted(line), -spring, spring);
    const Vec<D> conservative = side * spring * line.direction;  // on `from`
    const Vec<D> dissipative = side * dashpot * line.direction;
    book_pull(out, from, to, conservative, dissipative);
  }
  /// Books spring and dashpot over a step.
  void mean_loads(const ElementStep<D>& step, ElementLoads<D>& out) const {
    const MeanLine<D> line(step, from, to);
    const double pull = line.mean_tension(
        [this](double length) { return side * stiffness * excess(length); },
        [this](double length) { return 0.5 * stiffness * excess(length) * excess(length); });
    if (pull == 0.0) return;
    const double rate = line.growth / step.step;
    const double dashpot = std::clamp(damping * rate, -std::abs(pull), std::abs(pull));
    const Vec<D> conservative = pull * line.direction;  // on `from`
    const Vec<D> dissipative = dashpot * line.direction;
    book_pull(out, from, to, conservative, dissipative);
  }
  /// Derivatives. At a boundary between slack, free and limited, those of one side.
  void derivatives(const ElementView<D>& at, ElementDerivatives<D>& out) const {
    const LineOfAction<D> line(at, from, to);
    const double spring = stiffness * excess(line.length);
    const double dashpot = wanted(line);
    if (spring == 0.0 || dashpot <= -spring) return;
    if (dashpot > spring) {  // limited: the spring counts twice
      line.add_pull(out, from, to, side * 2.0 * spring, 2.0 * stiffness, 0.0);
    } else {
      line.add_pull(out, from, to, side * (spring + dashpot), stiffness, damping);
    }
  }
  /// Whether its ends stand at one place although its force does not vanish there: a bumper.
  [[nodiscard]] bool lacks_direction(const ElementView<D>& at, double fastest) const {
    return excess(0.0) > 0.0 && at_one_place(at.context(), at.attach(from), at.attach(to), fastest);
  }
  /// Switching value, zero where it goes taut or slack: (l^2 - L^2)/(2 L), near L as l - L [m]; 1 m where L =
  /// 0.
  void guards(const ElementView<D>& at, double* out) const {
    out[0] = length_guard<D>(at, from, to, free_length);
  }
  /// Motion of the switching value along the motion of the ends.
  void guard_motion(const ElementMotion<D>& at, GuardMotion* out) const {
    out[0] = length_guard_motion<D>(at, from, to, free_length);
  }
  /// k x^2 / 2 [J].
  [[nodiscard]] double potential(const ElementView<D>& at) const {
    const double x = excess((at.position(to) - at.position(from)).norm());
    return 0.5 * stiffness * x * x;
  }
  /// Adds ends and numbers.
  void fingerprint(Fingerprint& print) const {
    add_to(print, from);
    add_to(print, to);
    print.add(stiffness);
    print.add(damping);
    print.add(free_length);
  }

private:
  static constexpr double side = Pulls ? 1.0 : -1.0;

  // c dx/dt, before it is limited.
  [[nodiscard]] double wanted(const LineOfAction<D>& line) const { return damping * side * line.rate; }
  [[nodiscard]] double excess(double length) const { return std::max(0.0, side * (length - free_length)); }
};

/// Tension only.
template <int D>
using Cable = OneSidedSpring<D, true>;
/// Compression only.
template <int D>
using Bumper = OneSidedSpring<D, false>;

}  // namespace generic

namespace planar {
using Cable = generic::Cable<2>;    ///< generic::Cable in the plane
using Bumper = generic::Bumper<2>;  ///< generic::Bumper in the plane
}  // namespace planar
namespace spatial {
using Cable = generic::Cable<3>;    ///< generic::Cable in space
using Bumper = generic::Bumper<3>;  ///< generic::Bumper in space
}  // namespace spatial

}  // namespace carom

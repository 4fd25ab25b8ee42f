#pragma once

/// \file
/// The small parts that planar joints are made of: scalar conditions between the ends of two bodies.
///
///     point     e.d = 0          along an axis e of the fixed frame,  d = p_to - p_from
///     line      a.d - f(t) = 0   along an axis a fixed to `from`
///     angle     sum c_k angle_k - f(t) = 0
///     distance  |d| - f(t) = 0
///
/// A line may have angles in it (rolling).

#include <carom/core/end.h>
#include <carom/core/export.h>
#include <carom/core/joint_kind.h>
#include <carom/core/layout.h>
#include <carom/core/space.h>
#include <carom/core/system.h>

#include <cstdint>
#include <vector>

namespace carom::planar {

/// One condition between two ends, as described.
struct Binding {
  /// How the distance d between the ends enters.
  enum class Form : std::uint8_t { angles, fixed_axis, axis_of_from, distance };

  Form form = Form::angles;
  End<2> from{};                 ///< a body or ground
  End<2> to{};                   ///< a body or ground
  Vec<2> axis = Vec<2>::Zero();  ///< of unit length, in the fixed frame or that of `from`
  double turn_from = 0.0;        ///< coefficient of the angle of `from` [1, m]
  double turn_to = 0.0;          ///< of `to`
  BodyId carrier = ground;       ///< a third body whose angle may enter
  double turn_carrier = 0.0;     ///< coefficient of its angle
  double offset = 0.0;           ///< what is subtracted [m, rad]
};

/// A binding whose places in the arrays are known.
class CAROM_API LocatedBinding {
public:
  LocatedBinding(const Binding& binding, const Layout& layout);

  /// Writes which velocities the row has blocks for.
  void pattern(JointRow& row) const;
  /// Writes the row.
  void evaluate(const JointView& at, JointRow& row) const;
  /// Adds what a multiplier of the row does to `to`.
  void add_reaction(const JointView& at, double multiplier, JointReaction& out) const;

private:
  // A body and the point on it.
  struct Side {
    Index q = none, v = none, rotation = none;
    int columns = 0;
    Vec<2> local = Vec<2>::Zero();
    double turn = 0.0;

    [[nodiscard]] Vec<2> lever(const JointView& at) const;
    [[nodiscard]] Vec<2> position(const JointView& at, const Vec<2>& lever) const;
    [[nodiscard]] Vec<2> velocity(const JointView& at, const Vec<2>& lever) const;
    [[nodiscard]] double spin(const JointView& at) const {
      return rotation == none ? 0.0 : at.state.v[v + 2];
    }
    [[nodiscard]] double angle(const JointView& at) const {
      return rotation == none ? 0.0 : at.state.q[q + 2];
    }
  };
  [[nodiscard]] static Side side(BodyId body, const Vec<2>& point, double turn, const Layout& layout);
  [[nodiscard]] Vec<2> direction(const JointView& at, const Vec<2>& between) const;

  Binding::Form form_;
  Side from_, to_, carrier_;
  Vec<2> axis_;
  double offset_;
  double moment_;  // on `to` by a unit of the multiplier; the ground takes it too
};

/// Where a body stands as described.
struct CAROM_API DescribedPlace {
  Vec<2> position = Vec<2>::Zero();  ///< of its centre of mass [m]
  double angle = 0.0;                ///< [rad]

  /// A point of the body, in the fixed frame [m].
  [[nodiscard]] Vec<2> point(const Vec<2>& local) const;
};
/// Where a body of a system, or the ground, stands as described.
[[nodiscard]] CAROM_API DescribedPlace described_place(const System& system, BodyId body);

/// Demands two ends on different bodies that can be.
CAROM_API void check_joint_ends(const PartCheck& check, const End<2>& from, const End<2>& to);
/// Demands an axis that is finite and not zero; returns it with unit length.
[[nodiscard]] CAROM_API Vec<2> checked_axis(const PartCheck& check, const Vec<2>& axis,
                                            std::string_view quantity);
/// Demands a body that has an angle: a rigid body, or the ground.
CAROM_API void check_turning_end(const PartCheck& check, BodyId body, std::string_view quantity);

}  // namespace carom::planar

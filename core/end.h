#pragma once

/// \file
/// Ends of force elements and joints: points fixed to a body or to the ground.

#include <carom/core/evaluation.h>
#include <carom/core/export.h>
#include <carom/core/fingerprint.h>
#include <carom/core/ids.h>
#include <carom/core/layout.h>
#include <carom/core/part_check.h>
#include <carom/core/space.h>
#include <carom/core/state.h>

namespace carom {

/// An end: a body (its centre of mass), or a body and a point in its frame [m]. On `ground`
/// the point is in the fixed frame; an end on `ground` without a point is at the origin, of a joint where its
/// other end is (joints/joint_ends.h).
template <int D>
struct End {
  End() = default;
  End(BodyId on) : body(on) {}  // NOLINT(google-explicit-constructor): a body is an end
  End(BodyId on, const Vec<D>& at) : body(on), point(at), has_point(true) {}

  BodyId body;                    ///< invalid until given
  Vec<D> point = filled<D>(0.0);  ///< in the body's frame, from its centre of mass [m]
  bool has_point = false;         ///< the point was given, and is not only where an end is by default
};

/// Demands a valid end: a body of this system (or ground), a finite point, and away from the centre of mass
/// only on a body that has an orientation.
template <int D>
void check_end(const PartCheck& check, const End<D>& end, std::string_view quantity);

/// An end whose places in the arrays are known.
template <int D>
struct Attachment {
  Index q = none;                 ///< first coordinate of the body, `none` on the ground
  Index v = none;                 ///< first velocity of the body
  Index rotation = none;          ///< its rotation, `none` if the end is at its centre
  Vec<D> local = filled<D>(0.0);  ///< point in the body's frame (fixed frame on the ground) [m]

  /// At the origin of the ground, or at a given end.
  Attachment() = default;
  Attachment(const End<D>& end, const Layout& layout) : local(end.point) {
    if (end.body == ground) return;
    const BodySlot& slot = layout.slot(end.body);
    q = slot.q;
    v = slot.v;
    if (!local.isZero(0.0)) rotation = slot.rotation;
  }

  /// Lever from the centre of mass to the end, in the fixed frame [m].
  [[nodiscard]] Vec<D> lever(const Evaluation& evaluation) const {
    if constexpr (Space<D>::has_orientation) {
      if (rotation != none) return Space<D>::rotate(evaluation.rotation.data() + rotation, local);
    }
    return filled<D>(0.0);
  }
  /// Position [m].
  [[nodiscard]] Vec<D> position(const StateView& state, const Vec<D>& lever) const {
    if (q == none) return local;
    return Eigen::Map<const Vec<D>>(state.q + q) + lever;
  }
  /// Velocity [m/s].
  [[nodiscard]] Vec<D> velocity(const StateView& state, const Vec<D>& lever) const {
    if (q == none) return filled<D>(0.0);
    Vec<D> result = Eigen::Map<const Vec<D>>(state.v + v);
    if constexpr (Space<D>::has_orientation) {
      if (rotation != none) result += Space<D>::lever_velocity(state.v + v + D, lever);
    }
    return result;
  }
  /// Adds a force at the end to a generalised load [N, N m].
  void add_force(double* load, const Vec<D>& lever, const Vec<D>& force) const {
    if (q == none) return;
    Eigen::Map<Vec<D>>(load + v) += force;
    if constexpr (Space<D>::has_orientation) {
      if (rotation != none) Space<D>::add_torque(lever, force, load + v + D);
    }
  }
};

/// Adds an end to a fingerprint.
template <int D>
void add_to(Fingerprint& print, const End<D>& end) {
  print.add(std::uint64_t{end.body.serial});
  print.add({end.point.data(), static_cast<std::size_t>(D)});
}

extern template CAROM_API void check_end<2>(const PartCheck&, const End<2>&, std::string_view);
extern template CAROM_API void check_end<3>(const PartCheck&, const End<3>&, std::string_view);

}  // namespace carom

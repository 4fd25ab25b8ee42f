#pragma once

/// \file
/// Rows of a contact between a rounded point of a body and a shape on ground: Jacobian, drift, and the terms
/// of the shape's motion (docs/method.md, section 1).

#include <carom/contact/detection/body_features.h>
#include <carom/contact/detection/ground_shapes.h>
#include <carom/core/constraint.h>
#include <carom/core/evaluation.h>
#include <carom/core/ground_shape_kind.h>
#include <carom/core/space.h>
#include <carom/core/state.h>

#include <array>

namespace carom {

/// A feature where its body is now.
template <int D>
struct PlacedFeature {
  const BodySlot& body;        ///< its body
  const BodyFeature& feature;  ///< as described
  Vec<D> arm;                  ///< of its centre, from the body's centre of mass [m]
  Vec<D> centre;               ///< its centre [m]
};

/// Places a feature. The position group of `evaluation` must be up to date.
template <int D>
[[nodiscard]] inline PlacedFeature<D> place_feature(const BodySlot& body, const BodyFeature& feature,
                                                    const StateView& state, const Evaluation& evaluation) {
  Vec<D> arm = Vec<D>::Zero();
  if constexpr (Space<D>::has_orientation) {
    if (body.rotation != none) {
      arm = Space<D>::rotate(evaluation.rotation.data() + body.rotation,
                             Vec<D>(Eigen::Map<const Vec<D>>(feature.centre.data())));
    }
  }
  return {body, feature, arm, Eigen::Map<const Vec<D>>(state.q + body.q) + arm};
}

/// Writes body, gap, Jacobian and drift of a contact with a shape at rest; `out` is as made by default.
template <int D>
void fill_rows(const PlacedFeature<D>& at, const Gap& gap, const StateView& state, Constraint& out);

/// Adds the motion of the shape. \param step_end the shape at the end of the step
void add_ground_motion(const PlacedFeature<2>& at, const StateView& state, const GroundMotion& motion,
                       const GroundAtEnd& step_end, Constraint& out);

/// Share of the drift [m/s^2] by the curvature of a boundary that gap() describes, normal and tangential: the
/// normal turns as the feature's centre moves along. By differences over 1e-5 m, or less where it is small.
/// \param motion of the shape; null: at rest
[[nodiscard]] std::array<double, 2> curvature_drift(const PlacedFeature<2>& at, const StateView& state,
                                                    const GroundShapes& shapes, Index shape,
                                                    const GroundMotion* motion);

/// Bound on the rate of the normal velocity by turning of the body, and of the shape if it moves
/// (contact/detection/lasting_contacts.h) [m/s^2]. \param above distance of the feature's centre [m]
template <int D>
[[nodiscard]] double turning_bound(const PlacedFeature<D>& at, const StateView& state,
                                   const GroundMotion* motion, double above);

}  // namespace carom

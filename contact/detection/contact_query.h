#pragma once

/// \file
/// One question to detection.

#include <carom/contact/detection/chosen_bodies.h>
#include <carom/contact/detection/ground_shapes.h>
#include <carom/contact/detection/lasting_contacts.h>
#include <carom/core/evaluation.h>
#include <carom/core/function_ref.h>
#include <carom/core/state.h>

namespace carom {

/// A state, and which contacts of it are asked for. It is read during the call that it is given to.
struct ContactQuery {
  StateView state;                           ///< positions, velocities, time
  const Evaluation& evaluation;              ///< with its position group up to date
  const GroundPlaces& places;                ///< of the state's time
  const GroundPlaces* after = nullptr;       ///< at the end of the step; null where no time passes
  double margin = 0.0;                       ///< largest gap [m]
  const LastingContacts* lasting = nullptr;  ///< found also where they are a little open; null: none
  /// True of contacts with ground shapes of one piece that are not asked for; empty: none.
  FunctionRef<bool(Index body, const ConstraintKey& key)> leaves_out = {};
  /// Contacts of bodies with each other are asked for of these alone. What is not chosen is not looked at.
  ChosenBodies bodies = {};

  /// The end of the step, for a shape. \param shapes whose `places` these are
  [[nodiscard]] GroundAtEnd end_of(const GroundShapes& shapes, Index shape) const {
    if (after == nullptr) return {};
    return {shapes.motion(shape, *after), after->time() - state.time};
  }
};

}  // namespace carom

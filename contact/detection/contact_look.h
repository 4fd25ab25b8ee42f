#pragma once

/// \file
/// All contacts of a model at states of one's choice: the ends of steps, shares of them.

#include <carom/contact/detection/contact_pair.h>
#include <carom/contact/detection/detector.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint_set.h>
#include <carom/core/export.h>
#include <carom/core/state.h>

#include <vector>

namespace carom {

/// Places bodies and ground at a state and finds what touches. Keeps memory.
class CAROM_API ContactLook {
public:
  /// \param assembly,detector must outlive it
  ContactLook(const Assembly& assembly, const Detector& detector);

  /// The model.
  [[nodiscard]] const Assembly& assembly() const { return *assembly_; }
  /// The detector.
  [[nodiscard]] const Detector& detector() const { return *detector_; }

  /// Lists all contacts, and limits of joints, whose gap is <= `margin` [m], as Detector::find_all().
  /// \param after the ground at the end of a step that begins with the state; null: no time passes
  /// \param lasting contacts that may be a little open; null: none \param bodies whose contacts are listed
  void find(const StateView& state, double margin, ConstraintSet& out, const GroundPlaces* after = nullptr,
            const LastingContacts* lasting = nullptr, const ChosenBodies& bodies = {});
  /// The contact of a pair, whatever its gap, at the state of the last find().
  void contact(const ContactPair& pair, const StateView& state, Constraint& out) const {
    detector_->contact(pair, state, evaluation_, places_, out);
  }

private:
  const Assembly* assembly_;
  const Detector* detector_;
  Evaluation evaluation_;
  GroundPlaces places_;
  BodyContactSearch search_;
};

}  // namespace carom

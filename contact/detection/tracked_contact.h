#pragma once

/// \file
/// A contact of two bodies as long as the vertex stays with one feature of the outline, whichever is the
/// nearest: a smooth function of the motion, also a little beyond the border where another feature takes
/// over.

#include <carom/contact/detection/body_outlines.h>
#include <carom/contact/detection/contact_pair.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint.h>
#include <carom/core/evaluation.h>
#include <carom/core/export.h>
#include <carom/core/state.h>

namespace carom {

/// Brings rows, gap and drift of a contact of two bodies to a state; key and law stay.
/// \param pair of the contact \param feature of its outline (ConvexOutline) \param evaluation position group
/// up to date
CAROM_API void follow_feature(const Assembly& assembly, const BodyOutlines& outlines, const ContactPair& pair,
                              Index feature, const StateView& state, const Evaluation& evaluation,
                              Constraint& contact);

}  // namespace carom

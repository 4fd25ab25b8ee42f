#pragma once

/// \file
/// Who takes part in a contact and where it is, as records of contacts and events of both modes have it.

#include <carom/contact/frame_of_contact.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint.h>
#include <carom/core/ids.h>

namespace carom {

/// Sets `body`, and `other` or `obstacle` of a record, or none of a joint limit, from its constraint.
template <class Record>
void set_parties(const ConstraintHead& at, const Assembly& assembly, Record& out) {
  const Layout& layout = *assembly.layout();
  const bool of_bodies = at.rows > 1 && at.bodies == 2;
  const bool of_ground = at.key.b.owner == FeatureKey::Owner::obstacle;
  const BodyId body = layout.id(at.body()), other = of_bodies ? layout.id(at.blocks[1].body) : BodyId{};
  out.body = body;
  out.other = other;
  out.obstacle = of_ground ? ObstacleId{at.key.b.serial, layout.token()} : ObstacleId{};
}

/// Writes which contact a constraint is, of whom, and where it is. \param q coordinates of all bodies, where
/// it was detected
template <class Place>
void write_place(const Constraint& at, const Assembly& assembly, const double* q, Place& out) {
  set_parties(at, assembly, out);
  out.key = at.key;
  out.gap = at.gap;
  read_contact_frame(at, q + assembly.layout()->bodies()[at.body()].q, out);
}

}  // namespace carom

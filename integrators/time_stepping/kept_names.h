#pragma once

/// \file
/// Names of contacts of corners that meet, on the way of a step.
///
/// Two corners that meet have two contacts, each with the name of another corner. Where both are along edges
/// of one outline that has the name of the other corner whose gap is larger
/// (contact/detection/corner_meeting.h), so that the two may change names on the way of a step: directions
/// tell which is which.

#include <carom/contact/detection/corner_names.h>
#include <carom/core/constraint.h>
#include <carom/core/space.h>

#include <cmath>
#include <cstddef>
#include <span>

namespace carom {

/// Where a contact in the plane touches its first body, from the centre of that, by what its rows have for
/// the spin [m]; zero of a particle.
[[nodiscard]] inline Vec<2> lever_of(const Constraint& contact) {
  if (contact.rows < 2 || contact.blocks[0].columns < 3) return Vec<2>::Zero();
  const double *const n = contact.row(0), *const t = contact.row(1);
  return {n[1] * n[2] + t[1] * t[2], -n[0] * n[2] - t[0] * t[2]};
}

/// True of two contacts of corners that meet: by their names, and by their places.
/// \param same_place how far apart places are that count as one [m]
[[nodiscard]] inline bool are_of_corners(const Constraint& one, const Constraint& other, double same_place) {
  constexpr double drift = 1e4;   // places that count as one: corners that meet drift apart by less
  constexpr double depths = 2.0;  // what slides along one edge is behind the other edge by about as much
  if (other.attached != one.attached || !may_be_of_corners(one.key, other.key)) return false;
  const double deep = std::abs(one.gap) + std::abs(other.gap);
  return (lever_of(other) - lever_of(one)).norm() <= drift * same_place + depths * deep;
}

/// The contact that one at the begin of a step has become: that of its name, or, of corners that meet, that
/// along the same edge. Null where it has come to another edge. \param named that of its name, one of those
/// found \param found those of a body follow
/// one another \param same_place how far apart places are that count as one [m]
[[nodiscard]] inline const Constraint* become_of(const Constraint& begin, const Constraint& named,
                                                 std::span<const Constraint> found, double same_place) {
  constexpr double same_feature = 0.9;  // cosine: what turns farther within a step is along another edge
  const auto cosine = [&](const Constraint& of) {
    return begin.row(0)[0] * of.row(0)[0] + begin.row(0)[1] * of.row(0)[1];
  };
  const Constraint* out = &named;
  const auto is_of_body = [&](const Constraint& other) {
    return other.key.a.owner == begin.key.a.owner && other.key.a.serial == begin.key.a.serial;
  };
  const auto look_at = [&](const Constraint& other) {
    if (are_of_corners(named, other, same_place) && cosine(other) > cosine(*out)) out = &other;
  };
  const auto place = static_cast<std::size_t>(&named - found.data());
  for (std::size_t i = place + 1; i < found.size() && is_of_body(found[i]); ++i) look_at(found[i]);
  for (std::size_t i = place; i-- > 0 && is_of_body(found[i]);) look_at(found[i]);
  return cosine(*out) < same_feature ? nullptr : out;
}

}  // namespace carom

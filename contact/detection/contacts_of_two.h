#pragma once

/// \file
/// The contacts of two outlines that overlap or are near each other, from the places where they are nearest:
/// one, two along faces that lie on each other, and those of sharp corners that meet, which neighbours may
/// cover (corner_meeting.h).

#include <carom/contact/detection/corner_meeting.h>
#include <carom/contact/detection/gap_point.h>
#include <carom/core/export.h>
#include <carom/core/function_ref.h>

#include <optional>
#include <span>

namespace carom {

/// Two outlines whose contacts are listed: of two bodies, or of a body and a shape on ground.
struct TwoOutlines {
  /// Whether a contact is added anyway: it belongs to one that is.
  enum class Adds : bool { if_it_touches, anyway };
  /// The corners nearest to a contact; nothing where outlines are rounded or no corners are near.
  FunctionRef<std::optional<CornerMeeting>(const GapPoint&)> corners_near;
  /// True of two contacts of the same name.
  FunctionRef<bool(const GapPoint&, const GapPoint&)> have_one_name;
  /// Takes a contact that is closed, or lasts. False where it does not. The flag: it is one of the two of
  /// corners that meet.
  FunctionRef<bool(const GapPoint&, bool, Adds)> add;
  double same_place = 0.0;  ///< how far apart places are that count as one [m]
};

/// Lists the contacts of two outlines. \param nearest one or two places where they are nearest, the nearer
/// one first
CAROM_API void list_contacts(std::span<const GapPoint> nearest, const TwoOutlines& of);

}  // namespace carom

#pragma once

/// \file
/// Checks of the sets by which kinds of shapes say where bodies touch. Kinds of users may say anything; what
/// is found out here would otherwise touch nowhere, or where nothing is.

#include <carom/core/export.h>
#include <carom/core/ground_shape_kind.h>
#include <carom/core/part_check.h>
#include <carom/core/shape_kind.h>
#include <carom/core/space.h>

#include <span>
#include <string>
#include <string_view>

namespace carom {

/// Demands corners of a convex polygon, counter-clockwise, each of which turns to the left. \param allowed
/// what else may be done, for the message \throws ModelError
CAROM_API void check_convex(const PartCheck& check, std::span<const Vec<2>> vertices,
                            std::string_view quantity, const std::string& allowed);
/// Demands finite places and a radius >= 0. \throws ModelError
CAROM_API void check_rounded_points(const PartCheck& check, std::span<const RoundedPoint> points);
/// Demands a convex set of finite numbers, of one vertex at least. \throws ModelError
CAROM_API void check_outline(const PartCheck& check, const Outline& outline);
/// Demands that the points and the outlines of a shape, where it has both, describe the same set: that it
/// reaches as far in every direction. They have passed check_rounded_points() and check_outline(). \throws
/// ModelError
CAROM_API void check_same_set(const PartCheck& check, std::span<const RoundedPoint> points,
                              std::span<const Outline> outlines);
/// Demands of every piece a form, as many finite points as that has, a solid that is convex, a face with a
/// length and a depth > 0, a hollow with a radius > 0. \throws ModelError
CAROM_API void check_pieces(const PartCheck& check, std::span<const GroundPiece> pieces);

}  // namespace carom

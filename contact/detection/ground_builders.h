#pragma once

/// \file
/// Usual shapes on ground: stairs, a hopper, a drum, an open box. Materials, names and laws are given where
/// the shapes are added: `system.add(stairs({0, 0}, 5, 0.3, -0.2), law, "stairs")`.

#include <carom/contact/detection/ground_parts.h>
#include <carom/core/export.h>
#include <carom/core/space.h>

#include <array>

namespace carom::planar {

/// Stairs with a floor before the first step and one behind the last, each as long as three treads.
/// \param start edge where the first riser begins [m] \param steps how many, >= 1 \param tread length of a
/// tread, > 0 [m] \param rise height of a riser, up towards +x, or down if < 0; not 0 [m]
/// Throws ModelError for numbers that are not allowed.
[[nodiscard]] CAROM_API Terrain stairs(const Vec<2>& start, int steps, double tread, double rise);

/// The two walls of a funnel, left and right, which is `outlet` wide at its outlet and `width` wide `height`
/// above that, between the surfaces of the walls. \param centre of the outlet [m] \param outlet > 0 [m]
/// \param width > outlet [m] \param height > 0 [m] \param radius of the walls, > 0 [m]
/// Throws ModelError for numbers that are not allowed.
[[nodiscard]] CAROM_API std::array<Wall, 2> hopper(const Vec<2>& centre, double outlet, double width,
                                                   double height, double radius);

/// A drum that turns about its centre. \param radius > 0 [m] \param spin counter-clockwise; 0: at rest
/// [rad/s] Throws ModelError for numbers that are not allowed.
[[nodiscard]] CAROM_API CircleInside drum(const Vec<2>& centre, double radius, double spin);

/// A box that is open above. \param floor the middle of its floor [m] \param width,height > 0, inside [m]
/// \param thickness how far its floor and walls are solid, > 0 [m]
/// Throws ModelError for numbers that are not allowed.
[[nodiscard]] CAROM_API Terrain open_box(const Vec<2>& floor, double width, double height, double thickness);

}  // namespace carom::planar

#pragma once

/// \file
/// Mass, centre of mass and moment of inertia of planar bodies, made by functions.

#include <carom/core/export.h>
#include <carom/core/space.h>

#include <initializer_list>
#include <limits>
#include <span>
#include <vector>

namespace carom {

template <int D>
struct MassProperties;

/// Mass properties of a planar body.
template <>
struct MassProperties<2> {
  double mass = std::numeric_limits<double>::quiet_NaN();     ///< [kg]
  double inertia = std::numeric_limits<double>::quiet_NaN();  ///< about the centre of mass [kg m^2]
  Vec<2> centre = filled<2>(0.0);  ///< centre of mass in the frame in which the body was described [m]
};

namespace planar {

// Bodies of uniform density. The mass is that of the whole body [kg], moments of inertia are about the axis
// normal to the plane. All functions throw ModelError, naming the function, the quantity, its value and what
// is allowed, if a mass or a size is not finite and > 0 or if the moment of inertia leaves the range of
// double.

/// A full disc or cylinder: I = m r^2 / 2, centre at the origin. \param radius [m]
[[nodiscard]] CAROM_API MassProperties<2> disc(double mass, double radius);
/// A thin ring or tube: I = m r^2, centre at the origin. \param radius [m]
[[nodiscard]] CAROM_API MassProperties<2> ring(double mass, double radius);
/// A full sphere: I = 2/5 m r^2, centre at the origin. \param radius [m]
[[nodiscard]] CAROM_API MassProperties<2> solid_sphere(double mass, double radius);
/// A thin spherical shell: I = 2/3 m r^2, centre at the origin. \param radius [m]
[[nodiscard]] CAROM_API MassProperties<2> thin_shell(double mass, double radius);
/// A thin rod: I = m l^2 / 12, centre at the origin. \param length [m]
[[nodiscard]] CAROM_API MassProperties<2> rod(double mass, double length);
/// A rectangle: I = m (w^2 + h^2) / 12, centre at the origin. \param width, height [m]
[[nodiscard]] CAROM_API MassProperties<2> box(double mass, double width, double height);

/// A simple polygon, its outline in either direction: the fan of triangles (p_0, p_i, p_i+1) with signed
/// areas A_i, centroids c_i and sides of lengths a, b, c,
///     A = sum A_i,   centre = sum A_i c_i / A,
///     I = m sum A_i / A ((a^2 + b^2 + c^2) / 36 + |c_i - centre|^2).
/// Coordinates are taken relative to the first vertex, so a polygon far from the origin loses no digits.
/// \param vertices at least 3, in order [m]; a vertex may be repeated, the first one at the end too
/// Throws ModelError also if the outline crosses itself or its area is not above the rounding of its
/// vertices.
[[nodiscard]] CAROM_API MassProperties<2> polygon(double mass, const std::vector<Vec<2>>& vertices);

/// A point mass at the origin, I = 0: a part for compose(). By itself it is a Particle, not a RigidBody.
[[nodiscard]] CAROM_API MassProperties<2> point_mass(double mass);

/// One body composed of parts at their centres:
///     m = sum m_i,   centre = sum m_i c_i / m,   I = sum (I_i + m_i |c_i - centre|^2).
/// Throws ModelError if there is no part or a part is invalid.
[[nodiscard]] CAROM_API MassProperties<2> compose(std::span<const MassProperties<2>> parts);
/// One body composed of the parts of a list. Throws ModelError if there is none or one is invalid. Example:
/// compose({rod(2.0, 1.0), shifted(disc(1.0, 0.1), {0.5, 0.0})}).
[[nodiscard]] CAROM_API MassProperties<2> compose(std::initializer_list<MassProperties<2>> parts);

/// A body at another place in its frame: the centre moved by `offset` [m].
[[nodiscard]] CAROM_API MassProperties<2> shifted(const MassProperties<2>& properties, const Vec<2>& offset);
/// A body with its centre at the origin, as RigidBody demands. Shapes described in the old frame must be
/// shifted by minus the old centre.
[[nodiscard]] CAROM_API MassProperties<2> centred(const MassProperties<2>& properties);
/// Moment of inertia about a point [kg m^2]: I + m |point - centre|^2 (parallel axes). \param point [m]
[[nodiscard]] CAROM_API double inertia_about(const MassProperties<2>& properties, const Vec<2>& point);

}  // namespace planar

}  // namespace carom

#pragma once

/// \file
/// Requirements on a struct that is a part of a system: it has a role, and says its type or has a kind.

#include <carom/core/body_kind.h>
#include <carom/core/force_kind.h>
#include <carom/core/ground_shape_kind.h>
#include <carom/core/ids.h>
#include <carom/core/joint_kind.h>
#include <carom/core/part_check.h>
#include <carom/core/part_type.h>
#include <carom/core/shape_kind.h>

#include <concepts>
#include <cstdint>

namespace carom {

/// Role of a part in the graph of a system.
enum class Role : std::uint8_t {
  body,      ///< a node
  force,     ///< a force element: an edge, or a load on one body
  joint,     ///< an edge with constraints
  shape,     ///< geometry fixed to a body
  obstacle,  ///< a shape on ground: fixed to the ground, or moved as prescribed
};

/// Interface and identity that belong to a role.
template <Role R>
struct RoleTraits;
/// Of bodies.
template <>
struct RoleTraits<Role::body> {
  using Interface = BodyKind;
  using Identity = BodyId;
};
/// Of force elements.
template <>
struct RoleTraits<Role::force> {
  using Interface = ForceKind;
  using Identity = ElementId;
};
/// Of joints.
template <>
struct RoleTraits<Role::joint> {
  using Interface = JointKind;
  using Identity = JointId;
};
/// Of shapes.
template <>
struct RoleTraits<Role::shape> {
  using Interface = ShapeKind;
  using Identity = ShapeId;
};
/// Of shapes on ground.
template <>
struct RoleTraits<Role::obstacle> {
  using Interface = GroundShapeKind;
  using Identity = ObstacleId;
};

template <class P>
class ForceElementKind;

/// The kind that stores a part: its own `P::Kind`, or for force elements without one a kind that calls the
/// element's own functions (core/force_element.h).
template <class P>
struct KindOf {
  using type = typename P::Kind;
};
template <class P>
  requires(P::role == Role::force && !requires { typename P::Kind; })
struct KindOf<P> {
  using type = ForceElementKind<P>;
};

/// A part that says its type itself, by `static PartType<...> part_type()`. Those of the library do: their
/// kinds are compiled in the library alone, not in every program that adds such a part.
template <class P>
concept TypedPart = requires {
  { P::part_type() } -> std::same_as<PartType<typename RoleTraits<P::role>::Interface>>;
};

/// A part whose kind takes it.
template <class P>
concept StoredPart = requires(typename KindOf<P>::type& kind, const P& part, const PartCheck& check) {
  kind.add(part, check);
};

/// A part: has a role, and says its type or has a kind.
template <class P>
concept Part = requires {
  { P::role } -> std::convertible_to<Role>;
}
&&(TypedPart<P> || StoredPart<P>);

/// The type of a part.
template <Part P>
[[nodiscard]] PartType<typename RoleTraits<P::role>::Interface> type_of_part() {
  if constexpr (TypedPart<P>) {
    return P::part_type();
  } else {
    return PartType<typename RoleTraits<P::role>::Interface>::template of<typename KindOf<P>::type, P>();
  }
}

/// Identity that a system gives to a part.
template <class P>
using IdOf = typename RoleTraits<P::role>::Identity;

}  // namespace carom

#pragma once

/// \file
/// Prescribed forces that turn with their body.

#include <carom/core/force_element.h>

#include <functional>
#include <vector>

namespace carom::planar {

/// A force at a point of a rigid body, a given function of time, in the body's frame: it turns with the body,
/// as a thruster does. Its work is external work.
struct CAROM_API FollowerLoad {
  static constexpr Role role = Role::force;
  static constexpr int dimension = 2;
  static constexpr std::string_view label = "follower load";
  /// Its type, for System::add().
  [[nodiscard]] static PartType<ForceKind> part_type();

  End<2> on{};                                 ///< rigid body, or rigid body and point (required)
  std::function<Vec<2>(double time)> force{};  ///< in the body's frame [N] (required)
  std::vector<double> breaks{};  ///< when the function of time jumps or has a kink, ascending [s]

  /// The body that it acts on.
  [[nodiscard]] std::vector<BodyId> bodies() const;
  /// Throws ModelError for an invalid end or function.
  void check(const PartCheck& check) const;
  /// Books the load.
  void loads(const ElementView<2>& at, ElementLoads<2>& out) const;
  /// Derivatives: the force turns with its body. Its moment is constant, because its lever turns too.
  void derivatives(const ElementView<2>& at, ElementDerivatives<2>& out) const;
  /// Adds the end (a function cannot be hashed).
  void fingerprint(Fingerprint& print) const;
};

}  // namespace carom::planar

#pragma once

/// \file
/// Prescribed forces that turn with their body.

#include <carom/core/force_element.h>

#include <functional>
#include <vector>

namespace carom::planar {

/// A force at a point of a rigid body, a given function of time, in the body's frame: it turns with the body,
/// as a thruster does. Its work is external work.
struct FollowerLoad {
  static constexpr Role role = Role::force;
  static constexpr int dimension = 2;
  static constexpr std::string_view label = "follower load";

  End<2> on{};                                 ///< rigid body, or rigid body and point (required)
  std::function<Vec<2>(double time)> force{};  ///< in the body's frame [N] (required)
  std::vector<double> breaks{};  ///< when the function of time jumps or has a kink, ascending [s]

  /// The body that it acts on.
  [[nodiscard]] std::vector<BodyId> bodies() const { return {on.body}; }
  /// Throws ModelError for an invalid end or function.
  void check(const PartCheck& check) const {
    check.oriented_body(on.body, "on");
    check_end(check, on, "on");
    if (!force) check.refuse("force", "not given", "a function of time");
    const Vec<2> start = force(0.0);
    check.finite({start.data(), 2}, "force at time 0", "N");
  }
  /// Books the load.
  void loads(const ElementView<2>& at, ElementLoads<2>& out) const { out.external(on, turned(at)); }
  /// Derivatives: the force turns with its body. Its moment is constant, because its lever turns too.
  void derivatives(const ElementView<2>& at, ElementDerivatives<2>& out) const {
    const Vec<2> now = turned(at);
    const Index v = at.oriented(on.body).v;
    out.entry(v, v + 2, -now[1], 0.0);
    out.entry(v + 1, v + 2, now[0], 0.0);
  }
  /// Adds the end (a function cannot be hashed).
  void fingerprint(Fingerprint& print) const { add_to(print, on); }

private:
  [[nodiscard]] Vec<2> turned(const ElementView<2>& at) const {
    const double* rotation = at.context().evaluation.rotation.data() + at.oriented(on.body).rotation;
    return Space<2>::rotate(rotation, force(at.time()));
  }
};

}  // namespace carom::planar

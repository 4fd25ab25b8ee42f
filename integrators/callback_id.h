#pragma once

/// \file
/// Functions of the user that a simulation calls, and their identities.

#include <functional>
#include <memory>

namespace carom {

class Simulation;

using Observer = std::function<void(const Simulation&)>;  ///< called after every step
using Action = std::function<void(Simulation&)>;          ///< called at the times of a rhythm

/// Identity of a function given to Simulation::observe() or Simulation::every(). Good as long as that
/// simulation calls it; keeps nothing alive.
class CallbackId {
public:
  /// Of no function.
  CallbackId() = default;

private:
  friend class Callbacks;
  explicit CallbackId(const std::shared_ptr<const void>& function) : function_(function) {}
  std::weak_ptr<const void> function_;
};

}  // namespace carom

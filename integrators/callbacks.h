#pragma once

/// \file
/// Functions of the user that a simulation calls after its steps.

#include <carom/core/export.h>
#include <carom/integrators/call_guard.h>
#include <carom/integrators/callback_id.h>
#include <carom/integrators/run/companion.h>

#include <cstddef>
#include <exception>
#include <memory>
#include <vector>

namespace carom {

/// Observers and actions of one simulation, and calling them. While they are called further ones may be
/// added (observers are called from the next step on) and any may be removed.
class CAROM_API Callbacks {
public:
  /// Adds an observer behind the others.
  CallbackId add_observer(Observer observer);
  /// Adds an action behind the others. Its rhythm is the next of Companion::rhythms.
  CallbackId add_action(Action action);
  /// Removes an observer, or an action with its rhythm. False if it is not there.
  [[nodiscard]] bool remove(const CallbackId& id, std::vector<Rhythm>& rhythms);

  /// True if there is an observer.
  [[nodiscard]] bool has_observers() const { return !observers_.empty(); }
  /// Calls all observers. An exception of one does not keep the others from their call; it is added to
  /// `thrown`.
  void call_observers(const Simulation& simulation, CallGuard& guard,
                      std::vector<std::exception_ptr>& thrown);
  /// Calls the actions that are due, once each. An exception of one does not keep the others from their call;
  /// it is added to `thrown`. \param is_due called with a rhythm
  template <class IsDue>
  void call_actions(Simulation& simulation, std::vector<Rhythm>& rhythms, CallGuard& guard,
                    std::vector<std::exception_ptr>& thrown, IsDue&& is_due) {
    for (next_action_ = 0; next_action_ < actions_.size();) {
      const std::size_t now = next_action_++;
      if (!is_due(rhythms[now])) continue;
      ++rhythms[now].fired;
      const std::shared_ptr<const Action> action = actions_[now];  // it may remove itself
      const CallGuard::Scope scope(guard, CallGuard::Caller::action);
      try {
        (*action)(simulation);
      } catch (...) {
        thrown.push_back(std::current_exception());
      }
    }
  }

private:
  std::vector<std::shared_ptr<const Observer>> observers_;
  std::vector<std::shared_ptr<const Action>> actions_;
  std::size_t next_observer_ = 0, last_observer_ = 0;  // of the calls being made
  std::size_t next_action_ = 0;
};

}  // namespace carom

#include <carom/integrators/callbacks.h>

#include <algorithm>
#include <utility>

namespace carom {

namespace {

/// Place of a function in a list, its end if it is not there.
template <class F>
auto place_of(std::vector<std::shared_ptr<const F>>& functions, const std::shared_ptr<const void>& wanted) {
  return std::find_if(functions.begin(), functions.end(),
                      [&](const auto& function) { return wanted && function == wanted; });
}

}  // namespace

CallbackId Callbacks::add_observer(Observer observer) {
  return CallbackId(observers_.emplace_back(std::make_shared<const Observer>(std::move(observer))));
}

CallbackId Callbacks::add_action(Action action) {
  return CallbackId(actions_.emplace_back(std::make_shared<const Action>(std::move(action))));
}

bool Callbacks::remove(const CallbackId& id, std::vector<Rhythm>& rhythms) {
  const std::shared_ptr<const void> wanted = id.function_.lock();
  if (const auto observer = place_of(observers_, wanted); observer != observers_.end()) {
    const auto place = static_cast<std::size_t>(observer - observers_.begin());
    if (place < next_observer_) --next_observer_;
    if (place < last_observer_) --last_observer_;
    observers_.erase(observer);
    return true;
  }
  const auto action = place_of(actions_, wanted);
  if (action == actions_.end()) return false;
  if (static_cast<std::size_t>(action - actions_.begin()) < next_action_) --next_action_;
  rhythms.erase(rhythms.begin() + (action - actions_.begin()));
  actions_.erase(action);
  return true;
}

void Callbacks::call_observers(const Simulation& simulation, CallGuard& guard,
                               std::vector<std::exception_ptr>& thrown) {
  const CallGuard::Scope scope(guard, CallGuard::Caller::observer);
  last_observer_ = observers_.size();
  for (next_observer_ = 0; next_observer_ < last_observer_;) {
    const std::shared_ptr<const Observer> observer = observers_[next_observer_++];  // it may remove itself
    try {
      (*observer)(simulation);
    } catch (...) {
      thrown.push_back(std::current_exception());
    }
  }
}

}  // namespace carom

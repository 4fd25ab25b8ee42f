// Problem: no time of a step is looked at twice, as long as few are.

#include <carom/integrators/event_driven/step_looks.h>

#include <algorithm>

namespace carom {

const StepLook& StepLooks::at(double time, StepLooker& looker) {
  for (std::size_t i = 0; i < count_; ++i) {
    if (looks_[i].time == time) return looks_[i];
  }
  if (next_ == looks_.size()) looks_.emplace_back();
  StepLook& look = looks_[next_];
  looker.look(time, look);
  look.time = time;
  count_ = std::max(count_, next_ + 1);
  next_ = next_ + 1 == most ? 0 : next_ + 1;
  return look;
}

}  // namespace carom

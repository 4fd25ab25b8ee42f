// Problem: no time of a step is sampled twice, as long as few are.

#include <carom/integrators/event_driven/guard_samples.h>

#include <algorithm>

namespace carom {

const GuardSample& GuardSamples::at(double time, GuardSampler& sampler) {
  for (std::size_t i = 0; i < count_; ++i) {
    if (samples_[i].time == time) return samples_[i];
  }
  if (next_ == samples_.size()) samples_.emplace_back();
  GuardSample& sample = samples_[next_];
  sampler.sample(time, sample);
  sample.time = time;
  count_ = std::max(count_, next_ + 1);
  next_ = next_ + 1 == most ? 0 : next_ + 1;
  return sample;
}

}  // namespace carom

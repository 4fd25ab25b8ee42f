#include <carom/integrators/time_stepping/capture_rule.h>
#include <carom/integrators/time_stepping/gap_rounding.h>

#include <algorithm>

namespace carom {

CaptureRule CaptureRule::of(const Assembly& assembly, const TimeStepping& options) {
  // Bounces of this many steps are impacts. Under gravity, at 1 ms, contacts bounce for 2 ms at the capture
  // speed.
  constexpr double followed_steps = 1000.0;
  return {options.capture_speed,
          std::min(gap_rounding(assembly, options) / options.step, options.capture_speed),
          followed_steps * options.step};
}

}  // namespace carom

// Problem: a run that may be interrupted has got somewhere, and is not slower for it.

#include <carom/integrators/event_driven/reached_motion.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {
constexpr auto quick = std::chrono::milliseconds(5);
constexpr auto slow = std::chrono::milliseconds(20);
constexpr double change = 4.0;  // of the length of stretches that are quick, or slow
}  // namespace

double Stretches::end(double from, double to, Clock::time_point now) {
  const auto took = now - begun_;
  if (!is_first_ && took < quick) length_ *= change;
  if (!is_first_ && took > slow) length_ = std::max(shortest_, length_ / change);
  is_first_ = false;
  begun_ = now;
  // Not lost in the rounding of time.
  const double end = std::max(from + length_, std::nextafter(from, std::numeric_limits<double>::infinity()));
  return std::min(to, end);
}

}  // namespace carom

// Problem: the closing of a gap on the exact motion, each look at which may cost a step.

#include <carom/contact/detection/first_closing.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

/// Where a gap closes, between a time at which it is open and a later one: at that it is closed, or open and
/// rises, so that the closing may lie before it, or it is the end of the span.
struct ClosingBracket {
  double low, high;
  double scale;  // of times: what is narrow against it is rounding [s]
  bool below;    // a gap below the level was found
  bool rises = false;

  void take(double time, double rest, double rate, bool is_open) {
    rises = rest > 0.0 && rate >= 0.0;
    const bool as_low = !rises && (rest > 0.0 || is_open);
    below = below || !(rises || as_low);
    (as_low ? low : high) = time;
  }
  [[nodiscard]] bool is_narrow() const {
    return high - low <= 2.0 * std::numeric_limits<double>::epsilon() * scale;
  }
  /// The next time to try. What is open by less than the clock can tell closes at the next time that it can:
  /// halfway to the far end the gap may be open again. \param ahead how far the time is ahead of the closing
  [[nodiscard]] double next(double time, double ahead, bool halve) const {
    double next = time - ahead;
    if (next == time) next = std::nextafter(time, ahead > 0.0 ? low : high);
    return next > low && next < high && !halve && !rises ? next : 0.5 * (low + high);
  }
};

}  // namespace

ClosingRoot locate_closing(PairPath& path, const PairGap& of, const ClosingRule& rule, const GapLook& from,
                           double to, bool is_below, double predicted) {
  using Kind = ClosingRoot::Kind;
  constexpr int most_looks = 60;
  ClosingBracket at{from.time, to, std::max(std::abs(to), to - from.time), is_below};
  const bool searches_behind = rule.contradiction > 0.0;
  const double first = std::clamp(predicted, at.low, at.high);
  double time = first;
  for (int i = 0; i < most_looks; ++i) {
    const StepPolynomial::End gap = gap_in(of, path.sample(time, PathLook::exact_rates));
    if (i == 0 && rule.misleading < never &&
        std::abs(gap_in(of, path.sample(time, PathLook::between)).value - gap.value) > rule.misleading) {
      return {time, Kind::misleads, gap.first};
    }
    const double rest = gap.value - rule.level;
    const bool falls = std::min(gap.first, from.gap.first) < -rule.slow;
    const bool is_there = std::abs(rest) <= rule.found;
    if ((is_there && falls) || at.low == at.high) return {time, Kind::closes, gap.first};
    if (is_there && searches_behind) return {time, Kind::touches, gap.first};
    // Before the time that was predicted first nothing closes: a gap that rises there opens. At any other
    // time it may have closed between the last time at which it fell and this one.
    const bool is_first = searches_behind ? i == 0 : time <= first;
    if (rest > 0.0 && gap.first >= 0.0 && is_first) return {time, Kind::opens, gap.first};
    // A gap that does not fall is open: it may close behind that.
    const bool is_open = !falls && !searches_behind;
    at.take(time, rest, gap.first, is_open);
    if (at.is_narrow()) break;
    constexpr int some = 8;
    time = at.next(time, rest / gap.first, is_open || i % some == some - 1);
  }
  if (searches_behind && at.rises) return {at.high, Kind::opens, 0.0};
  if (!at.below) return {first, Kind::opens, 0.0};
  return {at.high, Kind::closes, 0.0};
}

}  // namespace carom

// Problem: end a phase where a gap closes, which is known only where phases have ended.

#include <carom/integrators/time_stepping/phase_ends.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

/// True if both are gaps of one pair.
bool are_of_one_pair(const EndGap& a, const EndGap& b) {
  return a.time < never && b.time < never && a.pair == b.pair;
}

}  // namespace

void PhaseEnds::take(const EndGap& gap, double end, bool is_late) {
  (is_late ? closed_ : open_) = end;
  (is_late ? at_closed_ : at_open_) = gap;
  before_ = now_;
  now_ = gap;
}

bool PhaseEnds::are_as_near_as_can_be(const StepClosing& closing) const {
  constexpr double hardly = 2.0, much = 10.0;
  if (!(closed_ < never) || !are_of_one_pair(at_open_, at_closed_) || at_closed_.gap > closing.shallow)
    return false;
  if (at_open_.gap <= closing.shallow) return at_closed_.gap >= hardly * at_open_.gap;
  const double fastest = std::max(std::abs(at_open_.rate), std::abs(at_closed_.rate));
  return at_open_.gap - at_closed_.gap > much * fastest * (closed_ - open_);
}

/// When the gap reaches the aim, by the last two ends; the guess where they do not tell. Rates are those
/// along the way of one phase: how the gap goes with the end of the phase differs from them by a factor.
double PhaseEnds::by_secant(const StepClosing& closing, double guess) const {
  const double noise = closing.shallow - closing.deep, aim = closing.aim();
  if (!are_of_one_pair(before_, now_)) return guess;
  if (!(std::abs(now_.gap - aim) > noise) || !(std::abs(before_.gap - aim) > noise)) return guess;
  double slope = (now_.gap - before_.gap) / (now_.time - before_.time);
  if (now_.rate < 0.0 && before_.rate < 0.0) slope *= 2.0 * now_.rate / (now_.rate + before_.rate);
  return slope < 0.0 ? now_.time - (now_.gap - aim) / slope : guess;
}

double PhaseEnds::next(const StepClosing& closing, double guess) {
  constexpr int most_idle = 5;
  const double wanted = by_secant(closing, guess);
  const double end = std::min(closed_, last_);
  const bool shrinks = end - open_ <= 0.5 * width_;
  idle_ = shrinks ? 0 : idle_ + 1;
  if (shrinks) width_ = end - open_;
  if (wanted >= last_ && closed_ > last_) return last_;
  if (idle_ <= most_idle && wanted > open_ && wanted < end) return wanted;
  idle_ = 0;
  const double middle = 0.5 * (open_ + end);
  return middle > open_ && middle < end ? middle : end;
}

}  // namespace carom

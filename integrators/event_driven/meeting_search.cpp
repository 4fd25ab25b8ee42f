// Problem: no meeting of two groups is missed, although each has its own steps.

#include <carom/core/numerics/never.h>
#include <carom/integrators/event_driven/event_scales.h>
#include <carom/integrators/event_driven/joinable_group.h>
#include <carom/integrators/event_driven/meeting_search.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace carom {

namespace {

/// Two bodies that fly freely, as they do between events; centres only.
class FreePath final : public PairPath {
public:
  FreePath(const BodyPairBound& bound, const BodyFlight& a, const BodyFlight& b, MotionSample& out)
      : bound_(&bound), a_(&a), b_(&b), out_(&out) {}

  [[nodiscard]] const MotionSample& sample(double time) override {
    write(bound_->a, *a_, time);
    write(bound_->b, *b_, time);
    return *out_;
  }

private:
  void write(const BodySlot& slot, const BodyFlight& flight, double time) {
    const Vec<2> place = flight.place_at(time);
    const Vec<2> velocity = flight.velocity + (time - flight.time) * flight.acceleration;
    for (Index k = 0; k < 2; ++k) {
      out_->state.q[slot.q + k] = place[k];
      out_->state.v[slot.v + k] = velocity[k];
      out_->acceleration[slot.v + k] = flight.acceleration[k];
    }
  }

  const BodyPairBound* bound_;
  const BodyFlight *a_, *b_;
  MotionSample* out_;
};

/// Two groups within their steps.
class GroupsPath final : public PairPath {
public:
  GroupsPath(ClockGroup& a, ClockGroup& b, bool landed, Forces forces, MotionSample& out)
      : a_(&a), b_(&b), landed_(landed), forces_(forces), out_(&out) {}

  [[nodiscard]] const MotionSample& sample(double time) override {
    JoinableGroup(*a_).sample(time, landed_, forces_, *out_);
    JoinableGroup(*b_).sample(time, landed_, forces_, *out_);
    return *out_;
  }

private:
  ClockGroup *a_, *b_;
  bool landed_;
  Forces forces_;
  MotionSample* out_;
};

/// Where a gap closes, between a time at which it is open and falls and a later one: at that it is closed, or
/// open and rises, so that the closing may lie before it, or it is the end of the span.
struct ClosingBracket {
  double low, high;
  double scale;  // of times: what is narrow against it is rounding [s]
  bool rises = false;

  void take(double time, double rest, double rate) {
    rises = rest > 0.0 && rate >= 0.0;
    (rest > 0.0 && !rises ? low : high) = time;
  }
  [[nodiscard]] bool is_narrow() const {
    return high - low <= 2.0 * std::numeric_limits<double>::epsilon() * scale;
  }
  /// The next time to try. What is open by less than the clock can tell closes at the next time that it can:
  /// halfway to the far end the gap may be open again. \param ahead how far the time is ahead of the closing
  [[nodiscard]] double next(double time, double ahead, bool halve) const {
    const double beside = std::nextafter(time, ahead > 0.0 ? low : high);
    double next = time - ahead;
    if (next == time) next = beside;
    return next > low && next < high && !halve && !rises ? next : 0.5 * (low + high);
  }
};

}  // namespace

void GroupSamples::take(double time, ClockGroup& group) {
  const auto is_of = [&](const auto& known) { return known.first == &group; };
  const auto found = std::find_if(known_.begin(), known_.end(), is_of);
  if (found != known_.end() && found->second == time) return;
  JoinableGroup(group).sample(time, false, Forces::all, at_);
  if (found != known_.end()) {
    found->second = time;
  } else {
    known_.emplace_back(&group, time);
  }
}

const MotionSample& GroupSamples::at(double time, ClockGroup& a, ClockGroup& b) {
  if (at_.state.time != time) known_.clear();  // shapes on ground stand where they did then
  take(time, a);
  take(time, b);
  return at_;
}

/// Calls f(bodies, other group, pairs) for bodies of other groups whose volumes overlap those of a group.
template <class F>
void MeetingSearch::for_neighbours(ClockGroup& group, F&& f) {
  for (const MotionUnknowns::Part& part : group.motion().model().parts()) {
    for (Index body = part.ranges.bodies.begin; body < part.ranges.bodies.end; ++body) {
      const BodyFlight& flight = flights_->of(body);
      if (flight.reach < 0.0) continue;
      flights_->volumes().for_overlapping(body, [&](Index other) {
        const BodyFlight& of_other = flights_->of(other);
        ClockGroup& second = groups_->of(of_other.component);
        if (&second == &group) return;
        // In the order of assembly, whoever asks.
        if (body < other) {
          f(std::array{body, other}, Bodies{flight, of_other, group, second});
        } else {
          f(std::array{other, body}, Bodies{of_other, flight, second, group});
        }
      });
    }
  }
}

void MeetingSearch::find(ClockGroup& group, double time, MeetingQueue& queue) {
  begins_.forget();
  ends_.forget();
  for_neighbours(group, [&](const std::array<Index, 2>& numbers, const Bodies& bodies) {
    const double end = std::min(flights_->horizon(bodies.a.component), flights_->horizon(bodies.b.component));
    if (!(end > time)) return;
    pairs_.clear();
    groups_->pairs().append(numbers, pairs_);
    for (const ContactPair& pair : pairs_) {
      const double at = closing(bodies, pair, time, end);
      if (at < never) queue.add(at, bodies.a.component, bodies.b.component);
    }
  });
}

/// Rounding of gaps, not above that of the group of both.
double MeetingSearch::noise(const Bodies& bodies, const BodyPairBound& bound) const {
  const std::vector<double>& lengths = bodies.of_a.motion().memory().closure.lengths;
  double size = 0.0;
  for (const BodyFlight* flight : {&bodies.a, &bodies.b}) {
    size = std::max(size, flight->place.cwiseAbs().maxCoeff());
  }
  for (const BodySlot& slot : {bound.a, bound.b}) {
    if (slot.rotation != none) size = std::max(size, size_of_body(lengths[slot.v + 2]));
  }
  return gap_noise_of(size, *options_);
}

double MeetingSearch::closing(const Bodies& bodies, const ContactPair& pair, double begin, double end) {
  const BodyPairBound bound = bound_of_pair(*assembly_, *detector_, pair);
  if (!bound.closes_alone()) return never;
  const PairGap gap{*assembly_, *detector_, pair, bound};
  ClosingRule rule;
  rule.noise = noise(bodies, bound);
  rule.fine = std::max(fine_gap(*options_), rule.noise);  // far from the origin gaps are not known better
  rule.flies_freely = bodies.a.is_free && bodies.b.is_free;
  rule.until = never;
  if (rule.flies_freely && bound.central && bound.rounding > 0.0) {
    FreePath path(bound, flights_->of(pair.body), flights_->of(pair.other), at_);
    const GapLook from{begin, true, gap_in(gap, path.sample(begin))};
    const GapLook to{end, true, gap_in(gap, path.sample(end))};
    rule.level = std::min(0.0, from.gap.value);
    double time = first_closing(path, gap, rule, from, to);
    if (!(time < never)) return never;
    time = std::clamp(time, begin, end);
    // Fast bodies may be apart yet at a time that is rounded down, and would be met there again and again.
    constexpr int most_roundings = 8;
    for (int i = 0; i < most_roundings && time < end; ++i) {
      if (gap_in(gap, path.sample(time)).value <= rule.level + rule.noise) break;
      time = std::nextafter(time, end);
    }
    return time;
  }
  double speed = 0.0, pull = 0.0;
  const auto look = [&](double time, GroupSamples& samples) -> GapLook {
    const MotionSample& at = samples.at(time, bodies.of_a, bodies.of_b);
    speed = std::max(speed, bound.most_speed(at.state.v.data(), nullptr));
    pull = std::max(pull, bound.most_speed(at.acceleration.data(), nullptr));
    return {time, true, gap_in(gap, at)};
  };
  const GapLook from = look(begin, begins_), to = look(end, ends_);
  constexpr double unseen = 2.0;
  rule.fastest = speed + (rule.flies_freely ? 0.0 : unseen * (end - begin) * pull);
  rule.level = std::min(0.0, from.gap.value);
  return located(bodies, gap, rule, from, to, {});
}

/// The first closing between two looks, located. Where a closing that was predicted is none, the motion after
/// it is searched anew. A gap that opens where its value falls does not close: within steps of low order
/// values and rates contradict each other by the tolerance, and it is searched for what is deeper than that.
/// A step may be wrong far behind its own event, and what is interpolated in front of it too: where that is
/// not the motion that is landed on, the search is made in landings.
double MeetingSearch::located(const Bodies& bodies, const PairGap& gap, ClosingRule& rule,
                              const GapLook& from, const GapLook& to, const Depth& at_depth) {
  constexpr int most_landings = 60, deepest = 20;
  constexpr double growth = 4.0;  // of what the level is lowered by
  const double slow = speed_noise_of(rule.fastest, options_->absolute_tolerance);
  const double interpolated = 10.0 * options_->gap_tolerance;  // errors up to this are those of tolerances
  if (from.gap.value + to.gap.value - rule.fastest * (to.time - from.time) > 2.0 * rule.noise) return never;
  GroupsPath looks(bodies.of_a, bodies.of_b, at_depth.landed, Forces::all, at_);
  // Values and rates of a gap are asked for, its acceleration is not.
  GroupsPath landings(bodies.of_a, bodies.of_b, true, Forces::without_contact, at_);
  double time = first_closing(looks, gap, rule, from, to);
  if (!(time < never)) return never;
  ClosingBracket at{from.time, to.time, std::max(std::abs(to.time), to.time - from.time)};
  time = std::clamp(time, at.low, at.high);
  for (int i = 0; i < most_landings; ++i) {
    const StepPolynomial::End landed = gap_in(gap, landings.sample(time));
    if (i == 0 && !at_depth.landed &&
        std::abs(gap_in(gap, looks.sample(time)).value - landed.value) > interpolated) {
      GroupsPath landed_looks(bodies.of_a, bodies.of_b, true, Forces::all, at_);
      const GapLook begin{from.time, true, gap_in(gap, landed_looks.sample(from.time))},
          end{to.time, true, gap_in(gap, landed_looks.sample(to.time))};
      rule.level = std::min(0.0, begin.gap.value);
      return located(bodies, gap, rule, begin, end, {at_depth.halvings, true});
    }
    const double rest = landed.value - rule.level;
    if (std::min(landed.first, from.gap.first) >= -slow && std::abs(rest) <= 0.25 * rule.noise &&
        at_depth.drift < options_->gap_tolerance) {
      const double drift = std::min(growth * std::max(at_depth.drift, rule.noise), options_->gap_tolerance);
      rule.level -= drift - at_depth.drift;
      return located(bodies, gap, rule, from, to, {at_depth.halvings, at_depth.landed, drift});
    }
    if (std::abs(rest) <= 0.25 * rule.noise && !(landed.first >= 0.0 && time == from.time)) return time;
    if (rest > 0.0 && landed.first >= 0.0 && i == 0) break;
    at.take(time, rest, landed.first);
    if (at.is_narrow()) {
      if (!at.rises) return at.high;
      time = at.high;
      break;
    }
    time = at.next(time, rest / landed.first, i % 8 == 7);
  }
  if (at_depth.halvings == deepest) return never;
  // It opens there: halves are searched each by itself.
  const bool progress = time > from.time && time < to.time;
  const double between = progress ? time : 0.5 * (from.time + to.time);
  if (!(between > from.time && between < to.time)) return never;
  const GapLook middle{between, true, gap_in(gap, looks.sample(between))};
  const Depth deeper{at_depth.halvings + 1, at_depth.landed, at_depth.drift};
  if (!progress) {
    const double first = located(bodies, gap, rule, from, middle, deeper);
    if (first < never) return first;
  }
  return located(bodies, gap, rule, middle, to, deeper);
}

/// The least gap of two bodies at a time, or a lower bound of it.
double MeetingSearch::least_gap(const std::array<Index, 2>& numbers, const Bodies& bodies, double time) {
  pairs_.clear();
  groups_->pairs().append(numbers, pairs_);
  double least = never;
  for (const ContactPair& pair : pairs_) {
    const BodyPairBound bound = bound_of_pair(*assembly_, *detector_, pair);
    const PairGap gap{*assembly_, *detector_, pair, bound};
    if (bodies.a.is_free && bodies.b.is_free && bound.central) {
      const Vec<2> apart = bodies.a.place_at(time) - bodies.b.place_at(time);
      least = std::min(least, apart.norm() - bound.rounding);
      continue;
    }
    least = std::min(least, gap_in(gap, begins_.at(time, bodies.of_a, bodies.of_b)).value);
  }
  return least;
}

void MeetingSearch::add_near(double time, double near, std::vector<ClockGroup*>& list) {
  begins_.forget();
  for (std::size_t i = 0; i < list.size(); ++i) {
    for_neighbours(*list[i], [&](const std::array<Index, 2>& numbers, const Bodies& bodies) {
      ClockGroup* const other = &bodies.of_a == list[i] ? &bodies.of_b : &bodies.of_a;
      if (std::find(list.begin(), list.end(), other) != list.end()) return;
      if (least_gap(numbers, bodies, time) <= near) list.push_back(other);
    });
  }
}

}  // namespace carom

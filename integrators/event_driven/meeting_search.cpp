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

  [[nodiscard]] PathSample sample(double time, PathLook /*how*/) override {
    write(bound_->a, *a_, time);
    write(bound_->b, *b_, time);
    return out_->on_path();
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
  GroupsPath(ClockGroup& a, ClockGroup& b, MotionSample& out) : a_(&a), b_(&b), out_(&out) {}

  [[nodiscard]] PathSample sample(double time, PathLook how) override {
    const bool landed = how != PathLook::between;
    const Forces forces = how == PathLook::exact_rates ? Forces::without_contact : Forces::all;
    JoinableGroup(*a_).sample(time, landed, forces, *out_);
    JoinableGroup(*b_).sample(time, landed, forces, *out_);
    return out_->on_path();
  }

private:
  ClockGroup *a_, *b_;
  MotionSample* out_;
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
  const BodyPairBound bound = bound_of_pair(detector_->outlines(), pair);
  if (!bound.closes_alone()) return never;
  const PairGap gap{*detector_, pair, &bound};
  ClosingRule rule;
  rule.noise = noise(bodies, bound);
  rule.fine = std::max(fine_gap(*options_), rule.noise);  // far from the origin gaps are not known better
  rule.found = 0.25 * rule.noise;
  rule.flies_freely = bodies.a.is_free && bodies.b.is_free;
  if (rule.flies_freely && bound.central && bound.rounding > 0.0) {
    FreePath path(bound, flights_->of(pair.body), flights_->of(pair.other), at_);
    const GapLook from{begin, true, gap_in(gap, path.sample(begin, PathLook::exact))};
    const GapLook to{end, true, gap_in(gap, path.sample(end, PathLook::exact))};
    rule.level = std::min(0.0, from.gap.value);
    return first_closing(path, gap, rule, from, to);
  }
  double speed = 0.0, pull = 0.0;
  const auto look = [&](double time, GroupSamples& samples) -> GapLook {
    const MotionSample& at = samples.at(time, bodies.of_a, bodies.of_b);
    speed = std::max(speed, bound.most_speed(at.state.v.data(), nullptr));
    pull = std::max(pull, bound.most_speed(at.acceleration.data(), nullptr));
    return {time, true, gap_in(gap, at.on_path())};
  };
  const GapLook from = look(begin, begins_), to = look(end, ends_);
  constexpr double unseen = 2.0;
  constexpr double of_tolerances = 10.0;  // errors up to this are those of tolerances
  rule.fastest = speed + (rule.flies_freely ? 0.0 : unseen * (end - begin) * pull);
  rule.level = std::min(0.0, from.gap.value);
  rule.slow = speed_noise_of(rule.fastest, options_->absolute_tolerance);
  rule.misleading = of_tolerances * options_->gap_tolerance;
  rule.contradiction = options_->gap_tolerance;
  GroupsPath path(bodies.of_a, bodies.of_b, at_);
  return first_closing(path, gap, rule, from, to);
}

/// The least gap of two bodies at a time, or a lower bound of it.
double MeetingSearch::least_gap(const std::array<Index, 2>& numbers, const Bodies& bodies, double time) {
  pairs_.clear();
  groups_->pairs().append(numbers, pairs_);
  double least = never;
  for (const ContactPair& pair : pairs_) {
    const BodyPairBound bound = bound_of_pair(detector_->outlines(), pair);
    const PairGap gap{*detector_, pair, &bound};
    if (bodies.a.is_free && bodies.b.is_free && bound.central) {
      const Vec<2> apart = bodies.a.place_at(time) - bodies.b.place_at(time);
      least = std::min(least, apart.norm() - bound.rounding);
      continue;
    }
    least = std::min(least, gap_in(gap, begins_.at(time, bodies.of_a, bodies.of_b).on_path()).value);
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

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

/// Two bodies: by their flights where these tell, else by the steps of their groups.
class BodiesPath final : public PairPath {
public:
  BodiesPath(const BodyPairBound& bound, const ContactPair& pair, const BodyFlights& flights,
             GroupSet& groups, MotionSample& out)
      : bound_(&bound),
        a_(&flights.of(pair.body)),
        b_(&flights.of(pair.other)),
        of_a_(&groups.of(a_->component)),
        of_b_(&groups.of(b_->component)),
        out_(&out) {}

  /// True if flights tell the exact motion of both.
  [[nodiscard]] bool is_free() const { return a_->is_free && b_->is_free; }
  /// True if flights tell the motion of both, as exactly as steps are.
  [[nodiscard]] bool is_told() const {
    return (a_->is_free || a_->is_curve) && (b_->is_free || b_->is_curve);
  }
  /// Between landings: by flights, or by samples of groups, kept for others that ask for the same time.
  [[nodiscard]] PathSample between(double time, GroupSamples& samples) {
    return is_told() ? sample(time, PathLook::between) : samples.at(time, *of_a_, *of_b_).on_path();
  }
  [[nodiscard]] PathSample sample(double time, PathLook how) override {
    if (is_free() || (how == PathLook::between && is_told())) {
      out_->state.time = time;
      write(bound_->a, *a_, time);
      write(bound_->b, *b_, time);
      return out_->on_path();
    }
    const bool landed = how != PathLook::between;
    const Forces forces = how == PathLook::exact_rates ? Forces::without_contact : Forces::all;
    JoinableGroup(*of_a_).sample(time, landed, forces, *out_);
    JoinableGroup(*of_b_).sample(time, landed, forces, *out_);
    return out_->on_path();
  }

private:
  void write(const BodySlot& slot, const BodyFlight& flight, double time) {
    const BodyMoment at = flight.moment(time);
    for (Index k = 0; k < slot.v_size; ++k) {
      out_->state.q[slot.q + k] = at[k].place;
      out_->state.v[slot.v + k] = at[k].rate;
      out_->acceleration[slot.v + k] = at[k].acceleration;
    }
    if (bound_->central) return;  // nobody asks for rotations
    std::vector<double>& placed_at = out_->evaluation.placed_at;
    if (!placed_at.empty()) placed_at[flight.component] = time;
    if (slot.rotation == none) return;
    constexpr std::size_t angle = 2;
    Space<2>::rotation(&at[angle].place, out_->evaluation.rotation.data() + slot.rotation);
  }

  const BodyPairBound* bound_;
  const BodyFlight *a_, *b_;
  ClockGroup *of_a_, *of_b_;
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

/// Calls f(numbers of two bodies in the order of assembly, other group) for bodies of other groups whose
/// volumes overlap those of a group.
template <class F>
void MeetingSearch::for_neighbours(ClockGroup& group, F&& f) {
  for (const MotionUnknowns::Part& part : group.motion().model().parts()) {
    for (Index body = part.ranges.bodies.begin; body < part.ranges.bodies.end; ++body) {
      if (flights_->of(body).reach < 0.0) continue;
      flights_->volumes().for_overlapping(body, [&](Index other) {
        ClockGroup& second = groups_->of(flights_->of(other).component);
        if (&second != &group) f(std::array{std::min(body, other), std::max(body, other)}, second);
      });
    }
  }
}

void MeetingSearch::find(ClockGroup& group, double time, MeetingQueue& queue) {
  begins_.forget();
  ends_.forget();
  for_neighbours(group, [&](const std::array<Index, 2>& numbers, const ClockGroup&) {
    const BodyFlight &a = flights_->of(numbers[0]), &b = flights_->of(numbers[1]);
    pairs_.clear();
    groups_->pairs().append(numbers, pairs_);
    for (const ContactPair& pair : pairs_) {
      const double at = closing(pair, time, Wanted::guess);
      if (!(at < never)) continue;
      queue.add(at, a.component, b.component, a.is_free && b.is_free ? Guess{} : Guess{pair, time});
    }
  });
}

double MeetingSearch::locate(const Guess& guess) {
  begins_.forget();
  ends_.forget();
  return closing(guess.pair, guess.from, Wanted::exact);
}

/// Rounding of gaps, not above that of the group of both.
double MeetingSearch::noise(const ContactPair& pair, const BodyPairBound& bound) const {
  const BodyFlight &a = flights_->of(pair.body), &b = flights_->of(pair.other);
  const std::vector<double>& lengths = groups_->of(a.component).motion().memory().closure.lengths;
  double size = std::max(a.place().cwiseAbs().maxCoeff(), b.place().cwiseAbs().maxCoeff());
  for (const BodySlot& slot : {bound.a, bound.b}) {
    if (slot.rotation != none) size = std::max(size, size_of_body(lengths[slot.v + 2]));
  }
  return gap_noise_of(size, *options_);
}

double MeetingSearch::closing(const ContactPair& pair, double begin, Wanted wanted) {
  const double end = std::min(flights_->horizon(flights_->of(pair.body).component),
                              flights_->horizon(flights_->of(pair.other).component));
  if (!(end > begin)) return never;
  const BodyPairBound bound = bound_of_pair(detector_->outlines(), pair);
  if (!bound.closes_alone()) return never;
  const PairGap gap{*detector_, pair, &bound};
  BodiesPath path(bound, pair, *flights_, *groups_, at_);
  double speed = 0.0, pull = 0.0;
  const auto look = [&](double time, GroupSamples& samples) -> GapLook {
    const PathSample at = path.between(time, samples);
    speed = std::max(speed, bound.most_speed(at.state.v, nullptr));
    pull = std::max(pull, bound.most_speed(at.acceleration, nullptr));
    return {time, true, gap_in(gap, at)};
  };
  const GapLook from = look(begin, begins_), to = look(end, ends_);
  ClosingRule rule;
  rule.noise = noise(pair, bound);
  rule.fine = std::max(fine_gap(*options_), rule.noise);  // far from the origin gaps are not known better
  rule.found = 0.25 * rule.noise;
  rule.flies_freely = path.is_free();
  rule.level = std::min(0.0, from.gap.value);
  if (!(rule.flies_freely && bound.central && bound.rounding > 0.0)) {
    constexpr double unseen = 2.0;
    constexpr double of_tolerances = 10.0;  // errors up to this are those of tolerances
    rule.fastest = speed + (rule.flies_freely ? 0.0 : unseen * (end - begin) * pull);
    rule.slow = speed_noise_of(rule.fastest, options_->absolute_tolerance);
    rule.misleading = of_tolerances * options_->gap_tolerance;
    rule.contradiction = options_->gap_tolerance;
  }
  if (wanted == Wanted::guess && !path.is_free()) return predict_closing(path, gap, rule, from, to);
  return first_closing(path, gap, rule, from, to);
}

/// The least gap of two bodies at a time, or a lower bound of it.
double MeetingSearch::least_gap(const std::array<Index, 2>& numbers, double time) {
  pairs_.clear();
  groups_->pairs().append(numbers, pairs_);
  double least = never;
  for (const ContactPair& pair : pairs_) {
    const BodyPairBound bound = bound_of_pair(detector_->outlines(), pair);
    BodiesPath path(bound, pair, *flights_, *groups_, at_);
    least = std::min(least, gap_in({*detector_, pair, &bound}, path.between(time, begins_)).value);
  }
  return least;
}

void MeetingSearch::add_near(double time, double near, std::vector<ClockGroup*>& list) {
  begins_.forget();
  for (std::size_t i = 0; i < list.size(); ++i) {
    for_neighbours(*list[i], [&](const std::array<Index, 2>& numbers, ClockGroup& other) {
      if (std::find(list.begin(), list.end(), &other) != list.end()) return;
      if (least_gap(numbers, time) <= near) list.push_back(&other);
    });
  }
}

}  // namespace carom

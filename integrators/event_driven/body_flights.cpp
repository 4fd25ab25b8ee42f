// Problem: where can the bodies of a group be before its horizon?

#include <carom/core/numerics/never.h>
#include <carom/integrators/event_driven/body_flights.h>
#include <carom/integrators/event_driven/joinable_group.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

// Rounding of places, relative to their size: volumes are larger by it.
constexpr double place_rounding = 64.0 * std::numeric_limits<double>::epsilon();

/// Largest and least value of x + v s + a s^2/2 for s from 0 to a length.
void span_parabola(double x, double v, double a, double length, double& low, double& high) {
  const double end = x + length * (v + 0.5 * length * a);
  low = std::min(x, end);
  high = std::max(x, end);
  const double vertex = -v / a;
  if (!(vertex > 0.0 && vertex < length)) return;
  const double extreme = x + 0.5 * v * vertex;
  low = std::min(low, extreme);
  high = std::max(high, extreme);
}

/// The moment of a body in a sample.
BodyMoment moment_in(const MotionSample& sample, const BodySlot& slot) {
  BodyMoment at;
  for (Index k = 0; k < slot.v_size; ++k)
    at[k] = {sample.state.q[slot.q + k], sample.state.v[slot.v + k], sample.acceleration[slot.v + k]};
  return at;
}

}  // namespace

BodyMoment BodyFlight::moment(double at) const {
  const double s = at - time;
  BodyMoment out = begin;
  for (std::size_t k = 0; k < out.size(); ++k) {
    const CoordinateMotion& from = begin[k];
    const double pull = from.acceleration;
    if (is_free) {
      out[k] = {from.place + s * (from.rate + 0.5 * s * pull), from.rate + s * pull, pull};
    } else if (due < never && due > time) {
      out[k] = motion_between(begin[k], end[k], due - time, s / (due - time));
    }
  }
  return out;
}

BodyFlights::BodyFlights(const Assembly& assembly, const Detector& detector)
    : assembly_(&assembly),
      flights_(assembly.layout()->bodies().size()),
      horizons_(assembly.components().size(), 0.0) {
  for (const BodyOutline& outline : detector.outlines().of_bodies().list()) {
    BodyFlight& flight = flights_[outline.body];
    flight.reach = std::max(flight.reach, outline.reach);
    flight.component = assembly.component_of(outline.body);
  }
}

/// The frame goes on with the mean velocity of the bodies if they fly together: if all move against it at
/// less than a quarter of it.
void BodyFlights::choose_frame(const State& state) {
  constexpr double together = 0.25;
  Vec<2> sum = Vec<2>::Zero();
  double count = 0.0, most = 0.0;
  const auto for_velocities = [&](auto&& f) {
    for (Index body = 0; body < flights_.size(); ++body) {
      const Index v = assembly_->layout()->bodies()[body].v;
      if (flights_[body].reach >= 0.0) f(Vec<2>(state.v[v], state.v[v + 1]));
    }
  };
  for_velocities([&](const Vec<2>& velocity) {
    sum += velocity;
    count += 1.0;
  });
  frame_ = sum / std::max(count, 1.0);
  for_velocities([&](const Vec<2>& velocity) { most = std::max(most, (velocity - frame_).norm()); });
  if (!(most < together * frame_.norm())) frame_.setZero();
  frame_time_ = state.time;
}

void BodyFlights::start(const State& state, double extra) {
  choose_frame(state);
  extra_ = extra;
  double size = 0.0, count = 0.0;
  Vec<2> low(never, never), high(-never, -never);
  for (Index body = 0; body < flights_.size(); ++body) {
    BodyFlight& flight = flights_[body];
    if (flight.reach < 0.0) continue;
    const BodySlot slot = assembly_->layout()->bodies()[body];
    flight.begin = {};
    for (Index k = 0; k < 2; ++k) flight.begin[k].place = state.q[slot.q + k];
    flight.time = state.time;
    low = low.cwiseMin(flight.place());
    high = high.cwiseMax(flight.place());
    size += 2.0 * flight.reach;
    count += 1.0;
  }
  // Cells about as wide as bodies, or as the space between them.
  const double area = count > 0.0 ? (high - low).prod() : 0.0;
  double cell = count > 0.0 ? std::max(size / count, std::sqrt(area / count)) : 1.0;
  if (!(std::isfinite(cell) && cell > 0.0)) cell = 1.0;
  travel_ = 0.5 * cell;
  volumes_.start(static_cast<Index>(flights_.size()), cell);
  for (Index body = 0; body < flights_.size(); ++body) {
    const BodyFlight& flight = flights_[body];
    if (flight.reach < 0.0) continue;
    const double reach = flight.reach + extra;
    volumes_.set(body, {flight.place().array() - reach, flight.place().array() + reach});
  }
  std::fill(horizons_.begin(), horizons_.end(), state.time);
}

double BodyFlights::follow(ClockGroup& group, double time, MotionSample& now, MotionSample& end) {
  const SmoothMotion& motion = group.motion();
  const bool is_free = motion.is_ballistic();
  const FlowMethod method = motion.model().options->method;
  const bool is_curve = method == FlowMethod::explicit_runge_kutta || method == FlowMethod::one_step;
  JoinableGroup(group).sample(time, false, Forces::all, now);
  const auto for_flights = [&](auto&& f) {
    for (const MotionUnknowns::Part& part : motion.model().parts()) {
      for (Index body = part.ranges.bodies.begin; body < part.ranges.bodies.end; ++body) {
        if (flights_[body].reach >= 0.0) f(body, flights_[body]);
      }
    }
  };
  const BodySlots& slots = assembly_->layout()->bodies();
  for_flights([&](Index body, BodyFlight& flight) {
    flight.time = time;
    flight.is_free = is_free;
    flight.is_curve = is_curve;
    flight.speed = 0.0;
    flight.begin = moment_in(now, slots[body]);
  });
  const double due = JoinableGroup(group).due();
  const bool rests = !(due < never);
  if (!is_free && !rests) JoinableGroup(group).sample(due, false, Forces::all, end);
  for_flights([&](Index body, BodyFlight& flight) {
    flight.due = due;
    if (rests) {  // but for rounding
      for (CoordinateMotion& at : flight.begin) at.rate = at.acceleration = 0.0;
    }
    if (is_free) return;
    flight.speed = (flight.velocity() - frame_).norm();  // of bodies at rest too, in a frame that goes on
    if (rests) return;
    constexpr double unseen = 2.0;
    flight.end = moment_in(end, slots[body]);
    for (const CoordinateMotion& at : flight.end)
      flight.is_curve = flight.is_curve && std::isfinite(at.acceleration);
    const Vec<2> later(flight.end[0].rate, flight.end[1].rate),
        pull(flight.end[0].acceleration, flight.end[1].acceleration);
    flight.speed = std::max(flight.speed, (later - frame_).norm()) +
                   unseen * (due - time) * std::max(flight.acceleration().norm(), pull.norm());
  });
  double horizon = due;
  for_flights([&](Index, const BodyFlight& flight) {
    const double v = is_free ? (flight.velocity() - frame_).norm() : flight.speed;
    const double a = is_free ? flight.acceleration().norm() : 0.0;
    const double length = 2.0 * travel_ / (v + std::sqrt(v * v + 2.0 * a * travel_));
    if (time + length > time) horizon = std::min(horizon, time + length);
  });
  for_flights([&](Index body, const BodyFlight&) { sweep(body, horizon < never ? horizon - time : 0.0); });
  for (const MotionUnknowns::Part& part : motion.model().parts()) horizons_[part.component] = horizon;
  return horizon;
}

/// Sets the volume of a body that it covers within a length of time.
void BodyFlights::sweep(Index body, double length) {
  const BodyFlight& flight = flights_[body];
  const Vec<2> velocity = flight.velocity() - frame_,
               place = flight.place() - (flight.time - frame_time_) * frame_;
  Box<2> box;
  for (int k = 0; k < 2; ++k) {
    if (flight.is_free) {
      span_parabola(place[k], velocity[k], flight.acceleration()[k], length, box.min[k], box.max[k]);
    } else {
      box.min[k] = place[k] - length * flight.speed;
      box.max[k] = place[k] + length * flight.speed;
    }
    const double size =
        std::max({std::abs(box.min[k]), std::abs(box.max[k]), std::abs(flight.place()[k])}) + flight.reach;
    const double reach = flight.reach + extra_ + place_rounding * size;
    box.min[k] -= reach;
    box.max[k] += reach;
  }
  volumes_.set(body, box);
}

}  // namespace carom

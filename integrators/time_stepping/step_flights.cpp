// Problem: the way of a step on which bodies are hit.

#include <carom/integrators/time_stepping/step_flights.h>

#include <algorithm>

namespace carom {

void StepFlights::add(const StepInput& in, const LocatedMotion& motion) {
  const BodySlot body = in.assembly.layout()->bodies()[motion.body()];
  const MotionPhase* last = nullptr;
  for (const MotionPhase& phase : motion.phases()) {
    if (!phase.is_impact()) {
      last = &phase;
    } else if (phase.begin > 0.0 && phase.begin < 1.0) {
      corners_.push_back({phase.begin, body, phase.q});
    }
  }
  if (last == nullptr) return;
  LastFlight flight{body, motion.body(), {}};
  const double time = (last->end - last->begin) * in.step;
  for (Index i = 0; i < body.v_size; ++i) flight.acceleration[i] = (last->v1[i] - last->v0[i]) / time;
  last_.push_back(flight);
}

bool StepFlights::follow(const ContactPair& pair) const {
  const auto is_of = [&](const LastFlight& flight) { return flight.number == pair.body; };
  return pair.ground_shape != none && std::any_of(last_.begin(), last_.end(), is_of);
}

std::size_t StepFlights::write_way(const State& start, const State& end, std::vector<State>& out) {
  shares_.clear();
  for (const Corner& corner : corners_) shares_.push_back(corner.share);
  std::sort(shares_.begin(), shares_.end());
  shares_.erase(std::unique(shares_.begin(), shares_.end()), shares_.end());
  const std::size_t count = shares_.size() + 2;
  if (out.size() < count) out.resize(count, start);
  out.front() = start;
  out[count - 1] = end;
  for (std::size_t k = 0; k < shares_.size(); ++k) {
    State& at = out[k + 1];
    const double share = shares_[k];
    at = start;
    at.time = start.time + share * (end.time - start.time);
    for (std::size_t i = 0; i < at.q.size(); ++i) at.q[i] += share * (end.q[i] - start.q[i]);
  }
  // Of a body that is hit: from one of its corners to the next.
  for (std::size_t first = 0; first < corners_.size();) {
    const BodySlot& body = corners_[first].body;
    std::size_t last = first;
    while (last < corners_.size() && corners_[last].body.q == body.q) ++last;
    std::size_t next = first;
    for (std::size_t k = 0; k < shares_.size(); ++k) {
      while (next < last && corners_[next].share < shares_[k]) ++next;
      const double from = next == first ? 0.0 : corners_[next - 1].share;
      const double to = next == last ? 1.0 : corners_[next].share;
      const double* const a = next == first ? start.q.data() + body.q : corners_[next - 1].q.data();
      const double* const b = next == last ? end.q.data() + body.q : corners_[next].q.data();
      const double part = (shares_[k] - from) / (to - from);
      for (Index i = 0; i < body.q_size; ++i) out[k + 1].q[body.q + i] = a[i] + part * (b[i] - a[i]);
    }
    first = last;
  }
  return count;
}

void StepFlights::write_accelerations(const std::vector<double>& v, const State& end, double step,
                                      std::vector<double>& out) const {
  out.resize(v.size());
  for (std::size_t i = 0; i < v.size(); ++i) out[i] = (end.v[i] - v[i]) / step;
  for (const LastFlight& flight : last_) {
    std::copy_n(flight.acceleration.begin(), flight.body.v_size, out.begin() + flight.body.v);
  }
}

}  // namespace carom

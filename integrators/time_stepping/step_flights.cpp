// Problem: the way of a step on which bodies are hit.

#include <carom/integrators/time_stepping/step_flights.h>

#include <algorithm>

namespace carom {

namespace {

/// Displacement up to a share of the time in which velocities change evenly. \param whole displacement
/// \param change of the velocity, times the length of the time
double on_parabola(double share, double whole, double change) {
  return share * whole - 0.5 * share * (1.0 - share) * change;
}

}  // namespace

void StepFlights::add(const StepInput& in, const LocatedMotion& motion) {
  const BodySlot body = in.assembly.layout()->bodies()[motion.body()];
  for (const MotionPhase& phase : motion.phases()) {
    if (phase.is_impact()) continue;
    Flight flight{body, motion.body(), phase.begin, phase.end, in.step, phase.q, {}};
    for (Index i = 0; i < body.v_size; ++i) flight.change[i] = phase.v1[i] - phase.v0[i];
    flights_.push_back(flight);
  }
}

bool StepFlights::follow(const ContactPair& pair) const {
  const auto is_of = [&](const Flight& flight) { return flight.number == pair.body; };
  return pair.ground_shape != none && std::any_of(flights_.begin(), flights_.end(), is_of);
}

std::size_t StepFlights::write_way(const State& start, const State& end, const std::vector<double>& change,
                                   std::vector<State>& out) {
  shares_.clear();
  for (const Flight& flight : flights_) {
    if (flight.begin > 0.0) shares_.push_back(flight.begin);
  }
  std::sort(shares_.begin(), shares_.end());
  shares_.erase(std::unique(shares_.begin(), shares_.end()), shares_.end());
  const std::size_t count = shares_.size() + 2;
  if (out.size() < count) out.resize(count, start);
  out.front() = start;
  out[count - 1] = end;
  const double step = end.time - start.time;
  for (std::size_t k = 0; k < shares_.size(); ++k) {
    State& at = out[k + 1];
    const double share = shares_[k];
    at = start;
    at.time = start.time + share * step;
    for (std::size_t i = 0; i < at.q.size(); ++i)
      at.q[i] += on_parabola(share, end.q[i] - start.q[i], step * change[i]);
    for (std::size_t f = 0; f < flights_.size(); ++f) {
      const Flight& flight = flights_[f];
      if (!(share >= flight.begin && share < flight.end)) continue;
      const double length = flight.end - flight.begin;
      const double* const q = is_last(f) ? end.q.data() + flight.body.q : flights_[f + 1].q.data();
      for (Index i = 0; i < flight.body.q_size; ++i) {
        at.q[flight.body.q + i] =
            flight.q[i] + on_parabola((share - flight.begin) / length, q[i] - flight.q[i],
                                      length * step * flight.change[i]);
      }
    }
  }
  return count;
}

void StepFlights::write_changes(double from, double to, const std::vector<double>& change,
                                std::vector<double>& out) const {
  out.resize(change.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = (to - from) * change[i];
  const double middle = 0.5 * (from + to);
  for (const Flight& flight : flights_) {
    if (!(middle >= flight.begin && middle < flight.end)) continue;
    const double part = (to - from) / (flight.end - flight.begin);
    for (Index i = 0; i < flight.body.v_size; ++i) out[flight.body.v + i] = part * flight.change[i];
  }
}

void StepFlights::write_accelerations(const std::vector<double>& v, const State& end, double step,
                                      std::vector<double>& out) const {
  out.resize(v.size());
  for (std::size_t i = 0; i < v.size(); ++i) out[i] = (end.v[i] - v[i]) / step;
  for (std::size_t f = 0; f < flights_.size(); ++f) {
    const Flight& flight = flights_[f];
    const double time = (flight.end - flight.begin) * flight.step;
    for (Index i = 0; is_last(f) && i < flight.body.v_size; ++i)
      out[flight.body.v + i] = flight.change[i] / time;
  }
}

}  // namespace carom

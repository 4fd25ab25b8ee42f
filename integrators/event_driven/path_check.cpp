// Problem: an error estimate knows the stages of a step only.

#include <carom/integrators/event_driven/path_check.h>

#include <cmath>

namespace carom {

namespace {

constexpr double noticeable = 100.0;  // tolerances: the path is less exact than steps are
constexpr double shortest = 1e-9;     // steps against the time: what is left is its rounding

/// How far off the path a coordinate may be.
double allowed_off_path(const SmoothMotion& motion, std::size_t i, double coordinate) {
  return noticeable * (motion.model().options->relative_tolerance * std::abs(coordinate) +
                       motion.absolute_tolerances()[i]);
}

/// Writes the path at a time into the memory; number of coordinates.
std::size_t follow(SearchedStep& step, double time) {
  const std::size_t count = step.motion.model().unknowns.q_size();
  DetectionMemory& memory = step.memory;
  memory.y.resize(step.motion.size());
  memory.path_acceleration.resize(count);
  follow_path(*step.ends.start().path, *step.ends.end().path, count, time, memory.y,
              memory.path_acceleration.data());
  return count;
}

}  // namespace

bool misses_loads(SearchedStep& step, double until) {
  const double begin = step.begin(), length = until - begin;
  if (!step.motion.has_jacobian() || length <= shortest * std::abs(until)) return false;
  const std::size_t count = follow(step, begin + 0.5 * length);
  DetectionMemory& memory = step.memory;
  step.motion.sample(begin + 0.5 * length, memory.y.data(), Forces::all, memory.within);
  const MotionUnknowns& unknowns = step.motion.model().unknowns;
  for (std::size_t i = 0; i < count; ++i) {
    const double followed = memory.within.acceleration[unknowns.velocity_at(count + i)];
    // An acceleration that is missing like a parabola displaces by length^2/12.
    const double off = std::abs(followed - memory.path_acceleration[i]) * length * length / 12.0;
    if (!(off <= allowed_off_path(step.motion, i, memory.y[i]))) return true;
  }
  return false;
}

bool lands_off_path(SearchedStep& step, const Event& event, Landing& landing) {
  const double length = event.time - step.begin();
  if (event.guard == Guard::nothing || event.guard == Guard::painleve || !step.has_guards()) return false;
  if (!step.motion.has_jacobian() || length <= shortest * std::abs(event.time)) return false;
  if (landing.time != event.time) {
    landing.y.resize(step.motion.size());
    step.flow.land(event.time, landing.y);
    landing.time = event.time;
  }
  const std::size_t count = follow(step, event.time);
  const std::vector<double>& y = step.memory.y;
  for (std::size_t i = 0; i < count; ++i) {
    const double of_rate = length * (landing.y[count + i] - y[count + i]);
    if (!(std::abs(landing.y[i] - y[i]) + std::abs(of_rate) <= allowed_off_path(step.motion, i, y[i])))
      return true;
  }
  return false;
}

}  // namespace carom

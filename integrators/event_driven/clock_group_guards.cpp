// Problem: events of guards within a step, and steps that have passed over what elements do.

#include <carom/integrators/event_driven/clock_group.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

/// Looks at guards along the path between the ends of the flow's last step.
class ClockGroup::PathLooker final : public StepLooker {
public:
  explicit PathLooker(ClockGroup& driver) : driver_(&driver) {}

  void look(double time, StepLook& out) override {
    SmoothMotion& motion = driver_->motion_;
    std::vector<double>& y = driver_->work_->y;
    y.resize(motion.size());
    acceleration_.resize(motion.v_begin());
    follow_path(driver_->start_.path, driver_->end_.path, motion.v_begin(), time, y, acceleration_.data());
    motion.read_guards(time, y.data(), acceleration_.data(), out.guards);
  }

private:
  ClockGroup* driver_;
  std::vector<double>& acceleration_ = driver_->work_->free;
};

/// Guards nearer to zero than this have not passed it: what a step may be wrong by, and rounding.
double ClockGroup::guard_noise() const { return std::max(gap_noise_, options_.absolute_tolerance); }

/// When a guard changes its sign first.
void ClockGroup::predict_guards(StepLooker& looker, Found& found) {
  constexpr double never = std::numeric_limits<double>::infinity();
  const double until = found.guard == Guard::nothing ? never : found.time;
  PathLooker along(*this);
  const bool path = motion_.guards_follow_path();
  const GuardSearch::Passage passage =
      guards_.first(motion_.guards(), start_.seen, end_.seen, path ? work_->guard_looks : work_->looks,
                    path ? static_cast<StepLooker&>(along) : looker, guard_noise(), until);
  if (passage.time < until) found = {passage.time, Guard::kink, passage.guard, passage.sign};
}

namespace {

constexpr double noticeable = 100.0;  // tolerances: the path is less exact than steps are
constexpr double shortest = 1e-9;     // steps against the scale of time: what is left is rounding

}  // namespace

/// True of a step whose stages passed over what an element does, so that its error seems small: the element
/// is entered and left between two of them, or the one stage that meets it has no weight. Up to the first
/// event no guard changes its sign, so that the loads halfway, along the path, show whether they were
/// followed.
bool ClockGroup::leaps_over_loads(double until) {
  const double begin = flow_->begin(), length = until - begin;
  if (!motion_.has_jacobian() || length <= shortest * std::max(1.0, std::abs(until))) return false;
  const std::size_t count = motion_.v_begin();
  std::vector<double>& y = work_->y;
  y.resize(motion_.size());
  work_->free.resize(count);
  follow_path(start_.path, end_.path, count, begin + 0.5 * length, y, work_->free.data());
  motion_.evaluate(begin + 0.5 * length, y.data(), true);
  const double* const followed =
      work_->motion.acceleration.data() + assembly_->components()[motion_.component()].v.begin;
  for (std::size_t i = 0; i < count; ++i) {
    // An acceleration that is missing like a parabola displaces by length^2/12.
    const double off = std::abs(followed[i] - work_->free[i]) * length * length / 12.0;
    if (!(off <= allowed_off_path(i, y[i]))) return true;
  }
  return false;
}

/// True if a step that ends at the event leads elsewhere than the path: it may not be landed on.
bool ClockGroup::lands_off_path(const Found& found) {
  const double length = found.time - flow_->begin();
  if (found.guard == Guard::nothing || found.guard == Guard::painleve || end_.seen.guards.empty())
    return false;
  if (!motion_.has_jacobian() || length <= shortest * std::max(1.0, std::abs(found.time))) return false;
  if (landed_at_ != found.time) {
    landed_.resize(motion_.size());
    flow_->land(found.time, landed_);
    landed_at_ = found.time;
  }
  const std::size_t count = motion_.v_begin();
  std::vector<double>& y = work_->y;
  y.resize(motion_.size());
  work_->free.resize(count);
  follow_path(start_.path, end_.path, count, found.time, y, work_->free.data());
  for (std::size_t i = 0; i < count; ++i) {
    const double of_rate = length * (landed_[count + i] - y[count + i]);
    if (!(std::abs(landed_[i] - y[i]) + std::abs(of_rate) <= allowed_off_path(i, y[i]))) return true;
  }
  return false;
}

/// How far off the path a coordinate may be.
double ClockGroup::allowed_off_path(std::size_t i, double coordinate) const {
  return noticeable * (options_.relative_tolerance * std::abs(coordinate) + motion_.absolute_tolerances()[i]);
}

}  // namespace carom

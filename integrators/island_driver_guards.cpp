// Problem: events of guards within a step, and steps that have passed over what elements do.

#include <carom/integrators/island_driver.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace carom {

/// Looks at guards along the path between the ends of the flow's last step.
class IslandDriver::PathLooker final : public StepLooker {
public:
  explicit PathLooker(IslandDriver& driver) : driver_(&driver) {}

  void look(double time, StepLook& out) override {
    IslandMotion& motion = driver_->motion_;
    std::vector<double>& y = driver_->work_->y;
    y.resize(motion.size());
    acceleration_.resize(motion.v_begin());
    follow_path(driver_->start_.path, driver_->end_.path, motion.v_begin(), time, y, acceleration_.data());
    motion.read_guards(time, y.data(), acceleration_.data(), out.guards);
  }

private:
  IslandDriver* driver_;
  std::vector<double>& acceleration_ = driver_->work_->free;
};

/// Guards nearer to zero than this have not passed it: what a step may be wrong by, and rounding.
double IslandDriver::guard_noise() const { return std::max(gap_noise_, options_.absolute_tolerance); }

/// When a guard changes its sign first.
void IslandDriver::foretell_guards(StepLooker& looker, Found& found) {
  constexpr double never = std::numeric_limits<double>::infinity();
  const double until = found.guard == Guard::nothing ? never : found.time;
  PathLooker along(*this);
  const bool path = motion_.guards_follow_path();
  const GuardSearch::Passage passage =
      guards_.first(motion_.guards(), start_.seen, end_.seen, path ? work_->guard_looks : work_->looks,
                    path ? static_cast<StepLooker&>(along) : looker, guard_noise(), until);
  if (passage.time < until) found = {passage.time, Guard::kink, passage.guard, passage.sign};
}

/// True of a step whose stages passed over what an element does: it is entered and left between two of them,
/// so that the error of the step seems small. A step that ends at the event then leads elsewhere.
bool IslandDriver::leaps_over_guards(const Found& found) {
  constexpr double noticeable = 100.0;  // tolerances: interpolation is less exact than steps are
  constexpr double shortest = 1e-9;     // of the scale of time: what is left is rounding
  const double length = found.time - flow_->begin();
  if (found.guard == Guard::nothing || found.guard == Guard::jam || !motion_.has_jacobian()) return false;
  if (end_.seen.guards.empty()) return false;
  if (length <= shortest * std::max(1.0, std::abs(found.time))) return false;
  if (landed_at_ != found.time) {
    landed_.resize(motion_.size());
    flow_->land(found.time, landed_);
    landed_at_ = found.time;
  }
  const std::size_t count = motion_.v_begin();
  work_->y.resize(motion_.size());
  work_->free.resize(count);
  follow_path(start_.path, end_.path, count, found.time, work_->y, work_->free.data());
  const std::span<const double> absolute = motion_.absolute_tolerances();
  for (std::size_t i = 0; i < count; ++i) {
    const double size = std::max(std::abs(landed_[i]), std::abs(work_->y[i]));
    const double allowed = noticeable * (options_.relative_tolerance * size + absolute[i]);
    const double of_rate = length * (landed_[count + i] - work_->y[count + i]);
    if (!(std::abs(landed_[i] - work_->y[i]) + std::abs(of_rate) <= allowed)) return true;
  }
  return false;
}

}  // namespace carom

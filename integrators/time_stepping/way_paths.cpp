// Problem: along which paths do bodies go from the start of a step to its end?

#include <carom/integrators/time_stepping/way_paths.h>

namespace carom {

void WayPaths::begin(const StepWay& way, Form form) {
  bends_ = !way.flights.empty();
  bodies_ = way.bodies;
  corner_ = 0;
  if (bends_) {
    set_whole(way);
    count_ = way.flights.write_way(way.start, way.end, corners_);
    return;
  }
  count_ = 2;
  change_.resize(way.end.v.size());
  for (std::size_t i = 0; i < change_.size(); ++i) change_[i] = way.end.v[i] - way.after_impacts[i];
  path_.set(way.start, way.end, form == Form::chord ? nullptr : change_.data(), way.bodies);
}

/// The path between both ends of a way that has the velocities at its end.
void WayPaths::set_whole(const StepWay& way) {
  whole_.set(way.start, way.end, nullptr, way.bodies);
  change_.resize(way.end.v.size());
  const double length = whole_.length();
  for (Index i = 0; i < change_.size(); ++i)
    change_[i] = 2.0 * (way.end.v[i] - whole_.displacement(i) / length);
  whole_.set(way.start, way.end, change_.data(), way.bodies);
}

bool WayPaths::next() {
  while (++corner_ < count_) {
    if (!bends_) return true;
    const State &from = corners_[corner_ - 1], &to = corners_[corner_];
    if (!(to.time > from.time)) continue;  // as near as times can be told apart
    path_.set(from, to, nullptr, bodies_);
    return true;
  }
  return false;
}

}  // namespace carom

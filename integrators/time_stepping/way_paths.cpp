// Problem: along which paths do bodies go from the start of a step to its end?

#include <carom/integrators/time_stepping/way_paths.h>

namespace carom {

void WayPaths::begin(const StepWay& way, Form form) {
  flights_ = &way.flights;
  bodies_ = way.bodies;
  corner_ = 0;
  change_.resize(way.end.v.size());
  for (std::size_t i = 0; i < change_.size(); ++i) change_[i] = way.end.v[i] - way.after_impacts[i];
  if (bends()) {
    set_whole(way);
    count_ = way.flights.write_way(way.start, way.end, change_, corners_);
    return;
  }
  count_ = 2;
  path_.set(way.start, way.end, form == Form::chord ? nullptr : change_.data(), way.bodies);
}

/// The path between both ends of a way that has the velocities at its end.
void WayPaths::set_whole(const StepWay& way) {
  whole_.set(way.start, way.end, nullptr, way.bodies);
  between_.resize(way.end.v.size());
  const double length = whole_.length();
  for (Index i = 0; i < between_.size(); ++i)
    between_[i] = 2.0 * (way.end.v[i] - whole_.displacement(i) / length);
  whole_.set(way.start, way.end, between_.data(), way.bodies);
}

bool WayPaths::next() {
  while (++corner_ < count_) {
    if (!bends()) return true;
    const State &from = corners_[corner_ - 1], &to = corners_[corner_];
    if (!(to.time > from.time)) continue;  // as near as times can be told apart
    const double start = corners_.front().time, length = corners_[count_ - 1].time - start;
    flights_->write_changes((from.time - start) / length, (to.time - start) / length, change_, between_);
    path_.set(from, to, between_.data(), bodies_);
    return true;
  }
  return false;
}

}  // namespace carom

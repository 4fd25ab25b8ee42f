#include <carom/contact/detection/ground_shapes.h>
#include <carom/contact/detection/prescribed_motion.h>
#include <carom/core/described_sets.h>
#include <carom/core/law_jump.h>
#include <carom/core/registry.h>
#include <carom/core/run_error.h>
#include <carom/core/system.h>

#include <algorithm>
#include <string>
#include <utility>

namespace carom {

GroundShapes::GroundShapes(const System& system) : system_(&system) {
  const auto& registry = system.ground_shape_kinds();
  std::vector<GroundPiece> pieces;
  for (const Index serial : registry.serials()) {
    const auto place = registry.place(serial);
    const GroundShapeKind& kind = *registry.entries()[place.entry].kind;
    const Index moving = kind.moves(place.slot) ? moving_++ : none;
    pieces.clear();
    kind.pieces(place.slot, pieces);
    check_pieces({system.name(ObstacleId{serial, system.token()}), system}, pieces);
    shapes_.push_back({&kind, place.slot, serial, moving, kind.surface_speed(place.slot), !pieces.empty(),
                       kind.is_flat(place.slot)});
    std::vector<double> times;
    if (moving != none) kind.discontinuity_times(place.slot, times);
    for (const double time : times) breaks_.emplace_back(time, size() - 1);
  }
  std::sort(breaks_.begin(), breaks_.end());
}

Index GroundShapes::find(Index serial) const {
  const auto found = std::find_if(shapes_.begin(), shapes_.end(),
                                  [serial](const Shape& shape) { return shape.serial == serial; });
  return found == shapes_.end() ? none : static_cast<Index>(found - shapes_.begin());
}

ObstacleId GroundShapes::id(Index shape) const { return {shapes_[shape].serial, system_->token()}; }

GroundMotion GroundShapes::motion(Index shape, double time) const {
  const GroundMotion motion = shapes_[shape].kind->place(shapes_[shape].slot, time);
  const NonFiniteMotion bad = find_non_finite(motion);
  if (bad.quantity == nullptr) return motion;
  fail_law_not_finite(system_->name(id(shape)), std::string(bad.quantity) + " of its motion", bad.value,
                      bad.unit, time);
}

void GroundShapes::refuse(Index shape, const Gap& gap, const double* point, double time) const {
  SolverFailure failure;
  failure.time = time;
  failure.parts.push_back(system_->name(id(shape)));
  const auto list = [this](const double* numbers) {
    std::string text = "(" + to_text(numbers[0]);
    for (int i = 1; i < system_->dimension(); ++i) text += ", " + to_text(numbers[i]);
    return text + ")";
  };
  const bool of_normal = gap.distance >= std::numeric_limits<double>::lowest();
  const std::string message =
      failure.parts.front() + ": " + (of_normal ? "normal" : "distance") + " at " + list(point) + " m is " +
      (of_normal ? list(gap.normal.data()) + "; allowed: a vector of length 1"
                 : to_text(gap.distance) + " m; allowed: a finite number, or infinity");
  throw RunError(message, std::move(failure));
}

void GroundShapes::place(double time, GroundPlaces& places) const {
  if (places.time_ == time && places.motions_.size() == moving_) return;
  places.time_ = std::numeric_limits<double>::quiet_NaN();  // for as long as it takes
  places.motions_.clear();
  if (moving_ > 0) {
    for (Index shape = 0; shape < size(); ++shape) {
      if (moves(shape)) places.motions_.push_back(motion(shape, time));
    }
  }
  places.time_ = time;
}

void GroundShapes::demand_continuous(const GroundPlaces& before, const GroundPlaces& after) const {
  const auto point_of = [](const GroundMotion& motion, double time) {
    return LawPoint{time,        motion.point,          motion.velocity,  motion.angle,
                    motion.spin, motion.velocity_given, motion.spin_given};
  };
  constexpr PrescribedLaw::Names names{.place = "displacement", .unit = "m", .unit_of_velocity = "m/s"};
  for (Index shape = 0; shape < size(); ++shape) {
    if (!moves(shape)) continue;
    const Shape& at = shapes_[shape];
    const LawPoint from = point_of(before.motions_[at.moving], before.time_),
                   to = point_of(after.motions_[at.moving], after.time_);
    auto law = [&](double time) { return point_of(at.kind->place(at.slot, time), time); };
    auto name = [&] { return system_->name(id(shape)); };
    PrescribedLaw(law, name, names).demand_continuous(from, to);
  }
}

void GroundShapes::list_jumps(double from, double to, std::vector<GroundJump>& out) const {
  out.clear();
  const auto is_until = [](double time, const std::pair<double, Index>& of) { return time < of.first; };
  auto at = std::upper_bound(breaks_.begin(), breaks_.end(), from, is_until);
  for (; at != breaks_.end() && at->first <= to; ++at) {
    const double time = at->first;
    const GroundMotion after = motion(at->second, time),
                       before = motion(at->second, std::nextafter(time, from));
    GroundJump jump{time, shapes_[at->second].serial, {}, {}, after.spin - before.spin};
    for (std::size_t i = 0; i < jump.point.size(); ++i) {
      jump.point[i] = after.point[i];
      jump.velocity[i] = after.velocity[i] - before.velocity[i];
    }
    out.push_back(jump);
  }
}

std::vector<Discontinuity> GroundShapes::discontinuities() const {
  std::vector<Discontinuity> all;
  std::vector<double> times;
  for (Index shape = 0; shape < size(); ++shape) {
    times.clear();
    shapes_[shape].kind->discontinuity_times(shapes_[shape].slot, times);
    for (const double time : times) all.push_back({.time = time, .obstacle = id(shape)});
  }
  return all;
}

}  // namespace carom

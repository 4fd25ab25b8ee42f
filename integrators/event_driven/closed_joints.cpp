// Problem: rows of joints that the motion does not keep must not pass for free bodies.

#include <carom/core/dynamics/light_bodies.h>
#include <carom/core/errors.h>
#include <carom/integrators/event_driven/closed_joints.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace carom {

namespace {

/// True of a row that binds angles alone.
bool binds_angles(const JointConstraints& joints, std::size_t row) {
  const auto places = static_cast<int>(joints.pattern().dimension());
  const JointRow at = joints.row(row);
  for (int b = 0; b < at.bodies; ++b) {
    const JointRow::Block& block = at.blocks[static_cast<std::size_t>(b)];
    for (int c = 0; c < std::min(places, block.columns); ++c) {
      if (block.jacobian[static_cast<std::size_t>(c)] != 0.0) return false;
    }
  }
  return true;
}

/// Largest coordinate of a place, or radius of gyration, of the bodies of a component [m].
double size_of(const SmoothMotion& motion, Index component, const State& state) {
  const Assembly& assembly = *motion.model().assembly;
  const Layout& layout = *assembly.layout();
  const auto places = static_cast<Index>(layout.dimension());
  double size = 0.0;
  layout.bodies().for_range(assembly.components()[component].bodies, [&](Index, const BodySlot& slot) {
    for (Index i = 0; i < places; ++i) size = std::max(size, std::abs(state.q[slot.q + i]));
    for (Index i = places; i < slot.v_size; ++i)
      size = std::max(size, motion.memory().closure.lengths[slot.v + i]);
  });
  return size;
}

}  // namespace

void demand_closed(const SmoothMotion& motion, const MotionSample& at, const GroupFailure& failure) {
  // Of the errors of a step in places: levers and slopes of laws of time magnify them, so does the output
  // between two steps.
  constexpr double tolerances = 1e3;
  constexpr double least = 1e-8;  // of the size: rounding of poor matrices
  const GroupModel& model = motion.model();
  const EventDriven& options = *model.options;
  for (const GroupJoints::Part& part : motion.joints().rows().parts()) {
    const JointConstraints& joints = *part.joints;
    const double size = size_of(motion, part.component, at.state);
    const auto allowed_of = [&](double length) {
      return tolerances * (options.relative_tolerance * length + options.absolute_tolerance) + least * length;
    };
    double allowed = allowed_of(size);
    std::size_t worst = joints.size();
    for (std::size_t row = 0; row < joints.size(); ++row) {
      if (std::abs(joints.gaps()[row]) <= allowed) continue;
      const double of_row = binds_angles(joints, row) ? allowed_of(std::max(size, 1.0)) : allowed;
      if (std::abs(joints.gaps()[row]) <= of_row) continue;
      allowed = std::abs(joints.gaps()[row]);
      worst = row;
    }
    if (worst == joints.size()) continue;
    std::vector<std::string> parts{model.assembly->system().name(joints.joint(worst))};
    std::string what = parts.front() + " has opened by " + to_text(allowed) +
                       ", by more than tolerances of the integrator leave: its forces are lost in rounding";
    what += light_bodies(*model.assembly, part.component, parts);
    failure.fail(what, std::move(parts));
  }
}

}  // namespace carom

// Problem: closures take out what tolerances leave, and nothing else.

#include <carom/integrators/event_driven/group_closure.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace carom {

namespace {

ClosureInput input_of(SmoothMotion& motion, const MotionSample& at) {
  assert(motion.joints().is_at(at));
  const GroupModel& model = motion.model();
  std::vector<Index>& components = motion.memory().components;
  components.clear();
  for (const auto& part : model.parts()) components.push_back(part.component);
  return {.assembly = *model.assembly,
          .components = components,
          .joints = motion.joints().rows().list(),
          .contacts = motion.active(),
          .state = at.view(),
          .force = at.evaluation.force.data()};
}

/// Names of the joints that change the velocities of a sample most where all is closed, else of the closed
/// contacts. \param at the sample that the motion made last
std::vector<std::string> causes_of(SmoothMotion& motion, const MotionSample& at) {
  assert(motion.joints().is_at(at));
  // Of the largest impulse: smaller ones are caused by others.
  constexpr double considerable = 0.1;
  MotionMemory& memory = motion.memory();
  const GroupModel& model = motion.model();
  GroupJoints& joints = motion.joints().rows();
  model.unknowns.for_velocities([&](Range v, std::size_t) {
    std::copy(at.state.v.begin() + v.begin, at.state.v.begin() + v.end,
              memory.closure.of_velocity.begin() + v.begin);
  });
  memory.multipliers.assign(joints.size(), 0.0);
  joints.project(JointLevel::velocity, memory.closure.of_velocity.data(), memory.multipliers.data());
  double largest = 0.0;
  for (const double impulse : memory.multipliers) largest = std::max(largest, std::abs(impulse));
  std::vector<std::string> names;
  for (const GroupJoints::Part& part : joints.parts()) {
    const JointPattern& pattern = part.joints->pattern();
    const double* const multipliers = memory.multipliers.data() + part.first_row;
    for (std::size_t joint = 0; joint < pattern.size(); ++joint) {
      bool takes_part = false;
      for (Index row = pattern.first_row(joint); row < pattern.first_row(joint + 1); ++row) {
        takes_part = takes_part || (largest > 0.0 && std::abs(multipliers[row]) >= considerable * largest);
      }
      if (takes_part) names.push_back(model.assembly->system().name(pattern.id(joint)));
    }
  }
  if (!names.empty()) return names;
  for (const ActiveContact& contact : motion.active().list()) {
    names.push_back(model.detector->name(contact.at.key));
  }
  return names;
}

}  // namespace

bool find_closure(SmoothMotion& motion, const MotionSample& at) {
  return find_closure(input_of(motion, at), motion.memory().closure);
}

Closure close(SmoothMotion& motion, const MotionSample& at, std::span<double> y) {
  const std::vector<MotionUnknowns::Part>& parts = motion.model().parts();
  const auto place_of = [&](Index component) {
    const auto before = [](const MotionUnknowns::Part& part, Index of) { return part.component < of; };
    const auto part = std::lower_bound(parts.begin(), parts.end(), component, before);
    return ClosedPlace{y.data() + part->q, y.data() + part->v};
  };
  return close(input_of(motion, at), place_of, motion.memory().closure);
}

/// Errors within the tolerances are small, and near singular positions magnified by up to
/// 1/sqrt(dependent_pivot).
double GroupClosure::close_and_judge(const MotionSample& at, std::span<double> y, bool& changed,
                                     EventBalance& balance) {
  const Closure result = close(*motion_, at, y);
  changed = result.changed;
  balance.shift = std::max(balance.shift, result.shift);
  const EventDriven& options = *motion_->model().options;
  const double tolerated = 0.5 * motion_->absolute_tolerances().back() * options.absolute_tolerance;
  if (!(result.velocity_energy > tolerated / dependent_pivot)) return result.lost;
  const double present = motion_->model().kinetic_energy(at.state.v.data());
  if (result.velocity_energy <= options.largest_projection * present) return result.lost;
  failure_->fail("projecting velocities onto the constraints changes " + to_text(result.velocity_energy) +
                     " J of " + to_text(present) + " J kinetic energy; allowed: up to largest_projection, " +
                     to_text(options.largest_projection) +
                     " of it. The position is singular, or too near one",
                 causes_of(*motion_, at));
}

double GroupClosure::apply_to_output(const MotionSample& at, std::span<double> y, EventBalance& balance) {
  bool changed = false;
  return close_and_judge(at, y, changed, balance);
}

bool GroupClosure::apply(const MotionSample& at, std::span<double> y, EventBalance& balance) {
  bool changed = false;
  balance.flows[EnergyFlow::projection] += close_and_judge(at, y, changed, balance);
  return changed;
}

void GroupClosure::apply_with_contact_stuck(std::size_t contact, const MotionSample& at, std::span<double> y,
                                            EventBalance& balance) {
  ContactMode& mode = motion_->active().list()[contact].mode;
  const ContactMode before = std::exchange(mode, ContactMode::stick);
  apply(at, y, balance);
  mode = before;
}

void GroupClosure::apply_to_known_contacts(EventInstant& at) {
  constexpr double left_by_tolerances = 1e3;
  std::vector<ActiveContact>& list = motion_->active().list();
  const std::vector<ActiveContact> known = list;
  bool erased = false;  // the constraint that what is attached belongs to
  std::erase_if(list, [&](ActiveContact& closed) {
    closed.at = at.contacts[closed.place];
    // Time stepping gives what sticks its tangential restitution.
    const double noise = left_by_tolerances * at.scales.noise_of(*motion_, closed.at);
    const bool slips = closed.sticks() && std::abs(closed.at.tangential_velocity(at.velocities())) > noise;
    if (closed.at.attached) return erased || slips;
    erased =
        slips || closed.at.gap > motion_->model().options->gap_tolerance ||
        std::abs(closed.at.normal_velocity(at.velocities())) > left_by_tolerances * at.scales.speed_noise;
    return erased;
  });
  if (!list.empty()) {
    motion_->sample(at.time, at.y.data(), Forces::all, at.now);
    if (at.now.has_forces) apply(at.now, at.y, at.balance);
  }
  list = known;
  at.update();
}

}  // namespace carom

#include <carom/core/dynamics/force_directions.h>
#include <carom/core/dynamics/joint_closure.h>
#include <carom/core/dynamics/open_joints.h>
#include <carom/core/part_check.h>
#include <carom/core/run_error.h>
#include <carom/integrators/event_driven/impact_list.h>
#include <carom/integrators/run/companion.h>
#include <carom/integrators/running_model.h>
#include <carom/integrators/step_grid.h>
#include <carom/integrators/time_stepping/start_overlap.h>

#include <algorithm>
#include <utility>

namespace carom {

ModeMachines::ModeMachines(const Assembly& assembly, const Mode& mode, const StopRequest& request)
    : stop(&request) {
  if (const auto* options = std::get_if<TimeStepping>(&mode)) {
    stepper = std::make_unique<TimeStepper>(assembly, *options, stop);
    controller = std::make_unique<StepController>(assembly, *options);
    if (SetPhases::needed(assembly, *stepper)) phased = std::make_unique<PhasedSteps>(assembly, *stepper);
  } else {
    driver = std::make_unique<EventDriver>(assembly, std::get<EventDriven>(mode), stop);
  }
}

void ModeMachines::advance(const Run& run, double limit) {
  State& state = run.state;
  Companion& companion = run.companion;
  const auto make_step = [&](State& from, Companion& with, double step, double end, StepReport& report) {
    if (phased) return phased->step(from, with, step, end, report);
    stepper->step(from, with, step, end, report);
  };
  if (controller && std::get<TimeStepping>(run.mode).control) {
    controller->step(make_step, state, companion, limit, run.report);
    return;
  }
  const auto advance_to = [&](double step, double end) {
    if (stepper) {
      make_step(state, companion, step, end, run.report);
    } else {
      run.unlisted = driver->advance(state, companion, end, run.report, run.events);
      list_impacts(run.events, std::exchange(run.unlisted, 0), run.report);
    }
  };
  const StepGrid grid(run.mode);
  const double full = grid.length(), close = grid.closeness(state.time);
  const double grid_end = grid.next(companion);
  if (limit < grid_end - close) {
    // Cut short: the grid starts anew from there.
    advance_to(limit - state.time, limit);
    restart_grid(companion, state.time);
  } else {
    const bool snapped = limit <= grid_end + close;
    advance_to(full, snapped ? limit : grid_end);
    ++companion.grid_steps;
  }
}

void ModeMachines::advance_unseen(const Run& run, double limit) {
  stop->begin();
  try {
    run.unlisted = driver->advance(run.state, run.companion, limit, run.report, run.events, true);
    StepGrid(run.mode).skip_to(run.companion, limit);
  } catch (const RunError& error) {
    advance_while_good(run, limit);
    SolverFailure failure = error.failure();
    failure.step = std::max(failure.time + failure.step - run.state.time, 0.0);
    failure.time = run.state.time;
    throw RunError(error.what(), std::move(failure));
  } catch (...) {
    // Whoever interrupts does not wait for intervals.
    if (stop->interrupted()) {
      stand_where_reached(run);
    } else {
      advance_while_good(run, limit);
    }
    throw;
  }
}

/// After a failure: goes by intervals as far as the motion was good, where somebody who looks would stand.
/// A call that failed is not tried again: a function of the user that throws once would be lost.
void ModeMachines::advance_while_good(const Run& run, double limit) {
  const double good = driver->good_until();
  const StepGrid grid(run.mode);
  while (run.state.time < limit && std::min(grid.next(run.companion), limit) <= good) advance(run, limit);
}

/// Where that state is not good either, the run stands where it began.
void ModeMachines::stand_where_reached(const Run& run) {
  const double before = run.state.time;
  try {
    run.unlisted = driver->stand_where_reached(run.state, run.companion, run.report, run.events);
  } catch (const RunError&) {
    return;
  }
  if (run.state.time > before) StepGrid(run.mode).skip_to(run.companion, run.state.time);
}

RunningModel::Prepared RunningModel::prepare(State& start) const {
  const JointClosure closed = close_joints(assembly, start);
  demand_roughly_closed(assembly.system(), closed.open);
  double shift = closed.shift;
  if (machines.stepper) {
    const TimeStepper& stepper = *machines.stepper;
    shift = std::max(shift, prepare_overlaps(assembly, stepper.detector(), stepper.options(), start));
  }
  demand_directions(assembly, start);
  if (machines.driver) machines.driver->demand_start(start);
  return {shift, finding_of(assembly.system(), closed.open)};
}

std::vector<ModelFinding> RunningModel::findings(Prepared start) const {
  std::vector<ModelFinding> found = assembly.system().check();
  if (start.finding) found.push_back(*std::move(start.finding));
  return found;
}

State RunningModel::continued(const State& other) const {
  State state = assembly.initial_state();
  state.time = other.time;
  const Layout& from = *other.layout();
  for (const InternalSlot& slot : state.layout()->internals()) {
    const ElementId id{slot.serial, assembly.system().token()};
    if (!from.contains(id)) continue;
    std::copy_n(other.z.begin() + from.internal(id).first, slot.size, state.z.begin() + slot.first);
  }
  for (const BodySlot& slot : state.layout()->bodies()) {
    const BodyId id{slot.serial, assembly.system().token()};
    if (!from.contains(id)) continue;
    const BodySlot& old = from.slot(id);
    std::copy_n(other.q.begin() + old.q, slot.q_size, state.q.begin() + slot.q);
    std::copy_n(other.v.begin() + old.v, slot.v_size, state.v.begin() + slot.v);
  }
  return state;
}

StoredEnergies RunningModel::stored_energies(const State& state) const {
  Evaluation evaluation = make_evaluation(assembly);
  return carom::stored_energies(assembly, state.view(), evaluation);
}

JointReaction RunningModel::reaction(const State& state, const Companion& companion, const StepReport& report,
                                     JointId joint) const {
  const System& system = assembly.system();
  if (!system.contains(joint)) {
    throw ModelError("reaction of a joint: joint is " + refused_name(system, joint) +
                     "; allowed: a joint of this model");
  }
  const JointKind& kind = system.joint_kinds().kind_of(joint.serial);
  if (kind.rows() + kind.friction_rows() == 0) {
    throw ModelError("reaction of a joint: " + system.name(joint) +
                     " only limits; allowed: a joint that binds (impacts of a stop are events)");
  }
  if (machines.driver) {
    return machines.driver->reaction(state, companion, joint);
  }
  const auto recorded = std::find_if(report.joint_impulses.begin(), report.joint_impulses.end(),
                                     [&](const JointImpulse& entry) { return entry.joint == joint; });
  if (recorded == report.joint_impulses.end()) {
    EventDriver driver(assembly, EventDriven{});
    return driver.reaction(state, Companion{}, joint);
  }
  JointReaction mean = recorded->impulse;
  for (double& force : mean.force) force /= report.step;
  mean.moment /= report.step;
  return mean;
}

}  // namespace carom

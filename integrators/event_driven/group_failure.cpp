// Problem: name the cause that keeps a clock group from going on.

#include <carom/contact/pressed_bodies.h>
#include <carom/core/dynamics/coupling_rating.h>
#include <carom/core/listed.h>
#include <carom/core/run_error.h>
#include <carom/integrators/event_driven/group_failure.h>
#include <carom/integrators/run/failure_file.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

namespace carom {

namespace {

/// Text about the masses of bodies that touch, where digits that they leave may be the cause.
std::string uneven_masses_of(const GroupModel& model) {
  MassRange masses;
  model.for_bodies([&](const BodyKind& kind, Range slots, Index, Index, const MotionUnknowns::Part&) {
    for (Index slot = slots.begin; slot < slots.end; ++slot) masses.add(kind.mass(slot));
  });
  return uneven_masses(masses);
}

}  // namespace

void GroupFailure::fail(const std::string& what, std::vector<std::string> parts, const IslandProblem* problem,
                        std::span<const Constraint> unkept) const {
  std::string message = "event-driven at t = " + to_text(clock_->now) + " s: " + what;
  const Assembly& assembly = *model_->assembly;
  if (!unkept.empty()) {
    message += pressed_by(assembly.system(), unkept) + carried_by(assembly.system(), unkept);
  } else if (problem != nullptr) {
    const ContactReport& report = problem->report();
    if (report.outcome == Outcome::no_solution)
      message += pressed_by(assembly.system(), problem->constraints());
    if (!report.usable()) message += carried_by(assembly.system(), problem->constraints());
  }
  message += problem == nullptr ? uneven_masses_of(*model_) : uneven_masses(*problem);
  if (parts.empty()) {
    parts.push_back(assembly.system().name(model_->first_body()));
    message += "; component of " + parts.front();
  } else {
    const bool of_problem = problem != nullptr && parts.size() == problem->problem().groups().size();
    message += ": " + listed(of_problem ? worst_first(parts, problem->report().worst_group) : parts);
  }
  SolverFailure failure;
  failure.time = clock_->output;
  failure.step = clock_->now - clock_->output;
  failure.parts = std::move(parts);
  if (problem != nullptr) {
    failure.residual = problem->report().residual;
    failure.problem = std::make_shared<const ContactProblem>(problem->problem());
    message += write_failure(model_->options->failure_directory, failure, message);
  }
  throw RunError(message, std::move(failure));
}

void GroupFailure::demand_finite_loads(const MotionSample& at) const {
  const Assembly& assembly = *model_->assembly;
  ElementId cause;
  for (const auto& part : model_->parts()) {
    cause = find_non_finite(assembly, part.component, at.view(), at.evaluation);
    if (cause.valid()) break;
  }
  if (!cause.valid()) return;
  const System& system = assembly.system();
  std::vector<std::string> parts{system.name(cause)};
  const auto place = system.force_kinds().place(cause.serial);
  std::vector<BodyId> ends;
  system.force_kinds().entries()[place.entry].kind->ends(place.slot, ends);
  if (ends.empty()) ends.push_back(model_->first_body());
  for (const BodyId body : ends) {
    if (body != ground) parts.push_back(system.name(body));
  }
  fail("the loads are not finite", std::move(parts));
}

void GroupFailure::fail_loads(const MotionSample& at) const {
  demand_finite_loads(at);
  const JointRows& joints = model_->detector->joints();
  for (const MotionUnknowns::Part& part : model_->parts()) {
    if (joints.has_friction(part.component)) fail(unsettled_friction, {});
  }
  fail("the loads are not finite", {});
}

void GroupFailure::fail_flow(const RunError& error, SmoothMotion& motion, const double* y,
                             MotionSample& memory) const {
  // The last evaluation of the flow need not be where it failed: a law of time shows itself at the end of the
  // step that was tried, or behind it, up to some thousand roundings of time.
  demand_finite_loads(memory);
  const double end = error.failure().time + error.failure().step;
  const double rounding =
      std::numeric_limits<double>::epsilon() * std::max(error.failure().step, std::abs(end));
  constexpr double farthest = 4096.0;
  for (double ahead = 0.0; ahead <= farthest; ahead = std::max(1.0, 2.0 * ahead)) {
    motion.sample(end + ahead * rounding, y, Forces::without_contact, memory);
    demand_finite_loads(memory);
  }
  fail(error.what(), error.failure().parts);
}

}  // namespace carom

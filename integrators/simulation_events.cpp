// Problem: name the parts of events; tell forces and freedoms at the present state.

#include <carom/core/dynamics/joint_closure.h>
#include <carom/core/part_check.h>
#include <carom/core/whole_file.h>
#include <carom/integrators/contact_forces.h>
#include <carom/integrators/simulation_impl.h>

#include <sstream>

namespace carom {

namespace {

/// "cable 'rope' between ground and particle 'ball'", "applied force 'wind' on particle 'ball'".
std::string name_with_bodies(const System& system, ElementId element) {
  std::string text = system.name(element);
  if (!system.contains(element)) return text;
  const auto place = system.force_kinds().place(element.serial);
  std::vector<BodyId> bodies;
  system.force_kinds().entries()[place.entry].kind->ends(place.slot, bodies);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const bool last = i + 1 == bodies.size();
    const char* const joined = last ? " and " : ", ";
    text += i > 0 ? joined : bodies.size() == 1 ? " on " : " between ";
    text += system.name(bodies[i]);
  }
  return text;
}

}  // namespace

std::string Simulation::name(const EventRecord& event) const {
  const System& model = system();
  const auto demand = [&](const char* what, const auto& id) {
    if (!id.valid() || id.token == model.token()) return;
    throw ModelError(std::string("event: ") + what + " is " + refused_name(model, id) +
                     "; allowed: one of this model");
  };
  demand("element", event.element);
  demand("joint", event.joint);
  demand("obstacle", event.obstacle);
  if (event.element.valid()) return name_with_bodies(model, event.element);
  if (event.joint.valid()) return model.name(event.joint);
  return event.body.valid() ? name(event.contact) : model.name(event.obstacle);
}

void Simulation::write_events(const std::string& path) const {
  std::ostringstream text;
  carom::write_events(text, events(), [this](const EventRecord& event) { return name(event); });
  write_file(path, text.str(), "events");
}

Mobility Simulation::mobility() const {
  const CallGuard::Scope scope(impl_->guard, CallGuard::Caller::law);
  return carom::mobility(impl_->model->assembly, impl_->state);
}

JointReaction Simulation::reaction(JointId joint) const {
  Impl& self = *impl_;
  self.guard.demand("reaction", CallGuard::Need::no_step);
  const CallGuard::Scope scope(self.guard, CallGuard::Caller::law);
  return self.model->reaction(self.state, self.companion, self.report, joint);
}

std::vector<LastingContact> Simulation::contact_forces() const {
  Impl& self = *impl_;
  self.guard.demand("contact_forces", CallGuard::Need::no_step);
  const CallGuard::Scope scope(self.guard, CallGuard::Caller::law);
  const ModeMachines& machines = self.model->machines;
  return machines.driver ? machines.driver->contact_forces(self.state, self.companion)
                         : lasting_forces(self.report);
}

}  // namespace carom

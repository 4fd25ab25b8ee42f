// Problem: tell events to people and programs.

#include <carom/core/csv.h>
#include <carom/core/enum_name.h>
#include <carom/core/part_check.h>
#include <carom/core/whole_file.h>
#include <carom/integrators/event_log.h>
#include <carom/integrators/simulation.h>

#include <ostream>
#include <sstream>

namespace carom {

std::string_view to_string(EventKind kind) {
  constexpr std::array<std::string_view, event_kind_count> names{"impact",
                                                                 "accumulation",
                                                                 "closing",
                                                                 "lift-off",
                                                                 "stick",
                                                                 "slip",
                                                                 "impact without collision",
                                                                 "several accelerations",
                                                                 "kink",
                                                                 "law break",
                                                                 "mode switch"};
  return enum_name(names, kind);
}

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

void write_events(std::ostream& out, const std::vector<EventRecord>& events,
                  const std::function<std::string(const EventRecord&)>& name_of) {
  if (!name_of) throw ModelError("events: name_of is empty; allowed: a function that tells names");
  out << "time [s],kind,part,normal velocity before [m/s],tangential velocity before [m/s],"
         "normal velocity after [m/s],tangential velocity after [m/s],normal impulse [N s],"
         "tangential impulse [N s],kinetic energy before [J],kinetic energy after [J],mode,outcome,solver,"
         "residual,accumulation time [s]\n";
  std::string line;
  const auto add = [&line](const auto& cell) {
    if (!line.empty()) line += ',';
    append_csv(line, cell);
  };
  for (const EventRecord& event : events) {
    line.clear();
    add(event.time);
    add(to_string(event.kind));
    add(std::string_view(name_of(event)));
    for (const auto* numbers : {&event.velocity_before, &event.velocity_after, &event.impulse}) {
      add((*numbers)[0]);
      add((*numbers)[1]);
    }
    add(event.energy_before);
    add(event.energy_after);
    add(to_string(event.mode));
    add(to_string(event.outcome));
    add(event.solver);
    add(event.residual);
    add(event.accumulation_time);
    out << line << '\n';
  }
}

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

}  // namespace carom

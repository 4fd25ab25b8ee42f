// Problem: write events for people and programs.

#include <carom/core/csv.h>
#include <carom/core/enum_name.h>
#include <carom/core/errors.h>
#include <carom/integrators/run/event_log.h>

#include <ostream>

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
                                                                 "switching point",
                                                                 "discontinuity",
                                                                 "mode switch"};
  return enum_name(names, kind);
}

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

}  // namespace carom

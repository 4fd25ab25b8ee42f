// Problem: tell events to people and programs.

#include <carom/core/csv.h>
#include <carom/core/errors.h>
#include <carom/core/part_check.h>
#include <carom/integrators/event_log.h>

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
                                                                 "kink",
                                                                 "law break",
                                                                 "mode switch"};
  return names[static_cast<std::size_t>(kind)];
}

void write_events(std::ostream& out, const std::vector<EventRecord>& events,
                  const std::function<std::string(const EventRecord&)>& name_of) {
  out << "time [s],kind,part,normal velocity before [m/s],tangential velocity before [m/s],"
         "normal velocity after [m/s],tangential velocity after [m/s],normal impulse [N s],"
         "tangential impulse [N s],kinetic energy before [J],kinetic energy after [J],mode,outcome,solver,"
         "residual,accumulation time [s]\n";
  for (const EventRecord& event : events) {
    out << to_text(event.time) << ',' << to_string(event.kind) << ',' << '"' << name_of(event) << '"';
    for (const auto* numbers : {&event.velocity_before, &event.velocity_after, &event.impulse}) {
      out << ',' << to_text((*numbers)[0]) << ',' << to_text((*numbers)[1]);
    }
    out << ',' << to_text(event.energy_before) << ',' << to_text(event.energy_after) << ','
        << to_string(event.mode) << ',' << to_string(event.outcome) << ',' << event.solver << ','
        << to_text(event.residual) << ',' << to_text(event.accumulation_time) << '\n';
  }
}

}  // namespace carom

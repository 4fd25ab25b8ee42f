// Problem: write events for people and programs.

#include <carom/core/csv.h>
#include <carom/core/enum_name.h>
#include <carom/core/errors.h>
#include <carom/integrators/run/event_log.h>

#include <ostream>
#include <string>

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
                                                                 "mode switch",
                                                                 "roll",
                                                                 "hold"};
  return enum_name(names, kind);
}

namespace {

// Bodies whose motions are written; those of contacts and of limits of joints.
constexpr std::size_t bodies_listed = 2;

// "x 1 [m]", "spin before 1 [rad/s]", ...
void write_motion_columns(std::ostream& out, std::size_t body) {
  const std::string number = " " + std::to_string(body + 1);
  out << ",x" << number << " [m],y" << number << " [m],angle" << number << " [rad]";
  for (const char* const when : {" before", " after"}) {
    out << ",x velocity" << when << number << " [m/s],y velocity" << when << number << " [m/s],spin" << when
        << number << " [rad/s]";
  }
}

}  // namespace

void write_events(std::ostream& out, const std::vector<EventRecord>& events,
                  const std::function<std::string(const EventRecord&)>& name_of) {
  if (!name_of) throw ModelError("events: name_of is empty; allowed: a function that tells names");
  out << "time [s],kind,part,normal velocity before [m/s],tangential velocity before [m/s],"
         "normal velocity after [m/s],tangential velocity after [m/s],normal impulse [N s],"
         "tangential impulse [N s],kinetic energy before [J],kinetic energy after [J],mode,outcome,solver,"
         "residual,accumulation time [s],instant";
  for (std::size_t body = 0; body < bodies_listed; ++body) write_motion_columns(out, body);
  out << '\n';
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
    line += ',' + std::to_string(event.instant);
    for (std::size_t body = 0; body < bodies_listed; ++body) {
      const EventMotion& motion = event.motions[body];
      for (const auto* numbers : {&motion.position, &motion.velocity_before, &motion.velocity_after}) {
        for (const double number : *numbers) add(number);
      }
    }
    out << line << '\n';
  }
}

}  // namespace carom

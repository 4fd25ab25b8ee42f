#include <carom/integrators/run_news.h>

#include <string>

namespace carom {

std::vector<std::string> finding_lines(std::span<const ModelFinding> findings) {
  std::vector<std::string> lines;
  for (const ModelFinding& finding : findings) {
    lines.push_back(std::string(to_string(finding.kind)) + ": " + finding.text);
  }
  return lines;
}

namespace {

/// Contacts whose answers are not those of the law: jams without restitution, and what sweeps have not
/// finished.
void write_doubtful(Log& log, const std::string& when, const StepReport& report, const Detector& detector) {
  std::size_t jams = 0, capped = 0;
  const ContactRecord *jam = nullptr, *worst = nullptr;
  for (const ContactRecord& contact : report.contacts) {
    if (contact.restitution_factor == 0.0 && jams++ == 0) jam = &contact;
    if (contact.outcome != Outcome::accepted_at_cap) continue;
    ++capped;
    const bool larger = worst == nullptr || contact.residual > worst->residual;
    if (larger || (contact.worst && contact.residual == worst->residual)) worst = &contact;
  }
  if (jams > 0) {
    log.write(LogLevel::warning, when + std::to_string(jams) + " contacts jam, as that of " +
                                     detector.name(jam->key) + "; solved with e = 0");
  }
  if (capped == 0) return;
  log.write(LogLevel::warning, when + std::to_string(capped) +
                                   " contacts have an answer accepted at the cap of " +
                                   "sweeps, residual up to " + to_text(worst->residual) + " with that of " +
                                   detector.name(worst->key) + "; if some of them jam it does not show" +
                                   (report.capped_problem.empty() ? "" : "; see " + report.capped_problem));
}

}  // namespace

void write_step_news(Log& log, const StepReport& report, const Detector& detector) {
  if (!log.enabled(LogLevel::warning)) return;
  const std::string when = "t = " + to_text(report.time) + " s: ";
  const double impact_gain = report.energy_gain - report.lasting_gain;
  if (impact_gain > 0.0) {
    log.write(LogLevel::warning, when + "impact adds " + to_text(impact_gain) + " J");
  }
  write_doubtful(log, when, report, detector);
  for (const ContactRecord& contact : report.contacts) {
    if (contact.outcome != Outcome::several_solutions) continue;
    log.write(LogLevel::warning, when + "contact of " + detector.name(contact.key) +
                                     " has several solutions; the one with the smallest impulse was taken");
  }
}

void write_event_news(Log& log, std::span<const EventRecord> events, const Detector& detector) {
  for (const EventRecord& event : events) {
    const auto write = [&](LogLevel level, const std::string& what) {
      if (!log.enabled(level)) return;
      log.write(level, "t = " + to_text(event.time) + " s: contact of " + detector.name(event.contact) +
                           ": " + what);
    };
    const auto state_of = [&] {
      return "W_nn - s mu W_nt = " + to_text(event.stiffness) +
             " 1/kg, normal acceleration without contact " + to_text(event.free_acceleration) + " m/s^2";
    };
    if (event.kind == EventKind::impact_without_collision) {
      write(LogLevel::warning,
            "no force keeps it (" + state_of() + "); an impact without collision was made");
    } else if (event.kind == EventKind::several_accelerations) {
      write(LogLevel::warning, "several accelerations are possible (" + state_of() + "); it is " +
                                   std::string(to_string(event.mode)) + " now");
    } else if (event.kind == EventKind::impact && event.restitution_factor == 0.0) {
      write(LogLevel::warning, "it jams with others; their impact was solved with e = 0");
    } else if (event.kind == EventKind::accumulation) {
      write(LogLevel::info, "closed, impacts slower than the capture speed");
    }
  }
}

void write_exceptions(Log& log, double time, std::span<const std::exception_ptr> thrown) {
  if (!log.enabled(LogLevel::error)) return;
  for (const std::exception_ptr& exception : thrown) {
    std::string what = "an unknown exception";
    try {
      std::rethrow_exception(exception);
    } catch (const std::exception& error) {
      what = error.what();
    } catch (...) {  // it has no text
    }
    log.write(LogLevel::error, "t = " + to_text(time) + " s: one more observer or action threw: " + what);
  }
}

}  // namespace carom

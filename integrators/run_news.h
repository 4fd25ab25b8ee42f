#pragma once

/// \file
/// Lines that a run writes to its log: warnings and notes on the model, on steps and on events.

#include <carom/contact/detection/detector.h>
#include <carom/core/log.h>
#include <carom/core/model_finding.h>
#include <carom/integrators/run/event_log.h>
#include <carom/integrators/run/step_report.h>

#include <exception>
#include <span>
#include <string>
#include <vector>

namespace carom {

/// Findings of System::check(), a line each: "contact without a law: ...".
[[nodiscard]] std::vector<std::string> finding_lines(std::span<const ModelFinding> findings);

/// Writes a gain of energy by an impact, and contacts with several solutions, as warnings. \param detector of
/// the model, for names
void write_step_news(Log& log, const StepReport& report, const Detector& detector);

/// Writes Painleve's states as warnings, accumulations of impacts (Zeno) as notes. \param events of one step
void write_event_news(Log& log, std::span<const EventRecord> events, const Detector& detector);

/// Writes exceptions of observers and actions that are not thrown on, as errors. \param time of the run [s]
void write_exceptions(Log& log, double time, std::span<const std::exception_ptr> thrown);

}  // namespace carom

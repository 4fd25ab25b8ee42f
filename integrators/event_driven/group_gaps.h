#pragma once

/// \file
/// Gaps of one clock group within a step: their values and rates, and when the first of them closes
/// (first_closing.h).

#include <carom/core/export.h>
#include <carom/integrators/event_driven/event.h>
#include <carom/integrators/event_driven/searched_step.h>

#include <cstddef>
#include <span>

namespace carom {

/// Samples the gaps of all pairs of two bodies that are open, or bounds of them, and of their rates. False if
/// one is not finite. \param is_active by pair
[[nodiscard]] CAROM_API bool sample_body_gaps(const SmoothMotion& motion, std::span<const char> is_active,
                                              const MotionSample& at, StepEnd& out);

/// Longest step in which gaps of bodies are searched with few looks [s]: the bound of their rates grows with
/// the step, and the looks that it asks for with its square. Infinity where all gaps are smooth, or nothing
/// acts. \param is_active by pair \param start of the step
[[nodiscard]] CAROM_API double longest_searched(const SmoothMotion& motion, std::span<const char> is_active,
                                                const StepEnd& start);

/// The first closing of a gap before an event, else that event: by looks between the ends of the step.
[[nodiscard]] CAROM_API Event predict_gap(SearchedStep& step, const FalseAlarms& passed_over, Event before);

/// The closing of a gap that was predicted, by steps of the flow that end on it. Returns `restart` where the
/// gap opens. \param landing out: the state at the event, if a step ended there
[[nodiscard]] CAROM_API Event locate_gap(SearchedStep& step, const Event& predicted, Landing& landing);

}  // namespace carom

#pragma once

/// \file
/// Output state of a clock group at the time that it was last advanced to, and the works up to there.

#include <carom/core/export.h>
#include <carom/integrators/event_driven/event_balance.h>
#include <carom/integrators/event_driven/motion_unknowns.h>

#include <array>
#include <span>
#include <vector>

namespace carom {

/// Output of one clock group. The state within a step is projected onto the constraints; the run itself
/// continues unprojected.
class CAROM_API GroupOutput {
public:
  /// \param unknowns must outlive it
  explicit GroupOutput(const MotionUnknowns& unknowns) : unknowns_(&unknowns), y_(unknowns.size()) {}

  /// Begins with a new motion.
  void start(std::span<const double> y);
  /// The state.
  [[nodiscard]] std::span<const double> y() const { return y_; }
  [[nodiscard]] std::span<double> y() { return y_; }
  /// Books the works of the state beyond those booked so far. \param projected energy that its projection
  /// took out; it is given back at the next output [J]
  void book(double projected, EventBalance& balance);

private:
  const MotionUnknowns* unknowns_;
  std::vector<double> y_;
  std::array<double, work_lines> booked_{};  // works
  double projected_ = 0.0;                   // of the last output [J]
};

}  // namespace carom

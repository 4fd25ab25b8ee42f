#pragma once

/// \file
/// When is a fixed-point iteration finished? One judge for all components.

#include <carom/core/export.h>

namespace carom {

/// Follows the changes between sweeps and decides.
class CAROM_API FixedPointJudge {
public:
  enum class Verdict { go_on, converged, failed };

  /// \param tolerance change below which the iteration is finished [m]; 0: go on until it stops shrinking
  /// \param max_sweeps sweeps after which it is given up
  FixedPointJudge(double tolerance, int max_sweeps) : tolerance_(tolerance), max_sweeps_(max_sweeps) {}

  /// Takes the change of a sweep and the size of the numbers that changed (their rounding is the floor).
  [[nodiscard]] Verdict judge(double change, double size);

  /// Takes the change that the next sweep would make, without its being made. That sweep leaves an error of
  /// its change times the contraction, so that to forgo it is as good only when the change is below that part
  /// of the tolerance (below 1e-5 of it while no contraction was seen).
  [[nodiscard]] Verdict judge_ahead(double change, double size);

  /// Sweeps judged.
  [[nodiscard]] int sweeps() const { return sweeps_; }
  /// Ratio of the last two changes that stood clear of rounding; 0 if none was seen.
  [[nodiscard]] double contraction() const { return contraction_; }
  /// Change of the last sweep [m].
  [[nodiscard]] double change() const { return last_; }

private:
  [[nodiscard]] Verdict judge(double change, double size, double part);

  double tolerance_;
  int max_sweeps_;
  int sweeps_ = 0;
  double first_ = 0.0;       // largest of the first few changes
  double first_size_ = 0.0;  // and of their sizes
  double last_ = 0.0;
  double contraction_ = 0.0;
};

}  // namespace carom

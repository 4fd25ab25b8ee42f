#pragma once

/// \file
/// Continuity of what is prescribed, joints and shapes on ground, over an advance.

#include <carom/contact/detection/detector.h>
#include <carom/core/assembly.h>
#include <carom/core/dynamics/prescribed_joints.h>
#include <carom/core/export.h>

namespace carom {

/// Laws of time of one model. Keeps what they said last.
class CAROM_API LawContinuity {
public:
  /// \param assembly,detector must outlive it
  LawContinuity(const Assembly& assembly, const Detector& detector)
      : detector_(&detector), prescribed_(assembly) {}

  /// Demands that nothing prescribed jumps between two times [s], looking at times no farther apart than
  /// `longest` [s]. Throws SolverError naming the part.
  void demand(double from, double to, double longest);
  /// Where the last demand() failed, the end of the part before, up to which all laws are good [s].
  [[nodiscard]] double good_until() const { return good_until_; }

private:
  void demand_part(double from, double to);

  const Detector* detector_;
  PrescribedJoints prescribed_;
  GroundPlaces before_, after_;  // at the ends of an advance
  double good_until_ = 0.0;
};

}  // namespace carom

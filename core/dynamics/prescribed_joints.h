#pragma once

/// \file
/// Joints that prescribe their coordinates: a watch over jumps of what they prescribe.

#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/core/law_jump.h>

#include <span>
#include <string>
#include <vector>

namespace carom {

/// All joints of an assembly that prescribe a coordinate (drivers).
class CAROM_API PrescribedJoints {
public:
  /// \param assembly must outlive it
  explicit PrescribedJoints(const Assembly& assembly);

  /// True if there are none.
  [[nodiscard]] bool empty() const { return laws_.empty(); }
  /// Demands that no prescribed coordinate jumps between two times [s], and that no rate contradicts it.
  /// Throws SolverError naming the joint, the time, and by how much it does (core/law_jump.h).
  void demand_continuous(double from, double to);

private:
  struct Law {
    const JointKind* kind;
    Index slot;
    JointId id;
    LawPoint last;  // at the end of what was looked at last
  };

  const Assembly* assembly_;
  std::vector<Law> laws_;
};

/// "; bodies are driven by driver 'hoist'", for messages; empty where no driver moves bodies of the
/// components.
[[nodiscard]] CAROM_API std::string driven_by(const Assembly& assembly, std::span<const Index> components);

}  // namespace carom

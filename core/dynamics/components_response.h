#pragma once

/// \file
/// Answer of the bodies of several components to impulses: those of a component with joints answer together
/// with what its joints leave of M^-1, all others by their masses alone.

#include <carom/core/assembly.h>
#include <carom/core/dynamics/body_response.h>
#include <carom/core/dynamics/joint_constraints.h>
#include <carom/core/export.h>

#include <span>
#include <vector>

namespace carom {

/// Appends the constraints of the joints of a component. False if they have no rows.
CAROM_API bool append_constraints(const Assembly& assembly, Index component,
                                  std::vector<JointConstraints>& out);
/// Addresses of constraints of joints, as ComponentsResponse takes them.
[[nodiscard]] CAROM_API std::vector<JointConstraints*> addresses_of(std::span<JointConstraints> joints);

/// K of each component with joints, M^-1 of all other bodies.
class CAROM_API ComponentsResponse final : public BodyResponse {
public:
  /// \param assembly must outlive it
  explicit ComponentsResponse(const Assembly& assembly) : masses_(assembly), assembly_(&assembly) {}
  /// Takes the joints of the components that have some, ascending; factored wherever it is asked. The list
  /// and they must outlive it.
  void bind(std::span<JointConstraints* const> joints) { joints_ = joints; }

  /// True if no component has joints.
  [[nodiscard]] bool no_joints() const { return joints_.empty(); }
  /// Joints of the component of a body; null if there are none.
  [[nodiscard]] JointConstraints* joints_of(Index body) const;

  [[nodiscard]] Range reach(Index body) const override;
  [[nodiscard]] BodyMasses alone(Index body) const override;
  void answer(Index body, double* x, std::size_t columns, char* held) override;

private:
  MassResponse masses_;
  const Assembly* assembly_;
  std::span<JointConstraints* const> joints_;
};

}  // namespace carom

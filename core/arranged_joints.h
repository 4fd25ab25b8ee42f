#pragma once

/// \file
/// Joints of a system in the order of assembly, and the bodies that they connect.

#include <carom/core/component.h>
#include <carom/core/joint_kind.h>
#include <carom/core/layout.h>
#include <carom/core/system.h>

#include <memory>
#include <vector>

namespace carom {

/// Kinds of joints, arranged: the joints of a component are a range of their kind.
class ArrangedJoints {
public:
  ArrangedJoints() = default;
  /// Orders joints by component, and tells the layout. \param component_of_body by serial number
  ArrangedJoints(const System& system, Layout& layout, const std::vector<Component>& components,
                 const std::vector<Index>& component_of_body);

  /// Kinds, in the order of the system.
  [[nodiscard]] const std::vector<std::unique_ptr<JointKind>>& kinds() const { return table_->kinds; }
  /// Joints of a kind in a component.
  [[nodiscard]] Range joints(Index component, Index kind) const {
    return slots_[component * table_->kinds.size() + kind];
  }
  /// Serial number of a joint.
  [[nodiscard]] Index serial(Index kind, Index slot) const { return serials_[kind][slot]; }
  /// Mechanism of a body (the bodies connected to it by joints), named by its first body.
  [[nodiscard]] Index mechanism(Index body) const { return mechanisms_.empty() ? body : mechanisms_[body]; }
  /// True if the body has a joint.
  [[nodiscard]] bool is_jointed(Index body) const { return !mechanisms_.empty() && is_jointed_[body] != 0; }

private:
  std::shared_ptr<JointTable> table_ = std::make_shared<JointTable>();
  std::vector<Range> slots_;                 // by component, kind
  std::vector<std::vector<Index>> serials_;  // by kind
  std::vector<Index> mechanisms_;            // by body; empty without joints
  std::vector<char> is_jointed_;             // by body; empty without joints
};

}  // namespace carom

#include <carom/core/joint_kind.h>

#include <algorithm>

namespace carom {

void JointKind::evaluate_all(const JointView& at, Range joints, JointNumbers out) const {
  std::array<JointRow, static_cast<std::size_t>(most_rows)> of_joint;
  for (Index joint = joints.begin; joint < joints.end; ++joint) {
    evaluate(at, joint, of_joint.data());
    for (const JointRow& row : std::span(of_joint).first(rows())) {
      *out.gap++ = row.gap;
      if (out.rate != nullptr) *out.rate++ = row.rate;
      if (out.drift != nullptr) *out.drift++ = row.drift;
      if (out.jacobian == nullptr) continue;
      for (const JointRow::Block& block : std::span(row.blocks).first(static_cast<std::size_t>(row.bodies))) {
        out.jacobian = std::copy_n(block.jacobian.begin(), block.columns, out.jacobian);
      }
    }
  }
}

}  // namespace carom

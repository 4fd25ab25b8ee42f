#include <carom/core/assembly.h>
#include <carom/core/dynamics/joint_constraints.h>
#include <carom/core/dynamics/open_joints.h>
#include <carom/core/largest_coordinate.h>
#include <carom/core/listed.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace carom {

namespace {

// A joint that is open by less is drawn closed [rad, or of a length].
constexpr double roughly_closed = 1e-3;

/// True of a row that binds angles alone.
bool binds_angles(const JointRow& row, Index dimension) {
  for (int b = 0; b < row.bodies; ++b) {
    const JointRow::Block& block = row.blocks[static_cast<std::size_t>(b)];
    const int places = std::min(block.columns, static_cast<int>(dimension));
    const auto first = block.jacobian.begin();
    if (std::any_of(first, first + places, [](double number) { return number != 0.0; })) return false;
  }
  return true;
}

/// Largest coordinate of a place, or radius of gyration [m].
double size_of(const Assembly& assembly, Index component, const State& state,
               const std::vector<double>& lengths) {
  const Layout& layout = *assembly.layout();
  const Range bodies = assembly.components()[component].bodies;
  const auto dimension = static_cast<Index>(layout.dimension());
  double size = largest_coordinate(state, bodies);
  layout.bodies().for_range(bodies, [&](Index, const BodySlot& slot) {
    for (Index i = dimension; i < slot.v_size; ++i) size = std::max(size, lengths[slot.v + i]);
  });
  return size;
}

}  // namespace

void list_open_joints(const Assembly& assembly, Index component, const JointConstraints& joints,
                      const State& state, const std::vector<double>& lengths, std::vector<OpenJoint>& out) {
  const auto dimension = static_cast<Index>(assembly.layout()->dimension());
  const double size = size_of(assembly, component, state, lengths);
  const std::vector<double>& gaps = joints.gaps();
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    const double gap = std::abs(gaps[i]);
    if (!(gap > roughly_closed * std::min(size, 1.0))) continue;  // of neither a length nor an angle
    const bool turns = binds_angles(joints.row(i), dimension);
    if (!(gap > roughly_closed * (turns ? 1.0 : size))) continue;
    const JointId joint = joints.joint(i);
    if (!out.empty() && out.back().joint == joint) {  // rows of a joint follow one another
      if (gap > out.back().gap) out.back() = {joint, gap, turns};
    } else {
      out.push_back({joint, gap, turns});
    }
  }
}

std::optional<ModelFinding> finding_of(const System& system, std::span<const OpenJoint> open) {
  constexpr std::size_t most = 3;  // that the text names
  if (open.empty()) return std::nullopt;
  std::vector<std::string> names, with_gaps;
  for (const OpenJoint& at : open) {
    names.push_back(system.name(at.joint));
    with_gaps.push_back(names.back() + " by " + to_text(at.gap) + (at.turns ? " rad" : " m"));
  }
  const std::string closed = open.size() == 1 ? "it" : "them";
  return ModelFinding{
      FindingKind::open_joint, std::move(names),
      listed(with_gaps, most) + ": open as described, so that bodies are moved to close " + closed};
}

}  // namespace carom

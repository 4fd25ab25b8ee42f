#include <carom/core/assembly.h>
#include <carom/core/dynamics/joint_constraints.h>
#include <carom/core/dynamics/open_joints.h>
#include <carom/core/largest_coordinate.h>
#include <carom/core/listed.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace carom {

namespace {

// A joint that is open by less is drawn closed [rad, or of a length].
constexpr double roughly_closed = 1e-3;

// A joint that is open by more is a mistake of the drawing [of the size of its bodies].
constexpr double far_open = 0.1;

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

using Place = std::array<double, 3>;

/// Points of a joint as described, how `from` would come to close it, and the size of its bodies.
struct JointDrawing {
  JointPlaces places;
  Place shift{};        // of the end on `from` [m]
  double size = 0.0;    // [m]
  double widest = 0.0;  // gap of the row that is furthest open [m]

  /// Takes what a row says that binds points. \param to_moves `to` is a body, whose block is the last one
  void add(const JointRow& row, double gap, bool to_moves, std::size_t dimension,
           const std::vector<double>& lengths) {
    Place along{};  // in which the row pushes `to`
    const JointRow::Block& last = row.blocks[static_cast<std::size_t>(row.bodies - 1)];
    for (std::size_t i = 0; i < dimension; ++i) along[i] = to_moves ? last.jacobian[i] : -last.jacobian[i];
    double apart = 0.0;  // of the ends, in that direction
    for (std::size_t i = 0; i < dimension; ++i) {
      apart += along[i] * (places.to[i] - places.from[i]);
      shift[i] += gap * along[i];
    }
    widest = std::max(widest, std::abs(gap));
    // The length of a rod, the radius of a disc that rolls; 0 where ends are to coincide.
    if (widest == std::abs(gap)) size = std::max(size, std::abs(apart - gap));
    for (int b = 0; b < row.bodies; ++b) {
      const JointRow::Block& block = row.blocks[static_cast<std::size_t>(b)];
      for (auto c = dimension; c < static_cast<std::size_t>(block.columns); ++c) {
        size = std::max({size, std::abs(block.jacobian[c]), lengths[block.v + static_cast<Index>(c)]});
      }
    }
  }
};

/// "(5, 3)".
std::string text_of(const Place& place, std::size_t dimension) {
  std::string text;
  for (std::size_t i = 0; i < dimension; ++i) text += (i == 0 ? "(" : ", ") + to_text(place[i]);
  return text + ")";
}

/// A place in the fixed frame, in that of a body.
Place in_frame(const Layout& layout, BodyId body, const JointView& at, const Place& place) {
  if (body == ground) return place;
  const BodySlot slot = layout.slot(body);
  Place local{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(layout.dimension()); ++i) {
    local[i] = place[i] - at.state.q[slot.q + static_cast<Index>(i)];
  }
  if (slot.rotation == none) return local;
  const double* const rotation = at.rotation + slot.rotation;
  return {rotation[0] * local[0] + rotation[1] * local[1], rotation[0] * local[1] - rotation[1] * local[0],
          0.0};
}

/// The words of the error on a joint that is far open; empty for any other.
std::string far_text(const Assembly& assembly, JointId joint, std::size_t first_row,
                     const JointConstraints& joints, const JointView& at,
                     const std::vector<double>& lengths) {
  const JointTable& table = *assembly.layout()->joints();
  const JointTable::Place slot = table.place(joint.serial);
  const JointKind& kind = *table.kinds[slot.kind];
  const std::optional<JointPlaces> places = kind.places(at, slot.slot);
  if (!places) return {};
  std::vector<BodyId> ends;
  kind.ends(slot.slot, ends);
  const Layout& layout = *assembly.layout();
  const auto dimension = static_cast<std::size_t>(layout.dimension());
  JointDrawing drawing{.places = *places};
  for (std::size_t row = first_row; row < first_row + kind.rows(); ++row) {
    const JointRow of = joints.row(row);
    if (binds_angles(of, static_cast<Index>(dimension))) continue;
    drawing.add(of, joints.gaps()[row], ends.back() != ground, dimension, lengths);
  }
  const double off = std::hypot(drawing.shift[0], drawing.shift[1], drawing.shift[2]);
  if (!(off > far_open * drawing.size)) return {};
  // An end on ground is the one to be moved, as it is by default.
  const bool moves_to = ends.back() == ground;
  Place place = moves_to ? places->to : places->from;
  for (std::size_t i = 0; i < dimension; ++i) place[i] += moves_to ? -drawing.shift[i] : drawing.shift[i];
  const BodyId body = moves_to ? ends.back() : ends.front();
  const System& system = assembly.system();
  return system.name(joint) + ": its bodies are drawn " + to_text(off) +
         " m from where it closes, which is more than a tenth of their size, " + to_text(drawing.size) +
         " m; allowed: '" + (moves_to ? "to" : "from") + "' at the point " +
         text_of(in_frame(layout, body, at, place), dimension) + " of " + system.name(body) +
         ", bodies drawn where the joint closes, or System::close_joints(), which lets them be moved there";
}

}  // namespace

void list_open_joints(const Assembly& assembly, Index component, const JointConstraints& joints,
                      const State& state, const JointView& at, const std::vector<double>& lengths,
                      std::vector<OpenJoint>& out) {
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
      if (gap > out.back().gap) out.back() = {joint, gap, turns, std::move(out.back().far)};
    } else {
      out.push_back({joint, gap, turns, {}});
    }
    if (!turns && out.back().far.empty()) {
      const std::size_t first = joints.pattern().first_row(joints.pattern().joint_of(i));
      out.back().far = far_text(assembly, joint, first, joints, at, lengths);
    }
  }
}

void demand_roughly_closed(const System& system, std::span<const OpenJoint> open) {
  if (system.closes_joints()) return;
  for (const OpenJoint& joint : open) {
    if (!joint.far.empty()) throw ModelError(joint.far);
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

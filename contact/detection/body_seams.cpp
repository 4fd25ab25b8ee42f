// Problem: which bodies are one for whoever slides over them.

#include <carom/contact/detection/body_seams.h>
#include <carom/contact/detection/flush_faces.h>
#include <carom/contact/detection/outline_pair.h>
#include <carom/contact/detection/pair_filter.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <utility>

namespace carom {

namespace {

using Pairs = std::set<std::pair<Index, Index>>;

/// Where bodies are at the start.
struct Start {
  State state;
  Evaluation evaluation;

  explicit Start(const Assembly& assembly)
      : state(assembly.initial_state()), evaluation(make_evaluation(assembly)) {
    evaluate_positions(assembly, state.view(), evaluation);
  }
};

/// True if a joint of three rows is closed at the start, so that its bodies stay as they stand there.
bool is_closed(const JointKind& kind, Index joint, const Start& start) {
  const double rounding = FeatureLengths().corner;  // [m, rad]
  std::array<JointRow, JointKind::most_rows> rows;
  kind.evaluate({start.state.view(), start.evaluation.rotation.data()}, joint, rows.data());
  return std::all_of(rows.begin(), rows.begin() + kind.rows(),
                     [&](const JointRow& row) { return std::abs(row.gap) <= rounding; });
}

/// Pairs of bodies that one joint binds in all three directions at all times, and that do not touch each
/// other. \param start is made if there are such joints
Pairs bound_pairs(const Assembly& assembly, std::optional<Start>& start) {
  constexpr Index all_directions = 3;
  const Layout& layout = *assembly.layout();
  Pairs pairs;
  std::optional<PairFilter> filter;
  std::vector<BodyId> ends;
  for (const auto& kind : assembly.joint_kinds()) {
    if (kind->rows() != all_directions || kind->depends_on_time()) continue;
    for (Index joint = 0; joint < kind->size(); ++joint) {
      ends.clear();
      kind->ends(joint, ends);
      if (ends.size() != 2 || ends[0] == ground || ends[1] == ground || ends[0] == ends[1]) continue;
      const std::pair<Index, Index> pair = std::minmax({layout.index(ends[0]), layout.index(ends[1])});
      if (!filter) filter.emplace(assembly);
      if (!start) start.emplace(assembly);
      if (filter->is_excluded(pair.first, pair.second) && is_closed(*kind, joint, *start)) pairs.insert(pair);
    }
  }
  return pairs;
}

/// By body, the first of those that are bound to it, directly or by others.
std::vector<Index> groups_of(const Pairs& pairs, std::size_t bodies) {
  std::vector<Index> first(bodies);
  std::iota(first.begin(), first.end(), Index{0});
  const auto root = [&](Index body) {
    while (first[body] != body) body = first[body] = first[first[body]];
    return body;
  };
  for (const auto& [a, b] : pairs) {
    const std::pair<Index, Index> roots = std::minmax({root(a), root(b)});
    first[roots.second] = roots.first;
  }
  for (Index body = 0; body < bodies; ++body) first[body] = root(body);
  return first;
}

bool may_have_seams(const DescribedOutline& of) { return of.outline.radius == 0.0 && of.vertices.size() > 2; }

}  // namespace

void draw_seams(const Assembly& assembly, std::vector<DescribedOutline>& outlines) {
  std::optional<Start> start;
  const Pairs bound = bound_pairs(assembly, start);
  const std::vector<Index> group = groups_of(bound, assembly.layout()->bodies().size());
  std::vector<Index> order;
  for (Index i = 0; i < outlines.size(); ++i) {
    if (may_have_seams(outlines[i])) order.push_back(i);
  }
  const auto group_of = [&](Index i) { return group[outlines[i].outline.body]; };
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return group_of(a) < group_of(b); });
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    for (end = begin + 1; end < order.size() && group_of(order[end]) == group_of(order[begin]);) ++end;
    if (end - begin < 2) continue;
    const std::span<const Index> own = std::span(order).subspan(begin, end - begin);
    const auto body_of = [&](Index i) { return outlines[own[i]].outline.body; };
    const bool is_one_body = std::all_of(own.begin(), own.end(), [&](Index i) {
      return outlines[i].outline.body == outlines[own[0]].outline.body;
    });
    std::vector<RestingShape> shapes;
    std::vector<PlaneFrame> frames;
    for (Index i = 0; i < own.size(); ++i) {
      const BodySlot slot = assembly.layout()->bodies()[body_of(i)];
      frames.push_back(is_one_body ? PlaneFrame() : PlaneFrame(slot, start->state.view(), start->evaluation));
      GroundPiece piece{.form = GroundPiece::Form::solid, .points = outlines[own[i]].vertices};
      for (Vec<2>& point : piece.points) point = frames[i].outside(point);
      shapes.push_back({.filter = outlines[own[i]].outline.filter, .pieces = {std::move(piece)}});
    }
    draw_covered_corners(shapes, [&](Index a, Index b) {
      return body_of(a) == body_of(b) || bound.contains(std::minmax(body_of(a), body_of(b)));
    });
    for (Index i = 0; i < own.size(); ++i) {
      std::vector<Vec<2>>& points = shapes[i].pieces.front().points;
      if (points.size() == outlines[own[i]].vertices.size()) continue;
      for (Vec<2>& point : points) point = frames[i].inside(point);
      outlines[own[i]].vertices = std::move(points);
    }
  }
}

}  // namespace carom

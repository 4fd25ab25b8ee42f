// Problem: what of two bodies may touch each other?

#include <carom/contact/detection/body_pairs.h>

namespace carom {

BodyPairs::BodyPairs(const Outlines& outlines) : outlines_(&outlines), of_(outlines.slots().size()) {
  const std::vector<BodyOutline>& list = outlines.of_bodies().list();
  for (Index i = 0; i < list.size(); ++i) {
    Range& range = of_[list[i].body];
    if (range.empty()) range.begin = i;
    range.end = i + 1;
  }
}

void BodyPairs::append(std::span<const Index> bodies, std::vector<ContactPair>& out) const {
  for (const Index body : bodies) {
    for (Index i = of_[body].begin; i < of_[body].end; ++i) {
      for (const Index other : bodies) {
        for (Index j = of_[other].begin; j < of_[other].end; ++j) append(i, j, out);
      }
    }
  }
}

/// Appends the pairs of the vertices of an outline and another one.
void BodyPairs::append(Index of_a, Index of_b, std::vector<ContactPair>& out) const {
  const std::vector<BodyOutline>& list = outlines_->of_bodies().list();
  const BodyOutline &a = list[of_a], &b = list[of_b];
  if (!outlines_->laws().may_touch(a, b)) return;
  // Of two round ends one is enough; a point touches both edges at a sharp corner.
  if (a.vertices.size() == 1 && b.vertices.size() == 1 && b.key < a.key) return;
  const bool point_at_corners = b.is_point() && a.radius == 0.0;
  if (b.vertices.size() == 1 && a.vertices.size() > 1 && !point_at_corners) return;
  const Index law = outlines_->number_of_law(of_a, of_b);
  for (Index vertex = a.vertices.begin; vertex < a.vertices.end; ++vertex) {
    out.push_back({.body = a.body, .feature = vertex, .law = law, .other = b.body, .outline = of_b});
  }
}

}  // namespace carom

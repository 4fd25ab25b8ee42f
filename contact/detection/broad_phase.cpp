#include <carom/contact/detection/broad_phase.h>
#include <carom/core/errors.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace carom {

namespace {

// How much larger a box is kept, at each side, than it is itself.
constexpr double allowance = 0.1;

constexpr double infinity = std::numeric_limits<double>::infinity();

// Bounds of a coordinate with half of the margin on its side. Two that lie within the margin, by rounded
// differences, have bounds that meet: each is out by more than the rounding of its part.
double reach(double coordinate, double half) {
  return half * (1.0 + 0x1p-49) + 0x1p-51 * std::abs(coordinate);
}
double lower(double coordinate, double half) { return coordinate - reach(coordinate, half); }
double upper(double coordinate, double half) { return coordinate + reach(coordinate, half); }

template <int D>
bool holds(const Box<D>& wide, const Box<D>& box, double half) {
  bool inside = true;
  for (int k = 0; k < D; ++k) {
    inside = inside & (wide.min[k] <= lower(box.min[k], half)) & (upper(box.max[k], half) <= wide.max[k]) &
             (box.min[k] <= box.max[k]);
  }
  return inside;
}

template <int D>
bool is_allowed(const Box<D>& box) {
  for (int k = 0; k < D; ++k) {
    const double far = BroadPhase<D>::farthest;
    if (!(-far <= box.min[k] && box.min[k] <= box.max[k] && box.max[k] <= far)) return false;
  }
  return true;
}

template <int D>
std::string text_of(const Box<D>& box) {
  std::string text;
  for (int k = 0; k < D; ++k) {
    text += (k == 0 ? "[" : " x [") + std::to_string(box.min[k]) + ", " + std::to_string(box.max[k]) + "]";
  }
  return text;
}

template <int D>
Box<D> widened(const Box<D>& box, double half) {
  double size = 2.0 * half;
  for (int k = 0; k < D; ++k) size = std::max(size, box.max[k] - box.min[k]);
  Box<D> wide;
  for (int k = 0; k < D; ++k) {
    wide.min[k] = lower(box.min[k], half) - allowance * size;
    wide.max[k] = upper(box.max[k], half) + allowance * size;
  }
  return wide;
}

}  // namespace

template <int D>
void BroadPhase<D>::reset(std::span<const Index> owners) {
  wide_.clear();
  // No box is inside these.
  const Box<D> empty{Vec<D>::Constant(infinity), Vec<D>::Constant(-infinity)};
  for (Index i = 0; i < owners.size(); ++i) wide_.push_back({empty, i, owners[i]});
  candidates_.start(size());
  candidates_.arrange();
}

template <int D>
void BroadPhase<D>::reset(Index boxes) {
  reset(std::vector<Index>(boxes, none));
}

template <int D>
void BroadPhase<D>::check(std::span<const Box<D>> boxes, double margin) const {
  if (boxes.size() != wide_.size()) {
    throw ModelError("broad phase: " + std::to_string(boxes.size()) + " boxes; reset() was told of " +
                     std::to_string(wide_.size()));
  }
  if (!(margin >= 0.0 && margin <= farthest)) {
    throw ModelError("broad phase: margin is " + std::to_string(margin) + ", must be finite and >= 0");
  }
}

template <int D>
void BroadPhase<D>::find_left(std::span<const Box<D>> boxes, double half) {
  left_.clear();
  for (Index i = 0; i < boxes.size(); ++i) {
    if (holds(wide_[i].box, boxes[i], half)) continue;
    if (!is_allowed(boxes[i])) {
      throw ModelError("broad phase: box " + std::to_string(i) + " is " + text_of(boxes[i]) +
                       ", must be finite with min <= max");
    }
    left_.push_back(i);
  }
}

template <int D>
void BroadPhase<D>::rebuild(std::span<const Box<D>> boxes, double half) {
  for (Index i = 0; i < boxes.size(); ++i) wide_[i].box = widened(boxes[i], half);
  grid_.build(wide_);
  candidates_.start(size());
  grid_.find_pairs(candidates_);
  candidates_.arrange();
}

template <int D>
std::span<const BoxPair> BroadPhase<D>::select(std::span<const Box<D>> boxes, double margin) {
  if (pairs_.size() < candidates_.size()) pairs_.resize(candidates_.size() + candidates_.size() / 2);
  std::size_t count = 0;
  for (Index i = 0; i < boxes.size(); ++i) {
    const Box<D>& box = boxes[i];
    for (const Index partner : candidates_.partners(i)) {
      pairs_[count] = {i, partner};
      count += are_within(box, boxes[partner], margin) ? 1U : 0U;
    }
  }
  return {pairs_.data(), count};
}

template <int D>
std::span<const BoxPair> BroadPhase<D>::update(std::span<const Box<D>> boxes, double margin) {
  check(boxes, margin);
  const double half = 0.5 * margin;
  find_left(boxes, half);
  if (!left_.empty()) rebuild(boxes, half);
  return select(boxes, margin);
}

template <int D>
void BroadPhase<D>::query(std::span<const Box<D>> boxes, const Box<D>& box, double margin,
                          std::vector<Index>& out) const {
  check(boxes, margin);
  out.clear();
  Box<D> around;
  for (int k = 0; k < D; ++k) {
    around.min[k] = lower(box.min[k], 0.5 * margin), around.max[k] = upper(box.max[k], 0.5 * margin);
  }
  grid_.for_overlapping(around, [&](const OwnedBox<D>& entry) {
    if (are_within(box, boxes[entry.number], margin)) out.push_back(entry.number);
  });
  std::sort(out.begin(), out.end());
}

template class BroadPhase<2>;
template class BroadPhase<3>;

}  // namespace carom

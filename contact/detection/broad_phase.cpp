#include <carom/contact/detection/broad_phase.h>
#include <carom/core/errors.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace carom {

namespace {

// A box is kept larger than it is, at each side, by this part of its size,
constexpr double allowance = 0.1;
// where that holds it for so many calls; else not at all.
constexpr double fewest_calls = 3.0;
// Boxes that left theirs are looked up one by one up to this part of all.
constexpr Index part_late = 8;

// Bounds of a coordinate with half of the margin on its side. Two that lie within the margin, by rounded
// differences, have bounds that meet: each is out by more than the rounding of its part.
double reach(double coordinate, double half) {
  return half * (1.0 + 0x1p-49) + 0x1p-51 * std::abs(coordinate);
}
double lower(double coordinate, double half) { return coordinate - reach(coordinate, half); }
double upper(double coordinate, double half) { return coordinate + reach(coordinate, half); }

template <int D>
bool holds(const Box<D>& wide, const Box<D>& box, double half) {
  unsigned inside = 1;
  for (int k = 0; k < D; ++k) {
    inside &= as_bit(wide.min[k] <= lower(box.min[k], half)) &
              as_bit(upper(box.max[k], half) <= wide.max[k]) & as_bit(box.min[k] <= box.max[k]);
  }
  return inside != 0;
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
void check_box(std::span<const Box<D>> boxes, Index i) {
  if (is_allowed(boxes[i])) return;
  throw ModelError("broad phase: box " + std::to_string(i) + " is " + text_of(boxes[i]) +
                   ", must be finite with min <= max");
}

// Length at each side that a box is kept larger by. \param before the larger box that it left
// \param calls since it was put into that
template <int D>
double allowance_of(const Box<D>& box, const Box<D>& before, double half, double calls) {
  double size = 2.0 * half, way = 0.0;
  for (int k = 0; k < D; ++k) {
    size = std::max(size, box.max[k] - box.min[k]);
    way = std::max(way, 0.5 * std::abs(box.min[k] + box.max[k] - (before.min[k] + before.max[k])));
  }
  return way * fewest_calls > allowance * size * calls ? 0.0 : allowance * size;
}

template <int D>
Box<D> widened(const Box<D>& box, double half, double by) {
  Box<D> wide;
  for (int k = 0; k < D; ++k) {
    wide.min[k] = lower(box.min[k], half) - by;
    wide.max[k] = upper(box.max[k], half) + by;
  }
  return wide;
}

}  // namespace

template <int D>
void BroadPhase<D>::reset(std::span<const Index> owners) {
  wide_.clear(), since_.assign(owners.size(), 0), call_ = 0;
  // No box is inside these.
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const Box<D> empty{Vec<D>::Constant(infinity), Vec<D>::Constant(-infinity)};
  for (Index i = 0; i < owners.size(); ++i) wide_.push_back({empty, i, owners[i]});
  late_.clear(), state_.assign(owners.size(), Place::left);
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

/// True if so many have left that all are looked up. \param left boxes outside of theirs in this call
template <int D>
bool BroadPhase<D>::are_many(std::size_t left) const {
  return late_.size() + left > size() / part_late;
}

template <int D>
void BroadPhase<D>::find_left(std::span<const Box<D>> boxes, double half) {
  left_.clear();
  Index i = 0;
  for (; i < boxes.size() && !are_many(left_.size()); ++i) {
    if (holds(wide_[i].box, boxes[i], half)) continue;
    check_box(boxes, i);
    left_.push_back(i);
  }
  for (; i < boxes.size(); ++i) check_box(boxes, i);
}

template <int D>
void BroadPhase<D>::widen(Index i, const Box<D>& box, double half) {
  const double by = allowance_of(box, wide_[i].box, half, static_cast<double>(call_ - since_[i]));
  wide_[i].box = widened(box, half, by), since_[i] = call_;
}

template <int D>
void BroadPhase<D>::rebuild(std::span<const Box<D>> boxes, double half) {
  for (Index i = 0; i < boxes.size(); ++i) widen(i, boxes[i], half);
  std::fill(state_.begin(), state_.end(), Place::grid);
  late_.clear(), late_grid_.build(late_);
  grid_.build(wide_);
  candidates_.start(size());
  grid_.find_pairs(candidates_);
  candidates_.arrange();
}

template <int D>
void BroadPhase<D>::replace_left(std::span<const Box<D>> boxes, double half) {
  for (const Index i : left_) widen(i, boxes[i], half);
  for (OwnedBox<D>& entry : late_) entry.box = wide_[entry.number].box;
  for (const Index i : left_) {
    if (state_[i] == Place::grid) late_.push_back(wide_[i]);
    state_[i] = Place::left;
  }
  late_grid_.build(late_);
  found_.start(size());
  for (const Index i : left_) {
    const auto pair = [&](const OwnedBox<D>& other) {
      if (other.owner != wide_[i].owner || other.owner == none) found_.add(i, other.number);
    };
    grid_.for_overlapping(wide_[i].box, [&](const OwnedBox<D>& other) {
      if (state_[other.number] == Place::grid) pair(other);
    });
    late_grid_.for_overlapping(wide_[i].box, [&](const OwnedBox<D>& other) {
      // Two that left find each other twice.
      if (state_[other.number] == Place::late || i < other.number) pair(other);
    });
  }
  found_.arrange();
  candidates_.replace(found_, [&](Index i) { return state_[i] == Place::left; });
  for (const Index i : left_) state_[i] = Place::late;
}

template <int D>
std::span<const BoxPair> BroadPhase<D>::select(std::span<const Box<D>> boxes, double margin) {
  const std::span<const BoxPair> candidates = candidates_.list();
  if (pairs_.size() < candidates.size()) pairs_.resize(candidates.size() + candidates.size() / 2);
  std::size_t count = 0;
  for (const BoxPair& pair : candidates) {
    pairs_[count] = pair;
    count += are_within(boxes[pair.first], boxes[pair.second], margin) ? 1U : 0U;
  }
  return {pairs_.data(), count};
}

template <int D>
std::span<const BoxPair> BroadPhase<D>::update(std::span<const Box<D>> boxes, double margin) {
  check(boxes, margin);
  const double half = 0.5 * margin;
  find_left(boxes, half);
  ++call_;
  if (are_many(left_.size())) {
    rebuild(boxes, half);
  } else if (!left_.empty()) {
    replace_left(boxes, half);
  }
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
  const auto test = [&](const OwnedBox<D>& entry) {
    if (are_within(box, boxes[entry.number], margin)) out.push_back(entry.number);
  };
  late_grid_.for_overlapping(around, test);
  grid_.for_overlapping(around, [&](const OwnedBox<D>& entry) {
    if (state_[entry.number] == Place::grid) test(entry);
  });
  std::sort(out.begin(), out.end());
}

template class BroadPhase<2>;
template class BroadPhase<3>;

}  // namespace carom

#include <carom/core/numerics/union_find.h>

#include <utility>

namespace carom {

void UnionFind::start(Index size) {
  for (const Index number : touched_) parent_[number] = number;
  touched_.clear();
  while (parent_.size() < size) parent_.push_back(static_cast<Index>(parent_.size()));
}

Index UnionFind::find(Index number) {
  while (parent_[number] != number) {
    parent_[number] = parent_[parent_[number]];
    number = parent_[number];
  }
  return number;
}

void UnionFind::join(Index a, Index b) {
  a = find(a);
  b = find(b);
  if (a == b) return;
  if (a > b) std::swap(a, b);
  parent_[b] = a;
  touched_.push_back(b);
}

}  // namespace carom

// Problem: rows of constraints stand behind one another, and stay where they are while lists grow.

#include <carom/core/constraint_set.h>

#include <algorithm>

namespace carom {

namespace {

constexpr std::size_t first_block = 48;  // numbers: four contacts of two bodies in the plane

}  // namespace

double* RowStore::take(std::size_t count) {
  if (size_ - used_ < count) {
    size_ = std::max({first_block, 2 * size_, count});
    used_ = 0;
    blocks_.push_back(std::make_unique_for_overwrite<double[]>(size_));
  }
  double* const first = blocks_.back().get() + used_;
  used_ += count;
  return first;
}

void Constraint::grow(std::size_t needed) {
  if (room_.store != nullptr) {
    room_.first = room_.store->take(needed);
  } else {  // what is of no set is single
    std::unique_ptr<double[]>& more = static_cast<SingleConstraint&>(*this).more_;
    more = std::make_unique_for_overwrite<double[]>(needed);
    room_.first = more.get();
  }
  room_.size = needed;
}

void ConstraintSet::grow() {
  if (rows_ == nullptr) rows_ = std::make_unique<RowStore>();
  list_.emplace_back(*rows_);
}

void ConstraintSet::resize(std::size_t count) {
  list_.reserve(count);
  while (list_.size() < count) grow();
  count_ = count;
}

void ConstraintSet::assign(std::span<const Constraint> others) {
  resize(others.size());
  for (std::size_t i = 0; i < others.size(); ++i) list_[i].take(others[i]);
}

}  // namespace carom

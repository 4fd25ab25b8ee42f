#pragma once

/// \file
/// Lists of constraints of one instant, with the numbers of their rows packed behind one another.

#include <carom/core/constraint.h>
#include <carom/core/export.h>

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace carom {

/// Room for numbers, in blocks that stay where they are.
class CAROM_API RowStore {
public:
  /// Room for some numbers, which is there as long as the store.
  [[nodiscard]] double* take(std::size_t count);

private:
  std::vector<std::unique_ptr<double[]>> blocks_;
  std::size_t size_ = 0, used_ = 0;  // of the last block
};

/// Constraints of one instant: made anew for the next one, in the memory that they have had. The rows of each
/// have as many columns as its bodies have velocities, and stand behind those of the one before it. A copy of
/// a set has rows of its own.
class CAROM_API ConstraintSet {
public:
  ConstraintSet() = default;
  ConstraintSet(const ConstraintSet& other) { assign(other); }
  ConstraintSet& operator=(const ConstraintSet& other) {
    if (this != &other) assign(other);
    return *this;
  }
  ConstraintSet(ConstraintSet&& other) noexcept
      : rows_(std::move(other.rows_)),
        list_(std::move(other.list_)),
        count_(std::exchange(other.count_, 0)) {}
  ConstraintSet& operator=(ConstraintSet&& other) noexcept {
    rows_.swap(other.rows_);
    list_.swap(other.list_);
    std::swap(count_, other.count_);
    return *this;
  }

  /// Number of constraints.
  [[nodiscard]] std::size_t size() const { return count_; }
  /// True if there are none.
  [[nodiscard]] bool empty() const { return count_ == 0; }
  /// First of all constraints, which may be read as a span. Valid until one is appended.
  [[nodiscard]] const Constraint* begin() const { return list_.data(); }
  [[nodiscard]] Constraint* begin() { return list_.data(); }
  [[nodiscard]] const Constraint* end() const { return list_.data() + count_; }
  [[nodiscard]] Constraint* end() { return list_.data() + count_; }
  /// A constraint by its place.
  [[nodiscard]] const Constraint& operator[](std::size_t place) const { return list_[place]; }
  [[nodiscard]] Constraint& operator[](std::size_t place) { return list_[place]; }

  /// Forgets all constraints, and keeps their memory and what is in it.
  void clear() { count_ = 0; }
  /// Appends one that a contact is to be written in, ready as ConstraintHead::start_contact() leaves it: less
  /// is cleared than by add().
  Constraint& add_contact() {
    Constraint& made = next();
    made.start_contact();
    return made;
  }
  /// Appends one as made by default.
  Constraint& add() {
    Constraint& made = next();
    made.clear();
    return made;
  }
  /// Appends a copy of a constraint of another set.
  Constraint& add(const Constraint& other) {
    Constraint& made = next();
    made.take(other);
    return made;
  }
  /// Shortens the list, or appends constraints as a set before has left them in their places, else as made by
  /// default.
  void resize(std::size_t count);
  /// Takes copies of constraints of another set in place of its own.
  void assign(std::span<const Constraint> others);
  /// Takes out the constraints that a predicate is true of. It is asked once of each, in their order, and may
  /// change those that stay.
  template <class Predicate>
  void remove_if(Predicate&& is_unwanted) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      if (is_unwanted(list_[i])) continue;
      if (kept < i) list_[kept] = std::move(list_[i]);
      ++kept;
    }
    count_ = kept;
  }

private:
  Constraint& next() {
    if (count_ == list_.size()) grow();
    return list_[count_++];
  }
  void grow();

  std::unique_ptr<RowStore> rows_;  // null until there is a constraint
  std::vector<Constraint> list_;    // behind the first count_ those that longer lists had
  std::size_t count_ = 0;
};

/// A constraint by itself. One of bodies in the plane asks for no memory.
class SingleConstraint : public Constraint {
public:
  SingleConstraint() { stand_alone(numbers_.data(), numbers_.size()); }
  explicit SingleConstraint(const Constraint& other) : SingleConstraint() { take(other); }
  SingleConstraint(const SingleConstraint& other) : SingleConstraint(static_cast<const Constraint&>(other)) {}
  SingleConstraint& operator=(const SingleConstraint& other) {
    return *this = static_cast<const Constraint&>(other);
  }
  SingleConstraint& operator=(const Constraint& other) {
    if (this != &other) take(other);
    return *this;
  }

  /// The list of this constraint.
  [[nodiscard]] std::span<const Constraint> alone() const {
    return {static_cast<const Constraint*>(this), 1};
  }

private:
  friend class Constraint;
  static constexpr std::size_t of_two_in_plane = 12;  // numbers: two rows of six

  std::array<double, of_two_in_plane> numbers_;
  std::unique_ptr<double[]> more_;  // for more of them
};

}  // namespace carom

#pragma once

// Constraints made by hand, and their rows as tests compare them.

#include <carom/core/constraint_set.h>

#include <initializer_list>
#include <vector>

namespace carom_test {

/// A set of constraints that were made one by one.
inline carom::ConstraintSet set_of(std::initializer_list<carom::SingleConstraint> list) {
  carom::ConstraintSet set;
  for (const carom::SingleConstraint& constraint : list) set.add(constraint);
  return set;
}

/// The numbers of all rows of a constraint.
inline std::vector<double> numbers_of(const carom::Constraint& constraint) {
  return {constraint.row(0), constraint.row(constraint.rows)};
}

}  // namespace carom_test

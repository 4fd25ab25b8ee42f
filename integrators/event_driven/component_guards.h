#pragma once

/// \file
/// Guards of the elements of a component: numbers whose changes of sign are switching points of loads.

#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/core/guard_motion.h>

#include <cstddef>
#include <vector>

namespace carom {

/// All guards of one component, element by element.
class CAROM_API ComponentGuards {
public:
  /// None.
  ComponentGuards() = default;
  /// The assembly must outlive it.
  ComponentGuards(const Assembly& assembly, Index component);

  /// How many there are.
  [[nodiscard]] std::size_t count() const { return elements_.size(); }
  /// The element of a guard.
  [[nodiscard]] ElementId element(std::size_t guard) const { return elements_[guard]; }
  /// True if derivatives of a guard are known; else they are written as 0.
  [[nodiscard]] bool has_motion(std::size_t guard) const { return has_motion_[guard] != 0; }
  /// True if they are known of all guards.
  [[nodiscard]] bool all_have_motion() const { return all_have_motion_; }
  /// Writes all. \param acceleration of all velocity coordinates, reactions included
  void read(const EvaluationContext& at, const double* acceleration, std::vector<GuardMotion>& out);

private:
  struct Run {
    Index kind;
    Range elements;
    std::size_t first, count;
  };
  std::vector<Run> runs_;
  std::vector<ElementId> elements_;
  std::vector<char> has_motion_;
  std::vector<double> values_;  // of one kind
  bool all_have_motion_ = true;
};

}  // namespace carom

#pragma once

/// \file
/// Guards of the elements of a clock group: numbers whose changes of sign are switching points of loads.

#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/core/guard_motion.h>

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace carom {

/// All guards of the components of one group, element by element.
class CAROM_API GroupGuards {
public:
  /// None.
  GroupGuards() = default;
  /// The assembly must outlive it. \param components ascending
  GroupGuards(const Assembly& assembly, std::span<const Index> components);

  /// How many there are.
  [[nodiscard]] std::size_t count() const { return list_ ? list_->elements.size() : 0; }
  /// The element of a guard.
  [[nodiscard]] ElementId element(std::size_t guard) const { return list_->elements[guard]; }
  /// True if derivatives of a guard are known; else they are written as 0.
  [[nodiscard]] bool has_motion(std::size_t guard) const { return list_->has_motion[guard] != 0; }
  /// True if they are known of all guards.
  [[nodiscard]] bool all_have_motion() const { return !list_ || list_->all_have_motion; }
  /// Writes all guards, those of each component in a context of that component: an element sees its own
  /// bodies only. \param evaluation of the state, with the positions of all components up to date
  /// \param acceleration of all velocity coordinates, reactions included
  void read(const StateView& state, const Evaluation& evaluation, const double* acceleration,
            std::vector<GuardMotion>& out);

private:
  void add(const Assembly& assembly, Index component);

  struct Run {
    Index component, kind;
    Range elements;
    std::size_t first, count;
  };
  struct List {
    const Assembly* assembly = nullptr;
    std::vector<Run> runs;
    std::vector<ElementId> elements;
    std::vector<char> has_motion;
    std::vector<double> values;  // of one kind
    bool all_have_motion = true;
  };
  std::unique_ptr<List> list_;  // null if there are none, as of most of many groups
};

}  // namespace carom

#pragma once

/// \file
/// Of forces of closed contacts that are not unique, those of least norm that the law of contact allows: they
/// depend continuously on the state, also where modes change.

#include <carom/contact/active_contact.h>
#include <carom/core/export.h>
#include <carom/core/numerics/full_pivoting.h>
#include <carom/core/numerics/least_distance.h>

#include <span>
#include <vector>

namespace carom {

/// Finds forces of least norm of closed contacts. Keeps its memory.
class CAROM_API LeastForces {
public:
  /// Forces of least norm: those of the basic solution without their part along the null vectors, and those
  /// of least norm that the law of contact allows where these are not allowed. Which rows elimination takes
  /// for dependent is a matter of rounding; this solution does not depend on it. It does not jump where
  /// contacts change their mode either: there the law leaves the same forces in both modes.
  /// \param contacts all \param group those of the group \param rows of its equations \param factors of their
  /// matrix \param forces in: a solution of the equations
  void find(std::span<const ActiveContact> contacts, std::span<const ActiveContact> group,
            std::span<const ContactPivot::Row> rows, const FullPivoting& factors,
            std::vector<double>& forces);

private:
  void collect_lines(std::span<const ActiveContact> group, const std::vector<double>& forces);
  void take_allowed(std::span<const ActiveContact> group, std::vector<double>& forces);

  std::vector<double> orthonormal_;        // null vectors
  std::vector<double> lines_at_, slopes_;  // margins without them and their slopes, line by line
  std::vector<double> work_;
  LeastDistance least_distance_;
};

}  // namespace carom

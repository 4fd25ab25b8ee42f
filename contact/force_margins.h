#pragma once

/// \file
/// How far the forces of closed contacts are from where their modes end. Forces that are not unique (a brick
/// that sticks at two corners) are distributed so that the least margin is as large as can be.

#include <carom/contact/active_contact.h>
#include <carom/core/export.h>
#include <carom/core/numerics/full_pivoting.h>
#include <carom/core/numerics/largest_margin.h>

#include <span>
#include <vector>

namespace carom {

/// Margin of the contacts of one body, or of bodies that joints bind.
struct ForceMargin {
  std::size_t first = 0, last = 0;  ///< contacts
  double margin = 0.0;  ///< the least normal force or distance from the edge of a cone [N]; a moment
                        ///< against rolling counts by its lever
};

/// Changes of forces that move nothing, by group, and the margins that they leave room for. Keeps its memory.
class CAROM_API ForceMargins {
public:
  /// Forgets all groups.
  void clear();
  /// Adds a group. Its null vectors are found when they are asked for: most forces that a flow needs are not
  /// asked for margins. \param first,last its contacts \param rows of the equations \param factors of their
  /// matrix, with rank() < size()
  void add(std::size_t first, std::size_t last, std::span<const ContactPivot::Row> rows,
           const FullPivoting& factors);
  /// Distributes forces that are not unique so that margins are largest. Lines of contacts that are at the
  /// least margin by chance do not set it (ActiveContact::sets_margin).
  /// \param mark whether to find out which contacts set the margin
  void distribute(std::span<ActiveContact> contacts, bool mark);
  /// True if there are null vectors.
  [[nodiscard]] bool has_vectors() const { return count_ > 0; }
  /// Calls f(first, numbers) for every null vector, numbers: a normal force and the tangential ones
  /// (numbers_of_force) for each contact of a group in turn, beginning with the contact `first`.
  /// \param contacts all, as they were added
  template <class F>
  void for_vectors(std::span<const ActiveContact> contacts, F&& f) {
    find_vectors(contacts);
    for (const NullVector& vector : vectors_) {
      f(vector.first,
        std::span(numbers_).subspan(vector.begin, numbers_of_force * (vector.last - vector.first)));
    }
  }
  /// Least margin of some contacts, as their forces are.
  [[nodiscard]] double least(std::span<const ActiveContact> contacts);

private:
  struct NullVector {
    std::size_t first = 0, last = 0;  // contacts
    std::size_t begin = 0;            // in numbers_: normal and tangential numbers of the contacts in turn
  };
  struct Line {
    double at = 0.0, slope = 0.0;  // a margin along a null vector
  };
  struct Group {
    std::size_t first = 0, last = 0;  // contacts
    std::vector<ContactPivot::Row> rows;
    FullPivoting factors;
  };
  void find_vectors(std::span<const ActiveContact> contacts);
  void append_vectors(std::span<const ActiveContact> contacts, const Group& of);
  void collect(std::span<const ActiveContact> contacts, const double* vector);
  void bound_wedged(std::span<const ActiveContact> contacts);
  [[nodiscard]] double least_at(double shift) const;
  void follow(std::span<ActiveContact> contacts, const NullVector& vector);
  [[nodiscard]] bool follow_all(std::span<ActiveContact> contacts, std::size_t from, std::size_t to,
                                bool mark);
  void state_lines(std::span<const ActiveContact> contacts, std::size_t from, std::size_t to);

  std::vector<Group> groups_;        // those added, and memory of more
  std::size_t count_ = 0;            // of those added
  std::vector<NullVector> vectors_;  // empty: not found yet
  std::vector<double> numbers_, work_;
  std::vector<Line> lines_;
  LargestMargin program_;  // forces of more than one freedom
};

}  // namespace carom

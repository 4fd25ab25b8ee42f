#pragma once

/// \file
/// Contact problems that are their own image in a mirror.
///
/// The problem: with friction a contact problem can have several solutions, and of one that is its own image
/// some come in pairs, of which each is the image of the other: nothing but the order of the contacts could
/// choose between these. What is symmetric stays so: of impulses that are their own image there are half as
/// many, P = E x, and they solve the problem with E^T W E and E^T b, which always has a solution where the
/// problem itself must have one: its matrix is positive semidefinite too, and its sets are of the same kinds.

#include <carom/contact/solvers/contact_problem.h>
#include <carom/core/export.h>

#include <span>
#include <vector>

namespace carom {

/// Finds the mirror of a problem, and makes the problem of one half. In the mirror contacts change places, or
/// are their own images, and the directions of sliding and rolling turn round. Keeps its memory.
class CAROM_API MirrorFold {
public:
  /// True if a dense planar problem is its own image but for rounding, and not each of its contacts is its
  /// own. Problems with bounds that are given as numbers (intervals) and with discs are left alone.
  [[nodiscard]] bool find(const ContactProblem& problem);

  /// The problem of one half, of the last problem whose mirror was found. Of a contact that is its own image
  /// it has the normal row only: nothing rubs there.
  [[nodiscard]] const ContactProblem& half() const { return half_; }

  /// Writes impulses of all [N s] from those of one half.
  void unfold(std::span<const double> half, std::span<double> impulse) const;

private:
  /// A row of one half, and the rows of the problem that it stands for.
  struct Row {
    int own, image;  // image: the same row where a contact is its own image
    double sign;     // of the impulse of the image
  };

  [[nodiscard]] bool is_foldable(const ContactProblem& problem) const;
  [[nodiscard]] bool are_images(const ContactProblem& problem, std::size_t one, std::size_t other) const;
  [[nodiscard]] bool have_image_of(const ContactProblem& problem, const RowGroup& one, const RowGroup& from,
                                   const RowGroup& other, const RowGroup& to) const;
  void fold(const ContactProblem& problem);
  void add_rows(const RowGroup& own, const RowGroup& image);

  std::vector<int> image_;  // of each group, -1: not found yet
  std::vector<Row> rows_;
  ContactProblem half_;
  double largest_ = 0.0;  // |b| [m/s]
};

}  // namespace carom

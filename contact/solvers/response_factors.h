#pragma once

/// \file
/// The matrix of a large contact problem by its factors, W = H M^-1 H^T: plain arrays, in which a body is a
/// place (slot) with three inverse masses. W itself would have as many numbers as the square of the contacts.

#include <carom/core/export.h>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace carom {

/// H row by row, M^-1 slot by slot.
struct CAROM_API ResponseFactors {
  static constexpr int columns = 3;     ///< of a slot; those that a body does not have are zero
  static constexpr int most_slots = 3;  ///< of a row
  static constexpr int no_slot = -1;

  /// A row of H: blocks of three numbers, for the slots that are in use. Those come first, each once.
  struct Row {
    std::array<int, std::size_t{most_slots}> slot{no_slot, no_slot, no_slot};
    std::array<double, std::size_t{most_slots * columns}> h{};
  };

  std::vector<double> inverse_mass;  ///< three numbers a slot [1/kg, 1/kg, 1/(kg m^2)]; 0: immovable
  std::vector<Row> rows;
  double largest_trace = 0.0;  ///< of W over the rows of a group (planar_certificate.h); of a grouped problem

  /// Sizes the arrays, all numbers zero.
  void reset(int row_count, int slot_count);
  /// Sizes the rows, whose numbers are to be written; no slots.
  void resize_rows(int row_count);
  /// Number of slots.
  [[nodiscard]] std::size_t slots() const { return inverse_mass.size() / columns; }
  /// Entry of W.
  [[nodiscard]] double entry(std::size_t row, std::size_t column) const;
  /// Entry of W on its diagonal.
  [[nodiscard]] double diagonal(std::size_t row) const;
  /// u = M^-1 H^T P. \param velocity out, three numbers a slot
  void respond(std::span<const double> impulse, std::vector<double>& velocity) const;
  /// H u along one row.
  [[nodiscard]] double along(std::size_t row, std::span<const double> velocity) const;
};

}  // namespace carom

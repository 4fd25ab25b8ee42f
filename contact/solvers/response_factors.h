#pragma once

/// \file
/// The matrix of a large contact problem by its factors, W = H M^-1 H^T: plain arrays, in which a body is a
/// place (slot) with three inverse masses. W itself would have as many numbers as the square of the contacts.
/// Bodies that answer together, since joints or a linearised step bind them, are slots without masses: what
/// an impulse along a row makes of their velocities stands beside H, W = H (M^-1 H^T + C).

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
    int paired = 0;  ///< slots, of the first row of a contact, whose other row is the next; else 0. Of a
                     ///< grouped problem
    std::array<double, std::size_t{most_slots * columns}> h{};
  };

  /// Velocities of consecutive slots, bound to each other, by a unit impulse along a row.
  struct Answer {
    std::size_t first_slot = 0, slots = 0;
    std::size_t number = 0;  ///< of Bound::numbers, three a slot
  };

  /// Slots that answer together. Empty where each slot answers for itself.
  struct Bound {
    std::vector<char> slots;         ///< by slot: true of these
    std::vector<std::size_t> first;  ///< by row, and an end: its first answer
    std::vector<Answer> answers;
    std::vector<double> numbers;
    /// No slots.
    void clear();
  };

  std::vector<double> inverse_mass;  ///< three numbers a slot [1/kg, 1/kg, 1/(kg m^2)]; 0: immovable, bound
  std::vector<Row> rows;
  Bound bound;
  double largest_trace = 0.0;  ///< of W over the rows of a group (planar_certificate.h); of a grouped problem
  bool any_held = false;       ///< W has a zero on its diagonal; of a grouped problem

  /// Sizes the arrays, all numbers zero.
  void reset(int row_count, int slot_count);
  /// Sizes the rows, whose numbers are to be written; no slots.
  void resize_rows(int row_count);
  /// True if some slots answer together.
  [[nodiscard]] bool any_bound() const { return !bound.slots.empty(); }
  /// True of a slot that answers with others; false of numbers beyond the slots.
  [[nodiscard]] bool is_bound(std::size_t slot) const {
    return slot < bound.slots.size() && bound.slots[slot] != 0;
  }
  /// Answers of bound slots to an impulse along a row.
  [[nodiscard]] std::span<const Answer> answers(std::size_t row) const;
  /// Number of slots.
  [[nodiscard]] std::size_t slots() const { return inverse_mass.size() / columns; }
  /// Entry of W.
  [[nodiscard]] double entry(std::size_t row, std::size_t column) const;
  /// Entry of W on its diagonal.
  [[nodiscard]] double diagonal(std::size_t row) const;
  /// u = (M^-1 H^T + C) P. \param velocity out, three numbers a slot
  void respond(std::span<const double> impulse, std::vector<double>& velocity) const;
  /// H u along one row.
  [[nodiscard]] double along(std::size_t row, std::span<const double> velocity) const;
};

}  // namespace carom

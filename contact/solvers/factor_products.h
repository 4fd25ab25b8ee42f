#pragma once

/// \file
/// Products with all rows of a problem in factors (response_factors.h).

#include <carom/contact/solvers/response_factors.h>

#include <array>
#include <cstddef>
#include <span>

namespace carom {

/// Whether two rows reach the same slots.
[[nodiscard]] inline bool share_slots(const ResponseFactors::Row& one, const ResponseFactors::Row& other) {
  return one.slot[0] == other.slot[0] && one.slot[1] == other.slot[1] && one.slot[2] == other.slot[2];
}

/// Number of slots of a row.
[[nodiscard]] inline int slots_of(const ResponseFactors::Row& row) {
  int count = 0;
  for (const int slot : row.slot) count += slot != ResponseFactors::no_slot ? 1 : 0;
  return count;
}

/// Entry of W on its diagonal, of a row.
[[nodiscard]] inline double diagonal_of(const ResponseFactors& factors, const ResponseFactors::Row& row) {
  constexpr std::size_t columns = ResponseFactors::columns;
  double sum = 0.0;
  for (std::size_t i = 0; i < ResponseFactors::most_slots && row.slot[i] != ResponseFactors::no_slot; ++i) {
    const double *const h = &row.h[columns * i], *const m = factors.inverse_mass.data() +
                                                            columns * static_cast<std::size_t>(row.slot[i]);
    sum = sum + h[0] * m[0] * h[0] + h[1] * m[1] * h[1] + h[2] * m[2] * h[2];
  }
  return sum;
}

/// Entries of W on its diagonal, of the two rows of a contact of two slots.
[[nodiscard]] inline std::array<double, 2> diagonal_of_both(const ResponseFactors& factors,
                                                            const ResponseFactors::Row* rows) {
  constexpr std::size_t columns = ResponseFactors::columns;
  const double* const masses = factors.inverse_mass.data();
  const double *const m = masses + columns * static_cast<std::size_t>(rows[0].slot[0]),
                      *const w = masses + columns * static_cast<std::size_t>(rows[0].slot[1]);
  const auto along = [&](const double* h) {
    const double first = 0.0 + h[0] * m[0] * h[0] + h[1] * m[1] * h[1] + h[2] * m[2] * h[2];
    return first + h[3] * w[0] * h[3] + h[4] * w[1] * h[4] + h[5] * w[2] * h[5];
  };
  return {along(rows[0].h.data()), along(rows[1].h.data())};
}

/// H u + c along all rows of a grouped problem. \param velocity u, three numbers a slot \param added c, by
/// row \param out by row
inline void along_all_rows(const ResponseFactors& factors, std::span<const double> velocity,
                           std::span<const double> added, std::span<double> out) {
  constexpr std::size_t columns = ResponseFactors::columns;
  const auto of_slot = [&](int slot) { return velocity.data() + columns * static_cast<std::size_t>(slot); };
  const ResponseFactors::Row* const rows = factors.rows.data();
  const std::size_t count = factors.rows.size();
  for (std::size_t r = 0; r < count; ++r) {
    const ResponseFactors::Row& row = rows[r];
    if (row.paired == 2) {  // velocities are read once
      const double *const n = row.h.data(), *const t = rows[r + 1].h.data();
      const double *const u = of_slot(row.slot[0]), *const w = of_slot(row.slot[1]);
      const double x = u[0], y = u[1], spin = u[2], a = w[0], b = w[1], c = w[2];
      const double along_n = n[0] * x + n[1] * y + n[2] * spin + n[3] * a + n[4] * b + n[5] * c;
      const double along_t = t[0] * x + t[1] * y + t[2] * spin + t[3] * a + t[4] * b + t[5] * c;
      out[r] = along_n + added[r];
      ++r;
      out[r] = along_t + added[r];
      continue;
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < ResponseFactors::most_slots && row.slot[i] != ResponseFactors::no_slot; ++i) {
      const double *const h = &row.h[columns * i], *const u = of_slot(row.slot[i]);
      sum = sum + h[0] * u[0] + h[1] * u[1] + h[2] * u[2];
    }
    out[r] = sum + added[r];
  }
}

}  // namespace carom

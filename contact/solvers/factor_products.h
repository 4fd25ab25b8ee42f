#pragma once

/// \file
/// Products with all rows of a problem in factors (response_factors.h).

#include <carom/contact/solvers/response_factors.h>

#include <cstddef>
#include <span>

namespace carom {

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

/// H u + c along all rows. \param velocity u, three numbers a slot \param added c, by row
/// \param out by row
inline void along_all_rows(const ResponseFactors& factors, std::span<const double> velocity,
                           std::span<const double> added, std::span<double> out) {
  constexpr std::size_t columns = ResponseFactors::columns;
  for (std::size_t r = 0; r < factors.rows.size(); ++r) {
    const ResponseFactors::Row& row = factors.rows[r];
    double sum = 0.0;
    for (std::size_t i = 0; i < ResponseFactors::most_slots && row.slot[i] != ResponseFactors::no_slot; ++i) {
      const double *const h = &row.h[columns * i], *const u = velocity.data() +
                                                              columns * static_cast<std::size_t>(row.slot[i]);
      sum = sum + h[0] * u[0] + h[1] * u[1] + h[2] * u[2];
    }
    out[r] = sum + added[r];
  }
}

}  // namespace carom

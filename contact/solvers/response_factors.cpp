// Problem: multiply with W = H M^-1 H^T without making it.

#include <carom/contact/solvers/response_factors.h>

namespace carom {

void ResponseFactors::reset(int row_count, int slot_count) {
  inverse_mass.assign(static_cast<std::size_t>(slot_count) * columns, 0.0);
  rows.assign(static_cast<std::size_t>(row_count), Row{});
}

double ResponseFactors::entry(std::size_t row, std::size_t column) const {
  const Row &left = rows[row], &right = rows[column];
  double sum = 0.0;
  for (std::size_t i = 0; i < most_slots && left.slot[i] != no_slot; ++i) {
    const double* const mass = inverse_mass.data() + static_cast<std::size_t>(left.slot[i]) * columns;
    for (std::size_t j = 0; j < most_slots && right.slot[j] != no_slot; ++j) {
      if (left.slot[i] != right.slot[j]) continue;
      for (std::size_t k = 0; k < columns; ++k) {
        sum += left.h[columns * i + k] * mass[k] * right.h[columns * j + k];
      }
    }
  }
  return sum;
}

double ResponseFactors::diagonal(std::size_t row) const {
  const Row& at = rows[row];
  double sum = 0.0;
  for (std::size_t i = 0; i < most_slots && at.slot[i] != no_slot; ++i) {
    const double* const mass = inverse_mass.data() + static_cast<std::size_t>(at.slot[i]) * columns;
    for (std::size_t k = 0; k < columns; ++k) sum += at.h[columns * i + k] * mass[k] * at.h[columns * i + k];
  }
  return sum;
}

void ResponseFactors::respond(std::span<const double> impulse, std::vector<double>& velocity) const {
  velocity.assign(inverse_mass.size(), 0.0);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const Row& row = rows[r];
    for (std::size_t i = 0; i < most_slots && row.slot[i] != no_slot; ++i) {
      double* const u = velocity.data() + static_cast<std::size_t>(row.slot[i]) * columns;
      for (std::size_t k = 0; k < columns; ++k) u[k] += row.h[columns * i + k] * impulse[r];
    }
  }
  for (std::size_t k = 0; k < velocity.size(); ++k) velocity[k] *= inverse_mass[k];
}

double ResponseFactors::along(std::size_t row, std::span<const double> velocity) const {
  const Row& at = rows[row];
  double sum = 0.0;
  for (std::size_t i = 0; i < most_slots && at.slot[i] != no_slot; ++i) {
    const double* const u = velocity.data() + static_cast<std::size_t>(at.slot[i]) * columns;
    for (std::size_t k = 0; k < columns; ++k) sum += at.h[columns * i + k] * u[k];
  }
  return sum;
}

void ResponseFactors::resize_rows(int row_count) {
  inverse_mass.clear();
  rows.resize(static_cast<std::size_t>(row_count));
}

}  // namespace carom

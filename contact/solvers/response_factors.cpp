// Problem: multiply with W = H M^-1 H^T without making it.

#include <carom/contact/solvers/response_factors.h>

#include <carom/contact/solvers/factor_products.h>

namespace carom {

namespace {

/// Adds h P + g Q to the velocity of a slot.
inline void push(const double* h, const double* g, double p, double q, double* u) {
  const double x = u[0] + h[0] * p + g[0] * q, y = u[1] + h[1] * p + g[1] * q, z = u[2] + h[2] * p + g[2] * q;
  u[0] = x;
  u[1] = y;
  u[2] = z;
}

/// Adds the products of a block of a row and the velocity of its slot.
inline double add_times(const double* h, const double* u, double sum) {
  return sum + h[0] * u[0] + h[1] * u[1] + h[2] * u[2];
}

}  // namespace

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

double ResponseFactors::diagonal(std::size_t row) const { return diagonal_of(*this, rows[row]); }

void ResponseFactors::respond(std::span<const double> impulse, std::vector<double>& velocity) const {
  velocity.assign(inverse_mass.size(), 0.0);
  double* const u = velocity.data();
  const auto slot_of = [u](int slot) { return u + columns * static_cast<std::size_t>(slot); };
  const Row* const end = rows.data() + rows.size();
  const double* p = impulse.data();
  for (const Row* row = rows.data(); row != end;) {
    // The two rows of a contact reach the same bodies, which are read and written once.
    const bool paired = row + 1 != end && share_slots(row[0], row[1]);
    const Row& other = paired ? row[1] : row[0];
    const double first = p[0], second = paired ? p[1] : 0.0;
    for (std::size_t i = 0; i < most_slots && row->slot[i] != no_slot; ++i) {
      push(&row->h[columns * i], &other.h[columns * i], first, second, slot_of(row->slot[i]));
    }
    row += paired ? 2 : 1;
    p += paired ? 2 : 1;
  }
  for (std::size_t k = 0; k < velocity.size(); ++k) velocity[k] *= inverse_mass[k];
}

double ResponseFactors::along(std::size_t row, std::span<const double> velocity) const {
  const Row& at = rows[row];
  double sum = 0.0;
  for (std::size_t i = 0; i < most_slots && at.slot[i] != no_slot; ++i) {
    const double* const u = velocity.data() + columns * static_cast<std::size_t>(at.slot[i]);
    sum = add_times(&at.h[columns * i], u, sum);
  }
  return sum;
}

void ResponseFactors::resize_rows(int row_count) {
  inverse_mass.clear();
  rows.resize(static_cast<std::size_t>(row_count));
}

}  // namespace carom

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

/// Product of a row and the answer of bound slots to another one.
double times_answers(const ResponseFactors& factors, const ResponseFactors::Row& row, std::size_t column) {
  constexpr std::size_t columns = ResponseFactors::columns;
  double sum = 0.0;
  for (const ResponseFactors::Answer& answer : factors.answers(column)) {
    for (std::size_t i = 0; i < ResponseFactors::most_slots && row.slot[i] >= 0; ++i) {
      const std::size_t place = static_cast<std::size_t>(row.slot[i]) - answer.first_slot;
      if (place >= answer.slots) continue;  // before the first one, too
      sum = add_times(&row.h[columns * i], &factors.bound.numbers[answer.number + columns * place], sum);
    }
  }
  return sum;
}

}  // namespace

// Made here: in the header this kind of a span would be compiled anew by every program.
std::span<const ResponseFactors::Answer> ResponseFactors::answers(std::size_t row) const {
  if (!any_bound()) return {};
  return {bound.answers.data() + bound.first[row], bound.first[row + 1] - bound.first[row]};
}

void ResponseFactors::Bound::clear() {
  slots.clear();
  first.clear();
  answers.clear();
  numbers.clear();
}

void ResponseFactors::reset(int row_count, int slot_count) {
  bound.clear();
  inverse_mass.assign(static_cast<std::size_t>(slot_count) * columns, 0.0);
  rows.assign(static_cast<std::size_t>(row_count), Row{});
}

double ResponseFactors::entry(std::size_t row, std::size_t column) const {
  const Row &left = rows[row], &right = rows[column];
  double sum = times_answers(*this, left, column);
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
  const double own = diagonal_of(*this, rows[row]);
  return any_bound() ? own + times_answers(*this, rows[row], row) : own;
}

void ResponseFactors::respond(std::span<const double> impulse, std::vector<double>& velocity) const {
  velocity.assign(inverse_mass.size(), 0.0);
  double* const u = velocity.data();
  const auto slot_of = [u](int slot) { return u + columns * static_cast<std::size_t>(slot); };
  const Row* const end = rows.data() + rows.size();
  const double* p = impulse.data();
  for (const Row* row = rows.data(); row != end;) {
    // The two rows of a contact reach the same bodies, which are read and written once.
    const bool paired = row->paired > 0;
    const double *const h = row->h.data(), *const g = row[paired ? 1 : 0].h.data();
    const double first = p[0], second = paired ? p[1] : 0.0;
    if (row->paired == 2) {  // the usual case, without a loop
      push(h, g, first, second, slot_of(row->slot[0]));
      push(h + columns, g + columns, first, second, slot_of(row->slot[1]));
    } else {
      for (std::size_t i = 0; i < most_slots && row->slot[i] != no_slot; ++i) {
        push(h + columns * i, g + columns * i, first, second, slot_of(row->slot[i]));
      }
    }
    row += paired ? 2 : 1;
    p += paired ? 2 : 1;
  }
  const double* const inverse = inverse_mass.data();
  for (std::size_t k = 0, size = velocity.size(); k < size; ++k) u[k] *= inverse[k];
  if (!any_bound()) return;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    for (const Answer& answer : answers(row)) {
      const double* number = &bound.numbers[answer.number];
      double* const to = u + columns * answer.first_slot;
      for (std::size_t k = 0; k < columns * answer.slots; ++k) to[k] += number[k] * impulse[row];
    }
  }
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
  bound.clear();
  inverse_mass.clear();
  rows.resize(static_cast<std::size_t>(row_count));
}

}  // namespace carom

// Problem: velocities along the rows of constraints as they would be without impulses.

#include <carom/contact/contact_velocity.h>
#include <carom/contact/free_velocity.h>
#include <carom/contact/solvers/factor_products.h>

#include <array>
#include <cmath>
#include <cstddef>

namespace carom {

namespace {

/// Velocity along a row that joints hold fast, without rounding: of what moves around it, or has moved
/// before [m/s]. Seldom asked.
[[gnu::noinline]] double along_held_row(const Constraint& constraint, int row, const double* velocity_free,
                                        double number) {
  constexpr double rounding = 1e-9, least = 1e-10;
  return std::abs(number) <= rounding * constraint.speed(row, velocity_free) + least ? 0.0 : number;
}

}  // namespace

void set_free_velocity_of_rows(std::span<const Constraint> constraints, const double* velocity_free,
                               const RowsBefore& before, ContactProblem& problem) {
  const double *const gamma = before.velocity.data(), *const e = before.restitution.data();
  double* const b = problem.vector().data();
  std::size_t row = 0;
  for (const Constraint& constraint : constraints) {
    const std::array<double, 3> after = velocities_after(constraint, velocity_free);
    for (int i = 0; i < constraint.rows; ++i, ++row) {
      double number = after[static_cast<std::size_t>(i)] + e[row] * gamma[row];
      if (i == 0 && constraint.allowed_approach > 0.0) number += constraint.allowed_approach;
      const bool held = problem.diagonal(static_cast<int>(row)) == 0.0;
      b[row] = held ? along_held_row(constraint, i, velocity_free, number) : number;
    }
  }
}

void set_free_velocity_of_slots(std::span<const ImpulseDirection> directions,
                                std::span<const FactorMaker::Slot> slots, const double* velocity_free,
                                std::span<const double> given, std::vector<double>& scratch,
                                ContactProblem& problem) {
  constexpr std::size_t columns = ResponseFactors::columns;
  scratch.resize(columns * slots.size());
  for (std::size_t slot = 0; slot < slots.size(); ++slot) {
    const Constraint::Block& block = slots[slot].block;
    const double* const from = velocity_free + block.v;
    double* const to = scratch.data() + columns * slot;
    to[0] = from[0];
    to[1] = from[1];
    to[2] = block.columns == columns ? from[2] : 0.0;
  }
  const auto b = problem.vector();
  along_all_rows(problem.factors(), scratch, given, b);
  if (!problem.factors().any_held) return;
  for (std::size_t row = 0; row < b.size(); ++row) {
    if (problem.diagonal(static_cast<int>(row)) > 0.0) continue;
    b[row] = along_held_row(*directions[row].constraint, directions[row].row, velocity_free, b[row]);
  }
}

}  // namespace carom

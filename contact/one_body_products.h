#pragma once

/// \file
/// W of the constraints of one body that answers for itself, in tight loops over its 2 or 3 velocities: the
/// usual case of an impact.

#include <carom/contact/delassus.h>
#include <carom/core/numerics/pair.h>

#include <array>
#include <cstddef>
#include <span>

namespace carom::one_body {

/// Velocities of a planar body.
inline constexpr std::size_t of_planar_body = 3;  // the last of them its spin

/// Numbers of a row of a constraint of one body of S velocities.
template <std::size_t S>
const double* row_of_one(const Constraint& at, int row) {
  return at.row(0) + S * static_cast<std::size_t>(row);
}

/// Responses of one body of S velocities.
template <std::size_t S>
void answer_alone(std::span<const ImpulseDirection> directions, const double* mass, const double* inertia,
                  double* x) {
  std::array<double, S> masses;
  for (std::size_t c = 0; c < S; ++c) masses[c] = c < 2 ? *mass : *inertia;
  for (const ImpulseDirection& direction : directions) {
    const Constraint& at = *direction.constraint;
    const double* const row = row_of_one<S>(at, direction.row);
    // In registers until they are divided.
    std::array<double, S> column;
    for (std::size_t c = 0; c < S; ++c) column[c] = row[c];
    if (direction.ratios[0] != 0.0) {  // a body in the plane has one tangent
      const double* const tangent = row_of_one<S>(at, at.tangent_row());
      for (std::size_t c = 0; c < S; ++c) column[c] += direction.ratios[0] * tangent[c];
    }
    if constexpr (S == of_planar_body) {
      if (direction.lever != 0.0) column[S - 1] += direction.lever;
    }
    for (std::size_t c = 0; c < S; ++c) x[c] = column[c] / masses[c];
    x += S;
  }
}

/// Product of a row and a response of one body of S velocities.
template <std::size_t S>
double product(const double* row, const double* response) {
  double sum = 0.0;
  for (std::size_t c = 0; c < S; ++c) sum += row[c] * response[c];
  return sum;
}

/// Products of rows and columns of one body of S velocities. \param lower of the lower triangle, mirrored
template <std::size_t S>
void multiply(std::span<const ImpulseDirection> directions, const double* responses, bool lower,
              double* matrix) {
  const std::size_t n = directions.size();
  for (std::size_t i = 0; i < n; ++i) {
    const double* const row = row_of_one<S>(*directions[i].constraint, directions[i].row);
    const double* response = responses;
    for (std::size_t j = 0; j < (lower ? i + 1 : n); ++j, response += S) {
      matrix[i * n + j] = product<S>(row, response);
      if (lower) matrix[j * n + i] = matrix[i * n + j];
    }
  }
}

/// Products of rows and columns of one body of S velocities: the lower triangle, mirrored. The two rows of a
/// planar contact are written out, without loops.
template <std::size_t S>
void multiply_symmetric(std::span<const ImpulseDirection> directions, const double* responses,
                        double* matrix) {
  if (directions.size() != 2) return multiply<S>(directions, responses, true, matrix);
  const double* const first = row_of_one<S>(*directions[0].constraint, directions[0].row);
  const double* const second = row_of_one<S>(*directions[1].constraint, directions[1].row);
  if constexpr (S == of_planar_body) {
    // In the pairs in which they were just written: a processor waits for any others.
    const Pair r01 = load_pair(responses), r23 = load_pair(responses + 2), r45 = load_pair(responses + 4);
    const double mixed = 0.0 + second[0] * r01[0] + second[1] * r01[1] + second[2] * r23[0];
    const double normal = 0.0 + first[0] * r01[0] + first[1] * r01[1] + first[2] * r23[0];
    const double tangential = 0.0 + second[0] * r23[1] + second[1] * r45[0] + second[2] * r45[1];
    store_pair(matrix, Pair{normal, mixed});
    store_pair(matrix + 2, Pair{mixed, tangential});
  } else {
    const double mixed = product<S>(second, responses);
    matrix[0] = product<S>(first, responses);
    matrix[1] = matrix[2] = mixed;
    matrix[3] = product<S>(second, responses + S);
  }
}

/// Responses and W of a planar contact of one body that turns, as answer_alone() and
/// multiply_symmetric() without loops, and without a way through memory between the two.
/// \param x out: 3 responses to each of both rows \param matrix out: W, 2 x 2
inline void answer_contact(const Constraint& at, const BodyMasses& masses, double* x, double* matrix) {
  const double *const n = at.row(0), *const t = n + of_planar_body;
  const double mass = *masses.mass, inertia = *masses.inertia;
  const Pair r01 = Pair{n[0], n[1]} / both(mass), r23 = Pair{n[2], t[0]} / Pair{inertia, mass},
             r45 = Pair{t[1], t[2]} / Pair{mass, inertia};
  store_pair(x, r01);
  store_pair(x + 2, r23);
  store_pair(x + 4, r45);
  const double mixed = 0.0 + t[0] * r01[0] + t[1] * r01[1] + t[2] * r23[0];
  store_pair(matrix, Pair{0.0 + n[0] * r01[0] + n[1] * r01[1] + n[2] * r23[0], mixed});
  store_pair(matrix + 2, Pair{mixed, 0.0 + t[0] * r23[1] + t[1] * r45[0] + t[2] * r45[1]});
}

/// Adds responses of one body of S velocities.
template <int S>
void add_alone(const double* responses, std::span<const double> impulses, double scale, double* x) {
  if (impulses.size() == 2) {  // of a planar contact: without loops
    const double first = scale * impulses[0], second = scale * impulses[1];
    for (int c = 0; c < S; ++c) {
      double sum = x[c];
      sum += responses[c] * first;
      sum += responses[S + c] * second;
      x[c] = sum;
    }
    return;
  }
  for (const double number : impulses) {
    const double impulse = scale * number;
    for (int c = 0; c < S; ++c) x[c] += *responses++ * impulse;
  }
}

}  // namespace carom::one_body

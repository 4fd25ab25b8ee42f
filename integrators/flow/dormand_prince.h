#pragma once

/// \file
/// Coefficients of the pair of orders 5 and 4 by J. R. Dormand and P. J. Prince, A family of embedded
/// Runge-Kutta formulae, J. Comput. Appl. Math. 6 (1980), 19-26. The last stage is the end of the step and
/// the first of the next.

#include <array>
#include <cstddef>

namespace carom::dormand_prince {

/// Number of stages. Stage i is at the time  t + c_i h  and the place  y + h sum over j < i of a_ij k_j.
inline constexpr std::size_t stages = 7;
/// c, by stage.
inline constexpr std::array<double, stages> c{0.0, 1.0 / 5, 3.0 / 10, 4.0 / 5, 8.0 / 9, 1.0, 1.0};
/// a, by stage.
inline constexpr std::array<std::array<double, stages>, stages> a{{
    {},
    {1.0 / 5},
    {3.0 / 40, 9.0 / 40},
    {44.0 / 45, -56.0 / 15, 32.0 / 9},
    {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
    {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
    {35.0 / 384, 0.0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84},
}};

}  // namespace carom::dormand_prince

#pragma once

/// \file
/// The sets that impulses of unilateral rows lie in. Contact, stops, torque limits and dry friction in
/// joints differ in nothing else.

#include <cstdint>
#include <limits>

namespace carom {

/// Kind of set that the impulse of a row is confined to.
enum class SetKind : std::uint8_t {
  half_line,         ///< P >= 0 (normal impulse of a contact, a stop)
  interval,          ///< lower <= P <= upper, both constant (torque limit); infinite bounds allowed
  bounded_interval,  ///< |P| <= coefficient * P[bound] (Coulomb friction in the plane)
  bounded_disc,      ///< |(P, P next row)| <= coefficient * P[bound] (Coulomb friction in space)
  /// P = coefficient * P[bound], of any sign: friction of a contact that slips in a known direction s,
  /// coefficient = -s mu. A set with one point, whose normal cone is the whole line: nothing is asked of xi.
  proportional
};

/// The set of one row. A disc takes two consecutive rows; both carry the same description.
struct RowSet {
  SetKind kind = SetKind::half_line;
  double lower = 0.0;                                      ///< lower bound [N s] (interval)
  double upper = std::numeric_limits<double>::infinity();  ///< upper bound [N s] (interval)
  int bound = -1;                                          ///< row whose impulse bounds this one, or gives it
  double coefficient = 0.0;  ///< coefficient of friction, factor of a proportional row
};

}  // namespace carom

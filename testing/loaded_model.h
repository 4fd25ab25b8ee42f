#pragma once

/// \file
/// An assembly with a state and its loads, by cause.

#include <carom/core/assembly.h>

#include <array>
#include <vector>

namespace carom::energy_test {

/// A model at one state.
class LoadedModel {
public:
  /// Assembles the system at its described state. Throws ModelError as Assembly.
  explicit LoadedModel(System system);

  /// Brings the loads up to date with the state.
  void update();
  /// Stored energies at the state [J].
  [[nodiscard]] StoredEnergies energies();
  /// Minus the gradient of the potential energy along the velocity coordinates [N, N m], by differences of
  /// fourth order: with their step, 1e-3 m or rad, truncation is about 4e-12 of the fifth derivative and
  /// rounding 2e-13 of the potential.
  [[nodiscard]] std::vector<double> minus_gradient();
  /// Resultant of a load (planar): force x, force y [N], moment about the origin [N m].
  [[nodiscard]] std::array<double, 3> resultant(const std::vector<double>& load) const;
  /// Power of a load [W].
  [[nodiscard]] double power(const std::vector<double>& load) const;

  Assembly assembly;                                        ///< the model
  State state;                                              ///< may be changed; call update() then
  Evaluation evaluation;                                    ///< workspace
  std::vector<double> conservative, dissipative, external;  ///< loads over all velocities [N, N m]
};

}  // namespace carom::energy_test

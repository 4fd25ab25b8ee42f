#pragma once

// An assembly with a state and the loads there, by cause; and what loads must obey.

#include <carom/core/assembly.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace carom_test {

class LoadedModel {
public:
  explicit LoadedModel(carom::System system)
      : assembly(std::move(system)), state(assembly.initial_state()), evaluation(make_evaluation(assembly)) {
    update();
  }

  /// Brings the loads up to date with the state.
  void update() {
    for (std::vector<double>* array : {&conservative, &dissipative, &external}) {
      array->assign(assembly.layout()->v_size(), 0.0);
    }
    for (carom::Index island = 0; island < assembly.islands().size(); ++island) {
      evaluate_positions(assembly, island, state.view(), evaluation);
      evaluate_loads(assembly, island, state.view(), evaluation,
                     {conservative.data(), dissipative.data(), external.data()});
    }
  }

  carom::StoredEnergies energies() {
    carom::StoredEnergies sum;
    for (carom::Index island = 0; island < assembly.islands().size(); ++island) {
      evaluate_positions(assembly, island, state.view(), evaluation);
      add_stored_energies(assembly, island, state.view(), evaluation, sum);
    }
    return sum;
  }

  /// Minus the gradient of the potential energy along the velocity coordinates, by differences of fourth
  /// order: with this step truncation is about 4e-12 of the fifth derivative and rounding 2e-13 of the
  /// potential.
  std::vector<double> minus_gradient() {
    constexpr double step = 1e-3;
    std::vector<double> result;
    const std::vector<double> q0 = state.q;
    for (const carom::BodySlot& slot : assembly.layout()->bodies()) {
      const carom::BodyKind& kind = *assembly.body_kinds()[slot.kind];
      for (carom::Index i = 0; i < slot.v_size; ++i) {
        const auto potential_at = [&](double distance) {
          std::vector<double> delta(slot.v_size, 0.0);
          delta[i] = distance;
          kind.advance({slot.slot, slot.slot + 1}, q0.data() + slot.q, delta.data(), state.q.data() + slot.q);
          return energies().potential();
        };
        const double near = potential_at(step) - potential_at(-step);
        const double far = potential_at(2.0 * step) - potential_at(-2.0 * step);
        result.push_back(-(8.0 * near - far) / (12.0 * step));
        state.q = q0;
      }
    }
    energies();  // brings the rotations back
    return result;
  }

  /// What of a load (planar) would move the whole: force x, force y, moment about the origin.
  std::array<double, 3> resultant(const std::vector<double>& load) const {
    std::array<double, 3> sum{};
    for (const carom::BodySlot& slot : assembly.layout()->bodies()) {
      const double* x = state.q.data() + slot.q;
      const double* f = load.data() + slot.v;
      sum[0] += f[0];
      sum[1] += f[1];
      sum[2] += x[0] * f[1] - x[1] * f[0] + (slot.v_size == 3 ? f[2] : 0.0);
    }
    return sum;
  }

  /// Power of a load.
  double power(const std::vector<double>& load) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < load.size(); ++i) sum += load[i] * state.v[i];
    return sum;
  }

  carom::Assembly assembly;
  carom::State state;
  carom::Evaluation evaluation;
  std::vector<double> conservative, dissipative, external;
};

}  // namespace carom_test

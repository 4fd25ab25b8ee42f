#include <carom/testing/loaded_model.h>

#include <utility>

namespace carom::energy_test {

LoadedModel::LoadedModel(System system)
    : assembly(std::move(system)), state(assembly.initial_state()), evaluation(make_evaluation(assembly)) {
  update();
}

void LoadedModel::update() {
  for (std::vector<double>* array : {&conservative, &dissipative, &external}) {
    array->assign(assembly.layout()->v_size(), 0.0);
  }
  for (Index component = 0; component < assembly.components().size(); ++component) {
    evaluate_positions(assembly, component, state.view(), evaluation);
    evaluate_loads(assembly, component, state.view(), evaluation,
                   {conservative.data(), dissipative.data(), external.data()});
  }
}

StoredEnergies LoadedModel::energies() {
  StoredEnergies sum;
  for (Index component = 0; component < assembly.components().size(); ++component) {
    evaluate_positions(assembly, component, state.view(), evaluation);
    add_stored_energies(assembly, component, state.view(), evaluation, sum);
  }
  return sum;
}

std::vector<double> LoadedModel::minus_gradient() {
  constexpr double step = 1e-3;
  std::vector<double> result;
  const std::vector<double> q0 = state.q;
  for (const BodySlot& slot : assembly.layout()->bodies()) {
    const BodyKind& kind = *assembly.body_kinds()[slot.kind];
    for (Index i = 0; i < slot.v_size; ++i) {
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
  static_cast<void>(energies());  // brings the rotations back
  return result;
}

std::array<double, 3> LoadedModel::resultant(const std::vector<double>& load) const {
  std::array<double, 3> sum{};
  for (const BodySlot& slot : assembly.layout()->bodies()) {
    const double* x = state.q.data() + slot.q;
    const double* f = load.data() + slot.v;
    sum[0] += f[0];
    sum[1] += f[1];
    sum[2] += x[0] * f[1] - x[1] * f[0] + (slot.v_size == 3 ? f[2] : 0.0);
  }
  return sum;
}

double LoadedModel::power(const std::vector<double>& load) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < load.size(); ++i) sum += load[i] * state.v[i];
  return sum;
}

}  // namespace carom::energy_test

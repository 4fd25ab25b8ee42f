#include <carom/core/dynamics/answering_bodies.h>

#include <cstddef>

namespace carom {

namespace {

double kinetic_energy_of_mechanism(const Assembly& assembly, Index body, const double* velocities) {
  const auto of_body = [&](Index one) {
    const BodySlot slot = assembly.layout()->bodies()[one];
    return assembly.body_kinds()[slot.kind]->kinetic_energy({slot.slot, slot.slot + 1}, velocities + slot.v);
  };
  if (!assembly.is_jointed(body)) return of_body(body);
  double sum = 0.0;
  const Range bodies = assembly.components()[assembly.component_of(body)].bodies;
  for (Index other = bodies.begin; other < bodies.end; ++other) {
    if (assembly.mechanism(other) == assembly.mechanism(body)) sum += of_body(other);
  }
  return sum;
}

}  // namespace

double kinetic_energy_of_answering(const Assembly& assembly, std::span<const Constraint> constraints,
                                   const double* velocities) {
  double sum = 0.0;
  // Each mechanism once, where it comes first.
  const auto comes_before = [&](std::size_t c, int b) {
    const auto mechanism = [&](const Constraint& at, int block) {
      return assembly.mechanism(at.blocks[static_cast<std::size_t>(block)].body);
    };
    const Index wanted = mechanism(constraints[c], b);
    for (std::size_t i = 0; i <= c; ++i) {
      for (int block = 0; block < (i == c ? b : constraints[i].bodies); ++block) {
        if (mechanism(constraints[i], block) == wanted) return true;
      }
    }
    return false;
  };
  for (std::size_t c = 0; c < constraints.size(); ++c) {
    for (int b = 0; b < constraints[c].bodies; ++b) {
      if (comes_before(c, b)) continue;
      const Index body = constraints[c].blocks[static_cast<std::size_t>(b)].body;
      sum += kinetic_energy_of_mechanism(assembly, body, velocities);
    }
  }
  return sum;
}

}  // namespace carom

#include <carom/core/dynamics/body_response.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

double largest(const double* numbers, Index count) {
  double size = 0.0;
  for (Index i = 0; i < count; ++i) size = std::max(size, std::abs(numbers[i]));
  return size;
}

/// x becomes K x. Where joints hold a row fast (of a corner at a pin to the ground) nothing is left in place
/// of a response by rounding, against which impulses would be as large as its inverse.
bool answer_with(JointConstraints& joints, double* x) {
  constexpr double held = 1e-12;  // of the response without joints: rounding
  const Range v = joints.velocities();
  // Joints count velocities from the first of all.
  joints.apply_inverse_mass(x - v.begin);
  const double alone = largest(x, v.size());
  joints.project(JointLevel::change, x - v.begin);
  if (largest(x, v.size()) > held * alone) return true;
  std::fill_n(x, v.size(), 0.0);
  return false;
}

}  // namespace

bool BodyResponse::take_loads(Index, double*) { return false; }

BodyMasses BodyResponse::alone(Index) const { return {}; }

MassResponse::MassResponse(const Assembly& assembly) : assembly_(&assembly) {
  const BodySlots& bodies = assembly.layout()->bodies();
  if (bodies.empty()) return;
  const BodySlot first = bodies[0], last = bodies[bodies.size() - 1];
  // Bodies of a kind follow one another in it: between these two there are no others.
  if (first.kind != last.kind || last.slot - first.slot + 1 != bodies.size()) return;
  of_all_ = assembly.body_kinds()[first.kind]->masses(first.slot);
}

BodyMasses MassResponse::of_any(Index body) const {
  const BodySlot& slot = assembly_->layout()->bodies()[body];
  return assembly_->body_kinds()[slot.kind]->masses(slot.slot);
}

Range MassResponse::reach(Index body) const {
  const BodySlot& slot = assembly_->layout()->bodies()[body];
  return {slot.v, slot.v + slot.v_size};
}

void MassResponse::answer(Index body, double* x, std::size_t columns, char* held) {
  const BodyMasses masses = alone(body);
  const double* const end = x + columns * reach(body).size();
  std::fill_n(held, columns, char{0});
  if (masses.layout == BodyMasses::Layout::planar_bodies) {
    for (; x != end; x += 3) {
      x[0] /= *masses.mass;
      x[1] /= *masses.mass;
      x[2] /= *masses.inertia;
    }
  } else {
    for (; x != end; ++x) *x /= *masses.mass;
  }
}

void JointResponse::answer(Index, double* x, std::size_t columns, char* held) {
  for (std::size_t j = 0; j < columns; ++j, x += joints_->velocities().size()) {
    held[j] = answer_with(*joints_, x) ? 0 : 1;
  }
}

LinearisedResponse::LinearisedResponse(const Assembly& assembly,
                                       std::span<const LinearisedComponent> components)
    : assembly_(&assembly),
      components_(components),
      joints_answer_(
          std::any_of(components.begin(), components.end(),
                      [](const LinearisedComponent& component) { return component.at_impact != nullptr; })) {}

const LinearisedComponent& LinearisedResponse::component_of(Index body) const {
  const Index v = assembly_->layout()->bodies()[body].v;
  const auto behind = std::upper_bound(
      components_.begin(), components_.end(), v,
      [](Index at, const LinearisedComponent& component) { return at < component.velocities.begin; });
  return *(behind - 1);
}

bool LinearisedResponse::take_loads(Index body, double* x) {
  if (!joints_answer_) return false;
  const LinearisedComponent& component = component_of(body);
  if (component.at_impact == nullptr) return true;  // impulses as they are
  const Range v = component.velocities;
  static_cast<void>(answer_with(*component.at_impact, x));
  velocity_.assign(x, x + v.size());
  component.step->apply_mass(velocity_.data() - v.begin, x - v.begin);
  return true;
}

void LinearisedResponse::answer(Index body, double* x, std::size_t columns, char* held) {
  const LinearisedComponent& component = component_of(body);
  std::fill_n(held, columns, char{0});
  for (std::size_t j = 0; j < columns; ++j, x += component.velocities.size()) component.step->solve(x);
}

}  // namespace carom

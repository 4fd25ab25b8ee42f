#include <carom/core/dynamics/components_response.h>

#include <algorithm>
#include <utility>

namespace carom {

bool append_constraints(const Assembly& assembly, Index component, std::vector<JointConstraints>& out) {
  if (!assembly.has_joints(component)) return false;
  JointConstraints joints(assembly, component);
  if (joints.empty()) return false;
  out.push_back(std::move(joints));
  return true;
}

std::vector<JointConstraints*> addresses_of(std::span<JointConstraints> joints) {
  std::vector<JointConstraints*> list;
  list.reserve(joints.size());
  for (JointConstraints& of_component : joints) list.push_back(&of_component);
  return list;
}

JointConstraints* ComponentsResponse::joints_of(Index body) const {
  if (joints_.empty()) return nullptr;
  const Index v = assembly_->layout()->bodies()[body].v;
  const auto behind = std::upper_bound(
      joints_.begin(), joints_.end(), v,
      [](Index at, const JointConstraints* joints) { return at < joints->velocities().begin; });
  if (behind == joints_.begin()) return nullptr;
  JointConstraints* const joints = *(behind - 1);
  return v < joints->velocities().end ? joints : nullptr;
}

Range ComponentsResponse::reach(Index body) const {
  const JointConstraints* const joints = joints_of(body);
  return joints == nullptr ? masses_.reach(body) : joints->velocities();
}

BodyMasses ComponentsResponse::alone(Index body) const {
  return joints_of(body) == nullptr ? masses_.alone(body) : BodyMasses{};
}

void ComponentsResponse::answer(Index body, double* x, std::size_t columns, char* held) {
  JointConstraints* const joints = joints_of(body);
  if (joints == nullptr) return masses_.answer(body, x, columns, held);
  JointResponse(*joints).answer(body, x, columns, held);
}

}  // namespace carom

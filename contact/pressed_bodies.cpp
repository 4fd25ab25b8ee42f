// Problem: name what presses a body that has no room.

#include <carom/contact/pressed_bodies.h>

#include <algorithm>
#include <vector>

namespace carom {

std::string pressed_by(const System& system, const IslandProblem& problem) {
  std::vector<std::string> names;
  for (const Constraint& contact : problem.constraints()) {
    const FeatureKey& ground = contact.key.b;
    if (contact.type != ConstraintType::contact || ground.owner != FeatureKey::Owner::obstacle) continue;
    if (contact.surface_velocity_after[0] == 0.0) continue;
    const std::string name = system.name(ObstacleId{ground.serial, system.token()});
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  if (names.empty()) return {};
  std::string text = "; bodies are pressed by the motion of ";
  for (const std::string& name : names) text += name + (name == names.back() ? "" : ", ");
  return text + " (allowed: motion that leaves them room, or friction on which they slide out)";
}

}  // namespace carom

// Problem: name what presses a body that has no room, or masses that leave it no digits.

#include <carom/contact/pressed_bodies.h>
#include <carom/core/errors.h>
#include <carom/core/listed.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace carom {

namespace {

/// Names of the shapes on ground that move along a row of contacts, each once: "a, b"; empty where none does.
std::string moving_along(std::size_t row, const System& system, std::span<const Constraint> contacts) {
  std::vector<std::string> names;
  for (const Constraint& contact : contacts) {
    const FeatureKey& ground = contact.key.b;
    if (contact.attached || ground.owner != FeatureKey::Owner::obstacle) continue;
    if (contact.surface_velocity_after[row] == 0.0) continue;
    const std::string name = system.name(ObstacleId{ground.serial, system.token()});
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return listed(names);
}

}  // namespace

std::string pressed_by(const System& system, std::span<const Constraint> contacts) {
  const std::string names = moving_along(0, system, contacts);
  if (names.empty()) return {};
  return "; bodies are pressed by the motion of " + names +
         " (allowed: motion that leaves them room, or friction on which they slide out)";
}

std::string carried_by(const System& system, std::span<const Constraint> contacts) {
  if (contacts.size() < 2) return {};
  const std::string names = moving_along(1, system, contacts);
  if (names.empty()) return {};
  return "; bodies are carried by the surfaces of " + names +
         " (allowed: surfaces that do not carry a body against what stops it, or less friction)";
}

std::string uneven_masses(const IslandProblem& problem) {
  return uneven_masses(MassRange{1.0, problem.map().mass_ratio()});
}

std::string uneven_masses(const MassRange& masses) {
  constexpr double uneven = 1e8;
  const double ratio = masses.most / masses.least;
  if (!(ratio > uneven)) return {};
  const double digits =
      std::max(std::floor(-std::log10(std::numeric_limits<double>::epsilon() * ratio)), 0.0);
  return "; masses differ by a factor of " + to_text(ratio) + ", which leaves " +
         std::to_string(static_cast<int>(digits)) +
         " digits of the motion of a light body between heavy ones (allowed: masses nearer to each other)";
}

}  // namespace carom

#include <carom/core/assembly.h>
#include <carom/core/dynamics/light_bodies.h>
#include <carom/core/errors.h>
#include <carom/core/listed.h>
#include <carom/core/system.h>

#include <algorithm>
#include <limits>

namespace carom {

std::string light_bodies(const Assembly& assembly, Index component, std::vector<std::string>& parts) {
  constexpr double light = 1e-2;   // of the heaviest body
  constexpr std::size_t most = 3;  // that are named
  const Layout& layout = *assembly.layout();
  const Range bodies = assembly.components()[component].bodies;
  const auto mass_of = [&](Index body) {
    const BodySlot& slot = layout.bodies()[body];
    return assembly.body_kinds()[slot.kind]->mass(slot.slot);
  };
  Index heaviest = bodies.begin;
  double least = std::numeric_limits<double>::infinity();
  for (Index body = bodies.begin; body < bodies.end; ++body) {
    if (mass_of(body) > mass_of(heaviest)) heaviest = body;
    least = std::min(least, mass_of(body));
  }
  const double largest = mass_of(heaviest);
  if (!(least <= light * largest)) return {};
  std::vector<std::string> names;
  for (Index body = bodies.begin; body < bodies.end; ++body) {
    if (mass_of(body) <= light * largest) names.push_back(assembly.system().name(layout.id(body)));
  }
  std::string text = "; light are " + listed(names, most) + ", from " + to_text(least) + " kg, against " +
                     to_text(largest) + " kg of " + assembly.system().name(layout.id(heaviest)) +
                     ", a ratio of " + to_text(largest / least);
  names.resize(std::min(names.size(), most));
  parts.insert(parts.end(), names.begin(), names.end());
  return text;
}

}  // namespace carom

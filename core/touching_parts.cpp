// Problem: find bodies that pass through each other because nobody gave them a law of contact.

#include <carom/core/listed.h>
#include <carom/core/registry.h>
#include <carom/core/stored_parts.h>
#include <carom/core/touching_parts.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <type_traits>
#include <utility>

namespace carom {

void Toucher::take(Index body, bool is_point) {
  std::vector<Index>& bodies = is_point ? points : extended;
  if (bodies.empty() || bodies.back() != body) bodies.push_back(body);
}

std::string material_name(const SurfaceTable& surfaces, MaterialId material) {
  return material.valid() ? "material '" + surfaces.name(material.serial) + "'" : "no material";
}

Touching touching_parts(const System& system) {
  Touching all;
  std::map<std::array<std::uint32_t, 3>, std::size_t> places;  // of kinds
  const auto add = [&](MaterialId material, const ContactFilter& filter, bool intended, Index body,
                       bool is_point, auto id) {
    constexpr bool is_shape = std::is_same_v<decltype(id), ShapeId>;
    all.any = true;
    if (intended) all.intended.push_back(system.name(id));
    const auto [known, is_new] =
        places.try_emplace({material.serial, filter.groups, filter.touches}, all.kinds.size());
    if (is_new) {
      std::string of = is_shape ? " of " + system.name(BodyId{body, system.token()}) : "";
      all.kinds.push_back({material, filter, system.name(id), std::move(of), {}, {}});
    }
    all.kinds[known->second].take(body, is_point);
  };
  // Names are made of few parts only where there are shapes on ground: then none is listed as intended.
  const bool lists = system.obstacles().empty();
  for (const auto& entry : system.body_kinds().entries()) {
    for (Index slot = 0; slot < entry.serials.size(); ++slot) {
      if (!entry.kind->has_contact_point(slot)) continue;
      const MaterialId material = entry.kind->material(slot);
      const Index serial = entry.serials[slot];
      add(material, entry.kind->filter(slot), lists && material.valid(), serial, true,
          BodyId{serial, system.token()});
    }
  }
  std::vector<RoundedPoint> points;
  for (const auto& entry : system.shape_kinds().entries()) {
    for (Index slot = 0; slot < entry.serials.size(); ++slot) {
      points.clear();
      entry.kind->rounded_points(slot, points);
      const bool is_point = points.size() == 1 && points.front().radius == 0.0;
      add(entry.kind->material(slot), entry.kind->filter(slot), lists, entry.kind->body(slot).serial,
          is_point, ShapeId{entry.serials[slot], system.token()});
    }
  }
  return all;
}

bool can_touch(const Toucher& a, const Toucher& b) {
  const auto differ = [](const std::vector<Index>& some, const std::vector<Index>& others) {
    return std::any_of(some.begin(), some.end(), [&](Index body) {
      return std::any_of(others.begin(), others.end(), [&](Index other) { return other != body; });
    });
  };
  if (!may_touch(a.filter, b.filter)) return false;
  return differ(a.extended, b.extended) || differ(a.extended, b.points) || differ(a.points, b.extended);
}

bool any_touch(const System& system, const Touching& touching) {
  for (const Toucher& a : touching.kinds) {
    for (const Toucher& b : touching.kinds) {
      if (can_touch(a, b) && system.law(a.material, b.material)) return true;
    }
  }
  return false;
}

bool can_touch(const Touching& touching, MaterialId a, MaterialId b) {
  for (const Toucher& one : touching.kinds) {
    for (const Toucher& other : touching.kinds) {
      if (one.material == a && other.material == b && can_touch(one, other)) return true;
    }
  }
  return false;
}

bool has(const Touching& touching, MaterialId material) {
  return std::any_of(touching.kinds.begin(), touching.kinds.end(),
                     [&](const Toucher& toucher) { return toucher.material == material; });
}

namespace {

/// Pairs of bodies, by serial numbers, that never touch each other.
using Pairs = std::set<std::pair<Index, Index>>;

/// Pairs of bodies that do not touch whatever their materials are: by a decision, or since a joint binds
/// both.
Pairs separate_pairs(const System& system) {
  Pairs pairs;
  std::vector<BodyId> ends;
  for (const auto& entry : system.joint_kinds().entries()) {
    for (Index slot = 0; slot < entry.serials.size(); ++slot) {
      ends.clear();
      entry.kind->ends(slot, ends);
      for (const BodyId a : ends) {
        for (const BodyId b : ends) {
          if (a.serial < b.serial && a != ground && b != ground) pairs.emplace(a.serial, b.serial);
        }
      }
    }
  }
  std::erase_if(pairs, [&](const std::pair<Index, Index>& pair) {
    return system.is_contact_allowed({pair.first, system.token()}, {pair.second, system.token()})
        .value_or(false);
  });
  return pairs;
}

/// True if two bodies of two kinds can meet: not both by points, and not separate.
bool some_meet(const System& system, const Toucher& a, const Toucher& b, const Pairs& separate) {
  const auto meet = [&](Index one, Index other) {
    const std::pair<Index, Index> pair = std::minmax(one, other);
    if (one == other || separate.contains(pair)) return false;
    return system.is_contact_allowed({one, system.token()}, {other, system.token()}).value_or(true);
  };
  const auto any = [&](const std::vector<Index>& some, const std::vector<Index>& others) {
    return std::any_of(some.begin(), some.end(), [&](Index one) {
      return std::any_of(others.begin(), others.end(), [&](Index other) { return meet(one, other); });
    });
  };
  return any(a.extended, b.extended) || any(a.extended, b.points) || any(a.points, b.extended);
}

}  // namespace

std::optional<ModelFinding> bodies_without_law(const System& system, const SurfaceTable& surfaces,
                                               const Touching& touching) {
  if (system.obstacles().empty() && !any_touch(system, touching)) return std::nullopt;
  const std::vector<Toucher>& kinds = touching.kinds;
  std::vector<std::string> parts, told;
  std::optional<Pairs> separate;  // made where it is needed
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      const Toucher &a = kinds[i], &b = kinds[j];
      if (!can_touch(a, b) || system.law(a.material, b.material)) continue;
      if (!separate) separate = separate_pairs(system);
      if (!some_meet(system, a, b, *separate)) continue;
      parts.push_back(b.name + " and " + (i == j ? "another one of its material" : a.name));
      told.push_back(parts.back() + " (" + material_name(surfaces, b.material) +
                     (i == j ? "" : " and " + material_name(surfaces, a.material)) + ")");
    }
  }
  if (parts.empty()) return std::nullopt;
  std::string text =
      listed(told, 3) +
      ": there is no law between their materials, so that such bodies pass through each other; "
      "allowed: System::set_default_law(), a law between the two materials, or, where they are to "
      "pass, filters";
  return ModelFinding{FindingKind::contact_without_law, std::move(parts), std::move(text)};
}

}  // namespace carom

// Problem: find what a model describes in vain.

#include <carom/core/enum_name.h>
#include <carom/core/listed.h>
#include <carom/core/stored_parts.h>
#include <carom/core/touching_parts.h>

#include <algorithm>
#include <array>
#include <map>
#include <type_traits>
#include <utility>

namespace carom {

std::string_view to_string(FindingKind kind) {
  constexpr std::array<std::string_view, finding_kind_count> names{
      "law without effect",   "contact without a law", "touches nothing",    "untouched obstacle",
      "body without a shape", "kept without a joint",  "hidden by a filter", "open joint"};
  return enum_name(names, kind);
}

namespace {

using PartNames = std::vector<std::string>;

std::string listed(const PartNames& parts) { return carom::listed(parts, 3); }

/// Materials of shapes on ground.
std::vector<MaterialId> ground_materials(const System& system) {
  std::vector<MaterialId> all;
  for (const auto& entry : system.ground_shape_kinds().entries()) {
    for (Index slot = 0; slot < entry.serials.size(); ++slot) all.push_back(entry.kind->material(slot));
  }
  return all;
}

/// Bodies on which elements act or which joints bind, by serial number.
template <class K>
void mark_ends(const Registry<K>& parts, std::vector<char>& marked) {
  std::vector<BodyId> ends;
  for (const auto& entry : parts.entries()) {
    for (Index slot = 0; slot < entry.serials.size(); ++slot) {
      ends.clear();
      entry.kind->ends(slot, ends);
      for (const BodyId end : ends) {
        if (end.serial < marked.size()) marked[end.serial] = 1;
      }
    }
  }
}

void find_bodies_without_shape(const System& system, std::vector<ModelFinding>& out) {
  const auto& kinds = system.body_kinds().entries();
  const auto oriented = [](const auto& entry) {
    return entry.kind->has_orientation() && !entry.serials.empty();
  };
  if (std::none_of(kinds.begin(), kinds.end(), oriented)) return;
  std::vector<char> held(system.body_kinds().next_serial(), 0);
  for (const auto& entry : system.shape_kinds().entries()) {
    for (Index slot = 0; slot < entry.serials.size(); ++slot) held[entry.kind->body(slot).serial] = 1;
  }
  mark_ends(system.force_kinds(), held);
  mark_ends(system.joint_kinds(), held);
  PartNames bare;
  for (const auto& entry : system.body_kinds().entries()) {
    if (!entry.kind->has_orientation()) continue;
    for (Index slot = 0; slot < entry.serials.size(); ++slot) {
      if (held[entry.serials[slot]] == 0)
        bare.push_back(system.name(BodyId{entry.serials[slot], system.token()}));
    }
  }
  if (bare.empty()) return;
  std::string text = listed(bare) + ": there is no shape, so that no obstacle is touched";
  out.push_back({FindingKind::body_without_shape, std::move(bare), std::move(text)});
}

ContactFilter filter_of(const System& system, ObstacleId obstacle) {
  const auto place = system.ground_shape_kinds().place(obstacle.serial);
  return system.ground_shape_kinds().entries()[place.entry].kind->filter(place.slot);
}

/// Finds parts whose filters leave them nothing to touch: shapes, particles made to touch something (with a
/// material or a filter), obstacles.
void find_hidden(const System& system, const Touching& touching, std::vector<ModelFinding>& out) {
  std::vector<ContactFilter> solid;
  for (const ObstacleId obstacle : system.obstacles()) solid.push_back(filter_of(system, obstacle));
  const auto is_hidden = [&](const Toucher& toucher) {
    const auto meets_solid = [&](const ContactFilter& other) { return may_touch(toucher.filter, other); };
    const auto meets_body = [&](const Toucher& other) {
      return can_touch(toucher, other) && system.law(toucher.material, other.material);
    };
    return std::none_of(solid.begin(), solid.end(), meets_solid) &&
           std::none_of(touching.kinds.begin(), touching.kinds.end(), meets_body);
  };
  // Most models have few kinds: parts are looked at where one of these is hidden only.
  std::vector<const Toucher*> all_hidden;
  for (const Toucher& toucher : touching.kinds) {
    if (is_hidden(toucher)) all_hidden.push_back(&toucher);
  }
  const auto hidden = [&](MaterialId material, const ContactFilter& filter) {
    return std::any_of(all_hidden.begin(), all_hidden.end(), [&](const Toucher* toucher) {
      return toucher->material == material && toucher->filter == filter;
    });
  };
  PartNames parts;
  if (!all_hidden.empty()) {
    for (const auto& entry : system.body_kinds().entries()) {
      for (Index slot = 0; slot < entry.serials.size(); ++slot) {
        const ContactFilter filter = entry.kind->filter(slot);
        const bool intended = entry.kind->material(slot).valid() || filter != ContactFilter{};
        if (!entry.kind->has_contact_point(slot) || !intended) continue;
        if (!hidden(entry.kind->material(slot), filter)) continue;
        parts.push_back(system.name(BodyId{entry.serials[slot], system.token()}));
      }
    }
    for (const auto& entry : system.shape_kinds().entries()) {
      for (Index slot = 0; slot < entry.serials.size(); ++slot) {
        if (!hidden(entry.kind->material(slot), entry.kind->filter(slot))) continue;
        parts.push_back(system.name(ShapeId{entry.serials[slot], system.token()}));
      }
    }
  }
  if (!parts.empty()) {
    std::string text = listed(parts) +
                       ": filters let it touch no obstacle; allowed: groups and touches that meet "
                       "those of an obstacle";
    out.push_back({FindingKind::hidden_by_filter, std::move(parts), std::move(text)});
  }
  PartNames obstacles;
  for (const ObstacleId obstacle : system.obstacles()) {
    const ContactFilter filter = filter_of(system, obstacle);
    const auto touches = [&](const Toucher& toucher) { return may_touch(toucher.filter, filter); };
    if (std::none_of(touching.kinds.begin(), touching.kinds.end(), touches))
      obstacles.push_back(system.name(obstacle));
  }
  if (obstacles.empty() || !touching.any) return;
  std::string text = listed(obstacles) +
                     ": filters let nothing touch it; allowed: groups and touches that meet those "
                     "of a shape or a particle";
  out.push_back({FindingKind::hidden_by_filter, std::move(obstacles), std::move(text)});
}

void find_contacts_without_law(const System& system, const SurfaceTable& surfaces, const Touching& touching,
                               std::vector<ModelFinding>& out) {
  for (const ObstacleId obstacle : system.obstacles()) {
    const auto place = system.ground_shape_kinds().place(obstacle.serial);
    const MaterialId material = system.ground_shape_kinds().entries()[place.entry].kind->material(place.slot);
    for (const Toucher& toucher : touching.kinds) {
      const bool may = may_touch(toucher.filter, filter_of(system, obstacle));
      if (!may || system.law(toucher.material, obstacle)) continue;
      const std::string name = system.name(obstacle);
      std::string text = "contact of " + toucher.name + toucher.of_body + " on " + name +
                         ": law is not given between " + material_name(surfaces, toucher.material) + " and " +
                         material_name(surfaces, material) +
                         "; allowed: a Surface on the obstacle, between the two materials or as default law";
      out.push_back({FindingKind::contact_without_law, {toucher.name, name}, std::move(text)});
    }
  }
}

}  // namespace

std::vector<ModelFinding> System::check() const {
  std::vector<ModelFinding> found;
  const Touching touching = touching_parts(*this);
  const std::vector<MaterialId> solid = ground_materials(*this);
  const auto is_solid = [&](MaterialId material) {
    return std::find(solid.begin(), solid.end(), material) != solid.end();
  };
  for (const auto& [pair, law] : stored().surfaces.pairs()) {
    const MaterialId a{pair.first, token_}, b{pair.second, token_};
    if ((is_solid(a) && has(touching, b)) || (is_solid(b) && has(touching, a))) continue;
    if (can_touch(touching, a, b)) continue;
    const std::string &given_a = stored().surfaces.name(a.serial),
                      &given_b = stored().surfaces.name(b.serial);
    const std::string name_a = "'" + given_a + "'", name_b = "'" + given_b + "'";
    std::string text = "surface between " + name_a + " and " + name_b + ": ";
    if (!is_solid(a) && !is_solid(b)) {
      text += "no obstacle is of " + name_a + (a == b ? "" : " or " + name_b) +
              ", and no two bodies that can touch each other are";
    } else {
      const bool solid_a = is_solid(a);
      text += "an obstacle is of " + (solid_a ? name_a : name_b) + ", but nothing that can touch it is of " +
              (solid_a ? name_b : name_a);
    }
    found.push_back({FindingKind::law_without_effect, {given_a, given_b}, text});
  }
  if (auto pairs = bodies_without_law(*this, stored().surfaces, touching)) found.push_back(*std::move(pairs));
  if (solid.empty()) {
    if (!touching.intended.empty() && !any_touch(*this, touching)) {
      std::string text = listed(touching.intended) +
                         ": there is no obstacle to touch, and no law by which bodies touch each other";
      found.push_back({FindingKind::touches_nothing, touching.intended, std::move(text)});
    }
  } else {
    find_contacts_without_law(*this, stored().surfaces, touching, found);
    find_hidden(*this, touching, found);
    if (!touching.any) {
      PartNames untouched;
      for (const ObstacleId obstacle : obstacles()) untouched.push_back(name(obstacle));
      std::string text = listed(untouched) + ": no body has a shape or touches as a particle";
      found.push_back({FindingKind::untouched_obstacle, std::move(untouched), std::move(text)});
    }
    find_bodies_without_shape(*this, found);
  }
  if (!stored().kept.empty()) {
    std::vector<char> bound(stored().bodies.next_serial(), 0);
    mark_ends(stored().joints, bound);
    PartNames kept;
    for (const Index serial : stored().kept) {
      if (bound[serial] == 0) kept.push_back(name(BodyId{serial, token_}));
    }
    if (!kept.empty()) {
      std::string text = listed(kept) + ": no joint binds it, so that keep_place() has no effect";
      found.push_back({FindingKind::keep_without_joint, std::move(kept), std::move(text)});
    }
  }
  return found;
}

}  // namespace carom

// Problem: what may touch what, and by which law.

#include <carom/contact/detection/outline_laws.h>
#include <carom/contact/detection/touching_kinds.h>

#include <algorithm>

namespace carom {

namespace {

/// Materials of shapes of bodies, and of particles that touch.
std::vector<MaterialId> materials_of_bodies(const System& system) {
  std::vector<MaterialId> all;
  const auto add = [&](MaterialId material) {
    if (std::find(all.begin(), all.end(), material) == all.end()) all.push_back(material);
  };
  for (const auto& entry : system.shape_kinds().entries()) {
    for (Index slot = 0; slot < entry.serials.size(); ++slot) add(entry.kind->material(slot));
  }
  if (all.empty()) return all;  // points do not touch points
  for (const auto& entry : system.body_kinds().entries()) {
    for (Index slot = 0; slot < entry.serials.size(); ++slot) {
      if (entry.kind->has_contact_point(slot)) add(entry.kind->material(slot));
    }
  }
  return all;
}

}  // namespace

bool has_law_between_bodies(const System& system) {
  const std::vector<MaterialId> materials = materials_of_bodies(system);
  for (const MaterialId a : materials) {
    for (const MaterialId b : materials) {
      if (system.law(a, b)) return true;
    }
  }
  return false;
}

OutlineLaws::OutlineLaws(const Assembly& assembly, const BodyOutlines& bodies, const GroundShapes& shapes,
                         bool between_bodies)
    : materials_(static_cast<Index>(bodies.materials().size())), surfaces_(materials_ + shapes.size()) {
  const System& system = assembly.system();
  for (const MaterialId a : bodies.materials()) {
    for (const MaterialId b : bodies.materials()) {
      laws_.push_back(between_bodies ? system.law(a, b) : std::nullopt);
    }
    for (Index shape = 0; shape < shapes.size(); ++shape) {
      laws_.push_back(shapes.has_pieces(shape) ? system.law(a, shapes.id(shape)) : std::nullopt);
    }
  }
  if (!between_bodies) return;
  filter_ = PairFilter(assembly);
  const auto by_kind = [this](const BodyOutline& a, const BodyOutline& b) { return kinds_may_touch(a, b); };
  const TouchingKinds kinds = touching_kinds(bodies.list(), filter_, by_kind);
  bodies_touch_ = kinds.any;
  all_may_touch_ = kinds.all;
  for (Index a = 0; bodies_touch_ && a < materials_; ++a) {
    for (Index b = 0; b < materials_; ++b) {
      if (const Surface* const law = at(a, b)) facts_.add(*law);
    }
  }
  if (!bodies_touch_) filter_ = {};
}

}  // namespace carom

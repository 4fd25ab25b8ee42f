// Problem: what may touch what, and by which law.

#include <carom/contact/detection/body_materials.h>
#include <carom/contact/detection/contact_laws.h>
#include <carom/contact/detection/touching_kinds.h>

namespace carom {

bool has_law_between_bodies(const System& system) {
  if (system.shape_kinds().serials().empty()) return false;  // points do not touch points
  const std::vector<MaterialId> materials = body_materials(system);
  for (const MaterialId a : materials) {
    for (const MaterialId b : materials) {
      if (system.law(a, b)) return true;
    }
  }
  return false;
}

ContactLaws::ContactLaws(const Assembly& assembly, const BodyOutlines& bodies, const GroundShapes& shapes,
                         bool between_bodies) {
  const System& system = assembly.system();
  const std::vector<MaterialId> materials = body_materials(system);
  if (between_bodies) with_bodies_ = static_cast<Index>(materials.size());
  surfaces_ = with_bodies_ + shapes.size();
  for (Index a = 0; a < materials.size(); ++a) {
    for (Index b = 0; b < with_bodies_; ++b)
      laws_.push_back(b < a ? std::nullopt : system.law(materials[a], materials[b]));
    for (Index shape = 0; shape < shapes.size(); ++shape)
      laws_.push_back(system.law(materials[a], shapes.id(shape)));
  }
  if (!between_bodies) return;
  filter_ = PairFilter(assembly);
  const auto by_kind = [this](const BodyOutline& a, const BodyOutline& b) { return kinds_may_touch(a, b); };
  const TouchingKinds kinds = touching_kinds(bodies.list(), filter_, by_kind);
  bodies_touch_ = kinds.any;
  all_may_touch_ = kinds.all;
  for (Index a = 0; bodies_touch_ && a < with_bodies_; ++a) {
    for (Index b = 0; b < with_bodies_; ++b) {
      if (const Index law = between(a, b); law != none) facts_.add((*this)[law]);
    }
  }
  if (!bodies_touch_) filter_ = {};
}

}  // namespace carom

// Problem: what may the features of bodies touch on ground? Each of them must have a law with it.

#include <carom/contact/detection/body_features.h>
#include <carom/contact/detection/body_materials.h>
#include <carom/contact/detection/contact_laws.h>
#include <carom/contact/detection/contact_name.h>
#include <carom/contact/detection/ground_shapes.h>
#include <carom/contact/detection/touched_ground.h>

#include <algorithm>
#include <string>
#include <vector>

namespace carom {

namespace {

/// Text of System::check() on the first contact with a shape on ground that has no law: parts and materials.
std::string missing_law(const System& system, ObstacleId obstacle) {
  const std::vector<ModelFinding> found = system.check();
  const std::string name = system.name(obstacle);
  const auto missing = std::find_if(found.begin(), found.end(), [&](const ModelFinding& finding) {
    return finding.kind == FindingKind::contact_without_law && finding.parts.back() == name;
  });
  return missing == found.end() ? name + ": law is not given" : missing->text;
}

}  // namespace

TouchedGround::TouchedGround(const Assembly& assembly, const BodyFeatures& features,
                             const GroundShapes& shapes, const ContactLaws& laws) {
  const System& system = assembly.system();
  const std::vector<MaterialId> materials = body_materials(system);
  begin_.push_back(0);
  for (Index material = 0; material < features.materials().size(); ++material) {
    const FeatureMaterial& of = features.materials()[material];
    const Index number = number_of(of.material, materials);
    for (Index shape = 0; shape < shapes.size(); ++shape) {
      if (!may_touch(of.filter, shapes.filter(shape))) continue;
      const Index which = laws.with_ground(number, shape);
      if (which == none) throw ModelError(missing_law(system, shapes.id(shape)));
      const Surface& law = laws[which];
      if (system.dimension() == 3 && (law.has_other_impact_law() || law.resists_rolling())) {
        const ConstraintKey key{features.first_of(material, *assembly.layout()), shapes.key(shape)};
        throw ModelError("contact of " + contact_name(system, key) + ": impact_law is " +
                         std::string(to_string(law.impact_law)) + " and rolling_resistance " +
                         to_text(law.rolling_resistance) + " m; allowed in space: newton and 0");
      }
      if (!shapes.has_pieces(shape)) touched_.push_back({shape, which});
      facts_.add(law);
    }
    begin_.push_back(static_cast<Index>(touched_.size()));
  }
}

}  // namespace carom

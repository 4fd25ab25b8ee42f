// Problem: which contacts that are open may have been opened by turning.

#include <carom/contact/detection/detector.h>

#include <algorithm>
#include <cmath>

namespace carom {

void Detector::remember(std::span<const std::pair<ConstraintKey, ContactMode>> contacts, double step,
                        LastingContacts& out) const {
  out.start(step);
  const Layout& layout = *assembly_->layout();
  const Index token = assembly_->system().token();
  for (const auto& entry : contacts) {
    const ConstraintKey& key = entry.first;
    if (key.a.owner != FeatureKey::Owner::body) {
      out.add(key);
      continue;
    }
    // A centre of mass has no arm: an obstacle that turns can alone open such a contact.
    if (moving_ == 0) continue;
    const auto obstacle = std::find_if(obstacles_.begin(), obstacles_.end(),
                                       [&key](const Obstacle& at) { return at.serial == key.b.serial; });
    const BodyId body{key.a.serial, token};
    if (obstacle == obstacles_.end() || obstacle->moving == none || !layout.contains(body)) continue;
    out.add(key, layout.index(body));
  }
  out.finish();
}

bool Detector::lasts(const Query& query, const ConstraintKey& key, double gap, double turning) {
  return gap <= query.lasting->reach(turning) && query.lasting->contains(key);
}

/// Of the drift in docs/method.md, section 1, without the acceleration of the place that is touched, which
/// its velocity at the end of the step has in it already. \param above distance of the feature's centre
double Detector::turning_of(const BodySlot& body, const Vec<2>& arm, const StateView& state,
                            const GroundMotion& motion, double above) {
  const double w = std::abs(motion.spin);
  Vec<2> relative =
      Eigen::Map<const Vec<2>>(state.v + body.v) - Vec<2>(motion.velocity[0], motion.velocity[1]);
  if (body.rotation != none) relative += Space<2>::lever_velocity(state.v + body.v + 2, arm);
  return 2.0 * w * (relative.lpNorm<1>() + w * std::abs(above));
}

}  // namespace carom

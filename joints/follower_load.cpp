#include <carom/joints/follower_load.h>

namespace carom::planar {

namespace {

Vec<2> turned_force(const FollowerLoad& load, const ElementView<2>& at) {
  const double* rotation = at.context().evaluation.rotation.data() + at.oriented(load.on.body).rotation;
  return Space<2>::rotate(rotation, load.force(at.time()));
}

}  // namespace

std::vector<BodyId> FollowerLoad::bodies() const { return {on.body}; }

void FollowerLoad::check(const PartCheck& check) const {
  check.oriented_body(on.body, "on");
  check_end(check, on, "on");
  if (!force) check.refuse("force", "not given", "a function of time");
  const Vec<2> start = force(0.0);
  check.finite({start.data(), 2}, "force at time 0", "N");
}

void FollowerLoad::loads(const ElementView<2>& at, ElementLoads<2>& out) const {
  out.external(on, turned_force(*this, at));
}

void FollowerLoad::derivatives(const ElementView<2>& at, ElementDerivatives<2>& out) const {
  const Vec<2> now = turned_force(*this, at);
  const Index v = at.oriented(on.body).v;
  out.entry(v, v + 2, -now[1], 0.0);
  out.entry(v + 1, v + 2, now[0], 0.0);
}

void FollowerLoad::fingerprint(Fingerprint& print) const { add_to(print, on); }

PartType<ForceKind> FollowerLoad::part_type() {
  return PartType<ForceKind>::of<ForceElementKind<FollowerLoad>, FollowerLoad>();
}

}  // namespace carom::planar

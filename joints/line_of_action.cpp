#include <carom/core/registry.h>
#include <carom/joints/line_of_action.h>

namespace carom {

DescribedStart::DescribedStart(const System& system, BodyId body) {
  const Registry<BodyKind>& registry = system.body_kinds();
  const BodyKind& kind = registry.kind_of(body.serial);
  q.resize(kind.q_size());
  v.resize(kind.v_size());
  kind.initial(registry.place(body.serial).slot, q.data(), v.data());
}

namespace planar {

RelativeAngle::RelativeAngle(const ElementView<2>& at, BodyId from, BodyId to) {
  if (to != ground) {
    angle = at.angle(to);
    rate = at.spin(to);
  }
  if (from != ground) {
    angle -= at.angle(from);
    rate -= at.spin(from);
  }
}

RelativeAngle::RelativeAngle(const System& system, BodyId from, BodyId to) {
  const auto add = [&](BodyId body, double sign) {
    if (body == ground) return;
    const DescribedStart start(system, body);
    angle += sign * start.q[2];
    rate += sign * start.v[2];
  };
  add(to, 1.0);
  add(from, -1.0);
}

void check_angular_ends(const PartCheck& check, BodyId from, BodyId to) {
  if (from != ground) check.oriented_body(from, "from");
  if (to != ground) check.oriented_body(to, "to");
  check.different_ends(from, to);
}

}  // namespace planar

}  // namespace carom

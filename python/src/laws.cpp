// Planar force elements with functions of the user.

#include "bind.h"
#include "element_fields.h"

#include <carom/joints/driver.h>
#include <carom/joints/follower_load.h>

namespace carom_python {

void bind_laws(nb::module_& planar) {
  using namespace carom::planar;
  bind_element_laws<2>(planar);
  bind_part<RotaryActuator>(planar, "RotaryActuator", {"RotaryActuator"}, [](auto& fields) {
    using P = RotaryActuator;
    fields("from", &P::from, required)("to", &P::to, required)("torque", &P::torque, required)(
        "torque_by_angle", &P::torque_by_angle)("torque_by_rate", &P::torque_by_rate)("breaks", &P::breaks);
  });
  bind_part<AppliedTorque>(planar, "AppliedTorque", {"AppliedTorque"}, [](auto& fields) {
    using P = AppliedTorque;
    fields("on", &P::on, required)("torque", &P::torque, required)("breaks", &P::breaks);
  });
  bind_part<FollowerLoad>(planar, "FollowerLoad", {"FollowerLoad"}, [](auto& fields) {
    using P = FollowerLoad;
    fields("on", &P::on, required)("force", &P::force, required)("breaks", &P::breaks);
  });
  bind_part<Motor>(planar, "Motor", {"Motor"}, [](auto& fields) {
    fields("joint", &Motor::joint, required)("torque", &Motor::torque, required)("breaks", &Motor::breaks);
  });
}

}  // namespace carom_python

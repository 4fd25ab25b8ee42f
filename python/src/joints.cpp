// Planar joints, and what acts on their coordinates.

#include "bind.h"
#include "parts.h"

#include <carom/joints/driver.h>
#include <carom/joints/joint.h>
#include <carom/joints/joint_friction.h>
#include <carom/joints/prismatic.h>
#include <carom/joints/revolute.h>
#include <carom/joints/rod.h>

namespace carom_python {

using namespace carom::planar;

namespace {

void bind_on_coordinates(nb::module_& planar) {
  bind_part<Driver>(planar, "Driver", {"Driver"}, [](auto& fields) {
    fields("joint", &Driver::joint, required)("position", &Driver::position, required)(
        "velocity", &Driver::velocity)("acceleration", &Driver::acceleration)("breaks", &Driver::breaks);
  });
  bind_part<Stop>(planar, "Stop", {"Stop"}, [](auto& fields) {
    fields("joint", &Stop::joint, required)("lower", &Stop::lower)("upper", &Stop::upper)("restitution",
                                                                                          &Stop::restitution);
  });
  bind_part<JointFriction>(planar, "JointFriction", {"JointFriction"}, [](auto& fields) {
    using P = JointFriction;
    fields("joint", &P::joint, required)("bound", &P::bound)("coefficient", &P::coefficient)(
        "static_factor", &P::static_factor);
  });
}

}  // namespace

void bind_joints(nb::module_& planar) {
  bind_part<Revolute>(planar, "Revolute", {"Revolute"}, [](auto& fields) {
    fields("from", &Revolute::from, required)("to", &Revolute::to, required)("zero_angle",
                                                                             &Revolute::zero_angle);
  });
  bind_part<Weld>(planar, "Weld", {"Weld"}, [](auto& fields) {
    fields("from", &Weld::from, required)("to", &Weld::to, required)("angle", &Weld::angle);
  });
  bind_part<Prismatic>(planar, "Prismatic", {"Prismatic"}, [](auto& fields) {
    using P = Prismatic;
    fields("from", &P::from, required)("to", &P::to, required)("axis", &P::axis, required)(
        "angle", &P::angle)("zero_distance", &P::zero_distance);
  });
  bind_part<PointOnLine>(planar, "PointOnLine", {"PointOnLine"}, [](auto& fields) {
    using P = PointOnLine;
    fields("from", &P::from, required)("to", &P::to, required)("axis", &P::axis, required)("zero_distance",
                                                                                           &P::zero_distance);
  });
  bind_part<Rolling>(planar, "Rolling", {"Rolling"}, [](auto& fields) {
    using P = Rolling;
    fields("from", &P::from, required)("to", &P::to, required)("normal", &P::normal, required)(
        "radius", &P::radius, required);
  });
  bind_part<Rod>(planar, "Rod", {"Rod"}, [](auto& fields) {
    fields("from", &Rod::from, required)("to", &Rod::to, required)("length", &Rod::length);
  });
  bind_part<Gear>(planar, "Gear", {"Gear"}, [](auto& fields) {
    fields("from", &Gear::from, required)("to", &Gear::to, required)("ratio", &Gear::ratio, required)(
        "carrier", &Gear::carrier);
  });
  bind_on_coordinates(planar);
}

}  // namespace carom_python

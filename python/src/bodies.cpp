// Planar bodies and their shapes.

#include "bind.h"
#include "parts.h"

#include <carom/bodies/particle.h>
#include <carom/bodies/rigid_body.h>
#include <carom/bodies/shape_disc.h>
#include <carom/bodies/shape_point.h>
#include <carom/bodies/shape_polygon.h>
#include <carom/bodies/shape_segment.h>

namespace carom_python {

using namespace carom::planar;

void bind_bodies(nb::module_& planar) {
  bind_part<Particle>(planar, "Particle", {"Particle"}, [](auto& fields) {
    fields("mass", &Particle::mass, required)("position", &Particle::position)(
        "velocity", &Particle::velocity)("contact", &Particle::contact)("material", &Particle::material)(
        "filter", &Particle::filter);
  });
  bind_part<RigidBody>(planar, "RigidBody", {"RigidBody"}, [](auto& fields) {
    fields("mass", &RigidBody::mass, required)("position", &RigidBody::position)("angle", &RigidBody::angle)(
        "velocity", &RigidBody::velocity)("spin", &RigidBody::spin);
  });
  bind_part<Disc>(planar, "Disc", {"Disc"}, [](auto& fields) {
    fields("body", &Disc::body, required)("radius", &Disc::radius, required)("centre", &Disc::centre)(
        "material", &Disc::material)("filter", &Disc::filter);
  });
  bind_part<Point>(planar, "Point", {"Point"}, [](auto& fields) {
    fields("body", &Point::body, required)("position", &Point::position)("material", &Point::material)(
        "filter", &Point::filter);
  });
  bind_part<Polygon>(planar, "Polygon", {"Polygon"}, [](auto& fields) {
    fields("body", &Polygon::body, required)("vertices", &Polygon::vertices, required)(
        "material", &Polygon::material)("radius", &Polygon::radius)("filter", &Polygon::filter);
  });
  bind_part<Segment>(planar, "Segment", {"Segment"}, [](auto& fields) {
    fields("body", &Segment::body, required)("from", &Segment::from, required)("to", &Segment::to, required)(
        "material", &Segment::material)("radius", &Segment::radius)("filter", &Segment::filter);
  });
}

}  // namespace carom_python

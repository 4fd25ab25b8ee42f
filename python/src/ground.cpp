// Planar shapes on ground, and usual ones made by functions.

#include "bind.h"
#include "parts.h"

#include <carom/contact/detection/ground_builders.h>
#include <carom/contact/detection/ground_parts.h>
#include <carom/contact/detection/half_space.h>

namespace carom_python {

using namespace carom::planar;

namespace {

// Fields that all have but the half-plane.
template <class P>
void add_common(Fields<P>& fields) {
  fields("material", &P::material)("surface_speed", &P::surface_speed)("pivot", &P::pivot)(
      "motion", &P::motion)("filter", &P::filter);
}

void bind_builders(nb::module_& planar) {
  planar.def(
      "stairs",
      [](nb::handle start, int steps, double tread, double rise) {
        return stairs(read<carom::Vec<2>>(start, "stairs(): start"), steps, tread, rise);
      },
      nb::arg("start"), nb::arg("steps"), nb::arg("tread"), nb::arg("rise"),
      nb::sig("def stairs(start: numpy.typing.ArrayLike, steps: int, tread: float, rise: float) -> Terrain"),
      doc("stairs"));
  planar.def(
      "hopper",
      [](nb::handle centre, double outlet, double width, double height, double radius) {
        const auto walls =
            hopper(read<carom::Vec<2>>(centre, "hopper(): centre"), outlet, width, height, radius);
        return nb::make_tuple(walls[0], walls[1]);
      },
      nb::arg("centre"), nb::arg("outlet"), nb::arg("width"), nb::arg("height"), nb::arg("radius"),
      nb::sig(
          "def hopper(centre: numpy.typing.ArrayLike, outlet: float, width: float, height: float, radius: "
          "float) -> tuple[Wall, Wall]"),
      doc("hopper"));
  planar.def(
      "drum",
      [](nb::handle centre, double radius, double spin) {
        CircleInside made = drum(read<carom::Vec<2>>(centre, "drum(): centre"), radius, spin);
        if (spin == 0.0) return made;
        // The same functions by numbers, so that they can be read and written.
        made.motion.angle = NumberLaw<double, double>{Law<double>{.polynomial = {0.0, spin}}};
        made.motion.spin = NumberLaw<double, double>{Law<double>{.polynomial = {spin}}};
        made.motion.angular_acceleration = NumberLaw<double, double>{Law<double>{.polynomial = {0.0}}};
        return made;
      },
      nb::arg("centre"), nb::arg("radius"), nb::arg("spin"),
      nb::sig("def drum(centre: numpy.typing.ArrayLike, radius: float, spin: float) -> CircleInside"),
      doc("drum"));
  planar.def(
      "open_box",
      [](nb::handle floor, double width, double height, double thickness) {
        return open_box(read<carom::Vec<2>>(floor, "open_box(): floor"), width, height, thickness);
      },
      nb::arg("floor"), nb::arg("width"), nb::arg("height"), nb::arg("thickness"),
      nb::sig("def open_box(floor: numpy.typing.ArrayLike, width: float, height: float, thickness: float) -> "
              "Terrain"),
      doc("open_box"));
}

}  // namespace

void bind_ground(nb::module_& planar) {
  bind_part<HalfPlane>(planar, "HalfPlane", {"HalfSpace"}, [](auto& fields) {
    using P = HalfPlane;
    fields("point", &P::point)("normal", &P::normal, required)("material", &P::material)(
        "motion", &P::motion)("surface_speed", &P::surface_speed)("filter", &P::filter);
  });
  bind_part<Terrain>(planar, "Terrain", {"Terrain"}, [](auto& fields) {
    fields("vertices", &Terrain::vertices, required)("depth", &Terrain::depth, required)("is_closed",
                                                                                         &Terrain::is_closed);
    add_common(fields);
  });
  bind_part<BoxInside>(planar, "BoxInside", {"BoxInside"}, [](auto& fields) {
    fields("lower", &BoxInside::lower, required)("upper", &BoxInside::upper, required);
    add_common(fields);
  });
  bind_part<CircleInside>(planar, "CircleInside", {"CircleInside"}, [](auto& fields) {
    fields("centre", &CircleInside::centre)("radius", &CircleInside::radius, required);
    add_common(fields);
  });
  bind_part<Wall>(planar, "Wall", {"Wall"}, [](auto& fields) {
    fields("from", &Wall::from, required)("to", &Wall::to, required)("radius", &Wall::radius, required);
    add_common(fields);
  });
  bind_part<Block>(planar, "Block", {"Block"}, [](auto& fields) {
    fields("vertices", &Block::vertices, required)("radius", &Block::radius);
    add_common(fields);
  });
  bind_part<Peg>(planar, "Peg", {"Peg"}, [](auto& fields) {
    fields("centre", &Peg::centre)("radius", &Peg::radius, required);
    add_common(fields);
  });
  bind_builders(planar);
}

}  // namespace carom_python

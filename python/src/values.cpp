// Values that parts are made of: mass properties, filters, surfaces, motions.

#include "bind.h"
#include "types.h"

#include <carom/contact/detection/ground_builders.h>
#include <carom/contact/detection/half_space.h>

#include <vector>

namespace carom_python {

using namespace carom;

namespace {

using Mass = MassProperties<2>;

void define(nb::module_& planar, const char* name, Mass (*make)(double, double), const char* size) {
  const std::string signature =
      "def " + std::string(name) + "(mass: float, " + size + ": float) -> MassProperties";
  planar.def(
      name,
      [make, where = std::string(name) + "(): ", size = std::string(size)](nb::handle mass,
                                                                           nb::handle length) {
        const auto m = read<double>(mass, where + "mass");
        return make(m, read<double>(length, where + size));
      },
      nb::arg("mass"), nb::arg(size), nb::sig(signature.c_str()), doc(name));
}

void bind_masses(nb::module_& planar) {
  bind_record<Mass>(planar, "MassProperties", {"MassProperties"}, true, [](auto& fields) {
    fields("mass", &Mass::mass, required)("inertia", &Mass::inertia, required)("centre", &Mass::centre);
  });
  define(planar, "disc", &planar::disc, "radius");
  define(planar, "ring", &planar::ring, "radius");
  define(planar, "solid_sphere", &planar::solid_sphere, "radius");
  define(planar, "thin_shell", &planar::thin_shell, "radius");
  define(planar, "rod", &planar::rod, "length");
  planar.def("box", &planar::box, nb::arg("mass"), nb::arg("width"), nb::arg("height"), doc("box"));
  planar.def(
      "polygon",
      [](double mass, nb::handle vertices) {
        return planar::polygon(mass, read<std::vector<Vec<2>>>(vertices, "polygon(): vertices"));
      },
      nb::arg("mass"), nb::arg("vertices"),
      nb::sig("def polygon(mass: float, vertices: collections.abc.Sequence[numpy.typing.ArrayLike]) -> "
              "MassProperties"),
      doc("polygon"));
  planar.def("point_mass", &planar::point_mass, nb::arg("mass"), doc("point_mass"));
  planar.def(
      "compose",
      [](nb::handle parts) {
        const auto given = read<std::vector<Mass>>(parts, "compose(): parts");
        return planar::compose(std::span<const Mass>(given));
      },
      nb::arg("parts"),
      nb::sig("def compose(parts: collections.abc.Sequence[MassProperties]) -> MassProperties"),
      doc("compose"));
  planar.def(
      "shifted",
      [](const Mass& properties, nb::handle offset) {
        return planar::shifted(properties, read<Vec<2>>(offset, "shifted(): offset"));
      },
      nb::arg("properties"), nb::arg("offset"),
      nb::sig("def shifted(properties: MassProperties, offset: numpy.typing.ArrayLike) -> MassProperties"),
      doc("shifted"));
  planar.def("centred", &planar::centred, nb::arg("properties"), doc("centred"));
  planar.def(
      "inertia_about",
      [](const Mass& properties, nb::handle point) {
        return planar::inertia_about(properties, read<Vec<2>>(point, "inertia_about(): point"));
      },
      nb::arg("properties"), nb::arg("point"),
      nb::sig("def inertia_about(properties: MassProperties, point: numpy.typing.ArrayLike) -> float"),
      doc("inertia_about"));
  planar.def(
      "incline", [](double slope) { return Convert<Vec<2>>::cast(planar::incline(slope)); }, nb::arg("slope"),
      nb::sig("def incline(slope: float) -> numpy.typing.NDArray[numpy.float64]"), doc("incline"));
}

}  // namespace

void bind_values(nb::module_& core, nb::module_& planar) {
  bind_record<ContactFilter>(core, "ContactFilter", {"ContactFilter"}, true, [](auto& fields) {
    fields("groups", &ContactFilter::groups)("touches", &ContactFilter::touches);
  });
  bind_record<Surface>(core, "Surface", {"Surface"}, true, [](auto& fields) {
    fields("friction", &Surface::friction, required)("normal_restitution", &Surface::normal_restitution,
                                                     required)("tangential_restitution",
                                                               &Surface::tangential_restitution)(
        "static_friction", &Surface::static_friction)("stribeck_speed", &Surface::stribeck_speed)(
        "impact_law", &Surface::impact_law)("rolling_resistance", &Surface::rolling_resistance)(
        "rolling_restitution", &Surface::rolling_restitution);
  });
  bind_masses(planar);
  bind_laws_by_numbers<double>(core, "");
  bind_laws_by_numbers<Vec<2>>(planar, "Vector");
  bind_record<planar::PrescribedMotion>(
      planar, "PrescribedMotion", {"PrescribedMotion"}, true, [](auto& fields) {
        using Motion = planar::PrescribedMotion;
        fields("displacement", &Motion::displacement)("velocity", &Motion::velocity)(
            "acceleration", &Motion::acceleration)("angle", &Motion::angle)("spin", &Motion::spin)(
            "angular_acceleration", &Motion::angular_acceleration)("breaks", &Motion::breaks);
      });
}

}  // namespace carom_python

// Parts in space.

#include "bind.h"
#include "element_fields.h"
#include "types.h"

#include <carom/bodies/particle.h>
#include <carom/contact/detection/half_space.h>

namespace carom_python {

void bind_spatial(nb::module_& spatial) {
  using namespace carom::spatial;
  bind_part<Particle>(spatial, "Particle", {"Particle"}, [](auto& fields) {
    fields("mass", &Particle::mass, required)("position", &Particle::position)(
        "velocity", &Particle::velocity)("contact", &Particle::contact)("material", &Particle::material)(
        "filter", &Particle::filter);
  });
  bind_laws_by_numbers<carom::Vec<3>>(spatial, "Vector");
  bind_springs<3>(spatial);
  bind_element_laws<3>(spatial);
  bind_part<HalfSpace>(spatial, "HalfSpace", {"HalfSpace"}, [](auto& fields) {
    using P = HalfSpace;
    fields("point", &P::point)("normal", &P::normal, required)("material", &P::material)("filter",
                                                                                         &P::filter);
  });
}

}  // namespace carom_python

// Planar force elements without functions of the user.

#include "bind.h"
#include "element_fields.h"

#include <carom/joints/bushing.h>
#include <carom/joints/torsional_spring.h>

namespace carom_python {

void bind_elements(nb::module_& planar) {
  using namespace carom::planar;
  bind_springs<2>(planar);
  bind_part<TorsionalSpring>(planar, "TorsionalSpring", {"TorsionalSpring"}, [](auto& fields) {
    using P = TorsionalSpring;
    fields("from", &P::from, required)("to", &P::to, required)("stiffness", &P::stiffness)(
        "damping", &P::damping)("free_angle", &P::free_angle);
  });
  bind_part<Bushing>(planar, "Bushing", {"Bushing"}, [](auto& fields) {
    using P = Bushing;
    fields("from", &P::from, required)("to", &P::to, required)("stiffness", &P::stiffness)(
        "damping", &P::damping)("rest", &P::rest);
  });
}

}  // namespace carom_python

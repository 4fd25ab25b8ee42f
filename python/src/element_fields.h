#pragma once

// Fields of force elements that exist in the plane and in space.

#include "parts.h"

#include <carom/joints/actuator.h>
#include <carom/joints/applied_load.h>
#include <carom/joints/drag.h>
#include <carom/joints/gravity.h>
#include <carom/joints/maxwell.h>
#include <carom/joints/nonlinear_spring.h>
#include <carom/joints/one_sided_spring.h>
#include <carom/joints/spring_damper.h>

namespace carom_python {

template <int D>
void bind_springs(nb::module_& module) {
  using namespace carom::generic;
  bind_part<Gravity<D>>(module, "Gravity", {"Gravity"},
                        [](auto& fields) { fields("acceleration", &Gravity<D>::acceleration, required); });
  bind_part<SpringDamper<D>>(module, "SpringDamper", {"SpringDamper"}, [](auto& fields) {
    using P = SpringDamper<D>;
    fields("from", &P::from, required)("to", &P::to, required)("stiffness", &P::stiffness)(
        "damping", &P::damping)("free_length", &P::free_length);
  });
  const auto one_sided = []<class P>(Fields<P>& fields) {
    fields("from", &P::from, required)("to", &P::to, required)("stiffness", &P::stiffness)(
        "damping", &P::damping)("free_length", &P::free_length);
  };
  bind_part<Cable<D>>(module, "Cable", {"Cable", "OneSidedSpring"}, one_sided);
  bind_part<Bumper<D>>(module, "Bumper", {"Bumper", "OneSidedSpring"}, one_sided);
  bind_part<MaxwellElement<D>>(module, "MaxwellElement", {"MaxwellElement"}, [](auto& fields) {
    using P = MaxwellElement<D>;
    fields("from", &P::from, required)("to", &P::to, required)("stiffness", &P::stiffness)(
        "damping", &P::damping)("free_length", &P::free_length)("lengthening", &P::lengthening);
  });
  bind_part<Drag<D>>(module, "Drag", {"Drag"}, [](auto& fields) {
    using P = Drag<D>;
    fields("on", &P::on, required)("linear", &P::linear)("quadratic", &P::quadratic);
  });
}

template <int D>
void bind_element_laws(nb::module_& module) {
  using namespace carom::generic;
  bind_part<NonlinearSpring<D>>(module, "NonlinearSpring", {"NonlinearSpring"}, [](auto& fields) {
    using P = NonlinearSpring<D>;
    fields("from", &P::from, required)("to", &P::to, required)("force", &P::force, required)(
        "potential_of", &P::potential_of, required)("damping", &P::damping)("force_by_length",
                                                                            &P::force_by_length);
  });
  bind_part<LinearActuator<D>>(module, "LinearActuator", {"LinearActuator"}, [](auto& fields) {
    using P = LinearActuator<D>;
    fields("from", &P::from, required)("to", &P::to, required)("force", &P::force, required)(
        "force_by_length", &P::force_by_length)("force_by_rate", &P::force_by_rate)("breaks", &P::breaks);
  });
  bind_part<AppliedForce<D>>(module, "AppliedForce", {"AppliedForce"}, [](auto& fields) {
    using P = AppliedForce<D>;
    fields("on", &P::on, required)("force", &P::force, required)("breaks", &P::breaks);
  });
}

}  // namespace carom_python

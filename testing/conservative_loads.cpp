#include <carom/core/errors.h>
#include <carom/core/part_check.h>
#include <carom/core/text_table.h>
#include <carom/testing/conservative_loads.h>
#include <carom/testing/loaded_model.h>

#include <cmath>
#include <string>
#include <vector>

namespace carom::energy_test {

Verdict check_conservative_loads(const System& system, double tolerance) {
  if (!(std::isfinite(tolerance) && tolerance >= 0.0)) {
    throw ModelError("conservative loads: tolerance is " + to_text(tolerance) + "; allowed: finite and >= 0");
  }
  LoadedModel model(system);
  const std::vector<double> expected = model.minus_gradient();
  const Layout& layout = *model.assembly.layout();
  TextTable table({"body", "velocity", "load", "-dV/dq", "apart"});
  for (Index body = 0; body < layout.bodies().size(); ++body) {
    const BodySlot& slot = layout.bodies()[body];
    for (Index i = 0; i < slot.v_size; ++i) {
      const double load = model.conservative[slot.v + i], gradient = expected[slot.v + i];
      if (std::abs(load - gradient) <= tolerance) continue;
      table.add({system.name(layout.id(body)), std::to_string(i), cell(load, 10), cell(gradient, 10),
                 cell(load - gradient, 3)});
    }
  }
  if (table.empty()) return {true, {}};
  return {false, "conservative loads that are not minus the gradient of the potential, allowed " +
                     cell(tolerance, 3) + ":\n" + table.text()};
}

}  // namespace carom::energy_test

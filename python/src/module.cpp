#include "bind.h"

NB_MODULE(_core, core) {
  using namespace carom_python;
  nanobind::set_leak_warnings(false);
  core.attr("__doc__") = "The compiled part of carom.";
  nanobind::module_ planar = core.def_submodule("planar", "Parts of models in the plane.");
  nanobind::module_ spatial = core.def_submodule("spatial", "Parts of models in space.");
  bind_errors(core);
  bind_ids(core);
  bind_enums(core);
  bind_values(core, planar);
  bind_options(core);
  bind_bodies(planar);
  bind_elements(planar);
  bind_laws(planar);
  bind_joints(planar);
  bind_ground(planar);
  bind_spatial(spatial);
  bind_system(core);
  bind_python_elements(planar, spatial);
  bind_state(core);
  bind_records(core);
  bind_energy(core);
  bind_simulation(core);
  bind_recorders(core);
  bind_recording(core);
  bind_analysis(core);
  bind_problems(core);
  bind_checks(core);
  bind_signatures(core);
}

#pragma once

// Rooms of the module: each is a file of its own, so that a change compiles little.

#include <nanobind/nanobind.h>

namespace carom_python {

void bind_errors(nanobind::module_& core);
void bind_ids(nanobind::module_& core);
void bind_enums(nanobind::module_& core);
void bind_values(nanobind::module_& core, nanobind::module_& planar);
void bind_options(nanobind::module_& core);
void bind_bodies(nanobind::module_& planar);
void bind_elements(nanobind::module_& planar);
void bind_laws(nanobind::module_& planar);
void bind_joints(nanobind::module_& planar);
void bind_ground(nanobind::module_& planar);
void bind_spatial(nanobind::module_& spatial);
void bind_python_elements(nanobind::module_& planar, nanobind::module_& spatial);
void bind_system(nanobind::module_& core);
void bind_state(nanobind::module_& core);
void bind_records(nanobind::module_& core);
void bind_energy(nanobind::module_& core);
void bind_simulation(nanobind::module_& core);
void bind_recorders(nanobind::module_& core);
void bind_recording(nanobind::module_& core);
void bind_analysis(nanobind::module_& core);
void bind_problems(nanobind::module_& core);
void bind_checks(nanobind::module_& core);
void bind_signatures(nanobind::module_& core);

}  // namespace carom_python

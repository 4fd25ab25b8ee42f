// Analysis: the cross-check of the modes, statics, vibrations, inverse dynamics.

#include "bind.h"
#include "runner.h"

#include <carom/analysis/cross_check.h>
#include <carom/analysis/equilibrium.h>
#include <carom/analysis/inverse_dynamics.h>
#include <carom/analysis/modes.h>

namespace carom_python {

using namespace carom;

template <>
struct Convert<State> {
  static TypeNames names() { return {"carom._core.State", "carom._core.State", ""}; }
  static nb::object cast(const State& value) { return nb::cast(value, nb::rv_policy::copy); }
};
template <>
struct Convert<JointForce> : BoundRecord<JointForce> {};
template <>
struct Convert<ContactForce> : BoundRecord<ContactForce> {};
template <>
struct Convert<DriverForces> : BoundRecord<DriverForces> {};
template <>
struct Convert<VibrationMode> : BoundRecord<VibrationMode> {};
template <class M>
struct Convert<M, std::enable_if_t<std::is_same_v<M, Eigen::MatrixXd>>> {
  static TypeNames names() { return {"", "numpy.typing.NDArray[numpy.float64]", ""}; }
  static nb::object cast(const M& value) {
    const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = value;
    return make_array(rows.data(), static_cast<std::size_t>(rows.rows()),
                      static_cast<std::size_t>(rows.cols()));
  }
};
template <>
struct Convert<Eigen::VectorXcd> {
  static TypeNames names() { return {"", "list[complex]", ""}; }
  static nb::object cast(const Eigen::VectorXcd& value) {
    nb::list list;
    for (const std::complex<double> number : value) list.append(Convert<std::complex<double>>::cast(number));
    return std::move(list);
  }
};

namespace {

void bind_cross_check(nb::module_& core) {
  bind_record<CrossCheckOptions>(core, "CrossCheckOptions", {"CrossCheckOptions"}, true, [](auto& fields) {
    using P = CrossCheckOptions;
    fields("end", &P::end, required)("steps", &P::steps, required)("probes", &P::probes)(
        "time_stepping", &P::time_stepping)("event_driven", &P::event_driven)("stop_when", &P::stop_when);
  });
  bind_record<CrossCheckLevel>(core, "CrossCheckLevel", {"CrossCheckLevel"}, false, [](auto& fields) {
    using P = CrossCheckLevel;
    fields("step", &P::step)("position_error", &P::position_error)("velocity_error", &P::velocity_error)(
        "body", &P::body);
  });
  bind_record<CrossCheckOutlier>(core, "CrossCheckOutlier", {"CrossCheckOutlier"}, false, [](auto& fields) {
    fields("level", &CrossCheckOutlier::level)("expected", &CrossCheckOutlier::expected);
  });
  bind_record<CrossCheck>(core, "CrossCheck", {"CrossCheck"}, false, [](auto& fields) {
    using P = CrossCheck;
    fields("levels", &P::levels)("probes", &P::probes)("outliers", &P::outliers)(
        "position_order", &P::position_order)("velocity_order", &P::velocity_order);
  }).def("__str__", &printed<CrossCheck>);
  core.def(
      "spread_steps",
      [](double largest, double smallest, int count) {
        return Convert<std::vector<double>>::cast(spread_steps(largest, smallest, count));
      },
      nb::arg("largest"), nb::arg("smallest"), nb::arg("count"),
      nb::sig("def spread_steps(largest: float, smallest: float, count: int) -> list[float]"),
      doc("spread_steps"));
  core.def(
      "cross_check",
      [](Model& system, const CrossCheckOptions& options) {
        check_threads(system, options.time_stepping);
        CrossCheckOptions watched = options;
        watched.stop_when = stop_or_signal(options.stop_when);
        if (!find_python_part(system).empty() || options.stop_when) return cross_check(system.get(), watched);
        const System copy = system.get();
        const nb::gil_scoped_release release;
        return cross_check(copy, watched);
      },
      nb::arg("system"), nb::arg("options"), doc("cross_check"));
}

void bind_equilibrium(nb::module_& core) {
  bind_record<EquilibriumOptions>(core, "EquilibriumOptions", {"EquilibriumOptions"}, true, [](auto& fields) {
    using P = EquilibriumOptions;
    fields("contact_tolerance", &P::contact_tolerance)("tolerance", &P::tolerance)(
        "most_steps", &P::most_steps)("stop_when", &P::stop_when);
  });
  bind_record<JointForce>(core, "JointForce", {"JointForce"}, false, [](auto& fields) {
    fields("joint", &JointForce::joint)("multipliers", &JointForce::multipliers)("reaction",
                                                                                 &JointForce::reaction);
  });
  bind_record<ContactForce>(core, "ContactForce", {"ContactForce"}, false, [](auto& fields) {
    using P = ContactForce;
    fields("key", &P::key)("name", &P::name)("normal", &P::normal)("tangential", &P::tangential)(
        "friction", &P::friction);
  });
  bind_record<Equilibrium>(core, "Equilibrium", {"Equilibrium"}, false,
                           [](auto& fields) {
                             using P = Equilibrium;
                             fields("state", &P::state)("joints", &P::joints)("contacts", &P::contacts)(
                                 "residual", &P::residual)("gap", &P::gap)("steps", &P::steps);
                           })
      .def(
          "force", [](const Equilibrium& self, JointId joint) { return self.force(joint); }, nb::arg("joint"),
          doc("Equilibrium.force"));
  core.def(
      "find_equilibrium",
      [](Model& system, const EquilibriumOptions& options) {
        EquilibriumOptions watched = options;
        watched.stop_when = stop_or_signal(options.stop_when);
        return find_equilibrium(system.get(), watched);
      },
      nb::arg("system"), nb::arg("options") = EquilibriumOptions{},
      nb::sig("def find_equilibrium(system: System, options: EquilibriumOptions = ...) -> Equilibrium"),
      doc("find_equilibrium"));
  core.def(
      "find_equilibrium",
      [](Runner& simulation, const EquilibriumOptions& options) {
        return find_equilibrium(simulation.get().assembly(), simulation.get().state(), options);
      },
      nb::arg("simulation"), nb::arg("options") = EquilibriumOptions{},
      nb::sig(
          "def find_equilibrium(simulation: Simulation, options: EquilibriumOptions = ...) -> Equilibrium"),
      "The same from the present state of a simulation, which takes the result by set_state().");
}

void bind_modes(nb::module_& core) {
  bind_record<ModesOptions>(core, "ModesOptions", {"ModesOptions"}, true, [](auto& fields) {
    fields("contact_tolerance", &ModesOptions::contact_tolerance)("tolerance", &ModesOptions::tolerance);
  });
  bind_record<Linearisation>(core, "Linearisation", {"Linearisation"}, false, [](auto& fields) {
    using P = Linearisation;
    fields("directions", &P::directions)("damping", &P::damping)("stiffness", &P::stiffness)(
        "conservative", &P::conservative);
  });
  bind_record<VibrationMode>(
      core, "VibrationMode", {"VibrationMode"}, false,
      [](auto& fields) { fields("eigenvalue", &VibrationMode::eigenvalue)("shape", &VibrationMode::shape); })
      .def("frequency", &VibrationMode::frequency, doc("VibrationMode.frequency"))
      .def("damping_ratio", &VibrationMode::damping_ratio, doc("VibrationMode.damping_ratio"));
  core.def(
      "linearise",
      [](Runner& simulation, const ModesOptions& options) {
        return linearise(simulation.get().assembly(), simulation.get().state(), options);
      },
      nb::arg("simulation"), nb::arg("options") = ModesOptions{},
      nb::sig("def linearise(simulation: Simulation, options: ModesOptions = ...) -> Linearisation"),
      doc("linearise"));
  using Modes = Convert<std::vector<VibrationMode>>;
  core.def(
      "find_modes", [](const Linearisation& linearisation) { return Modes::cast(find_modes(linearisation)); },
      nb::arg("linearisation"),
      nb::sig("def find_modes(linearisation: Linearisation) -> list[VibrationMode]"), doc("find_modes"));
  core.def(
      "find_modes",
      [](Runner& simulation, const ModesOptions& options) {
        return Modes::cast(find_modes(simulation.get().assembly(), simulation.get().state(), options));
      },
      nb::arg("simulation"), nb::arg("options") = ModesOptions{},
      nb::sig("def find_modes(simulation: Simulation, options: ModesOptions = ...) -> list[VibrationMode]"),
      doc("find_modes"));
}

void bind_inverse_dynamics(nb::module_& core) {
  bind_record<DriverForces>(core, "DriverForces", {"DriverForces"}, false, [](auto& fields) {
    using P = DriverForces;
    fields("state", &P::state)("accelerations", &P::accelerations)("forces", &P::forces)("powers",
                                                                                         &P::powers);
  });
  bind_record<InverseDynamics>(core, "InverseDynamics", {"InverseDynamics"}, false, [](auto& fields) {
    fields("drivers", &InverseDynamics::drivers)("samples", &InverseDynamics::samples);
  });
  core.def(
      "driver_forces",
      [](Runner& simulation) { return driver_forces(simulation.get().assembly(), simulation.get().state()); },
      nb::arg("simulation"), doc("driver_forces"));
  core.def(
      "inverse_dynamics",
      [](Model& system, nb::handle times) {
        return inverse_dynamics(system.get(), read<std::vector<double>>(times, "inverse_dynamics(): times"));
      },
      nb::arg("system"), nb::arg("times"),
      nb::sig(
          "def inverse_dynamics(system: System, times: collections.abc.Sequence[float]) -> InverseDynamics"),
      doc("inverse_dynamics"));
}

}  // namespace

void bind_analysis(nb::module_& core) {
  bind_cross_check(core);
  bind_equilibrium(core);
  bind_modes(core);
  bind_inverse_dynamics(core);
}

}  // namespace carom_python

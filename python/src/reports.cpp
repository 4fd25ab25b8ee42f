// Records and reports of runs: read only.

#include "bind.h"
#include "types.h"

#include <carom/core/dynamics/joint_closure.h>
#include <carom/integrators/contact_forces.h>

#include <nanobind/stl/vector.h>

#include <array>
#include <string>
#include <vector>

namespace carom_python {

using namespace carom;

namespace {

void bind_keys(nb::module_& core) {
  const auto comparable = []<class P>(nb::class_<P>&& type) {
    type.def(
        "__eq__",
        [](const P& self, nb::handle other) {
          return nb::isinstance<P>(other) && self == nb::cast<const P&>(other);
        },
        nb::arg("other").none(), nb::sig("def __eq__(self, other: object, /) -> bool"));
    type.def("__hash__", [](nb::handle self) { return nb::hash(nb::repr(self)); });
  };
  comparable(bind_record<FeatureKey>(core, "FeatureKey", {"FeatureKey"}, true, [](auto& fields) {
    fields("owner", &FeatureKey::owner)("serial", &FeatureKey::serial)("feature", &FeatureKey::feature);
  }));
  comparable(bind_record<ConstraintKey>(core, "ConstraintKey", {"ConstraintKey"}, true, [](auto& fields) {
    fields("a", &ConstraintKey::a)("b", &ConstraintKey::b);
  }));
  bind_record<ModelFinding>(core, "ModelFinding", {"ModelFinding"}, false, [](auto& fields) {
    fields("kind", &ModelFinding::kind)("parts", &ModelFinding::parts)("text", &ModelFinding::text);
  });
  bind_record<JointReaction>(core, "JointReaction", {"JointReaction"}, false, [](auto& fields) {
    fields("force", &JointReaction::force)("moment", &JointReaction::moment);
  });
  bind_record<RedundantJoint>(core, "RedundantJoint", {"RedundantJoint"}, false, [](auto& fields) {
    fields("joint", &RedundantJoint::joint)("with", &RedundantJoint::with);
  });
  bind_record<Mobility>(core, "Mobility", {"Mobility"}, false, [](auto& fields) {
    fields("velocities", &Mobility::velocities)("rows", &Mobility::rows)(
        "independent_rows", &Mobility::independent_rows)("degrees_of_freedom", &Mobility::degrees_of_freedom)(
        "redundant", &Mobility::redundant);
  });
}

/// Numbers of a contact as vectors in the fixed frame.
template <class P>
void bind_vector_of(nb::class_<P>& type) {
  type.def(
      "vector_of",
      [](const P& self, nb::handle by_direction) {
        std::array<double, 3> numbers{};
        load_numbers(by_direction, numbers.data(), numbers.size(), "vector_of: argument 'by_direction'",
                     "three numbers");
        return Convert<Vec<3>>::cast(self.vector_of(numbers));
      },
      nb::arg("by_direction"),
      nb::sig("def vector_of(self, by_direction: numpy.typing.ArrayLike) -> "
              "numpy.typing.NDArray[numpy.float64]"),
      doc("ContactFrame.vector_of"));
  type.def_prop_ro(
      "tangents",
      [](const P& self) {
        const auto [first, second] = self.tangents();
        const std::array<double, 6> rows{first[0], first[1], first[2], second[0], second[1], second[2]};
        return make_array(rows.data(), 2, 3);
      },
      nb::sig("def tangents(self) -> numpy.typing.NDArray[numpy.float64]"), doc("ContactFrame.tangents"));
}

/// A member of a contact's record, by direction, as a property that is a vector in the fixed frame.
template <auto member, class P>
void bind_vector(nb::class_<P>& type, const std::string& name, const char* unit) {
  const std::string signature = "def " + name + "_vector(self) -> numpy.typing.NDArray[numpy.float64]";
  const std::string text = "The `" + name + "` as a vector in the fixed frame, x, y and z " + unit +
                           "; zero of a limit of a joint.";
  type.def_prop_ro((name + "_vector").c_str(),
                   [](const P& self) { return Convert<Vec<3>>::cast(self.vector_of(self.*member)); },
                   nb::sig(signature.c_str()), text.c_str());
}

/// Impulse and velocities of a record of an impact or a step.
template <class P>
void bind_vectors_of_impulse(nb::class_<P>&& type) {
  bind_vector_of(type);
  bind_vector<&P::impulse>(type, "impulse", "[N s]");
  bind_vector<&P::velocity_before>(type, "velocity_before", "[m/s]");
  bind_vector<&P::velocity_after>(type, "velocity_after", "[m/s]");
}

void bind_events(nb::module_& core) {
  bind_record<EventMotion>(core, "EventMotion", {"EventMotion"}, false, [](auto& fields) {
    using P = EventMotion;
    fields("body", &P::body)("position", &P::position)("velocity_before", &P::velocity_before)(
        "velocity_after", &P::velocity_after);
  });
  const std::vector<std::string> keys{"EventRecord", "EventParts", "EventSolution", "ImpactNote",
                                      "ContactFrame"};
  bind_vectors_of_impulse(bind_record<EventRecord>(core, "EventRecord", keys, false, [](auto& fields) {
    using P = EventRecord;
    fields("time", &P::time)("kind", &P::kind)("contact", &P::contact)("body", &P::body)(
        "obstacle", &P::obstacle)("element", &P::element)("joint", &P::joint)("other", &P::other)(
        "mode", &P::mode)("outcome", &P::outcome)("residual", &P::residual)("solver", &P::solver)(
        "instant", &P::instant)("velocity_before", &P::velocity_before)("velocity_after", &P::velocity_after)(
        "impulse", &P::impulse)("directions", &P::directions)("point", &P::point)("normal", &P::normal)(
        "gap", &P::gap)("energy_before", &P::energy_before)("energy_after", &P::energy_after)(
        "motions", &P::motions)("stiffness", &P::stiffness)("free_acceleration", &P::free_acceleration)(
        "accumulation_time", &P::accumulation_time)("energy_gain", &P::energy_gain)(
        "contact_work", &P::contact_work)("restitution_factor", &P::restitution_factor)(
        "cut_sequence", &P::cut_sequence)("rolling_moment", &P::rolling_moment);
  }));
}

void bind_steps(nb::module_& core) {
  const std::vector<std::string> keys{"ContactRecord", "ContactPlace", "ImpactNote", "ContactFrame"};
  bind_vectors_of_impulse(bind_record<ContactRecord>(core, "ContactRecord", keys, false, [](auto& fields) {
    using P = ContactRecord;
    fields("key", &P::key)("body", &P::body)("obstacle", &P::obstacle)("other", &P::other)(
        "directions", &P::directions)("point", &P::point)("normal", &P::normal)("gap", &P::gap)(
        "time", &P::time)("velocity_before", &P::velocity_before)("velocity_after", &P::velocity_after)(
        "impulse", &P::impulse)("work", &P::work)("mode", &P::mode)("impact", &P::impact)("worst", &P::worst)(
        "outcome", &P::outcome)("residual", &P::residual)("solver", &P::solver)(
        "energy_gain", &P::energy_gain)("contact_work", &P::contact_work)(
        "restitution_factor", &P::restitution_factor)("cut_sequence", &P::cut_sequence)("rolling_moment",
                                                                                        &P::rolling_moment);
  }));
  bind_record<JointImpulse>(core, "JointImpulse", {"JointImpulse"}, false, [](auto& fields) {
    fields("joint", &JointImpulse::joint)("impulse", &JointImpulse::impulse)("time", &JointImpulse::time);
  });
  bind_record<ControlReport>(core, "ControlReport", {"ControlReport"}, false, [](auto& fields) {
    using P = ControlReport;
    fields("error", &P::error)("rejected", &P::rejected)("across_impact", &P::across_impact)("next_step",
                                                                                             &P::next_step);
  });
  const std::vector<std::string> report{"StepReport", "StepNumbers", "IterationReport"};
  bind_record<StepReport>(core, "StepReport", report, false, [](auto& fields) {
    using P = StepReport;
    fields("time", &P::time)("step", &P::step)("energy_gain", &P::energy_gain)(
        "lasting_gain", &P::lasting_gain)("steps_made", &P::steps_made)("projected", &P::projected)(
        "control", &P::control)("iteration", &P::iteration)("fallbacks", &P::fallbacks)("sweeps", &P::sweeps)(
        "local_sweeps", &P::local_sweeps)("contraction", &P::contraction)(
        "worst_coupling", &P::worst_coupling)("worst_coupling_rate", &P::worst_coupling_rate)(
        "contacts", &P::contacts)("joint_impulses", &P::joint_impulses)("findings", &P::findings)(
        "capped_problem", &P::capped_problem);
  });
}

void bind_statistics(nb::module_& core) {
  const std::vector<std::string> keys{"Statistics", "StepStatistics", "ContactCounts"};
  bind_record<Statistics>(
      core, "Statistics", keys, false,
      [](auto& fields) {
        using P = Statistics;
        fields("steps", &P::steps)("sweeps", &P::sweeps)("most_sweeps", &P::most_sweeps)(
            "largest_contraction", &P::largest_contraction)("steps_by_iteration", &P::steps_by_iteration)(
            "fallbacks", &P::fallbacks)("rejected_steps", &P::rejected_steps)(
            "steps_across_impacts", &P::steps_across_impacts)("impacts", &P::impacts)(
            "contact_steps", &P::contact_steps)("several_solutions", &P::several_solutions)(
            "forces_not_unique", &P::forces_not_unique)("energy_gains", &P::energy_gains)(
            "energy_gained", &P::energy_gained)("lasting_gains", &P::lasting_gains)(
            "lasting_gained", &P::lasting_gained)("cut_sequences", &P::cut_sequences)(
            "scaled_impacts", &P::scaled_impacts)("plastic_jams", &P::plastic_jams)(
            "deepest_gap", &P::deepest_gap)("worst_residual", &P::worst_residual)(
            "certified_steps", &P::certified_steps)("events", &P::events)("flow_steps", &P::flow_steps)(
            "flow_evaluations", &P::flow_evaluations)("flow_restarts", &P::flow_restarts);
      })
      .def("certified_share", &Statistics::certified_share, nb::arg("residual"),
           doc("ContactCounts.certified_share"));
  bind_record<ChainStatistics>(core, "ChainStatistics", {"ChainStatistics"}, false, [](auto& fields) {
    using P = ChainStatistics;
    fields("problems", &P::problems)("accepted", &P::accepted)("tried", &P::tried)(
        "fall_backs", &P::fall_backs)("tolerated", &P::tolerated)("several_solutions", &P::several_solutions)(
        "forces_not_unique", &P::forces_not_unique)("degenerate", &P::degenerate)(
        "no_solution", &P::no_solution)("not_solved", &P::not_solved)("accepted_at_cap", &P::accepted_at_cap)(
        "certified", &P::certified)("worst_residual", &P::worst_residual);
  }).def("__str__", &printed<ChainStatistics>);
  bind_record<PartForce>(core, "PartForce", {"PartForce"}, false, [](auto& fields) {
    using P = PartForce;
    fields("impulse", &P::impulse)("angular_impulse", &P::angular_impulse)(
        "impact_impulse", &P::impact_impulse)("mean_force", &P::mean_force)("mean_moment", &P::mean_moment)(
        "contacts", &P::contacts);
  });
  auto lasting = bind_record<LastingContact>(
      core, "LastingContact", {"LastingContact", "ContactPlace", "ContactFrame"}, false, [](auto& fields) {
        using P = LastingContact;
        fields("key", &P::key)("body", &P::body)("obstacle", &P::obstacle)("other", &P::other)(
            "directions", &P::directions)("point", &P::point)("normal", &P::normal)("gap", &P::gap)(
            "velocity", &P::velocity)("force", &P::force)("rolling_moment", &P::rolling_moment)("mode",
                                                                                                &P::mode);
      });
  bind_vector_of(lasting);
  bind_vector<&LastingContact::velocity>(lasting, "velocity", "[m/s]");
  bind_vector<&LastingContact::force>(lasting, "force", "[N]");
  core.def(
      "force_on", [](const StepReport& report, BodyId body) { return force_on(report, body); },
      nb::arg("report"), nb::arg("body"), doc("force_on"));
  core.def(
      "force_on", [](const StepReport& report, ObstacleId obstacle) { return force_on(report, obstacle); },
      nb::arg("report"), nb::arg("obstacle"), doc("force_on"));
  core.def(
      "force_on",
      [](const std::vector<LastingContact>& forces, BodyId body) { return force_on(forces, body); },
      nb::arg("forces"), nb::arg("body"), doc("force_on"));
  core.def(
      "force_on",
      [](const std::vector<LastingContact>& forces, ObstacleId obstacle) {
        return force_on(forces, obstacle);
      },
      nb::arg("forces"), nb::arg("obstacle"), doc("force_on"));
}

}  // namespace

void bind_records(nb::module_& core) {
  bind_keys(core);
  bind_events(core);
  bind_steps(core);
  bind_statistics(core);
}

}  // namespace carom_python

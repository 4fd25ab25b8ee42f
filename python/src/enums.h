#pragma once

// Names of enumerations, in the order of their values.

#include "convert.h"

#include <carom/analysis/cross_check.h>
#include <carom/contact/solvers/chain_statistics.h>
#include <carom/contact/solvers/contact_solver.h>
#include <carom/contact/solvers/impact_order.h>
#include <carom/core/constraint.h>
#include <carom/core/energy_term.h>
#include <carom/core/energy_trace.h>
#include <carom/core/log.h>
#include <carom/core/model_finding.h>
#include <carom/core/row_set.h>
#include <carom/core/surface.h>
#include <carom/integrators/flow/flow_method.h>
#include <carom/integrators/run/event_driven.h>
#include <carom/integrators/run/event_log.h>
#include <carom/integrators/run/time_stepping.h>

#include <array>
#include <utility>

namespace carom_python {

template <class E, std::size_t N>
constexpr auto numbered(const char* const (&names)[N]) {
  std::array<std::pair<const char*, E>, N> table{};
  for (std::size_t i = 0; i < N; ++i) table[i] = {names[i], static_cast<E>(i)};
  return table;
}

// NOLINTNEXTLINE(cppcoreguidelines-macro-usage): a name as text and as type
#define CAROM_PYTHON_ENUM(type, label, ...)                       \
  template <>                                                     \
  struct EnumNames<type> {                                        \
    static constexpr const char* name = label;                    \
    static constexpr auto values = numbered<type>({__VA_ARGS__}); \
  };

CAROM_PYTHON_ENUM(carom::ForceRule, "ForceRule", "trapezoidal", "energy_momentum")
CAROM_PYTHON_ENUM(carom::ImpactTimes, "ImpactTimes", "at_step_start", "located")
CAROM_PYTHON_ENUM(carom::Iteration, "Iteration", "fixed_point", "anderson", "linearly_implicit", "automatic")
CAROM_PYTHON_ENUM(carom::EnergyGain, "EnergyGain", "report", "limit", "refuse")
CAROM_PYTHON_ENUM(carom::ImpactOrder, "ImpactOrder", "simultaneous", "sequential")
CAROM_PYTHON_ENUM(carom::ImpactLaw, "ImpactLaw", "newton", "poisson", "energetic")
CAROM_PYTHON_ENUM(carom::FlowMethod, "FlowMethod", "explicit_runge_kutta", "adams", "bdf", "one_step")
CAROM_PYTHON_ENUM(carom::EventRecords::Choice, "EventRecords", "nothing", "with_impulse", "all")
CAROM_PYTHON_ENUM(carom::EventKind, "EventKind", "impact", "accumulation", "closing", "lift_off", "stick",
                  "slip", "impact_without_collision", "several_accelerations", "switching_point",
                  "discontinuity", "mode_switch", "roll", "hold")
CAROM_PYTHON_ENUM(carom::ContactMode, "ContactMode", "open", "stick", "slip_positive", "slip_negative",
                  "slip")
CAROM_PYTHON_ENUM(carom::Outcome, "Outcome", "solved", "several_solutions", "forces_not_unique",
                  "no_solution", "not_solved", "accepted_at_cap")
CAROM_PYTHON_ENUM(carom::StoredEnergy, "StoredEnergy", "kinetic", "gravity", "elastic", "potential")
CAROM_PYTHON_ENUM(carom::EnergyFlow, "EnergyFlow", "external", "intervention", "dashpot", "impact_normal",
                  "impact_tangential", "impact_without_collision", "contact_normal", "sliding",
                  "joint_friction", "rolling", "accumulation", "projection", "mode_switch",
                  "coupling_discretisation")
CAROM_PYTHON_ENUM(carom::FindingKind, "FindingKind", "law_without_effect", "contact_without_law",
                  "touches_nothing", "untouched_obstacle", "body_without_shape", "keep_without_joint",
                  "hidden_by_filter", "open_joint")
CAROM_PYTHON_ENUM(carom::SolverId, "SolverId", "single_contact", "principal_pivoting", "lemke",
                  "dense_sweeps", "enumeration", "nonlinear_cg")
CAROM_PYTHON_ENUM(carom::SetKind, "SetKind", "half_line", "interval", "bounded_interval", "bounded_disc",
                  "proportional")
CAROM_PYTHON_ENUM(carom::LogLevel, "LogLevel", "trace", "debug", "info", "warning", "error", "off")
CAROM_PYTHON_ENUM(carom::Quantity, "Quantity", "time", "energy", "momentum", "angular_momentum", "length")
CAROM_PYTHON_ENUM(carom::FeatureKey::Owner, "FeatureOwner", "body", "shape", "obstacle", "joint")

#undef CAROM_PYTHON_ENUM

static_assert(EnumNames<carom::Iteration>::values.size() == carom::iteration_count + 1);  // and automatic
static_assert(EnumNames<carom::EventKind>::values.size() == carom::event_kind_count);
static_assert(EnumNames<carom::StoredEnergy>::values.size() == carom::stored_energy_count);
static_assert(EnumNames<carom::EnergyFlow>::values.size() == carom::energy_flow_count);

/// `record_events` is a choice, or a truth as in C++.
template <>
struct Convert<carom::EventRecords> {
  using Choice = carom::EventRecords::Choice;
  static TypeNames names() {
    return {"carom._core.EventRecords | str | bool", "carom._core.EventRecords", "enum EventRecords"};
  }
  static void load(nb::handle from, carom::EventRecords& to, std::string_view where) {
    if (PyBool_Check(from.ptr())) {
      to = carom::EventRecords(from.ptr() == Py_True);
      return;
    }
    Choice choice{};
    Convert<Choice>::load(from, choice, where);
    to = carom::EventRecords(choice);
  }
  static nb::object cast(const carom::EventRecords& value) { return nb::cast(value.choice()); }
};

}  // namespace carom_python

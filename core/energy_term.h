#pragma once

/// \file
/// The terms of the energy ledger.

#include <carom/core/export.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace carom {

/// Forms in which energy is stored.
enum class StoredEnergy : std::uint8_t { kinetic, gravity, elastic, potential };
/// Number of forms of stored energy.
inline constexpr std::size_t stored_energy_count = 4;

/// Flows of energy into or out of the stored energies, by cause. All except `external` and `intervention` are
/// losses: positive where energy is lost.
enum class EnergyFlow : std::uint8_t {
  external,                  ///< work of prescribed loads, drivers and moving shapes on ground (a gain)
  intervention,              ///< brought in by edits of the model or of the state (a gain)
  dashpot,                   ///< lost in dashpots
  impact_normal,             ///< lost in the normal direction of impacts
  impact_tangential,         ///< lost in the tangential direction of impacts
  impact_without_collision,  ///< lost in impacts of contacts that did not approach (Painleve)
  contact_normal,            ///< normal work of lasting contact
  sliding,                   ///< tangential work of lasting contact
  joint_friction,            ///< lost in dry friction of joints
  rolling,                   ///< lost in rolling resistance
  accumulation,              ///< lost where an accumulation of impacts (Zeno) is closed
  projection,                ///< lost by projections onto constraints
  mode_switch,               ///< lost when the mode of integration is changed
  coupling_discretisation,   ///< -(change of potential energy + work of force elements and joint reactions)
};
/// Number of flows.
inline constexpr std::size_t energy_flow_count = 14;

/// Name of a form of stored energy, as used in tables and files: "kinetic", ...
[[nodiscard]] CAROM_API std::string_view to_string(StoredEnergy term);
/// Name of a flow of energy, as used in tables and files: "impact_normal", ...
[[nodiscard]] CAROM_API std::string_view to_string(EnergyFlow term);

/// Throws the ModelError of a value that is no term.
[[noreturn]] CAROM_API void refuse_term(std::size_t place, std::size_t count);
/// Number of a term among `count`. Throws ModelError for a value that is none of them.
template <class Term>
[[nodiscard]] constexpr std::size_t term_place(Term term, std::size_t count) {
  const auto place = static_cast<std::size_t>(term);
  if (place >= count) refuse_term(place, count);
  return place;
}

/// True for the flows that are counted as gains.
[[nodiscard]] constexpr bool is_gain(EnergyFlow flow) {
  return flow == EnergyFlow::external || flow == EnergyFlow::intervention;
}

/// Energies stored, by form [J].
struct StoredEnergies {
  std::array<double, stored_energy_count> values{};

  /// One of them. Throws ModelError for a value that is no term.
  [[nodiscard]] double& operator[](StoredEnergy term) {
    return values[term_place(term, stored_energy_count)];
  }
  [[nodiscard]] double operator[](StoredEnergy term) const {
    return values[term_place(term, stored_energy_count)];
  }
  /// Sum of all forms.
  [[nodiscard]] double total() const {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return sum;
  }
  /// Sum of all forms but the kinetic energy.
  [[nodiscard]] double potential() const {
    // Not the total less the kinetic energy: that would round at the size of the kinetic energy.
    double sum = 0.0;
    for (std::size_t i = 0; i < stored_energy_count; ++i) {
      if (static_cast<StoredEnergy>(i) != StoredEnergy::kinetic) sum += values[i];
    }
    return sum;
  }
};

/// Flows of energy during a step, by cause [J].
struct EnergyFlows {
  std::array<double, energy_flow_count> values{};

  /// One of them. Throws ModelError for a value that is no term.
  [[nodiscard]] double& operator[](EnergyFlow term) { return values[term_place(term, energy_flow_count)]; }
  [[nodiscard]] double operator[](EnergyFlow term) const {
    return values[term_place(term, energy_flow_count)];
  }
};

}  // namespace carom

#pragma once

// Scenes and checks that tests of the event-driven mode share.

#include <carom/carom.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace carom_test {

/// The tolerances at which every trap is set.
inline std::vector<carom::EventDriven> default_and_tight() {
  return {carom::EventDriven{}, carom::EventDriven{.relative_tolerance = 1e-11, .absolute_tolerance = 1e-13}};
}

inline constexpr std::array flow_methods{carom::FlowMethod::explicit_runge_kutta, carom::FlowMethod::adams,
                                         carom::FlowMethod::bdf, carom::FlowMethod::one_step};

inline std::int64_t count(const carom::Simulation& simulation, carom::EventKind kind) {
  return simulation.statistics().events[static_cast<std::size_t>(kind)];
}

}  // namespace carom_test

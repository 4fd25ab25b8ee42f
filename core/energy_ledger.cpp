#include <carom/core/energy_ledger.h>
#include <carom/core/enum_name.h>
#include <carom/core/errors.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iomanip>
#include <ostream>

namespace carom {

std::string_view to_string(StoredEnergy term) {
  constexpr std::array<std::string_view, stored_energy_count> names{"kinetic", "gravity", "elastic",
                                                                    "potential"};
  return enum_name(names, term);
}

void refuse_term(std::size_t place, std::size_t count) {
  throw ModelError("energy: term is " + std::to_string(place) + "; allowed: an enumerator, 0 to " +
                   std::to_string(count - 1));
}

std::string_view to_string(EnergyFlow term) {
  constexpr std::array<std::string_view, energy_flow_count> names{
      "external",          "intervention",
      "dashpot",           "impact_normal",
      "impact_tangential", "impact_without_collision",
      "contact_normal",    "sliding",
      "joint_friction",    "rolling",
      "accumulation",      "projection",
      "mode_switch",       "coupling_discretisation"};
  return enum_name(names, term);
}

void EnergyLedger::open(const StoredEnergies& stored) {
  stored_ = stored;
  initial_ = stored.total();
  flows_ = {};
  scale_ = 0.0;
  for (const double value : stored.values) scale_ = std::max(scale_, std::abs(value));
}

void EnergyLedger::store(const StoredEnergies& stored) {
  double largest = scale_;
  for (const double value : stored.values) largest = std::max(largest, std::abs(value));
  stored_ = stored;
  scale_ = largest;
}

void EnergyLedger::add_flows(const EnergyLedger& part) {
  scale_ = std::max(scale_, part.scale_);
  for (std::size_t i = 0; i < energy_flow_count; ++i) {
    flows_[i].add(part.flows_[i].value());
    scale_ = std::max(scale_, std::abs(flows_[i].value()));
  }
}

void EnergyLedger::book(EnergyFlow flow, double amount, const StoredEnergies& stored) {
  if (amount != 0.0) {
    CompensatedSum& sum = flows_[term_place(flow, energy_flow_count)];
    sum.add(amount);
    scale_ = std::max(scale_, std::abs(sum.value()));
  }
  store(stored);
}

void EnergyLedger::book(const EnergyFlows& flows, const StoredEnergies& stored) {
  double largest = scale_;
  const auto add = [&](std::size_t i) {
    if (flows.values[i] == 0.0) return;
    CompensatedSum sum = flows_[i];
    sum.add(flows.values[i]);
    largest = std::max(largest, std::abs(sum.value()));
    flows_[i] = sum;
  };
  // Hardly any flow is not zero: they are looked at together.
  constexpr std::size_t together = 7;
  static_assert(energy_flow_count % together == 0);
  for (std::size_t first = 0; first < energy_flow_count; first += together) {
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < together; ++i) bits |= std::bit_cast<std::uint64_t>(flows.values[first + i]);
    if (bits << 1 == 0) continue;  // but for signs
    for (std::size_t i = 0; i < together; ++i) add(first + i);
  }
  scale_ = largest;
  store(stored);
}

double EnergyLedger::lost() const {
  CompensatedSum sum;
  for (std::size_t i = 0; i < energy_flow_count; ++i) {
    if (!is_gain(static_cast<EnergyFlow>(i))) sum.add(flows_[i].value());
  }
  return sum.value();
}

double EnergyLedger::residual() const {
  CompensatedSum sum;
  for (const double value : stored_.values) sum.add(value);
  sum.add(-initial_);
  for (std::size_t i = 0; i < energy_flow_count; ++i) {
    const double flow = flows_[i].value();
    sum.add(is_gain(static_cast<EnergyFlow>(i)) ? -flow : flow);
  }
  return sum.value();
}

std::array<double, EnergyLedger::saved_size> EnergyLedger::save() const {
  std::array<double, saved_size> numbers{};
  auto at = std::copy(stored_.values.begin(), stored_.values.end(), numbers.begin());
  *at++ = initial_;
  *at++ = scale_;
  for (const CompensatedSum& flow : flows_) {
    *at++ = flow.raw();
    *at++ = flow.correction();
  }
  return numbers;
}

void EnergyLedger::load(const std::array<double, saved_size>& numbers) {
  std::copy_n(numbers.begin(), stored_energy_count, stored_.values.begin());
  const double* at = numbers.data() + stored_energy_count;
  initial_ = *at++;
  scale_ = *at++;
  for (CompensatedSum& flow : flows_) {
    flow = CompensatedSum(at[0], at[1]);
    at += 2;
  }
}

std::ostream& operator<<(std::ostream& out, const EnergyLedger& ledger) {
  const auto line = [&out](std::string_view name, double value) {
    out << "  " << std::left << std::setw(26) << name << std::right << std::setw(18) << value << " J\n";
  };
  const auto flags = out.flags();
  const auto precision = out.precision(10);
  for (std::size_t i = 0; i < stored_energy_count; ++i) {
    const auto term = static_cast<StoredEnergy>(i);
    if (ledger.stored(term) != 0.0) line(to_string(term), ledger.stored(term));
  }
  line("total", ledger.total());
  line("initial", ledger.initial());
  for (std::size_t i = 0; i < energy_flow_count; ++i) {
    const auto term = static_cast<EnergyFlow>(i);
    if (ledger.flow(term) != 0.0) line(to_string(term), ledger.flow(term));
  }
  line("residual", ledger.residual());
  out.precision(precision);
  out.flags(flags);
  return out;
}

}  // namespace carom

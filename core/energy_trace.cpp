#include <carom/core/energy_trace.h>
#include <carom/core/enum_name.h>
#include <carom/core/errors.h>
#include <carom/core/part_check.h>

#include <algorithm>
#include <cmath>
#include <ostream>

namespace carom {

namespace {

/// Calls f(name, quantity, is scale, number) for every number of a row: the one place that knows their order.
template <class Row, class F>
void visit(Row& row, F&& f) {
  constexpr std::array<std::string_view, 3> momenta{"momentum_x", "momentum_y", "momentum_z"};
  constexpr std::array<std::string_view, 3> angular{"angular_momentum_x", "angular_momentum_y",
                                                    "angular_momentum_z"};
  f("time", Quantity::time, false, row.time);
  for (std::size_t i = 0; i < stored_energy_count; ++i) {
    f(to_string(static_cast<StoredEnergy>(i)), Quantity::energy, false, row.stored.values[i]);
  }
  f("total", Quantity::energy, false, row.total);
  f("initial", Quantity::energy, false, row.initial);
  for (std::size_t i = 0; i < energy_flow_count; ++i) {
    f(to_string(static_cast<EnergyFlow>(i)), Quantity::energy, false, row.flows.values[i]);
  }
  f("residual", Quantity::energy, false, row.residual);
  f("energy_scale", Quantity::energy, true, row.energy_scale);
  for (std::size_t i = 0; i < 3; ++i) f(momenta[i], Quantity::momentum, false, row.momentum[i]);
  f("momentum_scale", Quantity::momentum, true, row.momentum_scale);
  for (std::size_t i = 0; i < 3; ++i)
    f(angular[i], Quantity::angular_momentum, false, row.angular_momentum[i]);
  f("angular_momentum_scale", Quantity::angular_momentum, true, row.angular_momentum_scale);
  f("penetration", Quantity::length, false, row.penetration);
  f("joint_error", Quantity::length, false, row.joint_error);
  f("length_scale", Quantity::length, true, row.length_scale);
}

std::size_t index_of(std::string_view name) {
  const auto& terms = trace_terms();
  const auto found =
      std::find_if(terms.begin(), terms.end(), [&](const TraceTerm& term) { return term.name == name; });
  if (found == terms.end()) {
    throw ModelError("trace: term is '" + std::string(name) + "'; allowed: a name in trace_terms()");
  }
  return static_cast<std::size_t>(found - terms.begin());
}

}  // namespace

std::string_view unit(Quantity quantity) {
  constexpr std::array<std::string_view, 5> units{"s", "J", "N s", "N m s", "m"};
  return enum_name(units, quantity);
}

double TraceRow::scale(Quantity quantity) const {
  switch (quantity) {
    case Quantity::energy:
      return energy_scale;
    case Quantity::momentum:
      return momentum_scale;
    case Quantity::angular_momentum:
      return angular_momentum_scale;
    case Quantity::length:
      return length_scale;
    case Quantity::time:
      break;
  }
  return 0.0;
}

const std::array<TraceTerm, trace_term_count>& trace_terms() {
  static const auto terms = [] {
    std::array<TraceTerm, trace_term_count> all{};
    std::size_t at = 0;
    const TraceRow row;
    visit(row, [&](std::string_view name, Quantity quantity, bool is_scale, double) {
      all.at(at++) = {name, quantity, is_scale};
    });
    return all;
  }();
  return terms;
}

std::array<double, trace_term_count> values_of(const TraceRow& row) {
  std::array<double, trace_term_count> values{};
  std::size_t at = 0;
  visit(row, [&](std::string_view, Quantity, bool, double value) { values[at++] = value; });
  return values;
}

TraceRow row_of(const std::array<double, trace_term_count>& values) {
  TraceRow row;
  std::size_t at = 0;
  visit(row, [&](std::string_view, Quantity, bool, double& value) { value = values[at++]; });
  return row;
}

void EnergyTrace::add(const TraceRow& row) {
  visit(row, [&](std::string_view name, Quantity quantity, bool, double value) {
    if (std::isfinite(value)) return;
    throw ModelError("trace: " + std::string(name) + " at t = " + to_text(row.time) + " s is " +
                     to_text(value) + " " + std::string(unit(quantity)) + "; allowed: finite");
  });
  if (!rows_.empty() && !(row.time > rows_.back().time)) {
    throw ModelError("trace: time is " + to_text(row.time) + " s; allowed: later than the row before, " +
                     to_text(rows_.back().time) + " s");
  }
  rows_.push_back(row);
}

void EnergyTrace::add(TraceEvent event) {
  if (event.text.empty()) throw ModelError("trace: text of an event is empty; allowed: some text");
  if (!std::isfinite(event.time) || (!events_.empty() && event.time < events_.back().time)) {
    throw ModelError("trace: time of the event '" + event.text + "' is " + to_text(event.time) +
                     " s; allowed: finite, not before the event before");
  }
  events_.push_back(std::move(event));
}

std::vector<double> EnergyTrace::values(std::string_view term) const {
  const std::size_t index = index_of(term);
  std::vector<double> result;
  result.reserve(rows_.size());
  for (const TraceRow& row : rows_) result.push_back(values_of(row)[index]);
  return result;
}

const TraceEvent* EnergyTrace::nearest_event(double time) const {
  const TraceEvent* nearest = nullptr;
  for (const TraceEvent& event : events_) {
    if (!nearest || std::abs(event.time - time) < std::abs(nearest->time - time)) nearest = &event;
  }
  return nearest;
}

std::ostream& operator<<(std::ostream& out, const EnergyTrace& trace) {
  out << "trace of " << trace.rows().size() << " times";
  if (!trace.rows().empty()) {
    out << " from " << to_text(trace.rows().front().time) << " s to " << to_text(trace.rows().back().time)
        << " s";
  }
  return out << " with " << trace.events().size() << " events";
}

}  // namespace carom

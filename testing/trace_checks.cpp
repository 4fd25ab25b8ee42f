#include <carom/core/errors.h>
#include <carom/core/numerics/compensated_sum.h>
#include <carom/core/part_check.h>
#include <carom/core/text_table.h>
#include <carom/testing/trace_checks.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>

namespace carom::energy_test {

namespace {

void demand(bool possible, std::string_view quantity, double value, std::string_view allowed) {
  if (possible) return;
  std::string message = "energy test: ";
  message.append(quantity).append(" is ").append(to_text(value)).append("; allowed: ").append(allowed);
  throw ModelError(message);
}

void demand_tolerance(double tolerance) {
  demand(std::isfinite(tolerance) && tolerance >= 0.0, "tolerance", tolerance, "finite and >= 0");
}

const std::vector<TraceRow>& rows_of(const EnergyTrace& trace, double tolerance) {
  if (trace.rows().empty()) throw ModelError("energy test: trace has no rows; allowed: at least one");
  demand_tolerance(tolerance);
  return trace.rows();
}

/// Rows in which something is larger than allowed.
class Excess {
public:
  struct Place {
    std::size_t row;
    double amount, allowed;
  };

  void take(std::size_t row, double amount, double allowed) {
    if (amount <= allowed) return;
    ++count_;
    if (!first_) first_ = Place{row, amount, allowed};
    if (!worst_ || amount - allowed > worst_->amount - worst_->allowed) worst_ = Place{row, amount, allowed};
  }

  /// Holds if nothing was taken; else says what, where, near which event, and shows the terms of `quantity`.
  [[nodiscard]] Verdict verdict(const std::string& what, const EnergyTrace& trace, Quantity quantity) const {
    if (!first_) return {true, {}};
    const auto& rows = trace.rows();
    const std::string in(unit(quantity));
    const auto place = [&](const Place& at) {
      return cell(at.amount, 4) + " " + in + " at t = " + cell(rows[at.row].time) + " s, allowed " +
             cell(at.allowed, 3) + " " + in;
    };
    std::string text = what + " " + place(*first_) + "\n";
    if (worst_->row != first_->row) {
      text += "worst: " + place(*worst_) + "; in " + std::to_string(count_) + " of " +
              std::to_string(rows.size()) + " rows\n";
    }
    if (const TraceEvent* event = trace.nearest_event(rows[first_->row].time)) {
      text += "nearest event: t = " + cell(event->time) + " s: " + event->text + "\n";
    }
    return {false, text + terms(rows, first_->row, quantity)};
  }

private:
  /// The terms of a quantity in a row that are not zero, with their change since the row before.
  static std::string terms(const std::vector<TraceRow>& rows, std::size_t row, Quantity quantity) {
    const std::size_t before = row == 0 ? 0 : row - 1;
    const auto then = values_of(rows[before]), now = values_of(rows[row]);
    const std::string in = " [" + std::string(unit(quantity)) + "]";
    TextTable table({"term" + in, "t = " + cell(rows[before].time) + " s",
                     "t = " + cell(rows[row].time) + " s", "change"});
    for (std::size_t i = 0; i < trace_term_count; ++i) {
      const TraceTerm& term = trace_terms()[i];
      if (term.quantity != quantity || (then[i] == 0.0 && now[i] == 0.0)) continue;
      table.add({std::string(term.name), cell(then[i], 12), cell(now[i], 12), cell(now[i] - then[i], 6)});
    }
    return table.text();
  }

  std::size_t count_ = 0;
  std::optional<Place> first_, worst_;
};

/// Energy that the recorded terms leave unexplained.
double unexplained(const TraceRow& row) {
  CompensatedSum sum(-row.initial);
  for (const double value : row.stored.values) sum.add(value);
  for (std::size_t i = 0; i < energy_flow_count; ++i) {
    const double flow = row.flows.values[i];
    sum.add(is_gain(static_cast<EnergyFlow>(i)) ? -flow : flow);
  }
  return sum.value();
}

double dot(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

std::string text_of(const Coordinates& v) {
  return "(" + cell(v.values[0]) + ", " + cell(v.values[1]) + ", " + cell(v.values[2]) + ")";
}

}  // namespace

Verdict check_ledger_closes(const EnergyTrace& trace, double relative) {
  const auto& rows = rows_of(trace, relative);
  Excess excess;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double residual = std::max(std::abs(rows[i].residual), std::abs(unexplained(rows[i])));
    excess.take(i, residual, relative * rows[i].energy_scale);
  }
  return excess.verdict("the ledger leaves unexplained", trace, Quantity::energy);
}

Verdict check_ledger_closes(const EnergyLedger& ledger, double relative) {
  demand_tolerance(relative);
  const double residual = std::abs(ledger.residual()), allowed = relative * ledger.scale();
  if (residual <= allowed) return {true, {}};
  std::ostringstream table;
  table << "the ledger leaves unexplained " << cell(residual, 4) << " J, allowed " << cell(allowed, 3)
        << " J\n"
        << ledger;
  return {false, table.str()};
}

Verdict check_energy_never_rises(const EnergyTrace& trace, double tolerance) {
  const auto& rows = rows_of(trace, tolerance);
  const auto own = [](const TraceRow& row) {
    return row.total - row.flows[EnergyFlow::external] - row.flows[EnergyFlow::intervention];
  };
  Excess excess;
  double least = own(rows.front());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    excess.take(i, own(rows[i]) - least, tolerance);
    least = std::min(least, own(rows[i]));
  }
  return excess.verdict("T + V - W_external - intervention rises above its least value before by", trace,
                        Quantity::energy);
}

Verdict check_momentum_in(const EnergyTrace& trace, const Coordinates& direction, double relative) {
  const auto& rows = rows_of(trace, relative);
  const double length = std::sqrt(dot(direction.values, direction.values));
  demand(std::isfinite(length) && length > 0.0, "length of the direction " + text_of(direction), length,
         "finite and > 0");
  Excess excess;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double change =
        (dot(rows[i].momentum, direction.values) - dot(rows.front().momentum, direction.values)) / length;
    excess.take(i, std::abs(change), relative * rows[i].momentum_scale);
  }
  return excess.verdict("the momentum in the direction " + text_of(direction) + " has changed by", trace,
                        Quantity::momentum);
}

Verdict check_angular_momentum_about(const EnergyTrace& trace, const Coordinates& point, double relative) {
  const auto& rows = rows_of(trace, relative);
  const auto& c = point.values;
  const double distance = std::sqrt(dot(c, c));
  demand(std::isfinite(distance), "distance of the point " + text_of(point), distance, "finite");
  const auto about = [&](const TraceRow& row) {  // L - c x p
    const auto& p = row.momentum;
    const auto& l = row.angular_momentum;
    return std::array<double, 3>{l[0] - (c[1] * p[2] - c[2] * p[1]), l[1] - (c[2] * p[0] - c[0] * p[2]),
                                 l[2] - (c[0] * p[1] - c[1] * p[0])};
  };
  const auto start = about(rows.front());
  Excess excess;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::array<double, 3> change = about(rows[i]);
    for (std::size_t k = 0; k < 3; ++k) change[k] -= start[k];
    excess.take(i, std::sqrt(dot(change, change)),
                relative * (rows[i].angular_momentum_scale + distance * rows[i].momentum_scale));
  }
  return excess.verdict("the angular momentum about " + text_of(point) + " has changed by", trace,
                        Quantity::angular_momentum);
}

Verdict check_constraints_within(const EnergyTrace& trace, double metres) {
  const auto& rows = rows_of(trace, metres);
  Excess excess;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    excess.take(i, std::max(rows[i].penetration, rows[i].joint_error), metres);
  }
  return excess.verdict("a constraint is violated by", trace, Quantity::length);
}

}  // namespace carom::energy_test

#include <carom/core/errors.h>
#include <carom/core/part_check.h>
#include <carom/core/text_table.h>
#include <carom/core/trace_comparison.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <ostream>
#include <utility>

namespace carom {

namespace {

double absolute(const TraceTolerances& tolerances, Quantity quantity) {
  switch (quantity) {
    case Quantity::energy:
      return tolerances.energy;
    case Quantity::momentum:
      return tolerances.momentum;
    case Quantity::angular_momentum:
      return tolerances.angular_momentum;
    case Quantity::length:
      return tolerances.length;
    case Quantity::time:
      break;
  }
  return 0.0;
}

void check(const TraceTolerances& t) {
  const std::array<std::pair<const char*, double>, 5> all{{{"relative", t.relative},
                                                           {"energy", t.energy},
                                                           {"momentum", t.momentum},
                                                           {"angular_momentum", t.angular_momentum},
                                                           {"length", t.length}}};
  for (const auto& [name, value] : all) {
    if (std::isfinite(value) && value >= 0.0) continue;
    throw ModelError(std::string("trace tolerances: ") + name + " is " + to_text(value) +
                     "; allowed: finite and >= 0");
  }
}

void check_times(const std::vector<TraceRow>& rows, const std::vector<TraceRow>& stored) {
  if (rows.empty() || stored.empty()) {
    throw ModelError(std::string("compare: ") + (rows.empty() ? "trace" : "stored trace") +
                     " has no rows; allowed: at least one");
  }
  const std::string allowed = "; allowed: traces taken at the same times (nothing is interpolated)";
  for (std::size_t i = 0; i < std::min(rows.size(), stored.size()); ++i) {
    const double a = rows[i].time, b = stored[i].time;
    if (std::abs(a - b) <= same_time * std::max(std::abs(a), std::abs(b))) continue;
    throw ModelError("compare: time of row " + std::to_string(i) + " is " + to_text(a) + " s, stored " +
                     to_text(b) + " s" + allowed);
  }
  if (rows.size() != stored.size()) {
    throw ModelError("compare: trace has " + std::to_string(rows.size()) + " rows, the stored one " +
                     std::to_string(stored.size()) + allowed);
  }
}

std::string nearest(const char* what, const EnergyTrace& trace, double time) {
  std::string text = what;
  const TraceEvent* event = trace.nearest_event(time);
  if (!event) return text + "none\n";
  const double ago = time - event->time;
  text += "t = " + cell(event->time) + " s";
  if (ago != 0.0) text += " (" + cell(std::abs(ago), 3) + " s " + (ago > 0.0 ? "before" : "after") + ")";
  return text + ": " + event->text + "\n";
}

std::string quoted(const TraceTerm& term) { return "'" + std::string(term.name) + "'"; }

/// A table of the terms that depart, in the order in which they do.
std::string departures(const std::vector<TermComparison>& terms) {
  std::vector<const TermComparison*> departing;
  for (const TermComparison& term : terms) {
    if (term.first) departing.push_back(&term);
  }
  std::stable_sort(departing.begin(), departing.end(), [](const TermComparison* a, const TermComparison* b) {
    return a->first->time < b->first->time;
  });
  TextTable table({"term", "departs at [s]", "worst at [s]", "trace", "stored", "apart", "allowed", "unit"});
  for (const TermComparison* term : departing) {
    const TermDifference& worst = term->worst;
    table.add({std::string(term->term.name), cell(term->first->time), cell(worst.time), cell(worst.value, 12),
               cell(worst.stored, 12), cell(worst.amount(), 3), cell(worst.allowed, 3),
               std::string(unit(term->term.quantity))});
  }
  return table.empty() ? "" : table.text();
}

std::string report_of(const TraceComparison& comparison, const EnergyTrace& trace,
                      const EnergyTrace& stored) {
  std::string text;
  if (comparison.first) {
    const TermComparison& term = comparison.terms[*comparison.first];
    const std::string in(unit(term.term.quantity));
    text = quoted(term.term) + " departs first: at t = " + cell(term.first->time) + " s by " +
           cell(term.first->amount(), 3) + " " + in + ", allowed " + cell(term.first->allowed, 3) + " " + in +
           "\n" + nearest("nearest event: ", trace, term.first->time) +
           nearest("nearest stored event: ", stored, term.first->time) + departures(comparison.terms);
  }
  std::size_t within = 0;
  const TermComparison* closest = nullptr;
  for (const TermComparison& term : comparison.terms) {
    if (term.first) continue;
    ++within;
    if (!closest || term.worst.ratio() > closest->worst.ratio()) closest = &term;
  }
  text += std::to_string(within) + " of " + std::to_string(comparison.terms.size()) + " terms agree at " +
          std::to_string(trace.rows().size()) + " times";
  if (closest && closest->worst.ratio() > 0.0) {
    text += "; the nearest to its limit is " + quoted(closest->term) + " with " +
            cell(closest->worst.ratio(), 2) + " of it at t = " + cell(closest->worst.time) + " s";
  }
  return text + "\n";
}

}  // namespace

double TermDifference::amount() const { return std::abs(value - stored); }

double TermDifference::ratio() const {
  if (value == stored) return 0.0;
  return allowed > 0.0 ? amount() / allowed : std::numeric_limits<double>::infinity();
}

TraceComparison compare(const EnergyTrace& trace, const EnergyTrace& stored,
                        const TraceTolerances& tolerances) {
  check(tolerances);
  check_times(trace.rows(), stored.rows());

  std::vector<TermComparison> all(trace_term_count);
  for (std::size_t row = 0; row < trace.rows().size(); ++row) {
    const TraceRow& expected = stored.rows()[row];
    const auto found_values = values_of(trace.rows()[row]);
    const auto stored_values = values_of(expected);
    for (std::size_t i = 0; i < trace_term_count; ++i) {
      const Quantity quantity = trace_terms()[i].quantity;
      const TermDifference here{
          expected.time, found_values[i], stored_values[i],
          absolute(tolerances, quantity) + tolerances.relative * expected.scale(quantity)};
      if (row == 0 || here.ratio() > all[i].worst.ratio()) all[i].worst = here;
      if (!all[i].first && here.ratio() > 1.0) all[i].first = here;
    }
  }

  TraceComparison result;
  for (std::size_t i = 0; i < trace_term_count; ++i) {
    all[i].term = trace_terms()[i];
    if (all[i].term.is_scale || all[i].term.quantity == Quantity::time) continue;
    result.terms.push_back(all[i]);
    if (!all[i].first) continue;
    const auto& now = all[i].first;
    const auto* before = result.first ? &*result.terms[*result.first].first : nullptr;
    if (!before || now->time < before->time ||
        (now->time == before->time && now->ratio() > before->ratio())) {
      result.first = result.terms.size() - 1;
    }
  }
  result.report = report_of(result, trace, stored);
  return result;
}

std::ostream& operator<<(std::ostream& out, const TraceComparison& comparison) {
  return out << comparison.report;
}

}  // namespace carom

// Problem: a trace as a table that people, spreadsheets and plotting tools can read, and that reads back to
// the same bits.

#include <carom/core/csv.h>
#include <carom/core/energy_trace.h>
#include <carom/core/errors.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>

namespace carom {

namespace {

constexpr std::string_view event_column = "event";

std::string column_name(const TraceTerm& term) {
  return std::string(term.name) + " [" + std::string(unit(term.quantity)) + "]";
}

/// Where the columns of a file stand.
struct Columns {
  std::vector<std::string> names;                     // of the file
  std::array<std::size_t, trace_term_count> terms{};  // places of the terms
  std::size_t event = 0;
};

Columns read_header(CsvReader& reader) {
  Columns columns;
  reader.next(columns.names);
  const auto place = [&](const std::string& name) {
    const auto found = std::find(columns.names.begin(), columns.names.end(), name);
    if (found == columns.names.end()) reader.refuse("column '" + name + "' is missing");
    return static_cast<std::size_t>(found - columns.names.begin());
  };
  std::vector<std::size_t> known;
  for (std::size_t i = 0; i < trace_term_count; ++i) {
    known.push_back(columns.terms[i] = place(column_name(trace_terms()[i])));
  }
  known.push_back(columns.event = place(std::string(event_column)));
  for (std::size_t i = 0; i < columns.names.size(); ++i) {
    if (std::find(known.begin(), known.end(), i) != known.end()) continue;
    const bool twice = std::count(columns.names.begin(), columns.names.end(), columns.names[i]) > 1;
    reader.refuse("column '" + columns.names[i] + "' is " + (twice ? "there twice" : "unknown") +
                  "; allowed: time, the terms of the energy ledger, momenta, errors, their scales, event");
  }
  return columns;
}

class RowReader {
public:
  RowReader(CsvReader& reader, const Columns& columns) : reader_(&reader), columns_(&columns) {}

  /// Adds the line to the trace, as a row or as an event.
  void take(const std::vector<std::string>& fields, EnergyTrace& trace) {
    if (fields.size() != columns_->names.size()) {
      reader_->refuse("it has " + std::to_string(fields.size()) +
                      " columns; allowed: " + std::to_string(columns_->names.size()) + ", as the header");
    }
    const std::size_t time_column = columns_->terms[0];
    const double time = number(fields, time_column);
    const bool is_event = !fields[columns_->event].empty();
    if (!(time >= last_) || (!is_event && !(time > last_row_))) {
      refuse(time_column, fields, is_event ? "not before the line before" : "later than the row before");
    }
    last_ = time;
    if (is_event) {
      for (std::size_t i = 0; i < fields.size(); ++i) {
        if (i == time_column || i == columns_->event || fields[i].empty()) continue;
        refuse(i, fields, "nothing beside time and event on the line of an event");
      }
      trace.add(TraceEvent{time, fields[columns_->event]});
      return;
    }
    last_row_ = time;
    std::array<double, trace_term_count> values{};
    for (std::size_t i = 0; i < trace_term_count; ++i) values[i] = number(fields, columns_->terms[i]);
    trace.add(row_of(values));
  }

private:
  [[noreturn]] void refuse(std::size_t column, const std::vector<std::string>& fields,
                           const std::string& allowed) const {
    reader_->refuse("column '" + columns_->names[column] + "': '" + fields[column] +
                    "'; allowed: " + allowed);
  }
  [[nodiscard]] double number(const std::vector<std::string>& fields, std::size_t column) const {
    const std::string& field = fields[column];
    double value = 0.0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc{} || end != field.data() + field.size() || !std::isfinite(value)) {
      refuse(column, fields, "a finite number");
    }
    return value;
  }

  CsvReader* reader_;
  const Columns* columns_;
  double last_ = -std::numeric_limits<double>::infinity(), last_row_ = last_;
};

}  // namespace

void EnergyTrace::save(const std::string& path) const {
  std::string text;
  for (const TraceTerm& term : trace_terms()) {
    append_csv(text, column_name(term));
    text += ',';
  }
  text.append(event_column).append("\n");

  auto event = events_.begin();
  const auto write_events_until = [&](double time) {
    for (; event != events_.end() && event->time <= time; ++event) {
      append_csv(text, event->time);
      text.append(trace_term_count, ',');
      append_csv(text, event->text);
      text += '\n';
    }
  };
  for (const TraceRow& row : rows_) {
    write_events_until(row.time);
    for (const double value : values_of(row)) {
      append_csv(text, value);
      text += ',';
    }
    text += '\n';
  }
  write_events_until(std::numeric_limits<double>::infinity());

  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw FileError("trace '" + path + "' cannot be written");
}

EnergyTrace EnergyTrace::load(const std::string& path) {
  CsvReader reader("trace", path);
  const Columns columns = read_header(reader);
  RowReader rows(reader, columns);
  EnergyTrace trace;
  std::vector<std::string> fields;
  while (reader.next(fields)) rows.take(fields, trace);
  return trace;
}

}  // namespace carom

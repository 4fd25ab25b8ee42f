// Problem: read a contact problem from a file that anybody may have written.

#include <carom/contact/solvers/problem_file.h>
#include <carom/contact/solvers/problem_format.h>
#include <carom/core/errors.h>

#if defined(CAROM_WITH_JSON)

#include <carom/core/part_check.h>
#include <carom/core/whole_file.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <stdexcept>
#include <string_view>

namespace carom {

namespace {

using Json = nlohmann::ordered_json;

// W may be off symmetry by this part of sqrt(W_ii W_jj): numbers written by hand or by another program with a
// dozen digits. carom itself writes symmetric ones.
constexpr double symmetry = 1e-12;

// Values that were read, with their address in messages.
class Reader {
public:
  explicit Reader(const std::string& path) : path_(path) {}

  [[noreturn]] void refuse(const std::string& message) const {
    throw FileError(std::string(problem_format::label) + " '" + path_ + "': " + message);
  }
  [[noreturn]] void refuse(const std::string& field, const std::string& value,
                           const std::string& allowed) const {
    refuse(field + " is " + value + "; allowed: " + allowed);
  }
  // A value as messages show it.
  static std::string shown(const Json& value) {
    constexpr std::size_t longest = 40;
    if (value.is_object()) return "an object";
    if (value.is_array()) return "a list of " + std::to_string(value.size());
    std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
    if (text.size() > longest) text = text.substr(0, longest) + "...";
    return text;
  }

  const Json& member(const Json& object, const std::string& of, const char* name) const {
    if (!object.contains(name)) refuse(of + name + " is not given");
    return object[name];
  }
  void demand_fields(const Json& object, const std::string& of,
                     std::initializer_list<std::string_view> known) const {
    for (const auto& [name, value] : object.items()) {
      if (std::find(known.begin(), known.end(), name) != known.end()) continue;
      std::string allowed;
      for (const std::string_view one : known) allowed.append(allowed.empty() ? "" : ", ").append(one);
      refuse("field '" + of + name + "' is unknown; allowed: " + allowed);
    }
  }
  double number(const Json& value, const std::string& field) const {
    if (value.is_number()) return value.get<double>();
    if (value == "inf") return std::numeric_limits<double>::infinity();
    if (value == "-inf") return -std::numeric_limits<double>::infinity();
    if (value == "nan") return std::numeric_limits<double>::quiet_NaN();
    refuse(field, shown(value), R"(a number, "inf", "-inf" or "nan")");
  }
  int whole(const Json& value, const std::string& field, int lowest, int highest,
            const std::string& allowed) const {
    // A number beyond 64 bits is read as one with a fraction.
    if (value.is_number_integer()) {
      const bool fits = !value.is_number_unsigned() ||
                        value.get<std::uint64_t>() <= std::uint64_t{std::numeric_limits<int>::max()};
      const std::int64_t read = fits ? value.get<std::int64_t>() : std::int64_t{-1};
      if (fits && read >= lowest && read <= highest) return static_cast<int>(read);
    }
    refuse(field, shown(value), allowed);
  }
  const Json& list(const Json& value, const std::string& field, int size, const char* of) const {
    if (!value.is_array() || value.size() != static_cast<std::size_t>(size)) {
      refuse(field, shown(value), "a list of " + std::to_string(size) + " " + of);
    }
    return value;
  }
  std::string text(const Json& value, const std::string& field) const {
    if (!value.is_string()) refuse(field, shown(value), "a text");
    return value.get<std::string>();
  }

private:
  const std::string& path_;
};

std::string at(const char* field, int row) { return std::string(field) + "[" + std::to_string(row) + "]"; }

void read_matrix(const Reader& in, const Json& rows, ContactProblem& problem) {
  const int n = problem.rows();
  for (int i = 0; i < n; ++i) {
    const Json& row = in.list(rows[static_cast<std::size_t>(i)], at("W", i), n, "numbers");
    for (int j = 0; j < n; ++j) {
      problem.w(i, j) = in.number(row[static_cast<std::size_t>(j)], at("W", i) + at("", j));
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < i; ++j) {
      const double below = problem.w(i, j), above = problem.w(j, i);
      // A number that is none says nothing of symmetry.
      if (std::isnan(below) || std::isnan(above) || below == above) continue;
      const double allowed =
          symmetry * std::sqrt(std::abs(problem.w(i, i))) * std::sqrt(std::abs(problem.w(j, j)));
      const double off = std::abs(below - above);
      if (off <= allowed) continue;
      in.refuse(at("W", i) + at("", j), to_text(below),
                at("W", j) + at("", i) + ", " + to_text(above) + ", within " + to_text(allowed) +
                    ": a symmetric matrix (it is off by " + to_text(off) + ")");
    }
  }
}

// M^-1 by slot, and H by row: a list of blocks, each a slot and its numbers.
void read_factors(const Reader& in, const Json& masses, const Json& rows, ContactProblem& problem) {
  constexpr int columns = ResponseFactors::columns, most = ResponseFactors::most_slots;
  ResponseFactors& factors = problem.factors();
  const int slots = static_cast<int>(factors.slots());
  for (int slot = 0; slot < slots; ++slot) {
    const std::string field = at("inverse_masses", slot);
    const Json& of_slot = in.list(masses[static_cast<std::size_t>(slot)], field, columns, "numbers");
    for (int k = 0; k < columns; ++k) {
      double& inverse = factors.inverse_mass[static_cast<std::size_t>(columns * slot + k)];
      inverse = in.number(of_slot[static_cast<std::size_t>(k)], field + at("", k));
      if (inverse < 0.0) in.refuse(field + at("", k), to_text(inverse), ">= 0");
    }
  }
  for (int r = 0; r < problem.rows(); ++r) {
    const Json& blocks = rows[static_cast<std::size_t>(r)];
    if (!blocks.is_array() || blocks.size() > std::size_t{most}) {
      in.refuse(at("H", r), Reader::shown(blocks), "a list of up to " + std::to_string(most) + " blocks");
    }
    ResponseFactors::Row& row = factors.rows[static_cast<std::size_t>(r)];
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const std::string field = at("H", r) + at("", static_cast<int>(i));
      const Json& block = in.list(blocks[i], field, columns + 1, "numbers, the first of them a slot");
      row.slot[i] =
          in.whole(block[0], field + "[0]", 0, slots - 1, "a slot, 0 to " + std::to_string(slots - 1));
      for (std::size_t k = 0; k < columns; ++k) {
        row.h[columns * i + k] = in.number(block[k + 1], field + at("", static_cast<int>(k) + 1));
      }
    }
  }
}

// W, as a matrix or in factors. Their lists bound the number of rows before anything is allocated for it.
void read_response(const Reader& in, const Json& file, int rows, ContactProblem& problem) {
  if (file.contains("H")) {
    if (file.contains("W")) in.refuse("W is given beside H; allowed: one of them");
    in.list(file["H"], "H", rows, "rows");
    const Json& masses = in.member(file, "", "inverse_masses");
    if (!masses.is_array())
      in.refuse("inverse_masses", Reader::shown(masses), "a list, three numbers a slot");
    problem.reset_factors(rows, static_cast<int>(masses.size()));
    return read_factors(in, masses, file["H"], problem);
  }
  const Json& matrix = in.member(file, "", "W");
  in.list(matrix, "W", rows, "rows");
  if (rows > 0) in.list(matrix[0], at("W", 0), rows, "numbers");
  problem.reset(rows);
  read_matrix(in, matrix, problem);
}

RowSet read_set(const Reader& in, const Json& value, int row) {
  const std::string field = at("sets", row);
  if (!value.is_object()) in.refuse(field, Reader::shown(value), "an object with a kind");
  const std::string kind = in.text(in.member(value, field + ".", "kind"), field + ".kind");
  const auto* const known = std::find_if(problem_format::kinds.begin(), problem_format::kinds.end(),
                                         [&](const auto& entry) { return entry.second == kind; });
  if (known == problem_format::kinds.end()) {
    in.refuse(field + ".kind", "\"" + kind + "\"",
              R"("half_line", "interval", "bounded_interval", "bounded_disc" or "proportional")");
  }
  RowSet set{.kind = known->first};
  const auto number = [&](const char* name) {
    return in.number(in.member(value, field + ".", name), field + "." + name);
  };
  switch (set.kind) {
    case SetKind::half_line:
      in.demand_fields(value, field + ".", {"kind"});
      break;
    case SetKind::interval:
      in.demand_fields(value, field + ".", {"kind", "lower", "upper"});
      set.lower = number("lower");
      set.upper = number("upper");
      if (std::isnan(set.lower)) in.refuse(field + ".lower", "nan", "a number or \"-inf\"");
      if (!(set.lower <= set.upper)) {
        in.refuse(field + ".upper", to_text(set.upper), "at least lower, " + to_text(set.lower));
      }
      break;
    case SetKind::bounded_interval:
    case SetKind::bounded_disc:
    case SetKind::proportional:
      in.demand_fields(value, field + ".", {"kind", "bound", "coefficient"});
      if (row == 0) in.refuse(field + ".kind", "\"" + kind + "\"", "a row before it that bounds it");
      set.bound = in.whole(in.member(value, field + ".", "bound"), field + ".bound", 0, row - 1,
                           "a row before it, 0 to " + std::to_string(row - 1));
      set.coefficient = number("coefficient");
      if (!std::isfinite(set.coefficient) || (set.coefficient < 0.0 && set.kind != SetKind::proportional)) {
        in.refuse(field + ".coefficient", to_text(set.coefficient),
                  set.kind == SetKind::proportional ? "finite" : "finite and >= 0");
      }
      break;
  }
  return set;
}

ProblemNotes read_notes(const Reader& in, const Json& file, std::size_t groups) {
  ProblemNotes notes;
  if (file.contains("comment")) notes.comment = in.text(file["comment"], "comment");
  if (file.contains("time")) notes.time = in.number(file["time"], "time");
  if (file.contains("contacts")) {
    const Json& names =
        in.list(file["contacts"], "contacts", static_cast<int>(groups), "names, one for each group of rows");
    for (const Json& name : names) {
      notes.contacts.push_back(in.text(name, at("contacts", static_cast<int>(notes.contacts.size()))));
    }
  }
  return notes;
}

void demand_this_format(const Reader& in, const Json& file) {
  if (!file.is_object()) in.refuse("the file", Reader::shown(file), "an object");
  const std::string found = in.text(in.member(file, "", "format"), "format");
  if (found != problem_format::name) {
    in.refuse("format", "\"" + found + "\"", "\"" + std::string(problem_format::name) + "\"");
  }
  constexpr int version = problem_format::version;
  const Json& number = in.member(file, "", "version");
  if (number.is_number_integer() && number > version) {
    in.refuse("version", Reader::shown(number),
              "up to " + std::to_string(version) + " in this carom: the file is from a newer one");
  }
  in.whole(number, "version", version, version, std::to_string(version));
}

Json parsed(const Reader& in, const std::string& content) {
  try {
    return Json::parse(content);
  } catch (const Json::parse_error& error) {
    const std::size_t byte = std::min(error.byte, content.size());
    const auto line =
        1 + std::count(content.begin(), content.begin() + static_cast<std::ptrdiff_t>(byte), '\n');
    in.refuse("is not JSON: line " + std::to_string(line) + ", byte " + std::to_string(error.byte) + ": " +
              error.what());
  } catch (const Json::exception& error) {  // a number beyond the range of a double
    in.refuse(std::string("cannot be read: ") + error.what());
  }
}

}  // namespace

bool problem_files_available() { return true; }

ProblemFile load_problem(const std::string& path) {
  const Reader in(path);
  const Json file = parsed(in, read_file(path, problem_format::label));
  demand_this_format(in, file);
  in.demand_fields(
      file, "",
      {"format", "version", "comment", "time", "contacts", "rows", "W", "inverse_masses", "H", "b", "sets"});
  ProblemFile result;
  ContactProblem& problem = result.problem;
  const int rows = in.whole(in.member(file, "", "rows"), "rows", 0, std::numeric_limits<int>::max(),
                            "a whole number >= 0");
  read_response(in, file, rows, problem);
  const Json& b = in.list(in.member(file, "", "b"), "b", rows, "numbers");
  const Json& sets = in.list(in.member(file, "", "sets"), "sets", rows, "sets");
  for (int row = 0; row < rows; ++row) {
    const auto place = static_cast<std::size_t>(row);
    problem.vector()[place] = in.number(b[place], at("b", row));
    problem.sets()[place] = read_set(in, sets[place], row);
  }
  try {
    problem.group();
  } catch (const std::invalid_argument& error) {
    in.refuse(error.what());
  }
  result.notes = read_notes(in, file, problem.groups().size());
  return result;
}

}  // namespace carom

#else

namespace carom {

namespace {

[[noreturn]] void refuse(const std::string& path) {
  throw FileError("contact problem '" + path +
                  "': this carom was built without JSON (CMake option CAROM_WITH_JSON)");
}

}  // namespace

bool problem_files_available() { return false; }

ProblemFile load_problem(const std::string& path) { refuse(path); }

}  // namespace carom

#endif

namespace carom {

void save_problem(const std::string& path, const ContactProblem& problem) {
  save_problem(path, problem, ProblemNotes{});
}

void ContactProblem::save(const std::string& path) const { save_problem(path, *this); }

ContactProblem ContactProblem::load(const std::string& path) { return load_problem(path).problem; }

}  // namespace carom

// Problem: write down a contact problem so that another machine solves the same one, bit for bit.

#include <carom/contact/solvers/problem_file.h>
#include <carom/core/errors.h>

#if defined(CAROM_WITH_JSON)

#include <carom/contact/solvers/problem_format.h>
#include <carom/core/part_check.h>
#include <carom/core/whole_file.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

namespace carom {

namespace {

using Json = nlohmann::ordered_json;

// JSON knows neither infinities nor NaN.
Json number(double value) {
  if (std::isfinite(value)) return value;
  return to_text(value);
}

Json numbers(std::span<const double> values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(number(value));
  return list;
}

Json written(const RowSet& set) {
  const auto* const kind = std::find_if(problem_format::kinds.begin(), problem_format::kinds.end(),
                                        [&](const auto& entry) { return entry.first == set.kind; });
  Json out;
  out["kind"] = kind->second;
  switch (set.kind) {
    case SetKind::half_line:
      break;
    case SetKind::interval:
      out["lower"] = number(set.lower);
      out["upper"] = number(set.upper);
      break;
    case SetKind::bounded_interval:
    case SetKind::bounded_disc:
    case SetKind::proportional:
      out["bound"] = set.bound;
      out["coefficient"] = number(set.coefficient);
      break;
  }
  return out;
}

// The numbers of each slot.
Json inverse_masses(const ResponseFactors& factors) {
  constexpr std::size_t columns = ResponseFactors::columns;
  Json list = Json::array();
  for (std::size_t slot = 0; slot < factors.slots(); ++slot) {
    list.push_back(numbers(std::span(factors.inverse_mass).subspan(columns * slot, columns)));
  }
  return list;
}

// Each row as its blocks: slot and numbers.
Json factor_rows(const ResponseFactors& factors) {
  constexpr std::size_t columns = ResponseFactors::columns;
  Json list = Json::array();
  for (const ResponseFactors::Row& row : factors.rows) {
    Json blocks = Json::array();
    for (std::size_t i = 0; i < row.slot.size() && row.slot[i] != ResponseFactors::no_slot; ++i) {
      Json block = Json::array({row.slot[i]});
      for (std::size_t k = 0; k < columns; ++k) block.push_back(number(row.h[columns * i + k]));
      blocks.push_back(std::move(block));
    }
    list.push_back(std::move(blocks));
  }
  return list;
}

// One field on a line; of lists of lists (W, sets) one element.
std::string laid_out(const Json& fields) {
  std::string text = "{";
  const char* separator = "\n";
  for (const auto& [name, value] : fields.items()) {
    text += separator + ("  " + Json(name).dump()) + ": ";
    separator = ",\n";
    if (!value.is_array() || value.empty() || !value.front().is_structured()) {
      text += value.dump();
      continue;
    }
    text += '[';
    const char* comma = "\n";
    for (const Json& element : value) {
      text += comma + ("    " + element.dump());
      comma = ",\n";
    }
    text += "\n  ]";
  }
  return text + "\n}\n";
}

}  // namespace

void save_problem(const std::string& path, const ContactProblem& problem, const ProblemNotes& notes) {
  // Files know bodies that answer for themselves.
  if (problem.is_factored() && problem.factors().any_bound()) {
    return save_problem(path, problem.dense(), notes);
  }
  const auto n = static_cast<std::size_t>(problem.rows());
  Json file;
  file["format"] = problem_format::name;
  file["version"] = problem_format::version;
  if (!notes.comment.empty()) file["comment"] = notes.comment;
  if (notes.time) file["time"] = number(*notes.time);
  if (!notes.contacts.empty()) file["contacts"] = notes.contacts;
  file["rows"] = problem.rows();
  if (problem.is_factored()) {
    file["inverse_masses"] = inverse_masses(problem.factors());
    file["H"] = factor_rows(problem.factors());
  } else {
    file["W"] = Json::array();
    for (std::size_t i = 0; i < n; ++i) file["W"].push_back(numbers(problem.matrix().subspan(i * n, n)));
  }
  file["b"] = numbers(problem.vector());
  file["sets"] = Json::array();
  for (const RowSet& set : problem.sets()) file["sets"].push_back(written(set));
  std::string text;
  try {
    text = laid_out(file);
  } catch (const Json::exception&) {
    throw FileError(std::string(problem_format::label) + " '" + path +
                    "': a name or the comment is not UTF-8");
  }
  write_file(path, text, problem_format::label);
}

}  // namespace carom

#else

namespace carom {

void save_problem(const std::string& path, const ContactProblem&, const ProblemNotes&) {
  throw FileError("contact problem '" + path +
                  "': this carom was built without JSON (CMake option CAROM_WITH_JSON)");
}

}  // namespace carom

#endif

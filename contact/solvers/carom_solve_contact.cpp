// carom-solve-contact: solves a saved contact problem with one solver, with the chain, or with all of them,
// and says who is right by the one residual that judges them (docs/contact_problems.md).

#include <carom/contact/solvers/problem_file.h>
#include <carom/contact/solvers/residual_history.h>
#include <carom/contact/solvers/solver_chain.h>
#include <carom/core/errors.h>
#include <carom/core/part_check.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <exception>
#include <iomanip>
#include <iostream>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace {

using namespace carom;

constexpr int certified = 0, not_certified = 1, wrong_call = 2;

constexpr std::string_view usage = R"(usage: carom-solve-contact FILE [--solver NAME] [--json] [--history CSV]

Solves the contact problem in FILE and prints the answer with its certificate.

  --solver NAME  chain (default), all (every solver beside the chain), single-contact,
                 principal-pivoting (on the paper's form), lemke, enumeration, dense-sweeps (of
                 many rows, or with discs), nonlinear-cg (of problems in factors)
  --json         prints JSON instead of tables
  --history CSV  also writes the residual of each solver asked after every sweep, and the seconds that it
                 took; of `chain` those of the solver whose answer it took
  --sweeps N     most sweeps of nonlinear-cg, at least 1 (default: 80)
  --help         prints this

Exit code: 0 if the answer is certified (residual up to 1e-10; of `all`: any answer), 1 if not, 2 if the
call or the file is wrong.
)";

// Name of a solver on the command line: "principal pivoting" is "principal-pivoting".
std::string option_name(SolverId solver) {
  std::string name(to_string(solver));
  std::transform(name.begin(), name.end(), name.begin(), [](char letter) {
    return letter == ' ' ? '-' : static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  });
  return name;
}

struct Options {
  std::string file;
  std::string solver = "chain";
  std::string history;  // path; empty: none
  SweepBudget budget{};
  bool json = false;
  bool help = false;
};

struct WrongCall : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// True if the argument at i is an option with a value, "--name value" or "--name=value"; i is then at its
// end.
bool read_value(std::span<char*> arguments, std::size_t& i, const std::string& name, std::string& value) {
  const std::string argument = arguments[i];
  if (argument.starts_with(name + "=")) {
    value = argument.substr(name.size() + 1);
  } else if (argument != name) {
    return false;
  } else if (++i == arguments.size()) {
    throw WrongCall(name + " needs a value");
  } else {
    value = arguments[i];
  }
  if (value.empty()) throw WrongCall(name + " needs a value");
  return true;
}

int sweeps_of(const std::string& text) {
  int sweeps = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), sweeps);
  if (error != std::errc() || end != text.data() + text.size() || sweeps < 1) {
    throw WrongCall("--sweeps is '" + text + "'; allowed: a whole number, at least 1");
  }
  return sweeps;
}

Options options_of(std::span<char*> arguments) {
  Options options;
  std::string sweeps;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (read_value(arguments, i, "--solver", options.solver)) continue;
    if (read_value(arguments, i, "--history", options.history)) continue;
    if (read_value(arguments, i, "--sweeps", sweeps)) {
      options.budget.sweeps = sweeps_of(sweeps);
      continue;
    }
    const std::string argument = arguments[i];
    if (argument == "--help" || argument == "-h") {
      options.help = true;
    } else if (argument == "--json") {
      options.json = true;
    } else if (argument.size() > 1 && argument.front() == '-') {
      throw WrongCall("unknown option '" + argument + "'");
    } else if (!options.file.empty()) {
      throw WrongCall("one file at a time: '" + options.file + "' and '" + argument + "' were given");
    } else {
      options.file = argument;
    }
  }
  if (options.file.empty() && !options.help) throw WrongCall("no file was given");
  return options;
}

// The solvers to ask; none stands for the chain.
std::vector<std::optional<SolverId>> asked(const std::string& name) {
  if (name == "chain") return {std::nullopt};
  std::string allowed = "chain, all";
  std::vector<std::optional<SolverId>> all;
  for (const SolverId solver : all_solvers) {
    if (name == option_name(solver)) return {solver};
    allowed += ", " + option_name(solver);
    all.emplace_back(solver);
  }
  if (name != "all") throw WrongCall("--solver is '" + name + "'; allowed: " + allowed);
  all.emplace_back(std::nullopt);
  return all;
}

struct Answer {
  std::string name;
  ContactReport report;
  std::vector<double> impulse, xi;
  std::vector<ContactMode> modes;

  Answer(const ContactProblem& problem, std::optional<SolverId> solver, const SweepBudget& budget)
      : name(solver ? to_string(*solver) : "chain"), impulse(static_cast<std::size_t>(problem.rows())) {
    SolverChain chain;
    if (problem.is_factored()) chain.set_budget(budget);
    report = solver ? chain.solve_with(*solver, problem, impulse) : chain.solve(problem, impulse);
    xi.assign(chain.velocities().begin(), chain.velocities().end());
    modes.assign(chain.modes().begin(), chain.modes().end());
  }
  // Nothing was written that is worth showing.
  [[nodiscard]] bool empty() const { return report.tried == 0 && !report.usable(); }
};

std::string group_name(const ProblemFile& file, int group) {
  if (group < 0) return "none";
  std::string name = std::to_string(group);
  if (!file.notes.contacts.empty()) name += " " + file.notes.contacts[static_cast<std::size_t>(group)];
  return name;
}

void print_summary(const ProblemFile& file, const std::vector<Answer>& answers) {
  std::cout << std::left << std::setw(20) << "solver" << std::setw(20) << "outcome" << std::right
            << std::setw(10) << "iterations" << std::setw(12) << "residual"
            << "  worst group\n";
  for (const Answer& answer : answers) {
    const ContactReport& report = answer.report;
    std::cout << std::left << std::setw(20) << answer.name << std::setw(20) << to_string(report.outcome)
              << std::right << std::setw(10) << report.iterations << std::setw(12) << std::scientific
              << std::setprecision(2) << report.residual << "  " << group_name(file, report.worst_group);
    if (report.degenerate) std::cout << "; at a boundary between modes";
    if (answer.name != report.solver && !report.solver.empty()) std::cout << "; by " << report.solver;
    if (!report.reason.empty()) std::cout << "; " << report.reason;
    std::cout << "\n";
  }
}

void print_answer(const ProblemFile& file, const Answer& answer) {
  std::cout << "\n" << answer.name << (answer.report.usable() ? "" : " (not an answer)") << "\n";
  std::cout << std::setw(6) << "row" << std::setw(26) << "P [N s]" << std::setw(26) << "xi [m/s]"
            << "  mode\n";
  const auto groups = file.problem.groups();
  for (std::size_t g = 0; g < groups.size(); ++g) {
    for (int i = 0; i < groups[g].size; ++i) {
      const int row = groups[g].first + i;
      std::cout << std::setw(6) << row << std::scientific << std::setprecision(16) << std::setw(26)
                << answer.impulse[static_cast<std::size_t>(row)] << std::setw(26)
                << answer.xi[static_cast<std::size_t>(row)];
      if (i == 0) std::cout << "  " << to_string(answer.modes[g]);
      if (i == 0 && !file.notes.contacts.empty()) std::cout << "  " << file.notes.contacts[g];
      std::cout << "\n";
    }
  }
}

// Largest difference of velocities between certified answers [m/s].
double disagreement(const std::vector<Answer>& answers) {
  double largest = 0.0;
  const Answer* first = nullptr;
  for (const Answer& answer : answers) {
    if (!answer.report.usable()) continue;
    if (first == nullptr) first = &answer;
    for (std::size_t i = 0; i < answer.xi.size(); ++i) {
      largest = std::max(largest, std::abs(answer.xi[i] - first->xi[i]));
    }
  }
  return largest;
}

const Answer* best_of(const std::vector<Answer>& answers) {
  const Answer* best = nullptr;
  for (const Answer& answer : answers) {
    if (!answer.report.usable()) continue;
    if (best == nullptr || answer.report.residual < best->report.residual) best = &answer;
  }
  return best;
}

void print_verdict(const std::vector<Answer>& answers) {
  std::string right, wrong;
  for (const Answer& answer : answers) {
    std::string& list = answer.report.usable() ? right : wrong;
    list += (list.empty() ? "" : ", ") + answer.name;
  }
  std::cout << "\nright (residual up to " << to_text(tolerated_residual)
            << "): " << (right.empty() ? "none" : right) << "\n";
  if (!wrong.empty()) std::cout << "without an answer: " << wrong << "\n";
  const Answer* const best = best_of(answers);
  if (best == nullptr) return;
  std::cout << "smallest residual: " << best->name << ", " << to_text(best->report.residual) << "\n";
  std::cout << "velocities of the right ones differ by up to " << to_text(disagreement(answers)) << " m/s\n";
}

void print_tables(const ProblemFile& file, const std::string& path, const std::vector<Answer>& answers) {
  std::cout << path << ": " << file.problem.rows() << " rows in " << file.problem.groups().size()
            << " groups";
  if (file.notes.time) std::cout << ", t = " << to_text(*file.notes.time) << " s";
  std::cout << "\n";
  if (!file.notes.comment.empty()) std::cout << file.notes.comment << "\n";
  std::cout << "\n";
  print_summary(file, answers);
  for (const Answer& answer : answers) {
    if (!answer.empty()) print_answer(file, answer);
  }
  if (answers.size() > 1) print_verdict(answers);
}

nlohmann::ordered_json numbers(const std::vector<double>& values) {
  auto list = nlohmann::ordered_json::array();
  for (const double value : values) {
    if (std::isfinite(value)) {
      list.push_back(value);
    } else {
      list.push_back(to_text(value));  // JSON has no other way
    }
  }
  return list;
}

void print_json(const std::string& path, const std::vector<Answer>& answers) {
  nlohmann::ordered_json out;
  out["file"] = path;
  out["answers"] = nlohmann::ordered_json::array();
  for (const Answer& answer : answers) {
    const ContactReport& report = answer.report;
    nlohmann::ordered_json entry;
    entry["solver"] = answer.name;
    entry["outcome"] = to_string(report.outcome);
    entry["certified"] = report.usable();
    entry["by"] = report.solver;
    entry["reason"] = report.reason;
    entry["degenerate"] = report.degenerate;
    entry["iterations"] = report.iterations;
    entry["residual"] = numbers({report.residual})[0];
    entry["worst_group"] = report.worst_group;
    entry["P"] = numbers(answer.impulse);
    entry["xi"] = numbers(answer.xi);
    entry["modes"] = nlohmann::ordered_json::array();
    for (const ContactMode mode : answer.modes) entry["modes"].push_back(to_string(mode));
    out["answers"].push_back(std::move(entry));
  }
  const Answer* const best = best_of(answers);
  out["best"] = best == nullptr ? nlohmann::ordered_json() : nlohmann::ordered_json(best->name);
  // A path need not be UTF-8.
  std::cout << out.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << "\n";
}

// Of a chain: of the solver that it believed, if there is one.
void write_histories(const Options& options, const ContactProblem& problem,
                     const std::vector<Answer>& answers) {
  std::vector<ResidualHistory> histories;
  for (const Answer& answer : answers) {
    const std::string_view by = answer.name == "chain" ? answer.report.solver : answer.name;
    const bool known = std::any_of(histories.begin(), histories.end(),
                                   [&](const ResidualHistory& history) { return history.solver == by; });
    for (const SolverId solver : all_solvers) {
      if (known || to_string(solver) != by || answer.empty()) continue;
      histories.push_back(residual_history(problem, solver, options.budget));
    }
  }
  carom::write_histories(options.history, histories);
}

int run(const Options& options) {
  const auto solvers = asked(options.solver);
  const ProblemFile file = load_problem(options.file);
  std::vector<Answer> answers;
  answers.reserve(solvers.size());
  for (const auto& solver : solvers) answers.emplace_back(file.problem, solver, options.budget);
  if (!options.history.empty()) write_histories(options, file.problem, answers);
  if (options.json) {
    print_json(options.file, answers);
  } else {
    print_tables(file, options.file, answers);
  }
  return best_of(answers) != nullptr ? certified : not_certified;
}

}  // namespace

int main(int count, char** arguments) {
  try {
    const Options options = options_of(std::span(arguments, static_cast<std::size_t>(count)).subspan(1));
    if (options.help) {
      std::cout << usage;
      return certified;
    }
    return run(options);
  } catch (const WrongCall& error) {
    std::cerr << "carom-solve-contact: " << error.what() << "\n\n" << usage;
  } catch (const std::exception& error) {
    std::cerr << "carom-solve-contact: " << error.what() << "\n";
  }
  return wrong_call;
}

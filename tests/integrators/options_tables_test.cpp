// The tables of options in docs/two_modes.md and docs/events.md: every option of the headers, with the
// default it has there.

#include <carom/carom.h>

#include "tests/page_blocks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <regex>
#include <string>
#include <vector>

namespace {

using carom_test::text_of;

struct Option {
  std::string name;
  std::string value;  // as written behind the equals sign; empty of a member that starts empty
};

/// Structs of options that stand together, by the member that holds them.
struct Nested {
  std::string member, header, name;
};
const std::vector<Nested> nested{{"impact_rules", "contact/solvers/impact_rules.h", "ImpactRules"},
                                 {"overlaps", "integrators/run/overlap_rules.h", "OverlapRules"}};

/// Members of a struct of options, as its header declares them; `a.b` of those that stand together.
std::vector<Option> options_of(const std::string& header, const std::string& name) {
  const std::string source = text_of(header), begin = "struct " + name + " {";
  const std::size_t from = source.find(begin);
  EXPECT_NE(from, std::string::npos) << header;
  const std::string body = source.substr(from, source.find("\n};", from) - from);
  const std::regex member(R"(\n  [A-Za-z][^\n;={}]* (\w+)(?: = ([^;]+)|\{\})?;)");
  std::vector<Option> options;
  for (std::sregex_iterator at(body.begin(), body.end(), member), end; at != end; ++at) {
    const auto inner = std::find_if(nested.begin(), nested.end(),
                                    [&](const Nested& group) { return group.member == at->str(1); });
    if (inner == nested.end()) {
      options.push_back({at->str(1), at->str(2)});
      continue;
    }
    for (const Option& option : options_of(inner->header, inner->name)) {
      options.push_back({inner->member + "." + option.name, option.value});
    }
  }
  return options;
}

/// The second cell of a row whose first one is the name of an option; empty if there is no such row.
std::string default_in(const std::string& page, const std::string& option) {
  const std::string row = "| `" + option + "` | ";
  const std::size_t at = page.find("\n" + row);
  if (at == std::string::npos) return {};
  const std::size_t from = at + 1 + row.size();
  return page.substr(from, page.find(" |", from) - from);
}

/// Whether a cell names the default of the code: the same number (a unit may follow), `name` for Enum::name,
/// "none" or "empty" for a member that starts empty.
bool same_default(const std::string& cell, const std::string& value) {
  if (value.empty()) return cell == "none" || cell == "empty";
  const std::size_t scope = value.rfind("::");
  if (scope != std::string::npos) return cell == "`" + value.substr(scope + 2) + "`";
  if (std::isdigit(static_cast<unsigned char>(value.front())) == 0) return cell == value;
  char* behind = nullptr;
  const double shown = std::strtod(cell.c_str(), &behind);
  return behind != cell.c_str() && shown == std::strtod(value.c_str(), nullptr);
}

void expect_all(const std::string& page, const std::string& header, const std::string& name,
                std::size_t at_least) {
  const std::vector<Option> options = options_of(header, name);
  EXPECT_GE(options.size(), at_least) << name;
  for (const Option& option : options) {
    const std::string cell = default_in(page, option.name);
    EXPECT_FALSE(cell.empty()) << "no row for " << name << "::" << option.name;
    EXPECT_TRUE(same_default(cell, option.value))
        << name << "::" << option.name << " is " << option.value << " and not " << cell;
  }
}

TEST(OptionsTables, TimeSteppingHasEveryOptionWithItsDefault) {
  const std::string page = text_of("docs/two_modes.md"), header = "integrators/run/time_stepping.h";
  const std::size_t control = page.find("The options of `StepControl`");
  ASSERT_NE(control, std::string::npos);
  expect_all(page.substr(0, control), header, "TimeStepping", 20);
  expect_all(page.substr(control), header, "StepControl", 3);
}

TEST(OptionsTables, EventDrivenHasEveryOptionWithItsDefault) {
  expect_all(text_of("docs/events.md"), "integrators/run/event_driven.h", "EventDriven", 18);
}

TEST(OptionsTables, ReadsNumbersAndNames) {
  EXPECT_TRUE(same_default("1e-2 s", "1e-2"));
  EXPECT_TRUE(same_default("0.01", "1e-2"));
  EXPECT_FALSE(same_default("1e-3", "1e-2"));
  EXPECT_TRUE(same_default("`fixed_point`", "Iteration::fixed_point"));
  EXPECT_FALSE(same_default("`anderson`", "Iteration::fixed_point"));
  EXPECT_TRUE(same_default("none", ""));
  EXPECT_FALSE(same_default("", "false"));
}

}  // namespace

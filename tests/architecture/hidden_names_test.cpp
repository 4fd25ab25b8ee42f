// Sources of a folder are compiled together, as many as a user asks for (CAROM_BATCH_SIZE): what they hide
// from each other in unnamed namespaces is one namespace then. Constants and types have names of their own
// there.

#include "tests/paths.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

/// What a source declares in its unnamed namespaces, by name.
struct HiddenNames {
  std::set<std::string> constants, types, functions;
};

HiddenNames read(std::istream& source) {
  static const std::regex constant(R"(^(?:constexpr|const) [\w:<>, ]*?(\w+)(?:\[[^\]]*\])?\s*(?:=|\{).*)");
  static const std::regex further(R"(, (\w+) = )");
  static const std::regex type(R"(^(?:struct|class|enum class) (\w+)\b.*)");
  static const std::regex function(R"(^[\w:<>,&\* ]+[ &\*](\w+)\(.*)");
  HiddenNames names;
  bool is_hidden = false;
  for (std::string line; std::getline(source, line);) {
    std::smatch found;
    if (line == "namespace {") {
      is_hidden = true;
    } else if (line.starts_with("}  // namespace")) {
      is_hidden = false;
    } else if (is_hidden && std::regex_match(line, found, constant)) {
      names.constants.insert(found[1]);
      for (std::sregex_iterator at(line.begin(), line.end(), further), end; at != end; ++at)
        names.constants.insert((*at)[1]);
    } else if (is_hidden && std::regex_match(line, found, type)) {
      names.types.insert(found[1]);
    } else if (is_hidden && std::regex_match(line, found, function)) {
      names.functions.insert(found[1]);
    }
  }
  return names;
}

/// Names that two sources of a folder cannot both have: those of constants and types, whatever the other's is
/// of.
std::vector<std::string> clashes(const std::map<std::string, HiddenNames>& folder) {
  std::vector<std::string> out;
  for (const auto& [source, own] : folder) {
    for (const auto& [other, others] : folder) {
      if (source == other) continue;
      for (const std::set<std::string>* const of_own : {&own.constants, &own.types}) {
        for (const std::string& name : *of_own) {
          if (others.constants.contains(name) || others.types.contains(name) ||
              others.functions.contains(name))
            out.push_back(source + ", " + other + ": " + name);
        }
      }
    }
  }
  return out;
}

HiddenNames names_of(const std::string& text) {
  std::istringstream source(text);
  return read(source);
}

TEST(HiddenNames, OfAFolderAreDifferent) {
  namespace fs = std::filesystem;
  std::map<std::string, std::map<std::string, HiddenNames>> folders;
  for (const char* const room : {"core", "bodies", "joints", "contact", "integrators", "analysis"}) {
    for (const auto& entry : fs::recursive_directory_iterator(carom_test::source_file(room))) {
      if (entry.path().extension() != ".cpp") continue;
      std::ifstream source(entry.path());
      folders[entry.path().parent_path().string()][entry.path().filename().string()] = read(source);
    }
  }
  EXPECT_GT(folders.size(), 10U);
  for (const auto& [folder, sources] : folders) {
    for (const std::string& clash : clashes(sources)) ADD_FAILURE() << folder << ": " << clash;
  }
}

TEST(HiddenNames, AreFound) {
  const HiddenNames names = names_of(
      "constexpr int seen = 1;\nnamespace {\n\nconstexpr double small = 1e-3, large = 2.0;\n"
      "constexpr double table[] = {1.0};\nstruct Look {\n  constexpr int inner = 1;\n};\n"
      "double turning(const State& at) {\nconst std::array<int, 2> pair{1, 2};\n}  // namespace\nclass Late "
      "{\n");
  EXPECT_EQ(names.constants, (std::set<std::string>{"small", "large", "table", "pair"}));
  EXPECT_EQ(names.types, std::set<std::string>{"Look"});
  EXPECT_EQ(names.functions, std::set<std::string>{"turning"});
}

TEST(HiddenNames, OfConstantsClashWithAnything) {
  const HiddenNames constant = names_of("namespace {\nconstexpr int turning = 2;\n}  // namespace\n");
  const HiddenNames function = names_of("namespace {\ndouble turning(int of) {\n}  // namespace\n");
  const HiddenNames overload = names_of("namespace {\ndouble turning(double of) {\n}  // namespace\n");
  EXPECT_EQ(clashes({{"a", constant}, {"b", function}}).size(), 1U);
  EXPECT_EQ(clashes({{"a", constant}, {"b", constant}}).size(), 2U);
  EXPECT_TRUE(clashes({{"a", function}, {"b", overload}}).empty());
}

}  // namespace

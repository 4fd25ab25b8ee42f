// The include edges between the library's folders, and who may see third-party headers.

#include "tests/paths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace {

namespace fs = std::filesystem;

// Which folders a folder may include besides itself. "bodies/shape_" stands for its shape headers only.
const std::map<std::string, std::set<std::string>> allowed_edges = {
    {"core", {}},
    {"bodies", {"core"}},
    {"joints", {"core"}},
    {"contact", {"core", "bodies/shape_"}},
    {"integrators", {"core", "contact"}},
    {"analysis", {"core", "contact", "integrators"}},
    {"testing", {"core", "bodies", "joints", "contact", "integrators", "analysis"}},
};
const std::set<std::string> folders_without_type_queries = {"core", "contact", "integrators"};
const std::set<std::string> forbidden_folder_names = {"utils", "common", "detail", "misc"};
const std::regex include_line(R"re(^\s*#\s*include\s*([<"])([^>"]+)[>"])re");
const std::regex sundials_header(
    "(sundials|cvodes?|arkode|idas?|kinsol|nvector|sunmatrix|sunlinsol|sunnonlinsol)/.*");
const std::regex logging_header("(spdlog|fmt)/.*");
const std::regex test_header("(gtest|gmock)/.*");
const std::regex json_header("nlohmann/.*");
const std::regex thread_header("(oneapi/)?tbb/.*");
const std::regex type_query(R"(\bdynamic_(pointer_)?cast\b)");

// The code without its comments.
std::string without_comments(std::string_view code) {
  static const std::regex pattern(R"re(//[^\n]*|/\*[\s\S]*?\*/)re");
  return std::regex_replace(std::string(code), pattern, "");
}

bool may_include(const std::string& folder, const std::string& path) {
  if (path.starts_with(folder + "/")) return true;
  const auto& allowed = allowed_edges.at(folder);
  return std::any_of(allowed.begin(), allowed.end(), [&](const std::string& target) {
    return path.starts_with(target.find('/') == std::string::npos ? target + "/" : target);
  });
}

// What is wrong with one library file; `path` is "folder/name".
std::vector<std::string> violations(const std::string& path, std::string_view content) {
  const std::string folder = path.substr(0, path.find('/'));
  const bool may_log = path == "core/log.cpp";
  const bool may_integrate = path.starts_with("integrators/sundials");
  const bool may_test = path == "testing/matchers.h";
  const std::string name = path.substr(path.find('/') + 1);
  const bool may_use_json =
      path == "contact/problem_file.cpp" || (name.starts_with("carom_") && name.ends_with(".cpp"));
  const std::string code = without_comments(content);

  std::vector<std::string> found;
  std::istringstream lines(code);
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (!std::regex_search(line, match, include_line)) continue;
    const std::string target = match[2];
    const auto refuse = [&](const std::string& why) { found.push_back(path + ": " + why + ": " + target); };

    if (match[1] == "\"") refuse("quoted include");
    if (target.find("..") != std::string::npos) refuse("relative include");
    if (std::regex_match(target, logging_header) && !may_log) refuse("logging library outside core/log.cpp");
    if (std::regex_match(target, json_header) && !may_use_json)
      refuse("JSON outside contact/problem_file.cpp");
    if (std::regex_match(target, thread_header) && path != "core/workers.cpp") {
      refuse("oneTBB outside core/workers.cpp");
    }
    if (std::regex_match(target, sundials_header) && !may_integrate) {
      refuse("SUNDIALS outside integrators/sundials*");
    }
    if (std::regex_match(target, test_header) && !may_test) refuse("GoogleTest outside testing/matchers.h");
    if (!target.starts_with("carom/")) continue;

    const std::string own = target.substr(std::string_view("carom/").size());
    if (own == "carom.h") {
      refuse("the library includes all of itself");
    } else if (!may_include(folder, own)) {
      refuse("edge not allowed");
    } else if (own.starts_with("integrators/sundials") && !may_integrate) {
      refuse("private header");
    }
  }
  if (folders_without_type_queries.contains(folder) && std::regex_search(code, type_query)) {
    found.push_back(path + ": asks an object for its type (dynamic_cast)");
  }
  return found;
}

std::string read(const fs::path& file) {
  std::ifstream stream(file);
  EXPECT_TRUE(stream) << file;
  return {std::istreambuf_iterator<char>(stream), {}};
}

const fs::path source_dir = carom_test::source_file("");

TEST(IncludeEdges, LibraryFollowsTheTable) {
  int files = 0;
  for (const auto& [folder, edges] : allowed_edges) {
    if (!fs::is_directory(source_dir / folder)) continue;
    for (const auto& entry : fs::directory_iterator(source_dir / folder)) {
      EXPECT_FALSE(entry.is_directory()) << entry.path() << ": the library's folders have no subfolders";
      const std::string extension = entry.path().extension().string();
      if (extension != ".h" && extension != ".cpp") continue;
      ++files;
      const std::string name = folder + "/" + entry.path().filename().string();
      for (const std::string& violation : violations(name, read(entry.path()))) ADD_FAILURE() << violation;
    }
  }
  EXPECT_GT(files, 10) << "looked into the wrong place: " << source_dir;
}

TEST(IncludeEdges, NoFolderIsACatchAll) {
  for (auto entry = fs::recursive_directory_iterator(source_dir); entry != fs::recursive_directory_iterator();
       ++entry) {
    if (!entry->is_directory()) continue;
    const std::string name = entry->path().filename().string();
    if (name == ".git" || name.starts_with("build")) {
      entry.disable_recursion_pending();
      continue;
    }
    EXPECT_FALSE(forbidden_folder_names.contains(name)) << entry->path();
  }
}

TEST(IncludeEdges, GoodLinesPass) {
  EXPECT_TRUE(
      violations("core/a.cpp", "#include <carom/core/b.h>\n#include <vector>\n#include <Eigen/Core>\n")
          .empty());
  EXPECT_TRUE(
      violations("contact/a.h", "#include <carom/bodies/shape_disc.h>\n#include <carom/core/b.h>\n").empty());
  EXPECT_TRUE(violations("integrators/a.cpp", "#include <carom/contact/b.h>\n").empty());
  EXPECT_TRUE(violations("core/log.cpp", "#include <spdlog/spdlog.h>\n").empty());
  EXPECT_TRUE(violations("core/workers.cpp", "#include <oneapi/tbb/task_arena.h>\n").empty());
  EXPECT_FALSE(violations("core/assembly.cpp", "#include <oneapi/tbb/task_arena.h>\n").empty());
  EXPECT_TRUE(violations("contact/problem_file.cpp", "#include <nlohmann/json.hpp>\n").empty());
  EXPECT_TRUE(violations("contact/carom_program.cpp", "#include <nlohmann/json.hpp>\n").empty());
  EXPECT_TRUE(violations("integrators/sundials_flow.cpp", "#include <arkode/arkode_erkstep.h>\n").empty());
  EXPECT_TRUE(violations("testing/matchers.h", "#include <gmock/gmock.h>\n").empty());
  EXPECT_TRUE(violations("testing/a.cpp", "#include <carom/integrators/simulation.h>\n").empty());
  EXPECT_TRUE(violations("core/a.cpp", "// #include \"b.h\"\n/* no dynamic_cast\n here */\n").empty());
  EXPECT_TRUE(violations("joints/a.cpp", "auto* b = dynamic_cast<B*>(a);\n").empty());
}

// One made-up bad line for every rule: the check above can fail.
struct BadLine {
  const char* file;
  const char* line;
};

class IncludeEdgesBadLine : public testing::TestWithParam<BadLine> {};

TEST_P(IncludeEdgesBadLine, IsFound) {
  const BadLine& bad = GetParam();
  EXPECT_EQ(violations(bad.file, std::string("#pragma once\n") + bad.line + "\n").size(), 1U);
}

INSTANTIATE_TEST_SUITE_P(
    Rules, IncludeEdgesBadLine,
    testing::Values(BadLine{"core/a.h", "#include <carom/bodies/particle.h>"},
                    BadLine{"core/a.cpp", "  #  include <carom/integrators/simulation.h>"},
                    BadLine{"bodies/a.h", "#include <carom/joints/gravity.h>"},
                    BadLine{"joints/a.h", "#include <carom/bodies/particle.h>"},
                    BadLine{"contact/a.cpp", "#include <carom/bodies/particle.h>"},
                    BadLine{"contact/a.cpp", "#include <carom/integrators/simulation.h>"},
                    BadLine{"integrators/a.cpp", "#include <carom/bodies/shape_disc.h>"},
                    BadLine{"analysis/a.cpp", "#include <carom/joints/gravity.h>"},
                    BadLine{"core/a.cpp", "#include <carom/carom.h>"},
                    BadLine{"integrators/a.cpp", "#include <carom/testing/trace_checks.h>"},
                    BadLine{"testing/trace_checks.h", "#include <gmock/gmock.h>"},
                    BadLine{"core/a.cpp", "#include \"a.h\""},
                    BadLine{"core/log.h", "#include <spdlog/spdlog.h>"},
                    BadLine{"integrators/a.cpp", "#include <spdlog/spdlog.h>"},
                    BadLine{"contact/problem_file.h", "#include <nlohmann/json.hpp>"},
                    BadLine{"contact/carom_program.h", "#include <nlohmann/json_fwd.hpp>"},
                    BadLine{"integrators/a.cpp", "#include <cvode/cvode.h>"},
                    BadLine{"core/a.cpp", "#include <sundials/sundials_context.h>"},
                    BadLine{"integrators/a.cpp", "#include <carom/integrators/sundials_flow.h>"},
                    BadLine{"integrators/a.cpp", "auto* b = dynamic_cast<B*>(a);"},
                    BadLine{"core/a.h", "std::dynamic_pointer_cast<B>(a);"}));

}  // namespace

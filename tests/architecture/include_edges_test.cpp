// The include edges between the library's folders, and who may see third-party headers.

#include "tests/paths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
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

// Rooms from the ground up: a room may include itself and those before it that it lists. "bodies/shape_"
// stands for shape headers only. What numerics has of core includes nothing of the library.
struct Room {
  std::string folder;
  std::set<std::string> includes;
};
const std::vector<Room> rooms = {
    {"core/numerics", {"core/export.h", "core/ids.h"}},
    {"core", {"core/numerics"}},
    {"bodies", {"core", "core/numerics"}},
    {"joints", {"core", "core/numerics"}},
    {"core/dynamics", {"core", "core/numerics"}},
    {"contact/detection", {"core", "core/numerics", "bodies/shape_"}},
    {"contact/solvers", {"core", "core/numerics"}},
    {"contact", {"core", "core/numerics", "core/dynamics", "contact/detection", "contact/solvers"}},
    {"integrators/flow", {"core", "core/numerics"}},
    {"integrators/run", {"core", "core/numerics", "contact/solvers", "integrators/flow"}},
    {"integrators/time_stepping",
     {"core", "core/numerics", "core/dynamics", "contact", "contact/detection", "contact/solvers",
      "integrators/run"}},
    {"integrators/event_driven",
     {"core", "core/numerics", "core/dynamics", "contact", "contact/detection", "contact/solvers",
      "integrators/flow", "integrators/run"}},
    {"integrators",
     {"core", "core/numerics", "core/dynamics", "contact", "contact/detection", "contact/solvers",
      "integrators/run", "integrators/time_stepping", "integrators/event_driven"}},
    {"analysis",
     {"core", "core/numerics", "core/dynamics", "contact", "contact/detection", "integrators/run",
      "integrators"}},
    {"testing", {"core", "core/numerics", "bodies", "joints", "contact", "integrators", "analysis"}},
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

// The code without its comments. By hand: a regular expression takes ten times as long.
std::string without_comments(std::string_view code) {
  std::string rest;
  while (true) {
    const std::size_t line = code.find("//"), block = code.find("/*");
    const std::size_t begin = std::min(line, block);
    rest += code.substr(0, begin);
    if (begin == std::string_view::npos) return rest;
    const std::size_t end = line < block ? code.find('\n', line) : code.find("*/", block + 2);
    if (end == std::string_view::npos) return rest;
    code.remove_prefix(line < block ? end : end + 2);
  }
}

// Few lines are worth a look by the expression.
bool is_include(const std::string& line, std::smatch& match) {
  return line.find('#') != std::string::npos && std::regex_search(line, match, include_line);
}

// Whether an object is asked for its type.
bool queries_type(const std::string& code) {
  std::istringstream lines(code);
  for (std::string line; std::getline(lines, line);) {
    if (line.find("dynamic_") != std::string::npos && std::regex_search(line, type_query)) return true;
  }
  return false;
}

// The folder of "folder/name".
std::string folder_of(const std::string& path) { return path.substr(0, path.rfind('/')); }

bool may_include(const std::string& folder, const std::string& path) {
  const auto room =
      std::find_if(rooms.begin(), rooms.end(), [&](const Room& entry) { return entry.folder == folder; });
  if (room == rooms.end()) return false;
  const std::string other = folder_of(path);
  if (other == folder) return true;
  return std::any_of(room->includes.begin(), room->includes.end(), [&](const std::string& target) {
    const bool is_room =
        std::any_of(rooms.begin(), rooms.end(), [&](const Room& entry) { return entry.folder == target; });
    return is_room ? other == target : path.starts_with(target);
  });
}

// Faults of one library file; `path` is "room/name".
std::vector<std::string> violations(const std::string& path, std::string_view content) {
  const std::string folder = folder_of(path);
  const bool may_log = path == "core/log.cpp";
  const bool may_integrate = path.starts_with("integrators/flow/sundials");
  const bool may_test = path == "testing/matchers.h";
  const std::string name = path.substr(path.rfind('/') + 1);
  const bool may_use_json = path == "contact/solvers/problem_file.cpp" ||
                            path == "contact/solvers/problem_file_writer.cpp" ||
                            (name.starts_with("carom_") && name.ends_with(".cpp"));
  const std::string code = without_comments(content);

  std::vector<std::string> found;
  std::istringstream lines(code);
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (!is_include(line, match)) continue;
    const std::string target = match[2];
    const auto refuse = [&](const std::string& why) { found.push_back(path + ": " + why + ": " + target); };

    if (match[1] == "\"") refuse("quoted include");
    if (target.find("..") != std::string::npos) refuse("relative include");
    if (std::regex_match(target, logging_header) && !may_log) refuse("logging library outside core/log.cpp");
    if (std::regex_match(target, json_header) && !may_use_json)
      refuse("JSON outside contact/solvers/problem_file*.cpp");
    if (std::regex_match(target, thread_header) && path != "core/workers.cpp") {
      refuse("oneTBB outside core/workers.cpp");
    }
    if (std::regex_match(target, sundials_header) && !may_integrate) {
      refuse("SUNDIALS outside integrators/flow/sundials*");
    }
    if (std::regex_match(target, test_header) && !may_test) refuse("GoogleTest outside testing/matchers.h");
    if (!target.starts_with("carom/")) continue;

    const std::string own = target.substr(std::string_view("carom/").size());
    if (own == "carom.h") {
      refuse("the library includes all of itself");
    } else if (!may_include(folder, own)) {
      refuse("edge not allowed");
    } else if (own.starts_with("integrators/flow/sundials") && !may_integrate) {
      refuse("private header");
    }
  }
  if (folders_without_type_queries.contains(path.substr(0, path.find('/'))) && queries_type(code)) {
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
  for (const char* const top :
       {"core", "bodies", "joints", "contact", "integrators", "analysis", "testing"}) {
    for (const auto& entry : fs::recursive_directory_iterator(source_dir / top)) {
      const std::string name = fs::relative(entry.path(), source_dir).generic_string();
      if (entry.is_directory()) {
        const auto is_it = [&](const Room& room) { return room.folder == name; };
        EXPECT_TRUE(std::any_of(rooms.begin(), rooms.end(), is_it)) << name << " is no room";
        continue;
      }
      const std::string extension = entry.path().extension().string();
      if (extension != ".h" && extension != ".cpp") continue;
      ++files;
      for (const std::string& violation : violations(name, read(entry.path()))) ADD_FAILURE() << violation;
    }
  }
  EXPECT_GT(files, 100) << "looked into the wrong place: " << source_dir;
}

TEST(IncludeEdges, RoomsSeeOnlyThoseBelow) {
  std::set<std::string> below;
  for (const Room& room : rooms) {
    for (const std::string& target : room.includes) {
      const bool is_room =
          std::any_of(rooms.begin(), rooms.end(), [&](const Room& entry) { return entry.folder == target; });
      EXPECT_TRUE(!is_room || below.contains(target)) << room.folder << " > " << target;
    }
    below.insert(room.folder);
  }
  for (const char* const file : {"core/export.h", "core/ids.h"}) {
    EXPECT_EQ(read(source_dir / file).find("#include <carom/"), std::string::npos) << file;
  }
}

// The headers that cmake/CaromPublicHeaders.cmake lists.
std::set<std::string> public_headers() {
  const std::string list =
      std::regex_replace(read(source_dir / "cmake/CaromPublicHeaders.cmake"), std::regex("#[^\n]*"), "");
  const std::regex name(R"([a-z_]+(/[a-z_]+)+\.h)");
  std::set<std::string> headers;
  for (auto it = std::sregex_iterator(list.begin(), list.end(), name); it != std::sregex_iterator(); ++it) {
    headers.insert(it->str());
  }
  return headers;
}

// Else the installed ones would not compile.
TEST(IncludeEdges, PublicHeadersIncludePublicOnes) {
  const std::set<std::string> headers = public_headers();
  EXPECT_GT(headers.size(), 50U);
  for (const std::string& header : headers) {
    std::istringstream lines(read(source_dir / header));
    for (std::string line; std::getline(lines, line);) {
      std::smatch match;
      if (!is_include(line, match)) continue;
      const std::string target = match[2];
      if (!target.starts_with("carom/")) continue;
      EXPECT_TRUE(headers.contains(target.substr(6))) << header << " > " << target;
    }
  }
}

TEST(IncludeEdges, NoFolderIsACatchAll) {
  for (auto entry = fs::recursive_directory_iterator(source_dir); entry != fs::recursive_directory_iterator();
       ++entry) {
    if (!entry->is_directory()) continue;
    const std::string name = entry->path().filename().string();
    if (name == ".git" || name == "node_modules" || name.starts_with("build")) {
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
      violations("contact/detection/a.h", "#include <carom/bodies/shape_disc.h>\n#include <carom/core/b.h>\n")
          .empty());
  EXPECT_TRUE(violations("integrators/a.cpp", "#include <carom/contact/b.h>\n").empty());
  EXPECT_TRUE(violations("core/log.cpp", "#include <spdlog/spdlog.h>\n").empty());
  EXPECT_TRUE(violations("core/workers.cpp", "#include <oneapi/tbb/task_arena.h>\n").empty());
  EXPECT_FALSE(violations("core/assembly.cpp", "#include <oneapi/tbb/task_arena.h>\n").empty());
  EXPECT_TRUE(violations("contact/solvers/problem_file.cpp", "#include <nlohmann/json.hpp>\n").empty());
  EXPECT_TRUE(violations("contact/carom_program.cpp", "#include <nlohmann/json.hpp>\n").empty());
  EXPECT_TRUE(
      violations("integrators/flow/sundials_flow.cpp", "#include <arkode/arkode_erkstep.h>\n").empty());
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
                    BadLine{"core/numerics/a.h", "#include <carom/core/state.h>"},
                    BadLine{"core/a.h", "#include <carom/core/dynamics/joint_constraints.h>"},
                    BadLine{"contact/detection/a.h", "#include <carom/contact/solvers/residual.h>"},
                    BadLine{"contact/solvers/a.h", "#include <carom/contact/island_problem.h>"},
                    BadLine{"contact/solvers/a.h", "#include <carom/contact/detection/half_space.h>"},
                    BadLine{"integrators/time_stepping/a.h", "#include <carom/integrators/simulation.h>"},
                    BadLine{"integrators/time_stepping/a.h",
                            "#include <carom/integrators/event_driven/event_driver.h>"},
                    BadLine{"contact/a.cpp", "#include <carom/integrators/simulation.h>"},
                    BadLine{"integrators/a.cpp", "#include <carom/bodies/shape_disc.h>"},
                    BadLine{"analysis/a.cpp", "#include <carom/joints/gravity.h>"},
                    BadLine{"core/a.cpp", "#include <carom/carom.h>"},
                    BadLine{"integrators/a.cpp", "#include <carom/testing/trace_checks.h>"},
                    BadLine{"testing/trace_checks.h", "#include <gmock/gmock.h>"},
                    BadLine{"core/a.cpp", "#include \"a.h\""},
                    BadLine{"core/log.h", "#include <spdlog/spdlog.h>"},
                    BadLine{"integrators/a.cpp", "#include <spdlog/spdlog.h>"},
                    BadLine{"contact/solvers/problem_file.h", "#include <nlohmann/json.hpp>"},
                    BadLine{"contact/carom_program.h", "#include <nlohmann/json_fwd.hpp>"},
                    BadLine{"integrators/a.cpp", "#include <cvode/cvode.h>"},
                    BadLine{"core/a.cpp", "#include <sundials/sundials_context.h>"},
                    BadLine{"integrators/a.cpp", "#include <carom/integrators/flow/sundials_flow.h>"},
                    BadLine{"integrators/a.cpp", "auto* b = dynamic_cast<B*>(a);"},
                    BadLine{"core/a.h", "std::dynamic_pointer_cast<B>(a);"}));

}  // namespace

// Sizes of the library's classes, functions and files.

#include "tests/architecture/source_sizes.h"
#include "tests/paths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace {

namespace fs = std::filesystem;
using carom_test::ClassSize;
using carom_test::FunctionSize;
using carom_test::source_sizes;
using carom_test::SourceSizes;

constexpr int most_functions = 25;
constexpr int most_members = 15;
constexpr std::size_t most_function_lines = 60;
constexpr std::size_t most_file_lines = 350;
constexpr std::size_t most_test_lines = 450;

// Interfaces of kinds: wide, since every part must say all of this. Their functions do not count in the kinds
// themselves. ForceElements is ForceKind, less what does not depend on the type of an element.
const std::set<std::string> interfaces_of_kinds = {"BodyKind",  "ForceKind",       "JointKind",
                                                   "ShapeKind", "GroundShapeKind", "ForceElements"};
// The two wide classes of the API.
const std::set<std::string> wide_classes = {"System", "Simulation"};

std::string read(const fs::path& file) {
  std::ifstream stream(file);
  EXPECT_TRUE(stream) << file;
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::size_t lines_of(std::string_view content) {
  return static_cast<std::size_t>(std::count(content.begin(), content.end(), '\n'));
}

/// Functions that count: a kind need not answer for the width of its interface.
int counted_functions(const ClassSize& of) {
  const bool is_kind =
      std::any_of(interfaces_of_kinds.begin(), interfaces_of_kinds.end(),
                  [&](const std::string& name) { return of.bases.find(name) != std::string::npos; });
  return of.functions - (is_kind ? of.overrides : 0);
}

/// Faults of one library file, of which the sizes are known.
std::vector<std::string> violations(const std::string& path, std::string_view content,
                                    const SourceSizes& sizes) {
  std::vector<std::string> found;
  const auto refuse = [&](const std::string& name, std::size_t line, const char* quantity, std::size_t size,
                          std::size_t most) {
    found.push_back(path + ":" + std::to_string(line) + ": " + name + ": " + quantity + " " +
                    std::to_string(size) + "; allowed: " + std::to_string(most));
  };
  for (const ClassSize& of : sizes.classes) {
    if (wide_classes.contains(of.name) || interfaces_of_kinds.contains(of.name)) continue;
    const int functions = counted_functions(of);
    if (functions > most_functions) {
      refuse(of.name, of.line, "functions", static_cast<std::size_t>(functions), most_functions);
    }
    if (of.members > most_members) {
      refuse(of.name, of.line, "data members", static_cast<std::size_t>(of.members), most_members);
    }
  }
  for (const FunctionSize& of : sizes.functions) {
    if (of.lines <= most_function_lines) continue;
    refuse(of.name, of.line, "lines", of.lines, most_function_lines);
  }
  if (lines_of(content) > most_file_lines) {
    refuse("the file", 1, "lines", lines_of(content), most_file_lines);
  }
  return found;
}

std::vector<std::string> violations(const std::string& path, std::string_view content) {
  return violations(path, content, source_sizes(content));
}

/// Calls f(name, content) for the sources below some folders.
void for_sources(const std::vector<std::string>& folders,
                 const std::function<void(const std::string&, const std::string&)>& f) {
  const fs::path root = carom_test::source_file("");
  for (const std::string& folder : folders) {
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".h" && extension != ".cpp") continue;
      f(fs::relative(entry.path(), root).generic_string(), read(entry.path()));
    }
  }
}

TEST(Sizes, LibraryKeepsTheLimits) {
  std::set<std::string> classes;
  std::size_t functions = 0;
  for_sources({"core", "bodies", "joints", "contact", "integrators", "analysis", "testing"},
              [&](const std::string& path, const std::string& content) {
                const SourceSizes sizes = source_sizes(content);
                for (const std::string& violation : violations(path, content, sizes))
                  ADD_FAILURE() << violation;
                for (const ClassSize& of : sizes.classes) classes.insert(of.name);
                functions += sizes.functions.size();
              });
  // The reader has not lost its way.
  EXPECT_GT(classes.size(), 250U);
  EXPECT_GT(functions, 1000U);
  for (const auto& names : {wide_classes, interfaces_of_kinds}) {
    for (const std::string& name : names) EXPECT_TRUE(classes.contains(name)) << name << " is no class";
  }
}

TEST(Sizes, TestsAreShort) {
  int files = 0;
  for_sources({"tests"}, [&](const std::string& path, const std::string& content) {
    EXPECT_LE(lines_of(content), most_test_lines) << path;
    ++files;
  });
  EXPECT_GT(files, 200);
}

const ClassSize& class_of(const SourceSizes& sizes, const std::string& name) {
  static const ClassSize missing{"missing", 0, "", -1, -1, -1};
  const auto found = std::find_if(sizes.classes.begin(), sizes.classes.end(),
                                  [&](const ClassSize& of) { return of.name == name; });
  return found == sizes.classes.end() ? missing : *found;
}

TEST(SourceSizes, CountsFunctionsOfAClass) {
  const SourceSizes sizes = source_sizes(R"(
    /// class Comment { int a(); };
    namespace a::b {
    template <class T, int N = 3>
    class CAROM_API [[nodiscard]] Table final : public Base<T>, private Other {
    public:
      Table() = default;
      explicit Table(int size) : size_(size), names_{size, "x;{"} {}
      ~Table();
      Table(const Table&) = delete;
      Table& operator=(const Table&) = delete;
      [[nodiscard]] int size() const override { return size_; }
      [[nodiscard]] double at(int i) const;
      double at(std::size_t i);
      template <class F>
      void each(F&& f) const { for (int i = 0; i < size_; ++i) f(i); }
      double& operator()(int i, int j);
      operator bool() const;
      bool operator<(const Table& other) const { return size_ < other.size_; }
      friend bool operator==(const Table&, const Table&) = default;
      friend class Reader;
      using Row = std::array<double, 3>;
      static int count();
    private:
      int size_ = 0;
    };
    }
  )");
  EXPECT_EQ(class_of(sizes, "Table").functions, 13);
  EXPECT_EQ(class_of(sizes, "Table").overrides, 1);
  EXPECT_EQ(class_of(sizes, "Table").members, 1);
  EXPECT_EQ(sizes.classes.size(), 1U);
}

TEST(SourceSizes, CountsMembersOfAClass) {
  const SourceSizes sizes = source_sizes(R"(
    struct Many {
      static constexpr int limit = 3;
      enum class Kind { a, b, c };
      struct Inner { double x, y; void f(); } inner;
      struct Forward;
      int a, b = f(1, 2), c{3};
      std::map<int, std::function<void(int, int)>> calls;  // int not, these
      std::vector<std::pair<int, int>> pairs, others;
      double (*function)(double) = nullptr;
      alignas(32) double numbers[4] = {1, 2, 3, 4};
      mutable std::array<double, (3 > 2 ? 1 : 2)> more{};
      Kind kind = Kind::a;
    #if X
      int one;
    #else
      int two;
    #endif
    };
  )");
  EXPECT_EQ(class_of(sizes, "Many").members, 12);
  EXPECT_EQ(class_of(sizes, "Many").functions, 0);
  EXPECT_EQ(class_of(sizes, "Many::Inner").members, 2);
  EXPECT_EQ(class_of(sizes, "Many::Inner").functions, 1);
}

TEST(SourceSizes, CountsLinesOfFunctions) {
  const SourceSizes sizes = source_sizes(
      "int one() { return '}'; }\n"
      "template <int D>\n"
      "double Kind<D>::long_one(\n"
      "    double x) const {\n"
      "  const auto f = [&] {\n"
      "    return R\"(})\";\n"
      "  };\n"
      "}\n"
      "Maker::Maker(int a)\n"
      "    : a_(a), b_{a} {\n"
      "}\n"
      "int declared();\n"
      "const std::array<int, 2> table{{1, 2}};\n"
      "auto Maker::size() const -> std::size_t { return 1'000; }\n");
  ASSERT_EQ(sizes.functions.size(), 4U);
  EXPECT_EQ(sizes.functions[0].lines, 1U);
  EXPECT_EQ(sizes.functions[1].name, "Kind<D>::long_one");
  EXPECT_EQ(sizes.functions[1].line, 2U);
  EXPECT_EQ(sizes.functions[1].lines, 7U);
  EXPECT_EQ(sizes.functions[2].name, "Maker::Maker");
  EXPECT_EQ(sizes.functions[2].lines, 3U);
  EXPECT_EQ(sizes.functions[3].lines, 1U);
}

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text + std::to_string(i) + (text.ends_with("f") ? "();\n" : ";\n");
  return all;
}

TEST(Sizes, LimitsAreKeptExactly) {
  EXPECT_TRUE(violations("core/a.h", "class A {\n" + repeated("void f", most_functions) + "};\n").empty());
  EXPECT_TRUE(violations("core/a.h", "struct A {\n" + repeated("int a", most_members) + "};\n").empty());
  EXPECT_TRUE(violations("core/a.h", "void f() {\n" + repeated("g", 58) + "}\n").empty());
  EXPECT_TRUE(violations("core/a.h", std::string(most_file_lines, '\n')).empty());
}

TEST(Sizes, ExcessIsFound) {
  EXPECT_EQ(violations("core/a.h", "class A {\n" + repeated("void f", most_functions + 1) + "};\n").size(),
            1U);
  EXPECT_EQ(violations("core/a.h", "struct A {\n" + repeated("int a", most_members + 1) + "};\n").size(), 1U);
  EXPECT_EQ(violations("core/a.h", "void f() {\n" + repeated("g", 59) + "}\n").size(), 1U);
  EXPECT_EQ(violations("core/a.h", std::string(most_file_lines + 1, '\n')).size(), 1U);
  // Excepted by name only.
  EXPECT_TRUE(violations("core/a.h", "class System {\n" + repeated("void f", 40) + "};\n").empty());
  EXPECT_EQ(violations("core/a.h", "class Systems {\n" + repeated("void f", 40) + "};\n").size(), 1U);
}

TEST(Sizes, AKindDoesNotAnswerForItsInterface) {
  std::string overrides;
  for (int i = 0; i < 40; ++i) overrides += "void f" + std::to_string(i) + "() override;\n";
  EXPECT_TRUE(violations("core/a.h", "class A final : public ForceKind {\n" + overrides + "};\n").empty());
  EXPECT_EQ(violations("core/a.h", "class A final : public Flow {\n" + overrides + "};\n").size(), 1U);
  EXPECT_EQ(violations("core/a.h", "class A final : public ForceKind {\n" + overrides +
                                       repeated("void g", most_functions + 1) + "};\n")
                .size(),
            1U);
}

}  // namespace

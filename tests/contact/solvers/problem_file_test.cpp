// Contact problems written to files and read back, bit for bit; files that cannot be are refused by name.

#include <carom/contact/solvers/problem_file.h>
#include <carom/contact/solvers/solver_chain.h>
#include <carom/core/errors.h>

#include "tests/contact/random_problems.h"
#include "tests/integrators/throws.h"
#include "tests/paths.h"

#include <gtest/gtest.h>

#include <bit>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace carom {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

class ProblemFileTest : public testing::Test {
protected:
  ProblemFileTest() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    path_ = (std::filesystem::path(testing::TempDir()) / (std::string("carom_") + info->name() + ".json"))
                .string();
    std::filesystem::remove(path_);
  }
  ~ProblemFileTest() override { std::filesystem::remove(path_); }
  void SetUp() override {
    if (!problem_files_available()) GTEST_SKIP() << "built without JSON";
  }
  void write(const std::string& text) const { std::ofstream(path_, std::ios::binary) << text; }

  std::string path_;
};

// All NaN are one: their bits say nothing.
std::uint64_t bits(double value) { return std::isnan(value) ? 1 : std::bit_cast<std::uint64_t>(value); }

void expect_same(const ContactProblem& a, const ContactProblem& b) {
  ASSERT_EQ(a.rows(), b.rows());
  for (std::size_t i = 0; i < a.matrix().size(); ++i) EXPECT_EQ(bits(a.matrix()[i]), bits(b.matrix()[i]));
  for (std::size_t i = 0; i < a.sets().size(); ++i) {
    EXPECT_EQ(bits(a.vector()[i]), bits(b.vector()[i]));
    const RowSet &x = a.sets()[i], &y = b.sets()[i];
    EXPECT_EQ(x.kind, y.kind);
    EXPECT_EQ(x.bound, y.bound);
    EXPECT_EQ(bits(x.lower), bits(y.lower));
    EXPECT_EQ(bits(x.upper), bits(y.upper));
    EXPECT_EQ(bits(x.coefficient), bits(y.coefficient));
  }
  ASSERT_EQ(a.groups().size(), b.groups().size());
  for (std::size_t g = 0; g < a.groups().size(); ++g) {
    EXPECT_EQ(a.groups()[g].first, b.groups()[g].first);
    EXPECT_EQ(a.groups()[g].size, b.groups()[g].size);
  }
}

// Every kind of set.
ContactProblem of_all_kinds() {
  ContactProblem problem;
  problem.reset(9);
  for (int i = 0; i < 9; ++i) problem.w(i, i) = 1.0 + i;
  problem.sets()[1] = {.kind = SetKind::bounded_interval, .bound = 0, .coefficient = 0.1};
  problem.sets()[2] = {.kind = SetKind::interval, .lower = -infinity, .upper = infinity};
  problem.sets()[3] = {.kind = SetKind::interval, .lower = -0.1, .upper = -0.0};
  problem.sets()[5] = problem.sets()[6] = {.kind = SetKind::bounded_disc, .bound = 4, .coefficient = 1.0 / 3};
  problem.sets()[8] = {.kind = SetKind::proportional, .bound = 7, .coefficient = -0.0};
  problem.group();
  return problem;
}

TEST_F(ProblemFileTest, RandomProblemsComeBackBitForBit) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const ContactProblem problem = contact_test::random_problem(seed, 8, 12.0).problem;
    problem.save(path_);
    const ContactProblem read = ContactProblem::load(path_);
    expect_same(read, problem);
    // And so do answers.
    SolverChain chain;
    std::vector<double> first(problem.vector().size()), second(first);
    const ContactReport a = chain.solve(problem, first), b = chain.solve(read, second);
    EXPECT_EQ(first, second);
    EXPECT_EQ(a.residual, b.residual);
  }
}

TEST_F(ProblemFileTest, SlidingContactsComeBackBitForBit) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const ContactProblem problem = contact_test::random_sliding_problem(seed, 3, 0.5, 3.0);
    problem.save(path_);
    const ContactProblem read = ContactProblem::load(path_);
    expect_same(read, problem);
    SolverChain chain;
    std::vector<double> first(6), second(6);
    const ContactReport a = chain.solve(problem, first), b = chain.solve(read, second);
    EXPECT_EQ(first, second);
    EXPECT_EQ(a.outcome, b.outcome);
  }
}

TEST_F(ProblemFileTest, NumbersOfAnySizeComeBackBitForBit) {
  contact_test::Random random(7);
  ContactProblem problem;
  problem.reset(40);
  for (int i = 0; i < 40; ++i) {
    problem.w(i, i) = 1.0;
    double value = nan;
    while (!std::isfinite(value)) value = std::bit_cast<double>(random.next());
    problem.vector()[static_cast<std::size_t>(i)] = value;
  }
  const double special[] = {0.0,
                            -0.0,
                            std::numeric_limits<double>::denorm_min(),
                            -std::numeric_limits<double>::max(),
                            std::numeric_limits<double>::min(),
                            0x1.fffffffffffffp-1023,
                            0.1,
                            1e22,
                            9007199254740993.0};
  for (std::size_t i = 0; i < std::size(special); ++i) problem.vector()[i] = special[i];
  problem.group();
  problem.save(path_);
  expect_same(ContactProblem::load(path_), problem);
}

TEST_F(ProblemFileTest, SetsOfEveryKindAndBrokenNumbersComeBack) {
  ContactProblem problem = of_all_kinds();
  problem.save(path_);
  expect_same(ContactProblem::load(path_), problem);
  problem.w(0, 1) = problem.w(1, 0) = nan;
  problem.w(2, 3) = problem.w(3, 2) = -infinity;
  problem.w(4, 4) = infinity;
  problem.vector()[0] = nan;
  problem.vector()[1] = infinity;
  problem.vector()[2] = -infinity;
  problem.save(path_);
  expect_same(ContactProblem::load(path_), problem);
  SolverChain chain;
  std::vector<double> p(9);
  EXPECT_EQ(chain.solve(ContactProblem::load(path_), p).outcome, Outcome::not_solved);
}

TEST_F(ProblemFileTest, NotesComeBack) {
  ProblemNotes notes{
      .comment = "a \"stack\"\nof bricks, \xc3\xa4", .time = 0.1, .contacts = {"a", "", "c", "d", "e"}};
  save_problem(path_, of_all_kinds(), notes);
  const ProblemFile read = load_problem(path_);
  expect_same(read.problem, of_all_kinds());
  EXPECT_EQ(read.notes.comment, notes.comment);
  EXPECT_EQ(read.notes.time, notes.time);
  EXPECT_EQ(read.notes.contacts, notes.contacts);
  of_all_kinds().save(path_);
  const ProblemFile plain = load_problem(path_);
  EXPECT_TRUE(plain.notes.comment.empty());
  EXPECT_FALSE(plain.notes.time.has_value());
  EXPECT_TRUE(plain.notes.contacts.empty());
}

TEST_F(ProblemFileTest, AProblemWithoutRowsComesBack) {
  ContactProblem problem;
  problem.save(path_);
  EXPECT_EQ(ContactProblem::load(path_).rows(), 0);
}

TEST_F(ProblemFileTest, NearlySymmetricIsTakenAsItIs) {
  ContactProblem problem = of_all_kinds();
  problem.w(0, 1) = 0.5;
  problem.w(1, 0) = 0.5 + 1e-12;  // W_00 W_11 = 2
  problem.save(path_);
  expect_same(ContactProblem::load(path_), problem);
  problem.w(1, 0) = 0.5 + 2e-12;
  problem.save(path_);
  EXPECT_THROWS(FileError, ContactProblem::load(path_), path_, "W[1][0] is 0.500000000002", "W[0][1], 0.5",
                "symmetric", "within 1.41421356237309", "off by 1.99");
}

// The file below with one piece of text replaced, and what the message names.
constexpr const char* good = R"({
  "format": "carom contact problem",
  "version": 1,
  "comment": "by hand",
  "time": 2,
  "contacts": ["floor", "motor"],
  "rows": 3,
  "W": [[1, 0.5, 0], [0.5, 2, 0], [0, 0, 3]],
  "b": [-1, 2, "nan"],
  "sets": [{"kind": "half_line"}, {"kind": "bounded_interval", "bound": 0, "coefficient": 0.3},
           {"kind": "interval", "lower": -1, "upper": "inf"}]
}
)";

struct Wrong {
  const char* replace;
  const char* by;
  std::vector<std::string> names;
};

class WrongProblemFileTest : public ProblemFileTest, public testing::WithParamInterface<Wrong> {};

TEST_P(WrongProblemFileTest, IsRefusedByName) {
  const Wrong& wrong = GetParam();
  std::string text = good;
  const std::size_t at = text.find(wrong.replace);
  ASSERT_NE(at, std::string::npos) << wrong.replace;
  path_ = (std::filesystem::path(testing::TempDir()) /
           ("carom_wrong_" + std::to_string(std::hash<std::string>{}(std::string(wrong.replace) + wrong.by)) +
            ".json"))
              .string();
  write(text.replace(at, std::string(wrong.replace).size(), wrong.by));
  try {
    static_cast<void>(load_problem(path_));
    ADD_FAILURE() << "was taken:\n" << text;
  } catch (const FileError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("contact problem '" + path_ + "': "), std::string::npos) << message;
    for (const std::string& name : wrong.names) EXPECT_NE(message.find(name), std::string::npos) << message;
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, WrongProblemFileTest,
    testing::Values(
        Wrong{"{\n", "\n\n", {"not JSON", "line 3", "byte"}},  // the third line is the first with a text
        Wrong{"[-1, 2,", "[-1, 2", {"not JSON", "line 9"}}, Wrong{good, "", {"not JSON", "line 1"}},
        Wrong{good, "[1]", {"the file is a list of 1", "an object"}},
        Wrong{"[-1, 2,", "[-1, 1e999,", {"cannot be read", "1e999"}},
        Wrong{"carom contact", "other", {"format is \"other problem\"", "\"carom contact problem\""}},
        Wrong{"\"format\": \"carom contact problem\",", "", {"format is not given"}},
        Wrong{"\"version\": 1,", "", {"version is not given"}},
        Wrong{"\"version\": 1", "\"version\": 2", {"version is 2", "up to 1", "newer"}},
        Wrong{"\"version\": 1", "\"version\": 99999999999999999999", {"version is", "allowed: 1"}},
        Wrong{"\"version\": 1", "\"version\": 0", {"version is 0; allowed: 1"}},
        Wrong{"\"version\": 1", "\"version\": \"1\"", {"version is \"1\"; allowed: 1"}},
        Wrong{"\"rows\": 3,", "", {"rows is not given"}},
        Wrong{"\"rows\": 3", "\"rows\": 2", {"W is a list of 3", "a list of 2 rows"}},
        Wrong{"\"rows\": 3", "\"rows\": -1", {"rows is -1", "whole number >= 0"}},
        Wrong{"\"rows\": 3", "\"rows\": 3.5", {"rows is 3.5", "whole number >= 0"}},
        Wrong{"\"rows\": 3", "\"rows\": 18446744073709551615", {"rows is 18446744073709551615"}},
        Wrong{"\"rows\": 3", "\"rows\": 2147483647", {"W is a list of 3", "a list of 2147483647 rows"}},
        Wrong{"[0.5, 2, 0]", "[0.5, 2]", {"W[1] is a list of 2", "a list of 3 numbers"}},
        Wrong{"[1, 0.5, 0]", "7", {"W[0] is 7", "a list of 3 numbers"}},
        Wrong{"[0.5, 2, 0]", "[0.5, null, 0]", {"W[1][1] is null", "a number", "\"inf\""}},
        Wrong{"[0.5, 2, 0]", "[0.5, \"much\", 0]", {"W[1][1] is \"much\"", "a number", "\"-inf\""}},
        Wrong{"[0.5, 2, 0]",
              "[0.25, 2, 0]",
              {"W[1][0] is 0.25", "W[0][1], 0.5", "symmetric matrix", "off by 0.25"}},
        Wrong{"[0.5, 2, 0]", "[\"inf\", 2, 0]", {"W[1][0] is inf", "symmetric", "off by inf"}},
        Wrong{"[-1, 2, \"nan\"]", "[-1, 2]", {"b is a list of 2", "a list of 3 numbers"}},
        Wrong{"\"nan\"", "true", {"b[2] is true", "a number"}},
        Wrong{"\"half_line\"}",
              "\"half_plane\"}",
              {"sets[0].kind is \"half_plane\"",
               "\"half_line\", \"interval\", \"bounded_interval\", \"bounded_disc\" or"}},
        Wrong{"{\"kind\": \"half_line\"}", "{}", {"sets[0].kind is not given"}},
        Wrong{"{\"kind\": \"half_line\"}", "\"half_line\"", {"sets[0] is \"half_line\"", "an object"}},
        Wrong{"{\"kind\": \"half_line\"},", "", {"sets is a list of 2", "a list of 3 sets"}},
        Wrong{"\"half_line\"}", "\"half_line\", \"lower\": 0}", {"field 'sets[0].lower' is unknown", "kind"}},
        Wrong{"\"half_line\"}",
              "\"bounded_disc\", \"bound\": 0, \"coefficient\": 1}",
              {"sets[0].kind is \"bounded_disc\"", "a row before it"}},
        Wrong{"\"bound\": 0", "\"bound\": 1", {"sets[1].bound is 1", "a row before it, 0 to 0"}},
        Wrong{"\"bound\": 0", "\"bound\": -1", {"sets[1].bound is -1", "a row before it"}},
        Wrong{"\"bound\": 0, ", "", {"sets[1].bound is not given"}},
        Wrong{"0.3", "-0.3", {"sets[1].coefficient is -0.3", "finite and >= 0"}},
        Wrong{"0.3", "\"nan\"", {"sets[1].coefficient is nan", "finite and >= 0"}},
        Wrong{"\"bounded_interval\", \"bound\": 0, \"coefficient\": 0.3",
              "\"proportional\", \"bound\": 0, \"coefficient\": \"-inf\"",
              {"sets[1].coefficient is -inf; allowed: finite"}},
        Wrong{"\"bounded_interval\", \"bound\": 0", "\"proportional\", \"bound\": 1", {"sets[1].bound is 1"}},
        Wrong{"\"half_line\"}",
              "\"proportional\", \"bound\": 0, \"coefficient\": 1}",
              {"sets[0].kind is \"proportional\"", "a row before it"}},
        Wrong{"0.3", "\"inf\"", {"sets[1].coefficient is inf", "finite and >= 0"}},
        Wrong{"\"lower\": -1", "\"lower\": \"inf\", \"upper\": 1}]} //", {"not JSON"}},
        Wrong{"\"upper\": \"inf\"", "\"upper\": -2", {"sets[2].upper is -2", "at least lower, -1"}},
        Wrong{"\"lower\": -1", "\"lower\": \"nan\"", {"sets[2].lower is nan"}},
        Wrong{"\"upper\": \"inf\"", "\"upper\": \"nan\"", {"sets[2].upper is nan", "at least lower, -1"}},
        Wrong{"\"upper\": \"inf\"", "\"uper\": 1", {"field 'sets[2].uper' is unknown", "kind, lower, upper"}},
        Wrong{"\"interval\", \"lower\": -1, \"upper\": \"inf\"",
              "\"bounded_interval\", \"bound\": 1, \"coefficient\": 1",
              {"row 2", "impulse is not negative"}},
        Wrong{"\"interval\", \"lower\": -1, \"upper\": \"inf\"",
              "\"bounded_disc\", \"bound\": 0, \"coefficient\": 1",
              {"row 2", "a disc takes two rows"}},
        Wrong{"\"by hand\"", "7", {"comment is 7", "a text"}},
        Wrong{"\"time\": 2", "\"time\": \"now\"", {"time is \"now\"", "a number"}},
        Wrong{"\"floor\", ", "", {"contacts is a list of 1", "a list of 2 names", "each group"}},
        Wrong{"\"floor\", ", "3, ", {"contacts[0] is 3", "a text"}},
        Wrong{"\"comment\"", "\"remark\"", {"field 'remark' is unknown", "comment"}}));

TEST_F(ProblemFileTest, TheGoodFileIsGood) {
  write(good);
  const ProblemFile read = load_problem(path_);
  EXPECT_EQ(read.problem.groups().size(), 2u);
  EXPECT_EQ(read.problem.w(1, 0), 0.5);
  EXPECT_EQ(read.notes.time, 2.0);
  EXPECT_EQ(read.notes.contacts[1], "motor");
}

TEST_F(ProblemFileTest, ThePageShowsAGoodFile) {
  std::ifstream in(carom_test::source_file("docs/contact_problems.md"));
  const std::string page{std::istreambuf_iterator<char>(in), {}};
  const std::string fence = "```json\n";
  const std::size_t begin = page.find(fence) + fence.size();
  ASSERT_GT(begin, fence.size());
  std::string shown = page.substr(begin, page.find("```", begin) - begin);
  write(shown);
  const ProblemFile read = load_problem(path_);
  EXPECT_EQ(read.notes.contacts.size(), read.problem.groups().size());
  // It is what save_problem() writes, spaces apart.
  save_problem(path_, read.problem, read.notes);
  std::ifstream again(path_);
  std::string written{std::istreambuf_iterator<char>(again), {}};
  for (std::string* text : {&shown, &written})
    std::erase_if(*text, [](char letter) { return letter == ' '; });
  EXPECT_EQ(written, shown);
}

TEST_F(ProblemFileTest, FilesThatAreNotThereAreNamed) {
  EXPECT_THROWS(FileError, ContactProblem::load(path_), path_, "cannot be read");
  EXPECT_THROWS(FileError, of_all_kinds().save(path_ + "/x"), path_, "cannot be written");
  EXPECT_THROWS(FileError, save_problem(path_, of_all_kinds(), {.comment = "\xff"}), path_, "UTF-8");
  EXPECT_FALSE(std::filesystem::exists(path_));
}

}  // namespace
}  // namespace carom

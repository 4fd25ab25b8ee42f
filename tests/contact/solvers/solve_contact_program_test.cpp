// The program carom-solve-contact, run as a user would, on problems that simulations failed on.

#include <carom/carom.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <sys/wait.h>
#include <vector>

#if defined(CAROM_SOLVE_CONTACT)

namespace {

using namespace carom;
using namespace carom::planar;

struct Outcome {
  int code = -1;
  std::string text;  // both outputs
};

Outcome run(const std::string& arguments) {
  const std::string command = std::string("'") + CAROM_SOLVE_CONTACT + "' " + arguments + " 2>&1";
  Outcome outcome;
  FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return outcome;
  char block[4096];
  for (std::size_t size = 0; (size = std::fread(block, 1, sizeof block, pipe)) > 0;) {
    outcome.text.append(block, size);
  }
  const int status = pclose(pipe);
  if (WIFEXITED(status)) outcome.code = WEXITSTATUS(status);
  return outcome;
}

// Runs into a SolverError and saves its problem as a user would.
void save_failure(const System& system, const TimeStepping& options, const std::string& path) {
  Simulation simulation(system, options);
  try {
    simulation.step();
    FAIL() << "the step succeeded";
  } catch (const SolverError& error) {
    ASSERT_TRUE(error.has_problem()) << error.what();
    error.problem().save(path);
  }
}

class SolveContactProgram : public testing::Test {
protected:
  SolveContactProgram() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    path_ =
        (std::filesystem::path(testing::TempDir()) / (std::string("carom_program_") + info->name() + ".json"))
            .string();
    // A corner strikes with e_n = 1, e_t = 0 and would gain energy (docs/method.md, section 5).
    gaining_.add(HalfPlane{.normal = {0.0, 1.0}},
                 Surface{.friction = 1.0, .normal_restitution = 1.0, .tangential_restitution = 0.0});
    const BodyId body = gaining_.add(
        RigidBody{.mass = {.mass = 1.0, .inertia = 1.0}, .position = {0, 1}, .velocity = {1, -2}});
    gaining_.add(Point{.body = body, .position = {-1, -1}});
    // Between two walls with unequal restitution, both violated: no impulses exist.
    jammed_.add(HalfPlane{.point = {0, 0.1}, .normal = {0, 1}},
                Surface{.friction = 0.0, .normal_restitution = 0.2, .tangential_restitution = 0.0});
    jammed_.add(HalfPlane{.point = {0, -0.1}, .normal = {0, -1}},
                Surface{.friction = 0.0, .normal_restitution = 0.9, .tangential_restitution = 0.0});
    jammed_.add(Particle{.mass = 1.0, .velocity = {0, 1}});
  }
  ~SolveContactProgram() override { std::filesystem::remove(path_); }

  void save_gaining() const {
    save_failure(gaining_, {.impact_rules = {.energy_gain = EnergyGain::refuse}}, path_);
  }
  void save_jammed() const { save_failure(jammed_, {.impact_rules = {.refuse_jams = true}}, path_); }
  [[nodiscard]] std::string file() const { return "'" + path_ + "'"; }

  std::string path_;
  System gaining_, jammed_;
};

TEST_F(SolveContactProgram, EverySolverSolvesAProblemOfASolverError) {
  save_gaining();
  for (const std::string solver : {"chain", "single-contact", "principal-pivoting", "lemke", "enumeration"}) {
    const Outcome outcome = run(file() + " --solver " + solver + " --json");
    ASSERT_EQ(outcome.code, 0) << solver << "\n" << outcome.text;
    const auto read = nlohmann::json::parse(outcome.text);
    ASSERT_EQ(read["answers"].size(), 1u);
    const auto& answer = read["answers"][0];
    EXPECT_EQ(answer["certified"], true);
    EXPECT_EQ(answer["outcome"], "solved");
    EXPECT_FALSE(answer["solver"].get<std::string>().empty());
    EXPECT_FALSE(answer["by"].get<std::string>().empty());
    EXPECT_LE(answer["residual"].get<double>(), 1e-15);  // two rows, W well conditioned
    const ContactProblem problem = ContactProblem::load(path_);
    std::vector<double> p = answer["P"].get<std::vector<double>>(), xi(2);
    problem.velocities(p, xi);
    EXPECT_EQ(answer["xi"].get<std::vector<double>>().size(), 2u);
    EXPECT_LE(residual(problem, p, xi).value, 1e-15);
    EXPECT_EQ(answer["modes"].size(), 1u);
  }
}

TEST_F(SolveContactProgram, AllSaysWhoIsRight) {
  save_gaining();
  const Outcome all = run("--solver=all " + file());
  EXPECT_EQ(all.code, 0) << all.text;
  EXPECT_NE(all.text.find("right (residual up to 1e-10): single contact, principal pivoting, Lemke, "
                          "enumeration, chain"),
            std::string::npos)
      << all.text;
  EXPECT_NE(all.text.find("smallest residual: "), std::string::npos) << all.text;
  EXPECT_NE(all.text.find("2 rows in 1 groups"), std::string::npos) << all.text;
  const auto json = nlohmann::json::parse(run("--solver all --json " + file()).text);
  EXPECT_EQ(json["answers"].size(), 7u);
  EXPECT_FALSE(json["best"].is_null());
}

TEST_F(SolveContactProgram, AProblemWithoutSolutionIsNotCertified) {
  save_jammed();
  const Outcome chain = run(file());
  EXPECT_EQ(chain.code, 1) << chain.text;
  EXPECT_NE(chain.text.find("no solution"), std::string::npos) << chain.text;
  EXPECT_NE(chain.text.find("(not an answer)"), std::string::npos) << chain.text;
  const Outcome all = run(file() + " --solver all");
  EXPECT_EQ(all.code, 1) << all.text;
  EXPECT_NE(all.text.find("right (residual up to 1e-10): none"), std::string::npos) << all.text;
  const Outcome single = run(file() + " --solver single-contact");
  EXPECT_EQ(single.code, 1);
  EXPECT_NE(single.text.find("not applicable"), std::string::npos) << single.text;
  const auto json = nlohmann::json::parse(run("--solver all --json " + file()).text);
  EXPECT_TRUE(json["best"].is_null());
}

// The rod of Painlevé, sliding towards its lean with mu = 2, tan theta = 2.
TEST_F(SolveContactProgram, AContactThatSlides) {
  ContactProblem problem;
  problem.reset(2);
  problem.w(0, 0) = 1.6;
  problem.w(0, 1) = problem.w(1, 0) = -1.2;
  problem.w(1, 1) = 3.4;
  problem.sets()[1] = {.kind = SetKind::proportional, .bound = 0, .coefficient = 2.0};
  problem.group();
  problem.vector()[0] = -9.81;
  problem.save(path_);
  const Outcome none = run(file());
  EXPECT_EQ(none.code, 1) << none.text;
  EXPECT_NE(none.text.find("no solution"), std::string::npos) << none.text;
  problem.vector()[0] = 12.5;
  problem.save(path_);
  const auto two = nlohmann::json::parse(run("--json " + file()).text)["answers"][0];
  EXPECT_EQ(two["outcome"], "several solutions");
  EXPECT_EQ(two["modes"][0], "open");
  problem.sets()[1].coefficient = -2.0;
  problem.vector()[0] = -9.81;
  problem.save(path_);
  const auto all = nlohmann::json::parse(run("--solver all --json " + file()).text)["answers"];
  ASSERT_EQ(all.size(), 7u);
  int not_applicable = 0;
  for (const auto& one : all) {
    if (one["reason"] == "not applicable") {
      ++not_applicable;  // sweeps, which are of problems in factors or with discs only
      continue;
    }
    EXPECT_EQ(one["certified"], true) << one;
    EXPECT_EQ(one["modes"][0], "slip+") << one;
    EXPECT_NEAR(one["P"][0].get<double>(), 9.81 / 4.0, 1e-15);
  }
  EXPECT_EQ(not_applicable, 2);
}

TEST_F(SolveContactProgram, BrokenNumbersAreShown) {
  ContactProblem problem;
  problem.reset(1);
  problem.w(0, 0) = 1.0;
  problem.vector()[0] = std::numeric_limits<double>::quiet_NaN();
  problem.group();
  save_problem(path_, problem, {.comment = "made up", .time = 2.5, .contacts = {"ball on floor"}});
  const Outcome text = run(file());
  EXPECT_EQ(text.code, 1) << text.text;
  for (const char* part : {"made up", "t = 2.5 s", "ball on floor", "inf"}) {
    EXPECT_NE(text.text.find(part), std::string::npos) << part << "\n" << text.text;
  }
  const Outcome json = run(file() + " --json");
  EXPECT_EQ(json.code, 1) << json.text;
  EXPECT_EQ(nlohmann::json::parse(json.text)["answers"][0]["residual"], "inf");
}

TEST_F(SolveContactProgram, WritesResidualsBySweep) {
  save_gaining();
  const std::string table = path_ + ".csv";
  const auto lines_of = [&](const std::string& arguments) {
    std::filesystem::remove(table);
    const Outcome outcome = run(file() + " --history '" + table + "' " + arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    std::vector<std::string> lines;
    std::ifstream in(table);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
  };
  const std::vector<std::string> chain = lines_of("");
  ASSERT_EQ(chain.size(), 2U);
  EXPECT_TRUE(chain[1].starts_with("single contact,answer,solved,")) << chain[1];
  // Four exact solvers of the plane have an answer.
  EXPECT_EQ(lines_of("--solver=all").size(), 1U + 4U);
  // A contact in space.
  ContactProblem problem;
  problem.reset(3);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) problem.w(i, j) = i == j ? 2.0 : 0.5;
    problem.vector()[static_cast<std::size_t>(i)] = i == 1 ? 2.0 : -1.0;
  }
  problem.sets()[1] = problem.sets()[2] = {.kind = SetKind::bounded_disc, .bound = 0, .coefficient = 0.3};
  problem.group();
  problem.save(path_);
  const std::vector<std::string> sweeps = lines_of("--solver dense-sweeps --json");
  ASSERT_GT(sweeps.size(), 2U);
  EXPECT_TRUE(sweeps[1].starts_with("dense sweeps,sweep,,1,")) << sweeps[1];
  EXPECT_TRUE(sweeps.back().starts_with("dense sweeps,answer,solved,")) << sweeps.back();
  std::filesystem::remove(table);
}

TEST_F(SolveContactProgram, WrongCallsAndFilesAreNamed) {
  const auto expect = [](const std::string& arguments, const std::vector<std::string>& texts) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    for (const std::string& text : texts) {
      EXPECT_NE(outcome.text.find(text), std::string::npos) << arguments << "\n" << outcome.text;
    }
  };
  expect("", {"no file was given", "usage:"});
  expect(file(), {path_, "cannot be read"});
  expect(file() + " --solver newton", {"--solver is 'newton'; allowed: chain, all, single-contact", "lemke"});
  expect(file() + " --solver", {"--solver needs a value"});
  expect(file() + " --history=", {"--history needs a value"});
  for (const std::string sweeps : {"0", "ten", "3x"}) {
    expect(file() + " --sweeps " + sweeps,
           {"--sweeps is '" + sweeps + "'; allowed: a whole number, at least 1"});
  }
  expect(file() + " --fast", {"unknown option '--fast'"});
  expect(file() + " other.json", {"one file at a time", "other.json"});
  std::ofstream(path_) << "{}";
  expect(file(), {path_, "format is not given"});
  const Outcome help = run("--help");
  EXPECT_EQ(help.code, 0);
  EXPECT_NE(help.text.find("principal-pivoting"), std::string::npos);
}

}  // namespace

#endif

// Records read back bit for bit, under headers with names and units.

#include "examples/scenes/incline.h"
#include "tests/integrators/throws.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

struct Table {
  std::vector<std::string> header;
  std::vector<std::vector<double>> rows;

  [[nodiscard]] double at(std::size_t row, const std::string& column) const {
    for (std::size_t i = 0; i < header.size(); ++i) {
      if (header[i] == column) return rows.at(row).at(i);
    }
    ADD_FAILURE() << "no column " << column;
    return std::nan("");
  }
};

Table read(const std::string& path) {
  std::ifstream file(path);
  Table table;
  std::string line;
  std::getline(file, line);
  std::string field;
  bool quoted = false;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i == line.size() || (line[i] == ',' && !quoted)) {
      table.header.push_back(field);
      field.clear();
    } else if (line[i] == '"') {
      if (quoted && i + 1 < line.size() && line[i + 1] == '"')
        field += line[++i];
      else
        quoted = !quoted;
    } else {
      field += line[i];
    }
  }
  while (std::getline(file, line)) {
    std::vector<double> row;
    const char* at = line.data();
    const char* const end = line.data() + line.size();
    while (at < end) {
      double number = 0.0;
      const auto result = std::from_chars(at, end, number);
      EXPECT_EQ(result.ec, std::errc{}) << line;
      row.push_back(number);
      at = result.ptr + 1;
    }
    table.rows.push_back(row);
  }
  return table;
}

class Recorder : public testing::Test {
protected:
  Recorder() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    path_ = (std::filesystem::path(testing::TempDir()) / (std::string("carom_") + info->name() + ".csv"))
                .string();
  }
  ~Recorder() override { std::filesystem::remove(path_); }

  static System scene() {
    scenes::Incline incline;
    incline.height = 1.5;
    System system;
    scenes::add_plane(system, incline);
    scenes::add_bar(system, incline);
    scenes::add_pair(system, incline);
    return system;
  }

  std::string path_;
};

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

TEST_F(Recorder, DigitsReadBackBitForBit) {
  Simulation simulation(scene(), TimeStepping{.step = 1e-3});
  std::vector<State> states{simulation.state()};
  std::vector<EnergyLedger> ledgers{simulation.energy()};
  {
    CsvRecorder recorder(simulation, path_);
    simulation.observe([&](const Simulation& now) {
      states.push_back(now.state());
      ledgers.push_back(now.energy());
    });
    simulation.run_until(0.5);
    recorder.flush();
    EXPECT_EQ(recorder.rows(), 501);
  }
  const Table table = read(path_);
  ASSERT_EQ(table.rows.size(), states.size());
  const BodyId bar = simulation.system().body("bar"), lower = simulation.system().body("lower");
  for (std::size_t i = 0; i < states.size(); ++i) {
    ASSERT_EQ(table.rows[i].size(), table.header.size());
    EXPECT_TRUE(same_bits(table.at(i, "time [s]"), states[i].time));
    EXPECT_TRUE(same_bits(table.at(i, "bar.x [m]"), states[i].position(bar)[0]));
    EXPECT_TRUE(same_bits(table.at(i, "bar.y [m]"), states[i].position(bar)[1]));
    EXPECT_TRUE(same_bits(table.at(i, "bar.angle [rad]"), states[i].angle(bar)));
    EXPECT_TRUE(same_bits(table.at(i, "bar.vx [m/s]"), states[i].velocity(bar)[0]));
    EXPECT_TRUE(same_bits(table.at(i, "bar.spin [rad/s]"), states[i].spin(bar)));
    EXPECT_TRUE(same_bits(table.at(i, "lower.vy [m/s]"), states[i].velocity(lower)[1]));
    EXPECT_TRUE(same_bits(table.at(i, "kinetic [J]"), ledgers[i].kinetic()));
    EXPECT_TRUE(same_bits(table.at(i, "elastic [J]"), ledgers[i].stored(StoredEnergy::elastic)));
    EXPECT_TRUE(same_bits(table.at(i, "total [J]"), ledgers[i].total()));
    EXPECT_TRUE(same_bits(table.at(i, "impact_normal [J]"), ledgers[i].flow(EnergyFlow::impact_normal)));
    EXPECT_TRUE(same_bits(table.at(i, "residual [J]"), ledgers[i].residual()));
  }
}

TEST_F(Recorder, HeaderNamesEveryColumnWithItsUnit) {
  Simulation simulation(scene(), TimeStepping{});
  CsvRecorder recorder(simulation, path_);
  recorder.flush();
  const Table table = read(path_);
  // time; bar: 6 numbers; particles: 4 each; energies.
  ASSERT_EQ(table.header.size(), 1 + 6 + 4 + 4 + stored_energy_count + 1 + energy_flow_count + 1);
  for (const std::string& column : table.header) {
    EXPECT_NE(column.find(" ["), std::string::npos) << column;
    EXPECT_EQ(column.back(), ']') << column;
  }
}

TEST_F(Recorder, RecordsWhatIsAskedFor) {
  Simulation simulation(scene(), TimeStepping{.step = 1e-3});
  CsvRecorder recorder(simulation, path_,
                       {.bodies = {simulation.system().body("upper")}, .every_steps = 10, .energies = false});
  simulation.run_until(0.1);
  recorder.flush();
  const Table table = read(path_);
  EXPECT_EQ(table.header, (std::vector<std::string>{"time [s]", "upper.x [m]", "upper.y [m]",
                                                    "upper.vx [m/s]", "upper.vy [m/s]"}));
  ASSERT_EQ(table.rows.size(), 11u);
  EXPECT_EQ(table.at(3, "time [s]"), 0.03);
}

TEST_F(Recorder, NamesOfAnyKind) {
  System system;
  system.add(Particle{.mass = 1.0}, "a, \"b\"");
  system.add(Particle{.mass = 1.0});
  Simulation simulation(std::move(system), TimeStepping{});
  CsvRecorder recorder(simulation, path_, {.energies = false});
  recorder.flush();
  const Table table = read(path_);
  ASSERT_EQ(table.header.size(), 9u);
  EXPECT_EQ(table.header[1], "a, \"b\".x [m]");
  EXPECT_EQ(table.header[5], "particle #1.x [m]");
}

TEST_F(Recorder, SpatialBodiesHaveThreeCoordinates) {
  System system;
  system.add(spatial::Particle{.mass = 1.0, .position = {1.0, 2.0, 3.0}}, "p");
  Simulation simulation(std::move(system), TimeStepping{});
  CsvRecorder recorder(simulation, path_, {.energies = false});
  recorder.flush();
  const Table table = read(path_);
  EXPECT_EQ(table.header.size(), 7u);
  EXPECT_EQ(table.at(0, "p.z [m]"), 3.0);
}

TEST_F(Recorder, DoesNotChangeTheRun) {
  Simulation recorded(scene(), TimeStepping{.step = 1e-3}), plain(scene(), TimeStepping{.step = 1e-3});
  CsvRecorder recorder(recorded, path_);
  recorded.run_until(0.5);
  plain.run_until(0.5);
  EXPECT_EQ(recorded.state().q, plain.state().q);
  EXPECT_EQ(recorded.energy().save(), plain.energy().save());
}

TEST_F(Recorder, LivesAsLongAsTheSimulation) {
  Simulation simulation(scene(), TimeStepping{.step = 1e-3});
  { CsvRecorder recorder(simulation, path_); }
  simulation.run_until(0.01);
  { Simulation gone = std::move(simulation); }
  EXPECT_EQ(read(path_).rows.size(), 11u);
}

TEST_F(Recorder, RefusesWhatCannotBe) {
  Simulation simulation(scene(), TimeStepping{});
  EXPECT_THROWS(FileError, CsvRecorder(simulation, "/no/such/place/run.csv"), "/no/such/place/run.csv");
  EXPECT_THROWS(ModelError, CsvRecorder(simulation, path_, {.every_steps = 0}), "every_steps", "0");
  System other;
  const BodyId foreign = other.add(Particle{.mass = 1.0});
  EXPECT_THROWS(ModelError, CsvRecorder(simulation, path_, {.bodies = {foreign}}), "");
}

}  // namespace

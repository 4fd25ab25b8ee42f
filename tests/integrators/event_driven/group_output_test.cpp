// Works of output states are booked once.

#include <carom/carom.h>
#include <carom/core/assembly.h>
#include <carom/integrators/event_driven/group_output.h>

#include <gtest/gtest.h>

#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

TEST(GroupOutput, BooksWhatIsNewAndGivesProjectionsBack) {
  System system;
  system.add(Particle{.mass = 1.0});
  const Assembly assembly(system);
  const MotionUnknowns unknowns(assembly, std::vector<Index>{0}, work_lines - 1);
  GroupOutput output(unknowns);
  output.start(std::vector<double>(unknowns.size(), 0.0));
  EventBalance balance;
  const auto at = [&](double dashpot, double projected) {
    balance.clear();
    output.y()[unknowns.work_place(WorkLine::dashpot)] = dashpot;
    output.book(projected, balance);
  };
  at(3.0, 0.25);
  EXPECT_EQ(balance.flows[EnergyFlow::dashpot], 3.0);
  EXPECT_EQ(balance.flows[EnergyFlow::projection], 0.25);
  at(5.0, 0.5);
  EXPECT_EQ(balance.flows[EnergyFlow::dashpot], 2.0);
  EXPECT_EQ(balance.flows[EnergyFlow::projection], 0.25);
  at(5.0, 0.0);
  EXPECT_EQ(balance.flows[EnergyFlow::dashpot], 0.0);
  EXPECT_EQ(balance.flows[EnergyFlow::projection], -0.5);
}

}  // namespace

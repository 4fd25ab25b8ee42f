// Contacts whose rows almost follow from each other, of bodies that lie along each other: pivoting loses its
// digits, and sweeps end at a millionth.

#include "tests/paths.h"

#include <carom/contact/solvers/contact_problem.h>
#include <carom/contact/solvers/residual.h>
#include <carom/contact/solvers/solver_chain.h>

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {

using namespace carom;

// Two chains of hinged capsules with dry friction in their hinges, on each other and on the floor, as time
// stepping met them. None of the solvers has an answer by itself.
TEST(AlmostDependentContacts, OfChainsThatLieOnEachOtherAreSolved) {
  for (const char* const name : {"two_chains_at_rest", "two_chains_that_slide"}) {
    const ContactProblem problem = ContactProblem::load(
        carom_test::source_file("tests/contact/solvers/data/" + std::string(name) + ".json"));
    SolverChain chain;
    std::vector<double> impulse(static_cast<std::size_t>(problem.rows()));
    // Whether these find the answer of chains at rest is up to rounding.
    for (const SolverId id : {SolverId::principal_pivoting, SolverId::lemke}) {
      const bool usable = chain.solve_with(id, problem, impulse).usable();
      EXPECT_TRUE(!usable || std::string(name) == "two_chains_at_rest") << name;
    }
    const ContactReport report = chain.solve(problem, impulse);
    EXPECT_TRUE(report.usable()) << name;
    EXPECT_LE(report.residual, accepted_residual) << name;
    std::vector<double> xi(impulse.size());
    problem.velocities(impulse, xi);
    EXPECT_EQ(residual(problem, impulse, xi).value, report.residual) << name;
  }
}

}  // namespace

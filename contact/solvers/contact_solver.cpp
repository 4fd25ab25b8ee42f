// Problem: one spelling of the names of outcomes, for reports, logs and tests.

#include <carom/contact/solvers/contact_solver.h>

namespace carom {

std::string_view to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::solved:
      return "solved";
    case Outcome::several_solutions:
      return "several solutions";
    case Outcome::forces_not_unique:
      return "forces not unique";
    case Outcome::no_solution:
      return "no solution";
    case Outcome::not_solved:
      return "not solved";
    case Outcome::accepted_at_cap:
      return "accepted at cap";
  }
  return "unknown outcome";
}

}  // namespace carom

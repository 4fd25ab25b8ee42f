// Problem: one row with a slope of any sign: how many solutions has it, and which?

#include <carom/contact/solvers/sliding_contact.h>

#include <carom/contact/solvers/contact_mode.h>

#include <algorithm>
#include <cmath>

namespace carom {

PlanarSolutions solve_sliding_contact(const SlidingContact& c) {
  PlanarSolutions found;
  const double p = std::fma(c.coefficient, c.w_nt, c.w_nn);
  const double p_scale = c.w_nn + std::abs(c.coefficient * c.w_nt);
  // A proof about numbers that are none is no proof.
  if (!std::isfinite(p_scale + c.w_tt + c.b_n + c.b_t)) return found;

  const auto add = [&](const PlanarImpulse& impulse) {
    found.list[static_cast<std::size_t>(found.count++)] = impulse;
  };
  if (c.b_n >= 0.0) add({});
  if ((c.b_n < 0.0 && p > 0.0) || (c.b_n > 0.0 && p < 0.0)) {
    const double normal = -c.b_n / p;
    add({normal, c.coefficient * normal, sliding_mode(c.coefficient)});
  }
  found.outcome = found.count == 0   ? Outcome::no_solution
                  : found.count == 1 ? Outcome::solved
                                     : Outcome::several_solutions;
  if (c.b_n == 0.0 && p == 0.0) {
    const bool accelerates = std::fma(c.coefficient, c.w_tt, c.w_nt) != 0.0;
    found.outcome = accelerates ? Outcome::several_solutions : Outcome::forces_not_unique;
  }
  // An immovable contact has p = 0 exactly; nothing has cancelled.
  const bool p_vanishes = p_scale > 0.0 && !(std::abs(p) > degenerate_margin * p_scale);
  found.degenerate =
      p_vanishes || !(std::abs(c.b_n) > degenerate_margin * std::max(std::abs(c.b_n), std::abs(c.b_t)));
  return found;
}

}  // namespace carom

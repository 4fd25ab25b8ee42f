#pragma once

/// \file
/// Keeps the impulses of the contacts of a step, from which sweeps in the next one start.

#include <carom/contact/island_problem.h>
#include <carom/integrators/run/contact_history.h>

#include <array>
#include <cstddef>

namespace carom {

/// Keeps those of one problem.
class StartKeeper {
public:
  /// Contacts up to which a few sweeps reach all of a problem, so that next_start() is that of rest.
  /// Measured: piles of 100 to 700 discs gain by it, one of 2,000 was a third slower.
  static constexpr std::size_t most_of_rest = 1000;

  /// \param last of the step before \param problem solved \param out of this step
  StartKeeper(const ContactHistory& last, const IslandProblem& problem, ContactHistory& out)
      : last_(last),
        are_kept_(problem.constraints().size() > 1),
        may_rest_(last.step == out.step && problem.constraints().size() <= most_of_rest &&
                  problem.report().outcome != Outcome::accepted_at_cap),
        out_(out) {}
  /// True if impulses are kept at all: those of one contact are found as fast as they are looked up.
  [[nodiscard]] bool are_kept() const { return are_kept_; }
  /// Keeps those of a constraint. \param impulses by row
  void keep(const Constraint& at, const double* impulses) {
    const std::array<double, 2> found{impulses[0], at.rows > 1 ? impulses[1] : 0.0};
    const Index known = may_rest_ ? last_.contacts.find(at.key, next_) : none;
    if (known == none) return out_.add(at.key, {found, 0});
    next_ = known + 1;
    out_.add(at.key, next_start(last_.starts[known], found));
  }

private:
  const ContactHistory& last_;
  bool are_kept_, may_rest_;
  ContactHistory& out_;
  Index next_ = 0;  // most contacts are those of the step before, in the same order
};

}  // namespace carom

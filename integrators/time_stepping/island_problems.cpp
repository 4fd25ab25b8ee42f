// Problem: which answer does the solver of an island start from?

#include <carom/contact/solvers/sweep_budget.h>
#include <carom/integrators/time_stepping/island_problems.h>

#include <algorithm>
#include <functional>

namespace carom {

void IslandProblems::begin_passes(bool repeats) {
  is_kept_ = true;
  goes_on_ = repeats;
  if (repeats) return;
  places_.clear();
  first_ = count_ = used_ = 0;
}

/// Where problems are not kept, number 0 is for large ones, to keep its memory.
void IslandProblems::begin(const StepIsland& island) {
  if (is_kept_) {
    used_ = std::max(used_, first_ + count_);
    first_ = island.constraints.empty() ? used_ : place_of(island);
  } else {
    first_ = island.constraints.size() >= factored_constraints ? 0 : 1;
  }
  count_ = 0;
}

std::size_t IslandProblems::place_of(const StepIsland& island) {
  const Constraint* const first = island.constraints.data();
  const auto is_before = [](const Place& place, const Constraint* at) {
    return std::less<>()(place.constraints, at);
  };
  const auto known = std::lower_bound(places_.begin(), places_.end(), first, is_before);
  if (known != places_.end() && known->constraints == first) return known->first;
  places_.insert(known, {first, used_});
  return used_;
}

IslandProblem& IslandProblems::next() {
  while (first_ + count_ >= problems_.size()) problems_.emplace_back(options_);
  return problems_[first_ + count_++];
}

/// Where sweeps end at their budget answers depend on their start: it stays the same from pass to pass, so
/// that these differ by what has turned alone.
IslandStart IslandProblems::start_of(std::span<const Constraint> constraints) const {
  const bool is_exact = constraints.size() <= std::size_t{most_exact_contacts};
  return {.impulses = {}, .from_answer = goes_on_ && is_exact, .keeps_equations = is_kept_ && is_exact};
}

}  // namespace carom

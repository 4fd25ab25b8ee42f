// Problem: impulses of the constraints of a step against the guess at the loads.

#include <carom/integrators/time_stepping/contact_stage.h>
#include <carom/integrators/time_stepping/free_bodies.h>

#include <algorithm>
#include <array>
#include <utility>

namespace carom {

namespace {

/// The impulses of the step before, by key, are where sweeps start: per time, unless that step was much
/// shorter. Then they are more than forces, by what velocities had to change however short it was, and sweeps
/// would start from impulses without end that cancel each other.
class LastImpulses {
public:
  LastImpulses(const ContactHistory& before, double step) : before_(before), step_(step) {}
  /// \param impulses out, by row of the constraints
  void operator()(std::span<const Constraint> constraints, double* impulses) {
    const double longer = std::min(step_ / before_.step, most_growth);
    for (const Constraint& constraint : constraints) {
      const Index known = before_.contacts.find(constraint.key, next_);
      if (known != none) next_ = known + 1;
      for (std::size_t row = 0; row < static_cast<std::size_t>(constraint.rows); ++row) {
        const bool is_kept = known != none && row < before_.starts[known].impulse.size();
        *impulses++ = is_kept ? longer * before_.starts[known].impulse[row] : 0.0;
      }
    }
  }

private:
  static constexpr double most_growth = 2.0;  // that of step control

  const ContactHistory& before_;
  double step_;
  Index next_ = 0;  // most contacts are those of the step before, in the same order
};

/// True if all bodies of a problem are in a block.
bool lies_within(const IslandProblem& problem, const Block& block) {
  for (const Constraint& constraint : problem.constraints()) {
    for (int b = 0; b < constraint.bodies; ++b) {
      const Index body = constraint.blocks[static_cast<std::size_t>(b)].body;
      if (body < block.bodies.begin || body >= block.bodies.end) return false;
    }
  }
  return true;
}

/// Impulses against the velocities of free bodies, which are known. False if there are none.
bool solve_against_free(IslandProblem& problem, SolverChain& chain, StepTrial& trial) {
  problem.set_free_velocity(trial.free.data());
  if (!problem.solve(chain).usable()) return false;
  problem.add_velocities(trial.dv_impulses.data());
  return true;
}

}  // namespace

SweepBudget budget_of(const TimeStepping& options) {
  SweepBudget budget = options.contact_budget;
  if (options.impact_rules.refuse_jams) budget.accepted = 0.0;
  return budget;
}

ContactStage::ContactStage(const Assembly& assembly, const TimeStepping& options)
    : assembly_(&assembly),
      masses_(assembly),
      one_body_each_(assembly.components().size() == assembly.layout()->bodies().size()),
      problems_({.factored_from = factored_constraints, .plastic_jams = !options.impact_rules.refuse_jams}) {
  Index most_blocks = 1, most_runs = 1;
  for (const Component& component : assembly.components()) {
    most_blocks = std::max(most_blocks, component.blocks.size());
    most_runs = std::max(most_runs, component.runs.size());
  }
  block_problems_.resize(most_blocks);
  chains_.resize(most_runs);
  for (SolverChain& chain : chains_) chain.set_budget(budget_of(options));
}

void ContactStage::state_problems(const StepInput& in, const StepIsland& island, bool together,
                                  StepTrial& trial) {
  problems_.begin(island);
  by_block_ = !together && island.components.size() == 1;
  if (island.constraints.empty()) return;
  trial.expect_impulses();
  if (together) {
    problems_.next().build(island.constraints, in.start.v.data(), nullptr,
                           problems_.start_of(island.constraints));
  } else {
    static_cast<void>(part_problems(in, island, [](IslandProblem&) { return true; }));
  }
  if (by_block_) return share_out(island, trial);
  for (const Index component : island.components) {
    const Range v = assembly_->components()[component].v;
    std::fill(trial.dv_impulses.begin() + v.begin, trial.dv_impulses.begin() + v.end, 0.0);
  }
}

/// Problems of constraints that share bodies, whose bodies answer for themselves. Calls solved(problem) for
/// each while its numbers are at hand, up to the first where that is false, which it returns.
template <class F>
const IslandProblem* ContactStage::part_problems(const StepInput& in, const StepIsland& island, F&& solved) {
  const auto bodies = static_cast<Index>(assembly_->layout()->bodies().size());
  const ContactHistory& before = in.companion.contacts;
  LastImpulses last(before, in.step);
  const auto take = [&](std::span<Constraint> constraints) -> const IslandProblem* {
    IslandStart start = problems_.start_of(constraints);
    if (!before.empty()) start.impulses = last;
    IslandProblem& problem = problems_.next();
    problem.build(constraints, in.start.v.data(), &masses_, start);
    return solved(problem) ? nullptr : &problem;
  };
  if (island.constraints.size() == 1 || (island.joined && one_body_each_)) return take(island.constraints);
  for (const Range problem :
       partition_.arrange(island.constraints, bodies, [](Index body) { return body; })) {
    const IslandProblem* const failed = take(island.constraints.subspan(problem.begin, problem.size()));
    if (failed != nullptr) return failed;
  }
  return nullptr;
}

/// Lists the bodies of constraints of one body each, ascending. False if others are among them.
bool ContactStage::list_lone(std::span<const Constraint> constraints) {
  struck_.resize(constraints.size());
  Index last = none;
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    const Index body = constraints[i].body();
    if (constraints[i].bodies != 1 || !(last == none || last < body)) {
      struck_.clear();
      return false;
    }
    struck_[i] = last = body;
  }
  return true;
}

/// Lists bodies that have constraints, ascending.
void ContactStage::list_struck(std::span<const Constraint> constraints) {
  if (list_lone(constraints)) return;
  bool in_order = true;
  for (const Constraint& constraint : constraints) {
    for (int b = 0; b < constraint.bodies; ++b) {
      const Index body = constraint.blocks[static_cast<std::size_t>(b)].body;
      if (!struck_.empty() && struck_.back() == body) continue;
      in_order = in_order && (struck_.empty() || struck_.back() < body);
      struck_.push_back(body);
    }
  }
  if (in_order) return;
  put_struck_in_order();
  struck_.erase(std::unique(struck_.begin(), struck_.end()), struck_.end());
}

const IslandProblem* ContactStage::solve_constant(const StepInput& in, const StepIsland& island, Alone alone,
                                                  StepTrial& trial) {
  problems_.begin(island);
  lone_.clear();
  struck_.clear();
  if (island.constraints.empty()) return nullptr;
  const bool all_are_struck = island.joined && one_body_each_;
  if (all_are_struck) {
    struck_.assign(island.components.begin(), island.components.end());
  } else {
    list_struck(island.constraints);
  }
  trial.expect_impulses();
  const double* const loads = in.companion.loads.total.data();
  if (struck_.size() == 1) {
    free_alone(in, loads, masses_, island.constraints.front().blocks[0], trial);
  } else {
    free_bodies(in, loads, struck_, trial);
  }
  const LoneVelocities velocity{in.start.v.data(), trial.free.data(), trial.dv_impulses.data()};
  if (alone == Alone::from_numbers && lone_.solve(island.constraints, masses_, velocity)) return nullptr;
  return part_problems(in, island, [&](IslandProblem& problem) {
    return solve_against_free(problem, chains_.front(), trial);
  });
}

/// Many bodies are ticked off faster than they are sorted.
void ContactStage::put_struck_in_order() {
  const auto [first, last] = std::minmax_element(struck_.begin(), struck_.end());
  const Index begin = *first, count = *last - begin + 1;
  if (count > 2 * struck_.size()) {
    std::sort(struck_.begin(), struck_.end());
    return;
  }
  is_struck_.assign(count, 0);
  for (const Index body : struck_) is_struck_[body - begin] = 1;
  struck_.clear();
  for (Index i = 0; i < count; ++i) {
    if (is_struck_[i] != 0) struck_.push_back(begin + i);
  }
}

std::span<const Index> ContactStage::struck(Range bodies) const {
  if (struck_.empty()) return {};
  if (struck_.front() >= bodies.begin && struck_.back() < bodies.end) return struck_;
  const auto first = std::lower_bound(struck_.begin(), struck_.end(), bodies.begin);
  return {first, std::lower_bound(first, struck_.end(), bodies.end)};
}

/// Problems come in the order of their first bodies. Where one has bodies of several blocks, blocks are not
/// solved one by one.
void ContactStage::share_out(const StepIsland& island, StepTrial& trial) {
  const Component& component = assembly_->components()[island.components.front()];
  const Range blocks = component.blocks;
  first_run_ = component.runs.begin;
  const auto clear = [&](Range v) {
    std::fill(trial.dv_impulses.begin() + v.begin, trial.dv_impulses.begin() + v.end, 0.0);
  };
  if (blocks.size() == 1) {
    block_problems_[0] = {0, static_cast<Index>(problems().size())};
    return clear(component.v);
  }
  Index next = 0;
  for (Index part = 0; part < blocks.size(); ++part) {
    const Block& block = assembly_->blocks()[blocks.begin + part];
    const Index first = next;
    for (; next < problems().size() && problems()[next].constraints().front().body() < block.bodies.end;
         ++next) {
      by_block_ = by_block_ && lies_within(problems()[next], block);
    }
    block_problems_[part] = {first, next};
    if (next > first) clear(block.v);
  }
  if (!by_block_) clear(component.v);
}

bool ContactStage::touches(Index part) const {
  return !problems().empty() && (!by_block_ || !block_problems_[part].empty());
}

void ContactStage::solve_block(const StepInput& in, const StepRule& rule, const Block& block, Index part,
                               StepTrial& trial) {
  if (!touches(part)) return;
  const EndLoads loads{rule.start_of_sum(in, trial), trial.loads_guess.data()};
  for (Index i = block_problems_[part].begin; i < block_problems_[part].end; ++i) {
    static_cast<void>(solve(in, loads, problems()[i], chains_[block.run - first_run_], trial));
  }
}

const IslandProblem* ContactStage::solve(const StepInput& in, const StepRule& rule, StepTrial& trial) {
  const EndLoads loads{rule.start_of_sum(in, trial), trial.loads_guess.data()};
  for (IslandProblem& problem : problems()) {
    if (!solve(in, loads, problem, chains_.front(), trial)) return &problem;
  }
  return nullptr;
}

/// Bodies answer for themselves. False if there are no impulses.
bool ContactStage::solve(const StepInput& in, const EndLoads& loads, IslandProblem& problem,
                         SolverChain& chain, StepTrial& trial) {
  const std::span<const Constraint> constraints = problem.constraints();
  if (constraints.size() == 1 && constraints.front().bodies == 1) {
    free_body(in, loads.start, loads.end, constraints.front().body(), trial);
  } else {
    problem.map().for_bodies(
        [&](const Constraint::Block& block) { free_body(in, loads.start, loads.end, block.body, trial); });
  }
  return solve_against_free(problem, chain, trial);
}

const IslandProblem* ContactStage::first_unsolved() const {
  for (const IslandProblem& problem : problems()) {
    if (!problem.report().usable()) return &problem;
  }
  return nullptr;
}

void ContactStage::add_statistics(ChainStatistics& sum) {
  lone_.add_statistics(sum);
  for (SolverChain& chain : chains_) chain.take_statistics(sum);
}

void ContactStage::forget_statistics() {
  lone_.forget_statistics();
  for (SolverChain& chain : chains_) chain.reset_statistics();
}

}  // namespace carom

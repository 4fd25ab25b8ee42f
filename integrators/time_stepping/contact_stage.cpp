// Problem: which constraints take part in a step, and their impulses against the guess at the loads.

#include <carom/contact/impact_restitution.h>
#include <carom/integrators/time_stepping/contact_stage.h>

#include <algorithm>
#include <utility>

namespace carom {

ContactStage::ContactStage(const Assembly& assembly, const TimeStepping& options)
    : assembly_(&assembly), detector_(assembly), masses_(assembly), capture_speed_(options.capture_speed) {
  Index most_blocks = 1, most_runs = 1;
  for (const Component& component : assembly.components()) {
    most_blocks = std::max(most_blocks, component.blocks.size());
    most_runs = std::max(most_runs, component.runs.size());
  }
  block_problems_.resize(most_blocks);
  chains_.resize(most_runs);
}

void ContactStage::place_surfaces(const StepInput& in) {
  if (!detector_.has_moving_ground()) return;
  if (places_after_.time() == in.start.time) std::swap(places_, places_after_);
  detector_.place(in.start.time, places_);
  detector_.place(in.end_time, places_after_);
  detector_.demand_continuous(places_, places_after_);
}

/// A gap was opened by the step before, which this one may be a small part of.
void ContactStage::remember(const StepInput& in, double last_step) {
  detector_.remember(in.companion.modes, std::max(in.step, last_step), lasting_);
  if (!detector_.has_static_friction()) return;
  sticking_.clear();
  for (const auto& [key, mode] : in.companion.modes) {
    if (mode == ContactMode::stick) sticking_.push_back(key);
  }
  std::sort(sticking_.begin(), sticking_.end());
}

void ContactStage::find(const StepInput& in, Index component, const StepTrial& trial,
                        std::vector<Constraint>& out) {
  const std::size_t first = out.size();
  detector_.find(component, in.start.view(), trial.at_start, places_, &places_after_, 0.0, out, &lasting_);
  detector_.find_joint_friction(component, in.start.view(), trial.at_start, out);
  if (out.size() == first) return;
  const std::span<Constraint> found(out.data() + first, out.size() - first);
  if (detector_.has_static_friction()) {
    for (Constraint& contact : found) {
      if (!std::binary_search(sticking_.begin(), sticking_.end(), contact.key)) continue;
      contact.friction = contact.law.sticking_friction();
    }
  }
  // Friction in joints comes last.
  if (found.back().has_dry_friction()) share_impact_restitution(found, in.start.v.data(), capture_speed_);
}

void ContactStage::find(const StepInput& in, const StepTrial& trial) {
  remember(in, trial.history.step);
  constraints_.clear();
  members_.clear();
  for (Index component = 0; component < assembly_->components().size(); ++component) {
    find(in, component, trial, constraints_);
    members_.push_back(component);
  }
  make_islands();
}

Index ContactStage::component_of(Index body) const {
  const auto& all = assembly_->components();
  const auto at = std::upper_bound(
      all.begin(), all.end(), body,
      [](Index wanted, const Component& component) { return wanted < component.bodies.end; });
  return static_cast<Index>(at - all.begin());
}

/// Components stand alone but where a constraint joins them. Constraints come ordered by their first bodies.
void ContactStage::make_islands() {
  islands_.clear();
  const auto joins = [&](const Constraint& constraint) {
    for (int b = 1; b < constraint.bodies; ++b) {
      if (component_of(constraint.blocks[static_cast<std::size_t>(b)].body) !=
          component_of(constraint.body())) {
        return true;
      }
    }
    return false;
  };
  const auto count = static_cast<Index>(assembly_->components().size());
  if (std::any_of(constraints_.begin(), constraints_.end(), joins)) {
    const auto node = [&](Index body) { return component_of(body); };
    partition_.arrange_constraints(std::span(constraints_), count, node);
    std::stable_sort(members_.begin(), members_.end(),
                     [&](Index a, Index b) { return partition_.island_of(a) < partition_.island_of(b); });
  } else {
    partition_.clear(count);
  }
  std::size_t next = 0;
  for (std::size_t first = 0; first < members_.size();) {
    const Index island = partition_.island_of(members_[first]);
    std::size_t last = first + 1;
    while (last < members_.size() && partition_.island_of(members_[last]) == island) ++last;
    const std::size_t begin = next;
    const auto within = [&](const Constraint& constraint) {
      return partition_.island_of(component_of(constraint.body())) == island;
    };
    while (next < constraints_.size() && within(constraints_[next])) ++next;
    islands_.push_back(
        {{members_.data() + first, last - first}, {constraints_.data() + begin, next - begin}});
    first = last;
  }
}

void ContactStage::restore(const StepInput& in, const StepIsland& island, const StepTrial& trial) {
  again_.clear();
  for (const Index component : island.components) find(in, component, trial, again_);
  if (island.components.size() > 1) {
    std::stable_sort(again_.begin(), again_.end(),
                     [](const Constraint& a, const Constraint& b) { return a.key < b.key; });
    std::stable_sort(island.constraints.begin(), island.constraints.end(),
                     [](const Constraint& a, const Constraint& b) { return a.key < b.key; });
  }
  std::copy(again_.begin(), again_.end(), island.constraints.begin());
}

void ContactStage::add_problem(const StepInput& in, std::span<Constraint> constraints) {
  if (in_use_ == problems_.size()) problems_.emplace_back();
  problems_[in_use_++].build(constraints, in.start.v.data());
}

void ContactStage::state_problems(const StepInput& in, const StepIsland& island, bool together,
                                  StepTrial& trial) {
  in_use_ = 0;
  by_block_ = !together && island.components.size() == 1;
  if (island.constraints.empty()) return;
  trial.expect_impulses();
  if (together) {
    add_problem(in, island.constraints);
  } else {
    const auto bodies = static_cast<Index>(assembly_->layout()->bodies().size());
    const auto alone = [](Index body) { return body; };
    for (const Range problem : partition_.arrange_constraints(island.constraints, bodies, alone)) {
      add_problem(in, island.constraints.subspan(problem.begin, problem.size()));
      problems_[in_use_ - 1].respond(masses_);
    }
  }
  if (by_block_) return share_out(island, trial);
  for (const Index component : island.components) {
    const Range v = assembly_->components()[component].v;
    std::fill(trial.dv_impulses.begin() + v.begin, trial.dv_impulses.begin() + v.end, 0.0);
  }
}

/// Problems come in the order of their first bodies. Where one has bodies of several blocks, blocks are not
/// solved one by one.
void ContactStage::share_out(const StepIsland& island, StepTrial& trial) {
  const Range blocks = assembly_->components()[island.components.front()].blocks;
  first_run_ = assembly_->components()[island.components.front()].runs.begin;
  Index next = 0;
  for (Index part = 0; part < blocks.size(); ++part) {
    const Block& block = assembly_->blocks()[blocks.begin + part];
    const Index first = next;
    for (; next < in_use_ && problems_[next].constraints().front().body() < block.bodies.end; ++next) {
      for (const Constraint& constraint : problems_[next].constraints()) {
        for (int b = 0; b < constraint.bodies; ++b) {
          const Index body = constraint.blocks[static_cast<std::size_t>(b)].body;
          by_block_ = by_block_ && body >= block.bodies.begin && body < block.bodies.end;
        }
      }
    }
    block_problems_[part] = {first, next};
    if (next > first || !by_block_) {
      std::fill(trial.dv_impulses.begin() + block.v.begin, trial.dv_impulses.begin() + block.v.end, 0.0);
    }
  }
  if (by_block_) return;
  const Range v = assembly_->components()[island.components.front()].v;
  std::fill(trial.dv_impulses.begin() + v.begin, trial.dv_impulses.begin() + v.end, 0.0);
}

bool ContactStage::touches(Index part) const {
  return in_use_ > 0 && (!by_block_ || !block_problems_[part].empty());
}

void ContactStage::solve_block(const StepInput& in, const StepRule& rule, const Block& block, Index part,
                               StepTrial& trial) {
  if (!touches(part)) return;
  for (Index i = block_problems_[part].begin; i < block_problems_[part].end; ++i) {
    static_cast<void>(solve(in, rule, problems_[i], chains_[block.run - first_run_], trial));
  }
}

const IslandProblem* ContactStage::solve(const StepInput& in, const StepRule& rule, StepTrial& trial) {
  for (IslandProblem& problem : problems()) {
    if (!solve(in, rule, problem, chains_.front(), trial)) return &problem;
  }
  return nullptr;
}

/// Bodies answer for themselves: v_free = v_j + M^-1 h (F_j + F_{j+1})/2 of those of the problem. False if
/// there are no impulses.
bool ContactStage::solve(const StepInput& in, const StepRule& rule, IslandProblem& problem,
                         SolverChain& chain, StepTrial& trial) {
  const double half = 0.5 * in.step;
  const double* const load0 = rule.start_of_sum(in, trial);
  Index last = none;
  for (const Constraint& constraint : problem.constraints()) {
    for (int b = 0; b < constraint.bodies; ++b) {
      if (constraint.blocks[static_cast<std::size_t>(b)].body == last) continue;
      last = constraint.blocks[static_cast<std::size_t>(b)].body;
      const BodySlot& body = assembly_->layout()->bodies()[last];
      for (Index k = body.v; k < body.v + body.v_size; ++k) {
        trial.dv_impulses[k] = half * (load0[k] + trial.loads_guess[k]);
      }
      assembly_->body_kinds()[body.kind]->apply_inverse_mass(
          {body.slot, body.slot + 1}, trial.dv_impulses.data() + body.v, trial.free.data() + body.v);
      for (Index k = body.v; k < body.v + body.v_size; ++k) {
        trial.free[k] += static_cast<double>(in.companion.rounding[k]) + in.start.v[k];
        trial.dv_impulses[k] = 0.0;
      }
    }
  }
  problem.set_free_velocity(trial.free.data());
  if (!problem.solve(chain).usable()) return false;
  problem.map().add_velocities(trial.dv_impulses.data());
  return true;
}

const IslandProblem* ContactStage::first_unsolved() const {
  for (const IslandProblem& problem : problems()) {
    if (!problem.report().usable()) return &problem;
  }
  return nullptr;
}

void ContactStage::add_statistics(ChainStatistics& sum) {
  for (SolverChain& chain : chains_) {
    if (chain.statistics().problems > 0) sum += chain.statistics();
  }
  forget_statistics();
}

void ContactStage::forget_statistics() {
  for (SolverChain& chain : chains_) {
    if (chain.statistics().problems > 0) chain.reset_statistics();
  }
}

}  // namespace carom

// Problem: which contacts take part in a step, their impulses against the guess of the loads, and a guess
// that is good around them too.

#include <carom/contact/impact_restitution.h>
#include <carom/integrators/time_stepping/time_stepper.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace carom {

/// A gap was opened by the step before, which the one at hand may be a small part of.
void TimeStepper::remember_contacts(const Companion& companion, double step) {
  detector_.remember(companion.modes, std::max(step, companion.history.step), lasting_);
  if (!detector_.has_static_friction()) return;
  sticking_.clear();
  for (const auto& [key, mode] : companion.modes) {
    if (mode == ContactMode::stick) sticking_.push_back(key);
  }
  std::sort(sticking_.begin(), sticking_.end());
}

void TimeStepper::find_contacts(Index component, const State& state) {
  contacts_.clear();
  clusters_in_use_ = 0;
  detector_.find(component, state.view(), start_, places_, &places_after_, 0.0, contacts_, &lasting_);
  detector_.find_joint_friction(component, state.view(), start_, contacts_);
  if (contacts_.empty()) return;
  if (detector_.has_static_friction()) {
    for (Constraint& contact : contacts_) {
      if (!std::binary_search(sticking_.begin(), sticking_.end(), contact.key)) continue;
      contact.friction = contact.law.sticking_friction();
    }
  }
  // Friction in joints comes last.
  if (contacts_.back().has_dry_friction()) {
    share_impact_restitution(contacts_, state.v.data(), options_.capture_speed);
  }
  dv_impulses_.resize(trial_.v.size());
  free_.resize(trial_.v.size());
  if (iteration_ == Iteration::linearly_implicit || jointed(component)) {
    add_cluster(state, 0, contacts_.size());  // bodies answer together, those of all blocks
    const Component& all = assembly_->components()[component];
    std::fill_n(block_clusters_.begin(), all.blocks.size(), Range{0, 1});
    std::fill(dv_impulses_.begin() + all.v.begin, dv_impulses_.begin() + all.v.end, 0.0);
    return;
  }
  // Obstacles go their own way, so contacts share a problem where they share a body; they come ordered by
  // body.
  for (std::size_t first = 0; first < contacts_.size();) {
    std::size_t last = first + 1;
    while (last < contacts_.size() && contacts_[last].body() == contacts_[first].body()) ++last;
    add_cluster(state, first, last);
    first = last;
  }
  share_out_clusters(component);
}

/// Clusters come in the order of their bodies, of which each has one.
void TimeStepper::share_out_clusters(Index component) {
  const Range blocks = assembly_->components()[component].blocks;
  Index next = 0;
  for (Index part = 0; part < blocks.size(); ++part) {
    const Block& block = assembly_->blocks()[blocks.begin + part];
    const Index first = next;
    while (next < clusters_in_use_ && clusters_[next].constraints().front().body() < block.bodies.end) ++next;
    block_clusters_[part] = {first, next};
    if (next > first)
      std::fill(dv_impulses_.begin() + block.v.begin, dv_impulses_.begin() + block.v.end, 0.0);
  }
}

void TimeStepper::add_cluster(const State& state, std::size_t first, std::size_t last) {
  if (clusters_in_use_ == clusters_.size()) clusters_.emplace_back();
  IslandProblem& problem = clusters_[clusters_in_use_++];
  problem.build({contacts_.data() + first, last - first}, state.v.data());
  if (iteration_ != Iteration::linearly_implicit && joints_.empty()) problem.respond(masses_);
}

void TimeStepper::solve_contacts(Index component, const State& state, const Companion& companion,
                                 double step) {
  for (std::size_t i = 0; i < clusters_in_use_; ++i) {
    if (!solve(clusters_[i], chains_.front(), state, companion, step)) {
      fail_contact(component, clusters_[i], state, step);
    }
  }
}

void TimeStepper::solve_contacts(Index component, const Block& block, Index part, const State& state,
                                 const Companion& companion, double step) {
  if (!touched(part)) return;
  SolverChain& chain = chains_[block.run - assembly_->components()[component].runs.begin];
  for (Index i = block_clusters_[part].begin; i < block_clusters_[part].end; ++i) {
    static_cast<void>(solve(clusters_[i], chain, state, companion, step));
  }
}

bool TimeStepper::solve(IslandProblem& cluster, SolverChain& chain, const State& state,
                        const Companion& companion, double step) {
  const double half = 0.5 * step;
  const double* const load0 = start_of_sum(companion);
  const BodySlot& body = assembly_->layout()->bodies()[cluster.constraints().front().body()];
  for (Index k = body.v; k < body.v + body.v_size; ++k) {
    dv_impulses_[k] = half * (load0[k] + evaluation_.force[k]);
  }
  assembly_->body_kinds()[body.kind]->apply_inverse_mass({body.slot, body.slot + 1},
                                                         dv_impulses_.data() + body.v, free_.data() + body.v);
  for (Index k = body.v; k < body.v + body.v_size; ++k) {
    free_[k] += static_cast<double>(companion.rounding[k]) + state.v[k];
    dv_impulses_[k] = 0.0;
  }
  cluster.set_free_velocity(free_.data());
  if (!cluster.solve(chain).usable()) return false;
  cluster.map().add_velocities(dv_impulses_.data());
  return true;
}

/// Contact upsets the loads around it and, within a step, hardly any others. So few bodies would make all of
/// the component sweep more often. Upset is a block of which another sweep would change more than the
/// tolerance.
void TimeStepper::presolve_around_contacts(Index component, const State& state, const Companion& companion,
                                           double step) {
  constexpr Index small_part = 4;  // of the component: for more, sweeps of these blocks do not pay
  constexpr int most_sweeps = 8;
  enum : std::uint8_t { untouched, guessed, settled };
  const Range blocks = assembly_->components()[component].blocks;
  std::fill_n(settled_.begin(), blocks.size(), std::uint8_t{untouched});
  if (clusters_in_use_ == 0 || blocks.size() < small_part) return;
  if (iteration_ != Iteration::fixed_point) return;
  const auto block_at = [&](Index index) -> const Block& { return assembly_->blocks()[index]; };
  const auto sweep_at = [&](Index index) {
    const Index part = index - blocks.begin;
    solve_contacts(component, block_at(index), part, state, companion, step);
    sweep(component, block_at(index), part, state, companion, step);
  };
  Surroundings& upset = upset_;
  upset.inner.clear();
  for (Index part = 0; part < blocks.size(); ++part) {
    if (touched(part)) upset.inner.push_back(blocks.begin + part);
  }
  double* const total = loads_end_.data();
  FixedPointJudge judge(options_.tolerance, most_sweeps);
  while (!upset.inner.empty() && assembly_->surround(upset)) {
    std::swap(upset.inner, upset.touched);
    if (!assembly_->surround(upset) || small_part * upset.touched.size() > blocks.size()) break;
    for (const Index index : upset.touched) {
      if (settled_[index - blocks.begin] == untouched) {
        settled_[index - blocks.begin] = guessed;
        guess_block(index, companion, step);
      } else if (!std::binary_search(upset.inner.begin(), upset.inner.end(), index)) {
        continue;
      }
      sweep_at(index);
    }
    evaluate_loads_within(*assembly_, component, upset, trial_.view(), evaluation_, {total, total, total});
    SweepChange largest;
    std::erase_if(upset.inner, [&](Index index) {
      const SweepChange next = next_change(component, block_at(index), step);
      largest.take(next.change, next.size);
      improve_guess(block_at(index));
      settled_[index - blocks.begin] = settled;
      return next.change <= options_.tolerance;
    });
    if (judge.judge(largest.change, largest.size) != FixedPointJudge::Verdict::go_on) break;
  }
  report_.local_sweeps = std::max(report_.local_sweeps, judge.sweeps());
  // What does not settle is left to the iteration, which says why.
  const bool settles = std::isfinite(judge.change()) && judge.contraction() < 1.0;
  for (Index part = 0; part < blocks.size(); ++part) settled_[part] = settles && settled_[part] == settled;
}

void TimeStepper::demand_solved(Index component, const State& state, const Companion& companion, double step,
                                int sweeps) {
  for (std::size_t i = 0; i < clusters_in_use_; ++i) {
    if (clusters_[i].report().usable()) continue;
    const IslandProblem failed = clusters_[i];
    find_cause(component, state, companion, step, sweeps);
    fail_contact(component, failed, state, step);
  }
}

}  // namespace carom

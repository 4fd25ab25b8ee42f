// Problem: sweeps and the loads they lead to, with as little traffic to memory as can be: all that is to be
// done with a block of bodies is done while its numbers are at hand.

#include <carom/integrators/time_stepping/sweep_schedule.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace carom {

SweepSchedule::SweepSchedule(const Assembly& assembly, const TimeStepping& options, bool any_iterated)
    : assembly_(&assembly),
      threads_(static_cast<Index>(std::max(options.threads, 1))),
      workers_(std::max(options.threads, 1)),
      any_iterated_(any_iterated) {
  Index most_blocks = 1;
  for (const Component& component : assembly.components()) {
    most_blocks = std::max(most_blocks, component.blocks.size());
  }
  changes_.resize(most_blocks);
  earlier_changes_.resize(most_blocks);
  local_.resize(most_blocks);
}

bool SweepSchedule::may_fuse(const SweepStages& stages, int sweeps, int expected) const {
  return stages.blocks().size() > 1 && sweeps + 2 == expected;
}

void SweepSchedule::guess(const SweepStages& stages) const {
  for_blocks(stages, [&](const Block&, Index part) { stages.guess(part); });
}

void SweepSchedule::move(const SweepStages& stages) const {
  for_blocks(stages, [&](const Block& block, Index part) { stages.move(block, part); });
}

void SweepSchedule::improve(const SweepStages& stages) const {
  StepTrial& trial = stages.trial;
  if (assembly_->components()[stages.component].v.size() == trial.loads_guess.size()) {
    return trial.loads_guess.swap(trial.loads_end.total);
  }
  for_blocks(stages, [&](const Block& block, Index) { stages.improve(block); });
}

void SweepSchedule::run(const ConstantStages& stages, BodyTask before, BodyTask after,
                        BodyQuestion touch) const {
  const Range all = stages.bodies();
  constexpr Index size = BlockTable::block_size;
  const Index parts = (all.size() + size - 1) / size;
  stages.trial.account.start(parts);
  if (stages.components.size() > 1) stages.trial.account.of_fields.resize(parts);
  const auto& components = assembly_->components();
  const Range v{components[stages.components.begin].v.begin, components[stages.components.end - 1].v.end};
  const bool in_pieces = before && threads_ == 1;
  const auto move_pieces = [&](Range some) {
    for_pieces(some, piece_size, [&](Range large) {
      for_pieces(large, touch(large) ? touching_size : piece_size, [&](Range piece) {
        before(piece);
        stages.move(piece);
        after(piece);
      });
    });
  };
  const bool finish_apart = stages.locates && !in_pieces;  // `after` moves bodies on
  const auto run_part = [&](Range some, Range velocities, Index part) {
    if (any_iterated_) stages.load(velocities);
    in_pieces ? move_pieces(some) : stages.move(some);
    if (!finish_apart) stages.finish(some, velocities, part);
  };
  const auto finish_part = [&](Range some, Range velocities, Index part) {
    stages.finish(some, velocities, part);
  };
  const BodySlots& bodies = assembly_->layout()->bodies();
  constexpr Index of_several_threads = 4;  // parts of each: to share them out anew has a price
  const Index at_once = before && !in_pieces ? of_several_threads * threads_ : parts;
  for (Index next = 0; next < parts; next += at_once) {
    const Index count = std::min(at_once, parts - next);
    const Range some{all.begin + next * size, std::min(all.begin + (next + count) * size, all.end)};
    if (before && !in_pieces) before(some);
    const auto for_parts = [&](auto&& task) {
      if (parts == 1) return task(all, v, 0);
      workers_.for_each(count, [&](Index i) {
        const Index first = some.begin + i * size, end = std::min(first + size, all.end);
        task({first, end}, {bodies[first].v, end == all.end ? v.end : bodies[end].v}, next + i);
      });
    };
    for_parts(run_part);
    if (after && !in_pieces) after(some);
    if (finish_apart) for_parts(finish_part);
  }
  stages.close();
}

SweepChange SweepSchedule::largest(const std::vector<SweepChange>& changes, const SweepStages& stages) const {
  SweepChange largest = changes[0];
  for (Index part = 1; part < stages.blocks().size(); ++part) largest.take(changes[part]);
  return largest;
}

void SweepSchedule::evaluate(const SweepStages& stages, LoadsKnown asked, bool with_changes) {
  evaluate(stages, asked, with_changes, {});
}

void SweepSchedule::evaluate(const SweepStages& stages, LoadsKnown asked, bool with_changes,
                             BlockTask first) {
  StepTrial& trial = stages.trial;
  const Index component = stages.component;
  const bool by_cause = asked == LoadsKnown::by_cause;
  const auto last = [&](const Block& block, Index part) {
    if (by_cause) stages.finish(block, part);
    if (with_changes) changes_[part] = stages.change(block);
  };
  const Loads loads = by_cause ? trial.loads_end.by_cause() : trial.loads_end.in_one();
  const BlockTasks tasks{first, last};
  if (by_cause) trial.account.start(stages.blocks().size());
  if (stages.rule.is_mean()) {
    trial.with_step(stages.in, component, [&](const StepContext& at) {
      evaluate_mean_loads(*assembly_, component, at, loads, workers_, tasks);
    });
    if (by_cause)
      add_potentials(*assembly_, component, trial.end.view(), trial.at_end, trial.account.potentials);
  } else if (by_cause) {
    evaluate_loads_and_potentials(*assembly_, component, trial.end.view(), trial.at_end, loads,
                                  trial.account.potentials, workers_, tasks);
  } else {
    evaluate_loads(*assembly_, component, trial.end.view(), trial.at_end, loads, workers_, tasks);
  }
}

void SweepSchedule::stream(const SweepStages& stages, bool guessing, LoadsKnown asked) {
  const auto first = [&](const Block& block, Index part) {
    if (guessing && local_[part] == untouched) stages.guess(part);
    stages.react(block, part);
    stages.move(block, part);
  };
  evaluate(stages, asked, true, first);
}

void SweepSchedule::fuse(const SweepStages& stages, bool guessing) {
  StepTrial& trial = stages.trial;
  const auto first = [&](const Block& block, Index part) {
    if (guessing && local_[part] == untouched) stages.guess(part);
    stages.react(block, part);
    stages.move(block, part);
  };
  const auto compare = [&](const Block& block, Index part) { earlier_changes_[part] = stages.change(block); };
  const auto again = [&](const Block& block, Index part) {
    if (!std::isfinite(earlier_changes_[part].change)) return;
    stages.improve(block);
    stages.react(block, part);
    stages.move(block, part);
  };
  const auto last = [&](const Block& block, Index part) {
    stages.finish(block, part);
    changes_[part] = stages.change(block);
  };
  trial.account.start(stages.blocks().size());
  evaluate_loads_twice(*assembly_, stages.component, trial.end.view(), trial.at_end, trial.loads_end.in_one(),
                       {first, compare}, trial.loads_end.by_cause(), {again, last}, trial.account.potentials,
                       workers_);
}

SweepSchedule::LocalSweeps SweepSchedule::presolve(const SweepStages& stages, Iteration iteration,
                                                   double tolerance, bool again) {
  if (!again) std::fill_n(local_.begin(), stages.blocks().size(), std::uint8_t{untouched});
  return iteration == Iteration::fixed_point ? presolve_around_contacts(stages, tolerance) : LocalSweeps{};
}

/// Blocks around those that are upset; false if they are too many, or may depend on any block.
bool SweepSchedule::surround_upset(Index blocks) {
  constexpr Index small_part = 4;  // of the component: for more, sweeps of these blocks do not pay
  if (!assembly_->blocks().surround(upset_)) return false;
  std::swap(upset_.inner, upset_.touched);
  return assembly_->blocks().surround(upset_) && small_part * upset_.touched.size() <= blocks;
}

/// One sweep of the blocks around those that are upset.
void SweepSchedule::sweep_upset(const SweepStages& stages) {
  StepTrial& trial = stages.trial;
  const Range blocks = stages.blocks();
  for (const Index index : upset_.touched) {
    const Index part = index - blocks.begin;
    if (local_[part] == untouched) {
      local_[part] = guessed;
      stages.guess(part);
    } else if (!std::binary_search(upset_.inner.begin(), upset_.inner.end(), index)) {
      continue;
    }
    stages.react(assembly_->blocks()[index], part);
    stages.move(assembly_->blocks()[index], part);
  }
  evaluate_loads_within(*assembly_, stages.component, upset_, trial.end.view(), trial.at_end,
                        trial.loads_end.in_one());
}

/// Contact upsets the loads around it and, within a step, hardly any others. So few bodies would make all of
/// the component sweep more often. Upset is a block of which another sweep would change more than the
/// tolerance.
SweepSchedule::LocalSweeps SweepSchedule::presolve_around_contacts(const SweepStages& stages,
                                                                   double tolerance) {
  constexpr Index least_blocks = 4;
  constexpr int most_sweeps = 8;
  const Range blocks = stages.blocks();
  const bool any =
      !stages.contacts.problems().empty() || (stages.located != nullptr && !stages.located->empty());
  if (!any || blocks.size() < least_blocks) return {};
  upset_.inner.clear();
  for (Index part = 0; part < blocks.size(); ++part) {
    if (stages.contact_upsets(assembly_->blocks()[blocks.begin + part], part))
      upset_.inner.push_back(blocks.begin + part);
  }
  FixedPointJudge judge(tolerance, most_sweeps);
  while (!upset_.inner.empty() && surround_upset(blocks.size())) {
    sweep_upset(stages);
    SweepChange largest;
    std::erase_if(upset_.inner, [&](Index index) {
      const SweepChange next = stages.change(assembly_->blocks()[index]);
      largest.take(next);
      stages.improve(assembly_->blocks()[index]);
      local_[index - blocks.begin] = swept;
      return next.change <= tolerance;
    });
    if (judge.judge(largest.change, largest.size) != FixedPointJudge::Verdict::go_on) break;
  }
  // Blocks that do not converge are left to the iteration, which says why.
  const bool contracts = std::isfinite(judge.change()) && judge.contraction() < 1.0;
  for (Index part = 0; part < blocks.size(); ++part) {
    local_[part] = contracts && local_[part] == swept ? swept : untouched;
  }
  return {judge.sweeps(), judge.sweeps() > 0 && contracts};
}

}  // namespace carom

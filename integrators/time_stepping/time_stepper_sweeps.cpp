// Problem: the sweeps of an iteration and the loads they lead to, with as little traffic to memory as can be:
// all that is to be done with a block of bodies is done while its numbers are at hand.

#include <carom/integrators/time_stepping/time_stepper.h>

namespace carom {

namespace {

/// Where elements book. The conservative part goes into `total`, to which finish() adds the others; so do
/// those that no element books, whose arrays are empty.
Loads open(std::vector<double>& total, std::vector<double>& dissipative, std::vector<double>& external) {
  return {total.data(), dissipative.empty() ? total.data() : dissipative.data(),
          external.empty() ? total.data() : external.data()};
}

void add(std::vector<double>& total, const std::vector<double>& part, Range v) {
  if (part.empty()) return;
  for (Index i = v.begin; i < v.end; ++i) total[i] += part[i];
}

void finish(std::vector<double>& total, const std::vector<double>& dissipative,
            const std::vector<double>& external, Range v) {
  add(total, dissipative, v);
  add(total, external, v);
}

}  // namespace

void TimeStepper::start_loads(const State& state, Companion& companion) {
  PresentLoads& loads = companion.loads;
  if (loads.valid && loads.mean == mean_rule()) return;
  if (loads.valid) companion.history.known = 0;  // of the other rule
  loads.total.resize(trial_.v.size());
  loads.dissipative.resize(books_dissipative_ ? trial_.v.size() : 0);
  loads.external.resize(books_external_ ? trial_.v.size() : 0);
  for (Index component = 0; component < assembly_->components().size(); ++component) {
    evaluate_positions(*assembly_, component, state.view(), evaluation_);
    evaluate_loads(*assembly_, component, state.view(), evaluation_,
                   open(loads.total, loads.dissipative, loads.external));
    finish(loads.total, loads.dissipative, loads.external, assembly_->components()[component].v);
  }
  loads.valid = true;
  loads.mean = mean_rule();
}

void TimeStepper::sweep(Index component, const State& state, const Companion& companion, double step) {
  swept_ = true;
  for_blocks(component,
             [&](const Block& block, Index part) { sweep(component, block, part, state, companion, step); });
}

void TimeStepper::sweep(Index component, const Block& block, Index part, const State& state,
                        const Companion& companion, double step) {
  const double* const load0 = start_of_sum(companion);
  const bool responds = touched(part) || jointed(component);
  assembly_->for_bodies(
      component, block.bodies, [&](const BodyKind& kind, Range slots, Index q, Index v, Index) {
        kind.sweep(slots, step,
                   {state.q.data() + q, state.v.data() + v, companion.rounding.data() + v, load0 + v,
                    evaluation_.force.data() + v, responds ? dv_impulses_.data() + v : nullptr,
                    trial_.q.data() + q, trial_.v.data() + v, rounding_.data() + v, mean_rule()});
      });
}

SweepChange TimeStepper::next_change(Index component, const Block& block, double step) const {
  SweepChange change;
  assembly_->for_bodies(
      component, block.bodies, [&](const BodyKind& kind, Range slots, Index q, Index v, Index) {
        kind.next_change(
            slots, impulse_weight(step), step,
            {evaluation_.force.data() + v, loads_end_.data() + v, trial_.q.data() + q, trial_.v.data() + v},
            change);
      });
  return change;
}

SweepChange TimeStepper::largest(const std::vector<SweepChange>& changes, Index component) const {
  SweepChange largest = changes[0];
  for (Index part = 1; part < assembly_->components()[component].blocks.size(); ++part) {
    largest.take(changes[part].change, changes[part].size);
  }
  return largest;
}

void TimeStepper::finish_block(Index component, const Block& block, Index part, const State& state,
                               const Companion& companion, double step) {
  finish(loads_end_, dissipative_, external_, block.v);
  works_[part] = works(component, block, state, companion, step);
}

void TimeStepper::sweep_fused(Index component, const State& state, const Companion& companion, double step,
                              BlockTask first) {
  const auto compare = [&](const Block& block, Index part) {
    earlier_changes_[part] = next_change(component, block, step);
  };
  const auto again = [&](const Block& block, Index part) {
    improve_guess(block);
    solve_contacts(component, block, part, state, companion, step);
    sweep(component, block, part, state, companion, step);
  };
  const auto last = [&](const Block& block, Index part) {
    finish_block(component, block, part, state, companion, step);
    changes_[part] = next_change(component, block, step);
  };
  double* const total = loads_end_.data();
  evaluated_energies_ = {};
  evaluate_loads_twice(*assembly_, component, trial_.view(), evaluation_, {total, total, total},
                       {first, compare}, open(loads_end_, dissipative_, external_), {again, last},
                       evaluated_energies_, workers_);
}

void TimeStepper::evaluate_iterate(Index component, const State& state, const Companion& companion,
                                   double step, LoadsAsked asked, bool with_changes, BlockTask first) {
  const bool by_cause = asked == LoadsAsked::by_cause;
  const auto last = [&](const Block& block, Index part) {
    if (by_cause) finish_block(component, block, part, state, companion, step);
    if (with_changes) changes_[part] = next_change(component, block, step);
  };
  double* const total = loads_end_.data();
  const Loads loads = by_cause ? open(loads_end_, dissipative_, external_) : Loads{total, total, total};
  const BlockTasks tasks{first, last};
  if (by_cause) evaluated_energies_ = {};
  if (mean_rule()) {
    with_step(component, state, step, [&](const StepContext& at) {
      evaluate_mean_loads(*assembly_, component, at, loads, workers_, tasks);
    });
    if (by_cause) add_potentials(*assembly_, component, trial_.view(), evaluation_, evaluated_energies_);
  } else if (by_cause) {
    evaluate_loads_and_potentials(*assembly_, component, trial_.view(), evaluation_, loads,
                                  evaluated_energies_, workers_, tasks);
  } else {
    evaluate_loads(*assembly_, component, trial_.view(), evaluation_, loads, workers_, tasks);
  }
}

}  // namespace carom

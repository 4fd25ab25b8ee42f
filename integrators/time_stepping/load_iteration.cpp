#include <carom/integrators/time_stepping/load_iteration.h>

#include <span>

namespace carom {

void LoadIteration::use(Iteration iteration) {
  current_ = iteration;
  const std::size_t size = assembly_->layout()->v_size();
  if (iteration != Iteration::anderson || weights_.size() == size) return;
  const std::vector<double> ones(size, 1.0);
  weights_.resize(size);
  for (Index component = 0; component < assembly_->components().size(); ++component) {
    assembly_->for_bodies(component, [&](const BodyKind& kind, Range slots, Index, Index v, Index) {
      kind.apply_inverse_mass(slots, ones.data() + v, weights_.data() + v);
    });
  }
  const std::vector<double> lengths = assembly_->length_scales();
  for (std::size_t i = 0; i < size; ++i) weights_[i] *= lengths[i];
}

void LoadIteration::start(Index component) {
  if (current_ == Iteration::anderson) anderson_.start(assembly_->components()[component].v.size());
}

void LoadIteration::improve(const SweepStages& stages, const SweepSchedule& schedule,
                            const FixedPointJudge& judge) {
  StepTrial& trial = stages.trial;
  const Range v = assembly_->components()[stages.component].v;
  const auto part = [&](std::vector<double>& numbers) {
    return std::span<double>(numbers.data() + v.begin, v.size());
  };
  switch (current_) {
    case Iteration::anderson:
      anderson_.next(part(trial.loads_guess), part(trial.loads_end.total), part(weights_));
      return;
    case Iteration::linearly_implicit:
      return newton_.note_contraction(judge.sweeps(), judge.contraction());
    case Iteration::fixed_point:
    case Iteration::automatic:
      break;
  }
  if (v.size() == trial.loads_guess.size()) {
    trial.loads_guess.swap(trial.loads_end.total);
  } else {
    schedule.improve(stages);
  }
}

}  // namespace carom

#include <carom/integrators/time_stepping/load_iteration.h>

#include <algorithm>
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

void LoadIteration::start(std::span<const Index> components) {
  if (current_ != Iteration::anderson) return;
  std::size_t size = 0;
  for (const Index component : components) size += assembly_->components()[component].v.size();
  anderson_.start(size);
}

void LoadIteration::improve(std::span<const Index> components, const FixedPointJudge& judge,
                            StepTrial& trial) {
  if (current_ == Iteration::anderson) accelerate(components, trial);
  if (is_newton()) newton_.note_contraction(judge.sweeps(), judge.contraction());
}

void LoadIteration::accelerate(std::span<const Index> components, StepTrial& trial) {
  const auto part = [&](std::vector<double>& numbers, Range v) {
    return std::span<double>(numbers.data() + v.begin, v.size());
  };
  if (components.size() == 1) {
    const Range v = assembly_->components()[components.front()].v;
    return anderson_.next(part(trial.loads_guess, v), part(trial.loads_end.total, v), part(weights_, v));
  }
  gathered_.guess.clear();
  gathered_.led_to.clear();
  gathered_.weights.clear();
  const auto append = [&](std::vector<double>& numbers, Range v, std::vector<double>& out) {
    const std::span<const double> own = part(numbers, v);
    out.insert(out.end(), own.begin(), own.end());
  };
  for (const Index component : components) {
    const Range v = assembly_->components()[component].v;
    append(trial.loads_guess, v, gathered_.guess);
    append(trial.loads_end.total, v, gathered_.led_to);
    append(weights_, v, gathered_.weights);
  }
  anderson_.next(gathered_.guess, gathered_.led_to, gathered_.weights);
  const double* next = gathered_.guess.data();
  for (const Index component : components) {
    const Range v = assembly_->components()[component].v;
    std::copy_n(next, v.size(), trial.loads_guess.data() + v.begin);
    next += v.size();
  }
}

}  // namespace carom

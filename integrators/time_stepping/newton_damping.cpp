// Problem: bring Newton's method to the end of the motion from where the step begins, not to another
// solution.

#include <carom/integrators/time_stepping/newton_damping.h>

#include <algorithm>
#include <limits>

namespace carom {

namespace {

/// True near the end, where corrections are rounding and modes of contacts may change: nothing leads away.
bool is_near(const SweepChange& size) {
  constexpr double near = 1e-9;  // of the numbers themselves
  return size.change <= near * size.size;
}

}  // namespace

void NewtonDamping::keep_impulses(const IslandProblem* contact) {
  impulses_.clear();
  if (contact != nullptr) impulses_.assign(contact->impulses().begin(), contact->impulses().end());
}

bool NewtonDamping::leads_away(const SweepChange& size) const {
  constexpr double least_share = 1.0 / 64.0;
  constexpr double longer = 30.0;  // than the correction before
  if (!known_ || share_ <= least_share || is_near(size)) return false;
  return !(size.change <= longer * size_);
}

void NewtonDamping::apply(const Assembly& assembly, std::span<const Index> components,
                          const SweepChange& size, const std::vector<double>& guess,
                          std::vector<double>& correction, IslandProblem* contact, StepTrial& trial) {
  const bool back = leads_away(size);
  share_ = back ? 0.5 * share_ : known_ && !is_near(size) ? std::min(1.0, 2.0 * share_) : 1.0;
  const auto for_ranges = [&](auto&& f) {
    for (const Index component : components) f(assembly.components()[component]);
  };
  const auto copy = [](const std::vector<double>& from, Range part, std::vector<double>& to) {
    to.resize(from.size());
    std::copy(from.begin() + part.begin, from.begin() + part.end, to.begin() + part.begin);
  };
  if (back) {
    for_ranges([&](const Component& of) {
      copy(last_.q, of.q, trial.end.q);
      copy(last_.v, of.v, trial.end.v);
    });
  } else {
    for_ranges([&](const Component& of) {
      copy(trial.end.q, of.q, last_.q);
      copy(trial.end.v, of.v, last_.v);
      copy(trial.loads_guess, of.v, last_.guess);
      copy(guess, of.v, last_.next_guess);
      copy(correction, of.v, last_.correction);
    });
    last_.impulses = impulses_;
    if (contact != nullptr)
      last_.next_impulses.assign(contact->impulses().begin(), contact->impulses().end());
    // The first begins with loads that are foreseen, not those of an iterate: it is no measure of the next.
    size_ = known_ ? size.change : std::numeric_limits<double>::infinity();
    known_ = true;
  }
  const bool whole = share_ == 1.0;
  for_ranges([&](const Component& of) {
    for (Index i = of.v.begin; i < of.v.end; ++i) {
      trial.loads_guess[i] =
          whole ? last_.next_guess[i] : last_.guess[i] + share_ * (last_.next_guess[i] - last_.guess[i]);
      correction[i] = share_ * last_.correction[i];
    }
  });
  if (contact == nullptr || whole) return;
  for (std::size_t i = 0; i < impulses_.size(); ++i) {
    impulses_[i] = last_.impulses[i] + share_ * (last_.next_impulses[i] - last_.impulses[i]);
  }
  contact->set_impulses(impulses_);
}

}  // namespace carom

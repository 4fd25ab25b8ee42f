// Problem: by how much loads jump that depend on velocities, where bodies are hit within a step.

#include <carom/integrators/time_stepping/jump_search.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace carom {

/// Finds the blocks on which loads may jump. Returns false if these are not a small part of the component.
bool JumpSearch::surround_hit(const At& at) {
  constexpr Index small_part = 4;
  const BlockTable& blocks = assembly_->blocks();
  const Range all = assembly_->components()[at.component].blocks;
  around_.inner.clear();
  Index block = all.begin;
  for (const LocatedMotion* motion : at.motions) {
    while (block < all.end && blocks[block].bodies.end <= motion->body()) ++block;
    if (block == all.end || motion->body() < blocks[block].bodies.begin) continue;
    if (around_.inner.empty() || around_.inner.back() != block) around_.inner.push_back(block);
  }
  return blocks.surround(around_) && small_part * around_.touched.size() <= all.size();
}

/// Calls f(bodies, their velocities) for those whose loads may jump.
template <class F>
void JumpSearch::for_jumps(const At& at, F&& f) const {
  const Component& all = assembly_->components()[at.component];
  if (!local_) return f(all.bodies, all.v);
  for (const Index block : around_.touched) {
    f(assembly_->blocks()[block].bodies, assembly_->blocks()[block].v);
  }
}

/// Loads at the end of the iterate.
void JumpSearch::evaluate_at_end(const At& at, const StepTrial& trial, std::vector<double>& out) const {
  const Loads to{out.data(), out.data(), out.data()};
  if (local_) {
    evaluate_loads_within(*assembly_, at.component, around_, trial.end.view(), trial.at_end, to);
  } else {
    evaluate_loads(*assembly_, at.component, trial.end.view(), trial.at_end, to);
  }
}

/// Takes back a part of every impact. \param weight the part, by its share of the step \param add called with
/// the place of a load and by how much that changed it
template <class W, class F>
void JumpSearch::take_back(const At& at, const W& weight, const F& add, StepTrial& trial) {
  for (const LocatedMotion* motion : at.motions) {
    const Range v = motion->velocities(at.in);
    for (const MotionPhase& phase : motion->phases()) {
      const double part = phase.is_impact() ? weight(phase.begin) : 0.0;
      if (part == 0.0) continue;
      for (Index i = 0; i < v.size(); ++i) trial.end.v[v.begin + i] -= part * (phase.v1[i] - phase.v0[i]);
    }
  }
  evaluate_at_end(at, trial, before_);
  for_jumps(at, [&](Range, Range v) {
    for (Index i = v.begin; i < v.end; ++i) add(i, change_[i] - before_[i]);
  });
}

void JumpSearch::show_end(const At& at, StepTrial& trial) {
  for (const LocatedMotion* motion : at.motions) motion->show_end(at.in, motion->phases().back(), trial);
}

/// One instant after the other is taken back, the last first: exact for laws that are not linear too.
/// \param loads at the end
void JumpSearch::evaluate(const At& at, const std::vector<double>& loads, StepTrial& trial) {
  constexpr std::size_t most_instants = 4;  // beyond which they are added up
  instants_.clear();
  for (const LocatedMotion* motion : at.motions) {
    for (const MotionPhase& phase : motion->phases()) {
      if (phase.is_impact()) instants_.push_back(phase.begin);
    }
  }
  std::sort(instants_.begin(), instants_.end(), std::greater<>());
  instants_.erase(std::unique(instants_.begin(), instants_.end()), instants_.end());
  for_jumps(at, [&](Range, Range v) {
    for (std::vector<double>* const sum : {&jump_, &correction_})
      std::fill(sum->begin() + v.begin, sum->begin() + v.end, 0.0);
    std::copy(loads.begin() + v.begin, loads.begin() + v.end, change_.begin() + v.begin);
  });
  if (instants_.size() > most_instants) {
    add_up(at, trial);
    return;
  }
  for (const double instant : instants_) {
    const auto is_then = [&](double share) { return share == instant ? 1.0 : 0.0; };
    const auto add = [&](Index i, double jump) {
      jump_[i] += jump;
      correction_[i] += (1.0 - 2.0 * instant) * jump;
      change_[i] = before_[i];
    };
    take_back(at, is_then, add, trial);
  }
  show_end(at, trial);
}

/// The jumps of many instants in two evaluations, as those of a law that is linear in velocities.
void JumpSearch::add_up(const At& at, StepTrial& trial) {
  take_back(
      at, [](double) { return 1.0; }, [&](Index i, double jump) { jump_[i] = jump; }, trial);
  show_end(at, trial);
  take_back(
      at, [](double share) { return 1.0 - 2.0 * share; },
      [&](Index i, double jump) { correction_[i] = jump; }, trial);
  show_end(at, trial);
}

bool JumpSearch::update(const At& at, bool only_local, StepTrial& trial) {
  LoadJumps& jumps = trial.jumps;
  local_ = surround_hit(at);
  if (only_local && !local_) return false;
  for (std::vector<double>* const numbers : {&jump_, &correction_, &loads_, &before_, &change_}) {
    numbers->resize(trial.end.v.size());
  }
  // Not at hand: mean loads are others, and around contacts those at the end are not asked.
  const bool anew = local_ || at.rule.is_mean();
  if (anew) evaluate_at_end(at, trial, loads_);
  evaluate(at, anew ? loads_ : trial.loads_end.total, trial);
  // They stay as they are once a change is too small to go on.
  if (!(change(at, jumps) > at.tolerance)) return false;
  const std::vector<double>& start = at.in.companion.loads.total;
  if (!jumps.on) {
    jumps.jump.assign(start.size(), 0.0);
    jumps.correction.assign(start.size(), 0.0);
    jumps.start.assign(start.begin(), start.end());
    jumps.on = true;
  }
  for_jumps(at, [&](Range, Range v) {
    for (Index i = v.begin; i < v.end; ++i) {
      jumps.jump[i] = jump_[i];
      jumps.correction[i] = correction_[i];
      jumps.start[i] = start[i] + correction_[i];
    }
  });
  return true;
}

/// By how much the jumps at hand would move the bodies in place of those that acted, as SweepChange, at most
/// [m].
double JumpSearch::change(const At& at, const LoadJumps& acted) {
  double largest = 0.0;
  for_jumps(at, [&](Range bodies, Range v) {
    for (Index i = v.begin; i < v.end; ++i) {
      change_[i] = std::abs(correction_[i] - (acted.on ? acted.correction[i] : 0.0)) +
                   std::abs(jump_[i] - (acted.on ? acted.jump[i] : 0.0));
    }
    assembly_->for_bodies(bodies, [&](const BodyKind& kind, Range slots, Index, Index first, Index) {
      const double* change = change_.data() + first;
      kind.apply_inverse_mass(slots, change, change_.data() + first);
      for (Index slot = slots.begin; slot < slots.end; ++slot) {
        for (Index i = 0; i < kind.v_size(); ++i) {
          largest = std::max(largest, std::abs(*change++) * kind.length_scale(slot, i));
        }
      }
    });
  });
  return 0.5 * at.in.step * at.in.step * largest;
}

}  // namespace carom

// Problem: what a step is made with and of, kept apart from where it starts.

#include <carom/integrators/time_stepping/step_trial.h>

#include <algorithm>
#include <utility>

namespace carom {

namespace {

void add(std::vector<double>& total, const std::vector<double>& part, Range v) {
  if (part.empty()) return;
  for (Index i = v.begin; i < v.end; ++i) total[i] += part[i];
}

}  // namespace

/// Those that no element books have empty arrays, and go into the total.
Loads LoadsAtEnd::by_cause() {
  return {total.data(), dissipative.empty() ? total.data() : dissipative.data(),
          external.empty() ? total.data() : external.data()};
}

void LoadsAtEnd::finish(Range v) {
  add(total, dissipative, v);
  add(total, external, v);
}

void TrialAccount::start(Index parts) {
  works.resize(parts);
  potentials = {};
}

StepNeeds step_needs(const Assembly& assembly, const Detector& detector, bool mean) {
  StepNeeds needs;
  for (const auto& kind : assembly.force_kinds()) {
    needs.dissipative = needs.dissipative || kind->books_dissipative();
    needs.external = needs.external || kind->books_external();
    needs.load_rotations = needs.load_rotations || kind->needs_rotations();
  }
  if (assembly.layout()->rotation_size() == 0) needs.load_rotations = false;  // none of particles
  needs.start_rotations = needs.load_rotations || detector.needs_rotations();
  needs.midpoint = mean || has_joints(assembly) || assembly.layout()->z_size() > 0;
  return needs;
}

StepTrial::StepTrial(const Assembly& assembly, const StepNeeds& model)
    : needs(model), end(assembly.layout()) {
  const std::size_t size = assembly.layout()->v_size(), rotations = assembly.layout()->rotation_size();
  loads_guess.resize(size);
  rounding.resize(size);
  if (needs.dissipative) loads_end.dissipative.resize(size);
  if (needs.external) loads_end.external.resize(size);
  at_start.rotation.resize(rotations);
  at_end.rotation.resize(rotations);
  if (needs.midpoint) {
    midpoint = State(assembly.layout());
    at_midpoint.rotation.resize(rotations);
  }
  recorded.resize(assembly.blocks().size());
}

void StepTrial::stand_still(const State& start) {
  end.q = start.q;
  end.v = start.v;
  end.z = start.z;
}

void StepTrial::begin(const StepInput& in) {
  end.time = in.end_time;
  loads_end.total.resize(end.v.size());
}

void StepTrial::begin(const StepInput& in, LoadHistory& from) {
  history = std::move(from);
  if (history.known == 0) history.pending = false;
  // The room of loads whose change is recorded just before it is written over: taken over before any is made.
  if (!history.before.empty()) loads_end.total.swap(history.before);
  begin(in);
  if (history.pending) std::fill(recorded.begin(), recorded.end(), std::uint8_t{0});
}

void StepTrial::give_back(const StepInput& in, LoadHistory& to) {
  for (Index block = 0; block < recorded.size(); ++block) record_change(in, block);
  history.pending = false;
  history.before.clear();
  to = std::move(history);
}

/// Nothing has been written over the loads at the start of the last step before those of a block are guessed.
void StepTrial::record_change(const StepInput& in, Index block) {
  if (!history.pending || recorded[block] != 0) return;
  history.record_change(in.assembly.blocks()[block].v, loads_end.total.data(),
                        in.companion.loads.total.data());
  recorded[block] = 1;
}

void StepTrial::guess_loads(const StepInput& in, Index block) {
  record_change(in, block);
  history.guess(in.assembly.blocks()[block].v, in.step, in.companion.loads.total.data(), loads_guess.data());
}

void StepTrial::take_loads(Range v) {
  std::copy(loads_end.total.begin() + v.begin, loads_end.total.begin() + v.end,
            loads_guess.begin() + v.begin);
}

void StepTrial::place_midpoint(const StepInput& in, Index component) {
  const Range v_range = in.assembly.components()[component].v;
  midpoint.time = in.start.time + 0.5 * in.step;
  for (Index i = v_range.begin; i < v_range.end; ++i) {
    midpoint.v[i] = 0.5 * in.step * 0.5 * (in.start.v[i] + end.v[i]);
  }
  in.assembly.for_bodies(component, [&](const BodyKind& kind, Range slots, Index q, Index v, Index) {
    kind.advance(slots, in.start.q.data() + q, midpoint.v.data() + v, midpoint.q.data() + q);
  });
  for (Index i = v_range.begin; i < v_range.end; ++i) midpoint.v[i] = 0.5 * (in.start.v[i] + end.v[i]);
}

}  // namespace carom

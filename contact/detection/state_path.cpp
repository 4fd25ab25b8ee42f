#include <carom/contact/detection/state_path.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace carom {

StatePath::StatePath(const Assembly& assembly, const Detector& detector)
    : assembly_(&assembly),
      detector_(&detector),
      begin_(assembly.initial_state()),
      end_(begin_),
      between_(begin_),
      at_begin_(make_evaluation(assembly)),
      at_end_(at_begin_),
      at_between_(at_begin_),
      displacement_(begin_.v.size(), 0.0),
      acceleration_(begin_.v.size(), 0.0) {}

void StatePath::set(const State& from, const State& to, const double* change, const ChosenBodies& bodies) {
  begin_.time = from.time;
  end_.time = to.time;
  begin_.q = from.q;
  end_.q = to.q;
  const double length = to.time - from.time;
  for (const BodySlot slot : assembly_->layout()->bodies()) {
    assert(slot.q_size == slot.v_size);
    for (Index i = 0; i < slot.v_size; ++i) {
      const Index v = slot.v + i;
      const double by = change == nullptr ? 0.0 : change[v];
      displacement_[v] = to.q[slot.q + i] - from.q[slot.q + i];
      acceleration_[v] = by / length;
      begin_.v[v] = displacement_[v] / length - 0.5 * by;
      end_.v[v] = begin_.v[v] + by;
    }
  }
  evaluate_positions(*assembly_, bodies, begin_.view(), at_begin_);
  evaluate_positions(*assembly_, bodies, end_.view(), at_end_);
  detector_->place(begin_.time, ground_[0]);
  detector_->place(end_.time, ground_[1]);
  watches_ = 0;
}

double StatePath::bend(Index v) const {
  constexpr double of_middle = 1.0 / 8.0;
  return of_middle * length() * length() * std::abs(acceleration_[v]);
}

void StatePath::watch(std::span<const Index> bodies) {
  assert(bodies.size() <= most_watched);
  watches_ = 0;
  for (const Index body : bodies) watched_[watches_++] = assembly_->layout()->bodies()[body];
}

void StatePath::write(const BodySlot& slot, double share, State& out) const {
  const double h = length();
  for (Index i = 0; i < slot.v_size; ++i) {
    const Index v = slot.v + i;
    const double along = begin_.v[v] + 0.5 * share * h * acceleration_[v];  // mean up to there
    out.q[slot.q + i] = begin_.q[slot.q + i] + share * h * along;
    out.v[v] = begin_.v[v] + share * h * acceleration_[v];
  }
}

PathSample StatePath::sample(double time, PathLook /*how*/) {
  between_.time = time;
  const double share = (time - begin_.time) / length();
  for (std::size_t i = 0; i < watches_; ++i) {
    const BodySlot& slot = watched_[i];
    write(slot, share, between_);
    if (slot.rotation == none) continue;
    assembly_->body_kinds()[slot.kind]->rotations({slot.slot, slot.slot + 1}, between_.q.data() + slot.q,
                                                  at_between_.rotation.data() + slot.rotation);
  }
  detector_->place(time, ground_[2]);
  return {between_.view(), acceleration_.data(), at_between_, ground_[2]};
}

}  // namespace carom

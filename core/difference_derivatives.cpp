#include <carom/core/assembly.h>
#include <carom/core/difference_derivatives.h>

#include <algorithm>
#include <cmath>

namespace carom {

DifferenceDerivatives::DifferenceDerivatives(const EvaluationContext& at)
    : at_(at),
      q_(at.state.q, at.state.q + at.assembly.layout()->q_size()),
      v_(at.state.v, at.state.v + at.assembly.layout()->v_size()),
      force_(v_.size(), 0.0),
      evaluation_(at.evaluation) {}

void DifferenceDerivatives::loads(const ForceKind& kind, Index element, std::vector<double>& out) {
  const Layout& layout = *at_.assembly.layout();
  for (const Index body : bodies_) {
    const BodySlot& slot = layout.bodies()[body];
    if (slot.rotation == none) continue;
    at_.assembly.body_kinds()[slot.kind]->rotations({slot.slot, slot.slot + 1}, q_.data() + slot.q,
                                                    evaluation_.rotation.data() + slot.rotation);
  }
  for (const Index column : columns_) force_[column] = 0.0;
  const EvaluationContext moved{
      at_.assembly, {at_.state.time, q_.data(), v_.data(), at_.state.z}, evaluation_, at_.island};
  kind.evaluate(moved, {element, element + 1}, {force_.data(), force_.data(), force_.data()});
  out.clear();
  for (const Index column : columns_) out.push_back(force_[column]);
}

void DifferenceDerivatives::append(const ForceKind& kind, Index element, std::vector<LoadDerivative>& out) {
  const Layout& layout = *at_.assembly.layout();
  std::vector<BodyId> ends;
  kind.ends(element, ends);
  bodies_.clear();
  columns_.clear();
  for (const BodyId id : ends) {
    if (id == ground) continue;
    const Index body = layout.index(id);
    if (std::find(bodies_.begin(), bodies_.end(), body) != bodies_.end()) continue;
    bodies_.push_back(body);
    for (Index i = 0; i < layout.bodies()[body].v_size; ++i) columns_.push_back(layout.bodies()[body].v + i);
  }
  const std::size_t first = out.size();
  for (const Index row : columns_) {
    for (const Index column : columns_) out.push_back({row, column, 0.0, 0.0});
  }

  std::size_t c = 0;
  for (const Index body : bodies_) {
    const BodySlot& slot = layout.bodies()[body];
    const BodyKind& body_kind = *at_.assembly.body_kinds()[slot.kind];
    std::vector<double> delta(slot.v_size, 0.0);
    for (Index i = 0; i < slot.v_size; ++i, ++c) {
      const Index column = slot.v + i;
      const double velocity = v_[column];
      const double velocity_step = difference_step * std::max(1.0, std::abs(velocity));
      v_[column] = velocity + velocity_step;
      loads(kind, element, faster_);
      v_[column] = velocity - velocity_step;
      loads(kind, element, slower_);
      v_[column] = velocity;

      const auto move = [&](double step, std::vector<double>& result) {
        delta[i] = step;
        body_kind.advance({slot.slot, slot.slot + 1}, at_.state.q + slot.q, delta.data(), q_.data() + slot.q);
        loads(kind, element, result);
        delta[i] = 0.0;
      };
      move(difference_step, ahead_);
      move(-difference_step, behind_);
      std::copy_n(at_.state.q + slot.q, slot.q_size, q_.data() + slot.q);

      for (std::size_t r = 0; r < columns_.size(); ++r) {
        LoadDerivative& entry = out[first + r * columns_.size() + c];
        entry.by_velocity = (faster_[r] - slower_[r]) / (2.0 * velocity_step);
        entry.by_position = (ahead_[r] - behind_[r]) / (2.0 * difference_step);
      }
    }
    if (slot.rotation != none) {
      body_kind.rotations({slot.slot, slot.slot + 1}, q_.data() + slot.q,
                          evaluation_.rotation.data() + slot.rotation);
    }
  }
}

void difference_derivatives(const ForceKind& kind, const EvaluationContext& at, Index element,
                            std::vector<LoadDerivative>& out) {
  DifferenceDerivatives(at).append(kind, element, out);
}

}  // namespace carom

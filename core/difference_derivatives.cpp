#include <carom/core/assembly.h>
#include <carom/core/difference_derivatives.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace carom {

DifferenceDerivatives::DifferenceDerivatives(const EvaluationContext& at)
    : at_(at),
      q_(at.state.q, at.state.q + at.assembly.layout()->q_size()),
      v_(at.state.v, at.state.v + at.assembly.layout()->v_size()),
      z_(at.state.z, at.state.z + at.assembly.layout()->z_size()),
      force_(v_.size(), 0.0),
      z_rates_(z_.size(), 0.0),
      evaluation_(at.evaluation) {}

EvaluationContext DifferenceDerivatives::moved() {
  const Layout& layout = *at_.assembly.layout();
  for (const Index body : bodies_) {
    const BodySlot& slot = layout.bodies()[body];
    if (slot.rotation == none) continue;
    at_.assembly.body_kinds()[slot.kind]->rotations({slot.slot, slot.slot + 1}, q_.data() + slot.q,
                                                    evaluation_.rotation.data() + slot.rotation);
  }
  return {at_.assembly, {at_.state.time, q_.data(), v_.data(), z_.data()}, evaluation_, at_.component};
}

void DifferenceDerivatives::loads(const ForceKind& kind, Index element, std::vector<double>& out) {
  for (const Index column : columns_) force_[column] = 0.0;
  kind.evaluate(moved(), {element, element + 1}, {force_.data(), force_.data(), force_.data()});
  out.clear();
  for (const Index column : columns_) out.push_back(force_[column]);
}

void DifferenceDerivatives::internal_rates(const ForceKind& kind, Index element, Range z,
                                           std::vector<double>& out) {
  kind.internal_rates(moved(), {element, element + 1}, z_rates_.data());
  out.assign(z_rates_.begin() + z.begin, z_rates_.begin() + z.end);
}

void DifferenceDerivatives::find_columns(const ForceKind& kind, Index element) {
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
}

template <class F>
void DifferenceDerivatives::by_motion(const std::vector<Index>& rows, F&& evaluate,
                                      std::vector<LoadDerivative>& out) {
  const std::size_t first = out.size();
  for (const Index row : rows) {
    for (const Index column : columns_) out.push_back({row, column, 0.0, 0.0});
  }
  std::size_t c = 0;
  for (const Index body : bodies_) {
    const BodySlot& slot = at_.assembly.layout()->bodies()[body];
    const BodyKind& body_kind = *at_.assembly.body_kinds()[slot.kind];
    std::vector<double> delta(slot.v_size, 0.0);
    for (Index i = 0; i < slot.v_size; ++i, ++c) {
      const Index column = slot.v + i;
      const double velocity = v_[column];
      const double velocity_step = difference_step * std::max(1.0, std::abs(velocity));
      v_[column] = velocity + velocity_step;
      evaluate(faster_);
      v_[column] = velocity - velocity_step;
      evaluate(slower_);
      v_[column] = velocity;

      const auto move = [&](double step, std::vector<double>& result) {
        delta[i] = step;
        body_kind.advance({slot.slot, slot.slot + 1}, at_.state.q + slot.q, delta.data(), q_.data() + slot.q);
        evaluate(result);
        delta[i] = 0.0;
      };
      move(difference_step, ahead_);
      move(-difference_step, behind_);
      std::copy_n(at_.state.q + slot.q, slot.q_size, q_.data() + slot.q);

      for (std::size_t r = 0; r < rows.size(); ++r) {
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

template <class F>
void DifferenceDerivatives::by_internal(const std::vector<Index>& rows, Range z, F&& evaluate,
                                        std::vector<LoadDerivative>& out) {
  for (Index column = z.begin; column < z.end; ++column) {
    const double at = z_[column], step = difference_step * std::max(1.0, std::abs(at));
    z_[column] = at + step;
    evaluate(ahead_);
    z_[column] = at - step;
    evaluate(behind_);
    z_[column] = at;
    for (std::size_t r = 0; r < rows.size(); ++r) {
      out.push_back({rows[r], column, (ahead_[r] - behind_[r]) / (2.0 * step), 0.0});
    }
  }
}

void DifferenceDerivatives::append(const ForceKind& kind, Index element, std::vector<LoadDerivative>& out) {
  find_columns(kind, element);
  by_motion(
      columns_, [&](std::vector<double>& numbers) { loads(kind, element, numbers); }, out);
}

void DifferenceDerivatives::append_internal(const ForceKind& kind, Index element, Range z,
                                            InternalDerivatives& out) {
  find_columns(kind, element);
  std::vector<Index> rows;
  for (Index row = z.begin; row < z.end; ++row) rows.push_back(row);
  const auto of_loads = [&](std::vector<double>& numbers) { loads(kind, element, numbers); };
  const auto of_rates = [&](std::vector<double>& numbers) { internal_rates(kind, element, z, numbers); };
  by_motion(rows, of_rates, out.rates);
  by_internal(columns_, z, of_loads, out.loads_by_z);
  by_internal(rows, z, of_rates, out.rates_by_z);
}

void append_derivatives(const EvaluationContext& at, std::vector<LoadDerivative>& out) {
  std::optional<DifferenceDerivatives> differences;
  for (Index kind = 0; kind < at.assembly.force_kinds().size(); ++kind) {
    const ForceKind& force = *at.assembly.force_kinds()[kind];
    const Range elements = force.is_field() ? Range{} : at.assembly.elements(at.component, kind);
    for (Index element = elements.begin; element < elements.end; ++element) {
      if (force.has_derivatives()) {
        force.derivatives(at, element, out);
      } else {
        if (!differences) differences.emplace(at);
        differences->append(force, element, out);
      }
    }
  }
}

void difference_derivatives(const ForceKind& kind, const EvaluationContext& at, Index element,
                            std::vector<LoadDerivative>& out) {
  DifferenceDerivatives(at).append(kind, element, out);
}

}  // namespace carom

#include <carom/core/state.h>

#include <carom/core/errors.h>
#include <carom/core/joint_kind.h>
#include <carom/core/space.h>

#include <string>
#include <utility>

namespace carom {

State::State(std::shared_ptr<const Layout> layout) : layout_(std::move(layout)) {
  q.assign(layout_->q_size(), 0.0);
  v.assign(layout_->v_size(), 0.0);
  z.assign(layout_->z_size(), 0.0);
}

BodySlot State::slot(BodyId body) const {
  if (!layout_)
    throw ModelError("state of a body: the state belongs to no model; allowed: a state of a simulation");
  return layout_->slot(body);
}

ConstVectorMap State::position(BodyId body) const { return {q.data() + slot(body).q, layout_->dimension()}; }
VectorMap State::position(BodyId body) { return {q.data() + slot(body).q, layout_->dimension()}; }
ConstVectorMap State::velocity(BodyId body) const { return {v.data() + slot(body).v, layout_->dimension()}; }
VectorMap State::velocity(BodyId body) { return {v.data() + slot(body).v, layout_->dimension()}; }

namespace {

const InternalSlot& internal_slot(const std::shared_ptr<const Layout>& layout, ElementId element) {
  if (!layout) {
    throw ModelError(
        "internal variables of an element: the state belongs to no model; allowed: a state of a simulation");
  }
  return layout->internal(element);
}

}  // namespace

ConstVectorMap State::internal(ElementId element) const {
  const InternalSlot& slot = internal_slot(layout_, element);
  return {z.data() + slot.first, static_cast<Eigen::Index>(slot.size)};
}

VectorMap State::internal(ElementId element) {
  const InternalSlot& slot = internal_slot(layout_, element);
  return {z.data() + slot.first, static_cast<Eigen::Index>(slot.size)};
}

namespace {

/// The coordinate of a joint as a row, at a state.
JointRow coordinate_row(const State& state, JointId joint) {
  const Layout* const layout = state.layout().get();
  const JointTable* const table = layout != nullptr ? layout->joints() : nullptr;
  const JointTable::Place place =
      table != nullptr && joint.token == layout->token() ? table->place(joint.serial) : JointTable::Place{};
  const auto refuse = [&](const char* why) {
    throw ModelError("coordinate of a joint" +
                     (joint.valid() ? " (#" + std::to_string(joint.serial) + ")" : ", never given") + ": " +
                     why + "; allowed: a joint of this model that has a coordinate");
  };
  if (layout == nullptr) refuse("the state belongs to no model");
  if (place.slot == none) refuse("it is not in this model");
  const JointKind& kind = *table->kinds[place.kind];
  if (!kind.has_coordinate()) refuse("it has none");
  std::vector<double> rotation(layout->rotation_size());
  if (layout->dimension() == 2) {
    JointRow pattern;
    kind.coordinate_pattern(place.slot, pattern);
    for (const BodySlot& slot : layout->bodies()) {
      for (int b = 0; b < pattern.bodies; ++b) {
        if (slot.rotation == none || slot.v != pattern.blocks[static_cast<std::size_t>(b)].v) continue;
        Space<2>::rotation(state.q.data() + slot.q + 2, rotation.data() + slot.rotation);
      }
    }
  }
  JointRow row;
  kind.coordinate({state.view(), rotation.data()}, place.slot, row);
  return row;
}

}  // namespace

double State::coordinate(JointId joint) const { return coordinate_row(*this, joint).gap; }

double State::rate(JointId joint) const {
  const JointRow row = coordinate_row(*this, joint);
  return row.times(v.data()) + row.rate;
}

Index State::angle_index(BodyId body) const {
  const BodySlot& at = slot(body);
  if (at.rotation == none || layout_->dimension() != 2) {
    throw ModelError("angle or spin of body #" + std::to_string(body.serial) +
                     ": it has none; allowed: a planar rigid body");
  }
  return at.q + 2;
}

Index State::spin_index(BodyId body) const {
  (void)angle_index(body);
  return slot(body).v + 2;
}

}  // namespace carom

#include <carom/contact/detection/joint_rows.h>
#include <carom/core/errors.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

/// Radii of gyration of the velocities that are spins; 0 of those of places.
std::vector<double> arms_of(const Assembly& assembly) {
  std::vector<double> arms = assembly.length_scales();
  for (const BodySlot& slot : assembly.layout()->bodies()) {
    const Index places = slot.rotation == none ? slot.v_size : 2;
    std::fill_n(arms.begin() + slot.v, places, 0.0);
  }
  return arms;
}

}  // namespace

JointRows::JointRows(const Assembly& assembly)
    : assembly_(&assembly), of_component_(assembly.components().size()) {
  collect(&OfComponent::limits, [this](Row row) {
    for (row.limit = 0; row.limit < row.kind->limits(); ++row.limit) {
      if (row.kind->has_limit(row.slot, row.limit)) rows_.push_back(row);
    }
  });
  first_friction_ = static_cast<Index>(rows_.size());
  collect(&OfComponent::friction, [this](const Row& row) {
    if (row.kind->friction_rows() > 0) rows_.push_back(row);
  });
  if (!rows_.empty()) arms_ = arms_of(assembly);
}

template <class F>
void JointRows::for_joints(Index component, F&& f) const {
  std::vector<BodyId> ends;
  for (Index k = 0; k < assembly_->joint_kinds().size(); ++k) {
    const JointKind& kind = *assembly_->joint_kinds()[k];
    if (kind.limits() + kind.friction_rows() == 0) continue;
    const Range joints = assembly_->joints(component, k);
    for (Index joint = joints.begin; joint < joints.end; ++joint) {
      ends.clear();
      kind.ends(joint, ends);
      std::erase(ends, ground);
      JointBodies bodies;
      bodies.fill(none);
      for (std::size_t i = 0; i < ends.size(); ++i) bodies[i] = assembly_->layout()->index(ends[i]);
      f(Row{&kind, joint, none, assembly_->joint_id(k, joint).serial, bodies});
    }
  }
}

/// Collects the rows of all components, one range each.
template <class F>
void JointRows::collect(Range OfComponent::*rows, F&& add) {
  for (Index component = 0; component < of_component_.size(); ++component) {
    const auto first = static_cast<Index>(rows_.size());
    for_joints(component, add);
    of_component_[component].*rows = {first, static_cast<Index>(rows_.size())};
  }
}

void JointRows::find_limits(Index component, const ContactQuery& query, ConstraintSet& out) const {
  const Range limits = of_component_[component].limits;
  const JointView at{query.state, query.evaluation.rotation.data()};
  JointLimit limit;
  for (Index i = limits.begin; i < limits.end; ++i) {
    rows_[i].kind->limit(at, rows_[i].slot, rows_[i].limit, limit);
    const double length = length_of(limit.row), gap = length * limit.row.gap;
    const bool touches = gap <= query.margin;
    if (!touches && (query.lasting == nullptr ||
                     !query.lasting->lasts(key_of(rows_[i]), gap, length * std::abs(limit.row.drift)))) {
      continue;
    }
    Constraint& constraint = out.add();
    fill_limit(i, limit, constraint);
    if (!touches) constraint.allowed_approach = gap / query.lasting->step();
  }
}

void JointRows::find_friction(Index component, const StateView& state, const Evaluation& evaluation,
                              ConstraintSet& out) const {
  const Range friction = of_component_[component].friction;
  const JointView at{state, evaluation.rotation.data()};
  for (Index i = friction.begin; i < friction.end; ++i) fill_friction(i, at, out.add());
}

void JointRows::append(Range rows, std::vector<ContactPair>& out) const {
  for (Index i = rows.begin; i < rows.end; ++i) {
    out.push_back({.body = rows_[i].bodies.front(), .joint_row = i});
  }
}

void JointRows::append_limits(Index component, std::vector<ContactPair>& out) const {
  append(of_component_[component].limits, out);
}

void JointRows::append_friction(Index component, std::vector<ContactPair>& out) const {
  append(of_component_[component].friction, out);
}

void JointRows::constraint(Index number, const StateView& state, const Evaluation& evaluation,
                           Constraint& out) const {
  const Row& row = rows_[number];
  const JointView at{state, evaluation.rotation.data()};
  out.clear();
  if (row.limit == none) return fill_friction(number, at, out);
  JointLimit limit;
  row.kind->limit(at, row.slot, row.limit, limit);
  fill_limit(number, limit, out);
}

ConstraintKey JointRows::key_of(const Row& row) {
  const FeatureKey key{FeatureKey::Owner::joint, row.serial, row.limit == none ? 0 : row.limit};
  return {key, key};
}

void JointRows::fill_limit(Index number, const JointLimit& limit, Constraint& out) const {
  out.key = key_of(rows_[number]);
  out.of_joint.source = number;
  out.law.friction = 0.0;
  out.law.normal_restitution = limit.restitution;
  out.law.tangential_restitution = 0.0;
  take(limit.row, rows_[number].bodies, out);
  out.gap = out.of_joint.length * limit.row.gap;
}

void JointRows::fill_friction(Index number, const JointView& at, Constraint& out) const {
  const Row& row = rows_[number];
  const JointDryFriction friction = row.kind->dry_friction(row.slot);
  out.key = key_of(row);
  out.normals = 0;
  out.of_joint.source = number;
  out.friction = out.law.friction = 1.0;
  out.law.static_friction = friction.static_factor;
  out.law.normal_restitution = out.law.tangential_restitution = 0.0;
  update_friction(at, out);
  out.of_joint.friction_bound = friction.bound / out.of_joint.length;
}

void JointRows::update_friction(const JointView& at, Constraint& constraint) const {
  const Row& row = rows_[constraint.of_joint.source];
  const JointTable& joints = *assembly_->layout()->joints();
  const JointTable::Place place = joints.place(row.kind->on_joint(row.slot).serial);
  JointRow coordinate;
  joints.kinds[place.kind]->coordinate(at, place.slot, coordinate);
  take(coordinate, row.bodies, constraint);
}

void JointRows::take(const JointRow& from, const JointBodies& bodies, Constraint& out) const {
  const BodySlots& slots = assembly_->layout()->bodies();
  out.clear_bodies();
  for (int b = 0; b < from.bodies; ++b) {
    const JointRow::Block& block = from.blocks[static_cast<std::size_t>(b)];
    const auto owner = std::find_if(bodies.begin(), bodies.end(),
                                    [&](Index body) { return body != none && slots[body].v == block.v; });
    if (owner == bodies.end()) {
      throw ModelError(assembly_->system().name(JointId{out.key.a.serial, assembly_->system().token()}) +
                       ": a row has a body that is not among the ends; allowed: bodies that it binds");
    }
    out.add_body(*owner, block.v, block.columns);
  }
  out.start_rows(1);
  double* place = out.row(0);
  for (int b = 0; b < from.bodies; ++b) {
    const JointRow::Block& block = from.blocks[static_cast<std::size_t>(b)];
    place = std::copy_n(block.jacobian.begin(), block.columns, place);
  }
  out.of_joint.length = length_of(from);
  std::for_each(out.row(0), out.row(1), [&](double& number) { number *= out.of_joint.length; });
  out.drift[0] = out.of_joint.length * from.drift;
}

double JointRows::length_of(const JointRow& coordinate) const {
  double sum = 0.0;
  for (int b = 0; b < coordinate.bodies; ++b) {
    const JointRow::Block& block = coordinate.blocks[static_cast<std::size_t>(b)];
    for (int c = 0; c < block.columns; ++c) {
      const double number = block.jacobian[static_cast<std::size_t>(c)];
      if (number == 0.0) continue;
      const double arm = arms_[block.v + static_cast<Index>(c)];
      if (arm == 0.0) return 1.0;  // it moves a place
      sum += (number / arm) * (number / arm);
    }
  }
  // A power of two, so that nothing is rounded: what comes to rest does so exactly.
  return sum > 0.0 ? std::exp2(std::ilogb(1.0 / std::sqrt(sum)) + 1) : 1.0;
}

}  // namespace carom

#include <carom/contact/detection/joint_rows.h>

#include <algorithm>
#include <cmath>

namespace carom {

JointRows::JointRows(const Assembly& assembly)
    : assembly_(&assembly), of_component_(assembly.components().size()) {
  collect_limits();
  first_friction_ = static_cast<Index>(rows_.size());
  collect_friction();
}

template <class F>
void JointRows::for_joints(Index component, F&& f) const {
  std::vector<BodyId> ends;
  for (Index k = 0; k < assembly_->joint_kinds().size(); ++k) {
    const JointKind& kind = *assembly_->joint_kinds()[k];
    if (kind.limits() == 0 && !kind.has_dry_friction()) continue;
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

void JointRows::collect_limits() {
  for (Index component = 0; component < of_component_.size(); ++component) {
    Range& range = of_component_[component].limits;
    range.begin = static_cast<Index>(rows_.size());
    for_joints(component, [&](Row row) {
      for (row.limit = 0; row.limit < row.kind->limits(); ++row.limit) {
        if (row.kind->has_limit(row.slot, row.limit)) rows_.push_back(row);
      }
    });
    range.end = static_cast<Index>(rows_.size());
  }
}

void JointRows::collect_friction() {
  for (Index component = 0; component < of_component_.size(); ++component) {
    Range& range = of_component_[component].friction;
    range.begin = static_cast<Index>(rows_.size());
    for_joints(component, [&](const Row& row) {
      if (row.kind->has_dry_friction()) rows_.push_back(row);
    });
    range.end = static_cast<Index>(rows_.size());
  }
}

void JointRows::find_limits(Index component, const ContactQuery& query, std::vector<Constraint>& out) const {
  const Range limits = of_component_[component].limits;
  for (Index i = limits.begin; i < limits.end; ++i) {
    Constraint at;
    constraint(i, query.state, query.evaluation, at);
    if (!(at.gap <= query.margin)) {
      if (query.lasting == nullptr || !query.lasting->lasts(at.key, at.gap, std::abs(at.drift[0]))) continue;
      at.allowed_approach = at.gap / query.lasting->step();
    }
    out.push_back(at);
  }
}

void JointRows::find_friction(Index component, const StateView& state, const Evaluation& evaluation,
                              std::vector<Constraint>& out) const {
  const Range friction = of_component_[component].friction;
  for (Index i = friction.begin; i < friction.end; ++i) constraint(i, state, evaluation, out.emplace_back());
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
  const bool is_friction = row.limit == none;
  const FeatureKey key{FeatureKey::Owner::joint, row.serial, is_friction ? 0 : row.limit};
  out = {};
  out.key = {key, key};
  out.source = number;
  out.law.tangential_restitution = 0.0;
  if (!is_friction) return fill_limit(row, at, out);
  const JointDryFriction friction = row.kind->dry_friction(row.slot);
  out.type = ConstraintType::joint_friction;
  out.friction_bound = friction.bound;
  out.friction = out.law.friction = 1.0;
  out.law.static_friction = friction.static_factor;
  out.law.normal_restitution = 0.0;
  update_friction(at, out);
}

void JointRows::fill_limit(const Row& row, const JointView& at, Constraint& out) const {
  JointLimit limit;
  row.kind->limit(at, row.slot, row.limit, limit);
  out.type = ConstraintType::limit;
  out.gap = limit.row.gap;
  out.law.friction = 0.0;
  out.law.normal_restitution = limit.restitution;
  take(limit.row, row.bodies, out);
}

void JointRows::update_friction(const JointView& at, Constraint& constraint) const {
  const Row& row = rows_[constraint.source];
  const JointTable& joints = *assembly_->layout()->joints();
  const JointTable::Place place = joints.place(row.kind->on_joint(row.slot).serial);
  JointRow coordinate;
  joints.kinds[place.kind]->coordinate(at, place.slot, coordinate);
  take(coordinate, row.bodies, constraint);
}

void JointRows::take(const JointRow& from, const JointBodies& bodies, Constraint& out) const {
  const BodySlots& slots = assembly_->layout()->bodies();
  out.rows = 1;
  out.bodies = 0;
  double* place = out.row(0);
  for (int b = 0; b < from.bodies; ++b) {
    const JointRow::Block& block = from.blocks[static_cast<std::size_t>(b)];
    const auto owner = std::find_if(bodies.begin(), bodies.end(),
                                    [&](Index body) { return body != none && slots[body].v == block.v; });
    out.add_body(*owner, block.v, block.columns);
    place = std::copy_n(block.jacobian.begin(), block.columns, place);
  }
  out.drift[0] = from.drift;
}

}  // namespace carom

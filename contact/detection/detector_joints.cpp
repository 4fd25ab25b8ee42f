// Problem: what joints have of contact: stops, and friction along their coordinates.

#include <carom/contact/detection/detector.h>

#include <algorithm>

namespace carom {

namespace {

/// Makes a row of a joint the row of a constraint. \param bodies that the joint binds
void take_row(const JointRow& from, const Layout& layout, const Detector::JointBodies& bodies,
              Constraint& out) {
  out.rows = 1;
  out.bodies = 0;
  double* place = out.row(0);
  for (int b = 0; b < from.bodies; ++b) {
    const JointRow::Block& block = from.blocks[static_cast<std::size_t>(b)];
    const auto owner = std::find_if(bodies.begin(), bodies.end(), [&](Index body) {
      return body != none && layout.bodies()[body].v == block.v;
    });
    out.add_body(*owner, block.v, block.columns);
    place = std::copy_n(block.jacobian.begin(), block.columns, place);
  }
  out.drift[0] = from.drift;
}

}  // namespace

template <class F>
void Detector::for_joints(Index component, F&& f) const {
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
      f(kind, joint, assembly_->joint_id(k, joint).serial, bodies);
    }
  }
}

void Detector::collect_stops() {
  for (Index component = 0; component < assembly_->components().size(); ++component) {
    Range& range = of_component_[component].stops;
    range.begin = static_cast<Index>(stops_.size());
    for_joints(component, [&](const JointKind& kind, Index joint, Index serial, const JointBodies& bodies) {
      for (Index which = 0; which < kind.limits(); ++which) {
        if (kind.has_limit(joint, which)) stops_.push_back({&kind, joint, which, serial, bodies});
      }
    });
    range.end = static_cast<Index>(stops_.size());
  }
}

void Detector::collect_rubbing() {
  for (Index component = 0; component < assembly_->components().size(); ++component) {
    Range& range = of_component_[component].rubbing;
    range.begin = static_cast<Index>(stops_.size());
    for_joints(component, [&](const JointKind& kind, Index joint, Index serial, const JointBodies& bodies) {
      if (kind.has_dry_friction()) stops_.push_back({&kind, joint, none, serial, bodies});
    });
    range.end = static_cast<Index>(stops_.size());
    has_static_friction_ = has_static_friction_ || !range.empty();
  }
}

void Detector::make_stop(Index number, const StateView& state, const Evaluation& evaluation,
                         Constraint& out) const {
  const Stop& stop = stops_[number];
  const JointView at{state, evaluation.rotation.data()};
  const bool has_dry_friction = stop.which == none;
  const FeatureKey key{FeatureKey::Owner::joint, stop.serial, has_dry_friction ? 0 : stop.which};
  out = {};
  out.key = {key, key};
  out.law.tangential_restitution = 0.0;
  if (has_dry_friction) {
    const JointDryFriction dry_friction = stop.kind->dry_friction(stop.slot);
    out.type = ConstraintType::joint_friction;
    out.source = number;
    out.friction_bound = dry_friction.bound;
    out.friction = out.law.friction = 1.0;
    out.law.static_friction = dry_friction.static_factor;
    out.law.normal_restitution = 0.0;
    update_friction_rows(at, out);
    return;
  }
  JointLimit limit;
  stop.kind->limit(at, stop.slot, stop.which, limit);
  out.type = ConstraintType::limit;
  out.source = number;
  out.gap = limit.row.gap;
  out.law.friction = 0.0;
  out.law.normal_restitution = limit.restitution;
  take_row(limit.row, *assembly_->layout(), stop.bodies, out);
}

std::vector<ContactPair> Detector::rubbing(Index component) const {
  std::vector<ContactPair> out;
  const Range range = of_component_[component].rubbing;
  for (Index i = range.begin; i < range.end; ++i)
    out.push_back({stops_[i].bodies.front(), none, none, none, i});
  return out;
}

void Detector::find_joint_friction(Index component, const StateView& state, const Evaluation& evaluation,
                                   std::vector<Constraint>& out) const {
  const Range range = of_component_[component].rubbing;
  for (Index i = range.begin; i < range.end; ++i) make_stop(i, state, evaluation, out.emplace_back());
}

void Detector::update_friction_rows(const JointView& at, Constraint& contact) const {
  const Stop& stop = stops_[contact.source];
  const JointTable& joints = *assembly_->layout()->joints();
  const JointTable::Place place = joints.place(stop.kind->on_joint(stop.slot).serial);
  JointRow row;
  joints.kinds[place.kind]->coordinate(at, place.slot, row);
  take_row(row, *assembly_->layout(), stop.bodies, contact);
}

}  // namespace carom

// Problem: the equations of rest of a whole model, and their derivatives.

#include <carom/analysis/resting_model.h>
#include <carom/analysis/support_forces.h>
#include <carom/core/errors.h>
#include <carom/core/numerics/sparse_factors.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace carom {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The state with velocities zero. Refuses one that a model cannot rest in.
State at_rest(const Assembly& assembly, const State& start, const std::string& purpose) {
  check_state(assembly, start);
  const auto& internals = assembly.layout()->internals();
  if (!internals.empty()) {
    const System& system = assembly.system();
    throw ModelError(purpose + ": " + system.name(ElementId{internals.front().serial, system.token()}) +
                     " has internal variables; allowed: elements without");
  }
  State state = start;
  std::fill(state.v.begin(), state.v.end(), 0.0);
  return state;
}

Evaluation evaluation_at(const Assembly& assembly, const State& state) {
  Evaluation evaluation = make_evaluation(assembly);
  evaluate_positions(assembly, state.view(), evaluation);
  return evaluation;
}

VectorXd length_scales(const Assembly& assembly) {
  const std::vector<double> lengths = assembly.length_scales();
  return Eigen::Map<const VectorXd>(lengths.data(), eigen_index(static_cast<Index>(lengths.size())));
}

}  // namespace

RestingModel::RestingModel(const Assembly& assembly, const State& start, double contact_tolerance,
                           std::string purpose)
    : assembly_(&assembly),
      purpose_(std::move(purpose)),
      state_(at_rest(assembly, start, purpose_)),
      evaluation_(evaluation_at(assembly, state_)),
      lengths_(length_scales(assembly)),
      constraints_(assembly, state_, evaluation_, contact_tolerance),
      l_(VectorXd::Zero(constraints_.gaps().size())) {
  update();
}

std::string RestingModel::body_name(Eigen::Index velocity) const {
  const Layout& layout = *assembly_->layout();
  Index body = 0;
  for (Index i = 0; i < layout.bodies().size(); ++i) {
    if (eigen_index(layout.bodies()[i].v) <= velocity) body = i;
  }
  return assembly_->system().name(layout.id(body));
}

void RestingModel::move(const Place& from, const VectorXd& x) {
  const VectorXd change = x.cwiseQuotient(lengths_);
  VectorXd part(change.size());
  const auto go = [&](double way) {
    part = way * change;
    for (Index component = 0; component < assembly_->components().size(); ++component) {
      assembly_->for_bodies(component, [&](const BodyKind& kind, Range slots, Index q, Index v, Index) {
        kind.advance(slots, from.q.data() + q, part.data() + v, state_.q.data() + q);
      });
      evaluate_positions(*assembly_, component, state_.view(), evaluation_);
    }
  };
  // The sliding of a place of touch is an integral along the way (a wheel has no place that stays): Gauss.
  constexpr std::array<double, 4> nodes{0.06943184420297371, 0.33000947820757187, 0.66999052179242813,
                                        0.93056815579702629};
  constexpr std::array<double, 4> weights{0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                          0.17392742256872693};
  constraints_.set_slid(from.slid);
  const bool sticks = constraints_.sticks();
  for (std::size_t node = 0; sticks && node < nodes.size(); ++node) {
    go(nodes[node]);
    constraints_.slide(state_.view(), evaluation_, weights[node], change);
  }
  go(1.0);
  update();
}

void RestingModel::update() {
  constraints_.update(state_.view(), evaluation_, lengths_);
  for (Index component = 0; component < assembly_->components().size(); ++component) {
    double* const force = evaluation_.force.data();
    evaluate_loads(*assembly_, component, state_.view(), evaluation_, {force, force, force});
  }
  loads_ = Eigen::Map<const VectorXd>(evaluation_.force.data(), lengths_.size()).cwiseQuotient(lengths_);
  // Rows that nearly follow from others are let go, like those of core/numerics/sparse_factors.h: pivots
  // there are squares of those here.
  factors_.setThreshold(std::sqrt(dependent_pivot));
  factors_.compute(constraints_.rows());
}

void RestingModel::balance() {
  if (constraints_.rows().rows() > 0) l_ = factors_.transpose().solve(VectorXd(-loads_));
}

MatrixXd RestingModel::directions() const {
  const Eigen::Index size = lengths_.size();
  if (constraints_.rows().rows() == 0) return MatrixXd::Identity(size, size);
  Eigen::ColPivHouseholderQR<MatrixXd> qr;
  qr.setThreshold(std::sqrt(dependent_pivot));
  qr.compute(constraints_.rows().transpose());
  const MatrixXd q = qr.householderQ() * MatrixXd::Identity(size, size);
  return q.rightCols(size - qr.rank());
}

double RestingModel::size() const {
  double size = 1.0;
  for (const double number : state_.q) size = std::max(size, std::abs(number));
  return size;
}

void RestingModel::check_supports(double allowed) {
  const std::vector<RestingConstraints::Support>& supports = constraints_.supports();
  const auto fits = [&](const RestingConstraints::Support& support) {
    return outside_cone(constraints_, support, l_) <= allowed;
  };
  const bool redundant = constraints_.rows().rows() > 0 && factors_.rank() < constraints_.rows().rows();
  if (redundant && !std::all_of(supports.begin(), supports.end(), fits)) {
    const VectorXd smallest = std::exchange(l_, shared_within_cones(constraints_, l_));
    if (!std::all_of(supports.begin(), supports.end(), fits)) l_ = smallest;
  }
  const RestingConstraints::Support* worst = nullptr;
  for (const RestingConstraints::Support& support : supports) {
    if (fits(support)) continue;
    if (worst == nullptr || outside_cone(constraints_, support, l_) > outside_cone(constraints_, *worst, l_))
      worst = &support;
  }
  if (worst == nullptr) return;
  const Eigen::Index row = eigen_index(worst->row);
  const double normal = multiplier(row);
  double along = 0.0;
  for (int i = 1; i < worst->rows; ++i) along = std::hypot(along, multiplier(row + i));
  const std::string who = constraints_.name(*worst);
  const std::string what =
      -normal > allowed
          ? "would have to pull with " + to_text(-normal) + " N; allowed: contacts that press"
          : "would slip: it needs a friction of " + to_text(along) + " N at a normal force of " +
                to_text(normal) + " N; allowed: up to " + to_text(worst->friction()) + " times that";
  fail(who + " " + what, outside_cone(constraints_, *worst, l_), {who});
}

void RestingModel::check_open_contacts(double tolerance) const {
  const auto entered = constraints_.find_entered(state_.view(), evaluation_, tolerance);
  if (!entered) return;
  fail(entered->name + " is entered by " + to_text(-entered->gap) +
           " m; allowed: contacts that are closed at the start, or stay open",
       -entered->gap, {entered->name});
}

void RestingModel::fail(const std::string& what, double residual, std::vector<std::string> parts) const {
  SolverFailure failure;
  failure.time = state_.time;
  failure.residual = residual;
  failure.parts = std::move(parts);
  throw SolverError(purpose_ + ": " + what, std::move(failure));
}

JointReaction RestingModel::reaction(const RestingConstraints::Joint& joint) const {
  const JointKind& kind = *assembly_->joint_kinds()[joint.kind];
  std::vector<double> multipliers(kind.rows());
  for (Index i = 0; i < kind.rows(); ++i) multipliers[i] = multiplier(eigen_index(joint.row + i));
  return kind.reaction({state_.view(), evaluation_.rotation.data()}, joint.slot, multipliers.data());
}

}  // namespace carom

// Problem: the equations of rest of a whole model, and their derivatives.

#include <carom/analysis/resting_model.h>
#include <carom/core/errors.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace carom {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

Eigen::Index at(Index i) { return static_cast<Eigen::Index>(i); }

SolverError failure(const State& state, const std::string& message, double residual,
                    std::vector<std::string> parts) {
  SolverFailure what;
  what.time = state.time;
  what.residual = residual;
  what.parts = std::move(parts);
  return {message, std::move(what)};
}

}  // namespace

RestingModel::RestingModel(const Assembly& assembly, const State& start, double contact_tolerance,
                           std::string purpose)
    : assembly_(&assembly),
      purpose_(std::move(purpose)),
      detector_(assembly),
      state_(start),
      evaluation_(make_evaluation(assembly)) {
  check_state(assembly, start);
  refuse_internals();
  std::fill(state_.v.begin(), state_.v.end(), 0.0);
  const std::vector<double> lengths = assembly.length_scales();
  lengths_ = Eigen::Map<const VectorXd>(lengths.data(), at(static_cast<Index>(lengths.size())));
  detector_.place(state_.time, places_);
  joints_of_body_.resize(assembly.layout()->bodies().size());
  supports_of_body_.resize(joints_of_body_.size());

  Index row = 0;
  const Layout& layout = *assembly.layout();
  std::vector<Index> body_at(state_.v.size());
  for (Index body = 0; body < layout.bodies().size(); ++body) {
    const BodySlot slot = layout.bodies()[body];
    std::fill_n(body_at.begin() + slot.v, slot.v_size, body);
  }
  const auto touches = [&](std::vector<std::vector<std::size_t>>& lists, Index v, std::size_t what) {
    std::vector<std::size_t>& list = lists[body_at[v]];
    if (list.empty() || list.back() != what) list.push_back(what);
  };
  for (Index component = 0; component < assembly.components().size(); ++component) {
    for (Index kind = 0; kind < assembly.joint_kinds().size(); ++kind) {
      const JointKind& joints = *assembly.joint_kinds()[kind];
      const Range range = assembly.joints(component, kind);
      for (Index slot = range.begin; slot < range.end && joints.rows() > 0; ++slot) {
        joint_rows_.resize(row + joints.rows());
        joints.pattern(slot, joint_rows_.data() + row);
        for (Index i = row; i < joint_rows_.size(); ++i) {
          for (int b = 0; b < joint_rows_[i].bodies; ++b) {
            touches(joints_of_body_, joint_rows_[i].blocks[static_cast<std::size_t>(b)].v, joints_.size());
          }
        }
        joints_.push_back({kind, slot, row, assembly.joint_id(kind, slot)});
        row += joints.rows();
      }
    }
  }
  for (Index component = 0; component < assembly.components().size(); ++component) {
    evaluate_positions(assembly, component, state_.view(), evaluation_);
  }
  find_supports(contact_tolerance);
  for (std::size_t i = 0; i < supports_.size(); ++i) {
    Support& support = supports_[i];
    support.row = row;
    row += static_cast<Index>(support.rows);
    for (int b = 0; b < support.at.bodies; ++b) {
      touches(supports_of_body_, support.at.blocks[static_cast<std::size_t>(b)].v, i);
    }
  }
  rows_.resize(at(row), at(static_cast<Index>(state_.v.size())));
  gaps_.resize(at(row));
  norms_.resize(at(row));
  l_ = VectorXd::Zero(at(row));
  locate();
}

void RestingModel::refuse_internals() const {
  const auto& internals = assembly_->layout()->internals();
  if (internals.empty()) return;
  const System& system = assembly_->system();
  throw ModelError(purpose_ + ": " + system.name(ElementId{internals.front().serial, system.token()}) +
                   " has internal variables; allowed: elements without");
}

void RestingModel::find_supports(double tolerance) {
  for (Index component = 0; component < assembly_->components().size(); ++component) {
    for (const ContactPair& pair : detector_.pairs(component)) {
      Support support;
      support.pair = pair;
      detector_.contact(pair, state_.view(), evaluation_, places_, support.at);
      if (!(support.at.gap <= tolerance)) continue;
      const bool sticks = support.at.rows > 1 && support.at.law.sticking_friction() > 0.0;
      support.rows = sticks ? support.at.rows : 1;
      supports_.push_back(support);
    }
  }
}

std::string RestingModel::body_name(Eigen::Index velocity) const {
  const Layout& layout = *assembly_->layout();
  Index body = 0;
  for (Index i = 0; i < layout.bodies().size(); ++i) {
    if (at(layout.bodies()[i].v) <= velocity) body = i;
  }
  return assembly_->system().name(layout.id(body));
}

std::string RestingModel::row_name(Eigen::Index row) const {
  std::string name;
  for (const Joint& joint : joints_) {
    if (at(joint.row) <= row) name = assembly_->system().name(joint.id);
  }
  for (const Support& support : supports_) {
    if (at(support.row) <= row) name = this->name(support);
  }
  return name;
}

RestingModel::Place RestingModel::place() const {
  Place place{state_.q, {}};
  for (const Support& support : supports_) place.slid.push_back(support.slid);
  return place;
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
  for (std::size_t i = 0; i < supports_.size(); ++i) supports_[i].slid = from.slid[i];
  const bool sticks = std::any_of(supports_.begin(), supports_.end(),
                                  [](const Support& support) { return support.rows > 1; });
  for (std::size_t node = 0; sticks && node < nodes.size(); ++node) {
    go(nodes[node]);
    Constraint contact;
    for (Support& support : supports_) {
      if (support.rows == 1) continue;
      detector_.contact(support.pair, state_.view(), evaluation_, places_, contact);
      for (int row = 1; row < support.rows; ++row) {
        support.slid[static_cast<std::size_t>(row - 1)] += weights[node] * contact.times(row, change.data());
      }
    }
  }
  go(1.0);
  locate();
}

void RestingModel::locate() {
  const JointView view{state_.view(), evaluation_.rotation.data()};
  const Eigen::Index size = lengths_.size();
  rows_.setZero();
  VectorXd row(size);
  const auto take = [&](Eigen::Index place, double gap) {
    rows_.row(place) = row.cwiseQuotient(lengths_).transpose();
    // A row that moves nothing is left as it is: one that follows from others.
    const double norm = rows_.row(place).norm();
    norms_[place] = norm > 0.0 ? norm : 1.0;
    rows_.row(place) /= norms_[place];
    gaps_[place] = gap / norms_[place];
  };
  for (const Joint& joint : joints_) {
    const JointKind& kind = *assembly_->joint_kinds()[joint.kind];
    kind.evaluate(view, joint.slot, joint_rows_.data() + joint.row);
    for (Index i = 0; i < kind.rows(); ++i) {
      row.setZero();
      joint_rows_[joint.row + i].add_transposed(1.0, row.data());
      take(at(joint.row + i), joint_rows_[joint.row + i].gap);
    }
  }
  for (Support& support : supports_) {
    detector_.contact(support.pair, view.state, evaluation_, places_, support.at);
    for (int i = 0; i < support.rows; ++i) {
      row.setZero();
      support.at.add_transposed(i, 1.0, row.data());
      take(at(support.row) + i, i == 0 ? support.at.gap : support.slid[static_cast<std::size_t>(i - 1)]);
    }
  }
  for (Index component = 0; component < assembly_->components().size(); ++component) {
    double* const force = evaluation_.force.data();
    evaluate_loads(*assembly_, component, view.state, evaluation_, {force, force, force});
  }
  loads_ = Eigen::Map<const VectorXd>(evaluation_.force.data(), size).cwiseQuotient(lengths_);
  // Rows that nearly follow from others are let go, like those of core/numerics/sparse_factors.h: pivots
  // there are squares of those here.
  factors_.setThreshold(std::sqrt(dependent_pivot));
  factors_.compute(rows_);
}

void RestingModel::balance() {
  if (rows_.rows() > 0) l_ = factors_.transpose().solve(VectorXd(-loads_));
}

MatrixXd RestingModel::directions() const {
  const Eigen::Index size = lengths_.size();
  if (rows_.rows() == 0) return MatrixXd::Identity(size, size);
  Eigen::ColPivHouseholderQR<MatrixXd> qr;
  qr.setThreshold(std::sqrt(dependent_pivot));
  qr.compute(rows_.transpose());
  const MatrixXd q = qr.householderQ() * MatrixXd::Identity(size, size);
  return q.rightCols(size - qr.rank());
}

double RestingModel::size() const {
  double size = 1.0;
  for (const double number : state_.q) size = std::max(size, std::abs(number));
  return size;
}

double RestingModel::outside(const Support& support, const VectorXd& l) const {
  const Eigen::Index row = at(support.row);
  const double normal = l[row] / norms_[row];
  double along = 0.0;
  for (int i = 1; i < support.rows; ++i) along = std::hypot(along, l[row + i] / norms_[row + i]);
  return std::max(-normal, along - support.friction() * std::max(normal, 0.0));
}

void RestingModel::share() {
  // Forces that balance are a plane, those within all cones a convex set: projected on one and the other in
  // turn they come to a point of both, if there is one.
  constexpr int most_turns = 20000;
  VectorXd l = l_.cwiseQuotient(norms_);
  const VectorXd right = rows_.transpose() * l_;
  const MatrixXd plain = norms_.asDiagonal() * rows_;
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> factors;
  factors.setThreshold(std::sqrt(dependent_pivot));
  factors.compute(plain.transpose());
  double scale = l.lpNorm<Eigen::Infinity>();
  for (int turn = 0; turn < most_turns; ++turn) {
    for (const Support& support : supports_) {
      const Eigen::Index row = at(support.row);
      const double mu = support.friction();
      auto along = l.segment(row + 1, support.rows - 1);
      const double normal = l[row], tangential = along.norm();
      if (tangential <= mu * normal) continue;
      const double on_edge = (normal + mu * tangential) / (1.0 + mu * mu);
      l[row] = std::max(on_edge, 0.0);
      if (tangential > 0.0) along *= mu * l[row] / tangential;
    }
    const VectorXd change = factors.solve(VectorXd(plain.transpose() * l - right));
    l -= change;
    if (change.lpNorm<Eigen::Infinity>() <= 1e-12 * scale) break;
  }
  l_ = l.cwiseProduct(norms_);
}

void RestingModel::check_supports(double allowed) {
  const auto fits = [&](const Support& support) { return outside(support, l_) <= allowed; };
  const bool redundant = rows_.rows() > 0 && factors_.rank() < rows_.rows();
  if (redundant && !std::all_of(supports_.begin(), supports_.end(), fits)) {
    const VectorXd smallest = l_;
    share();
    if (!std::all_of(supports_.begin(), supports_.end(), fits)) l_ = smallest;
  }
  const Support* worst = nullptr;
  for (const Support& support : supports_) {
    if (fits(support)) continue;
    if (worst == nullptr || outside(support, l_) > outside(*worst, l_)) worst = &support;
  }
  if (worst == nullptr) return;
  const Eigen::Index row = at(worst->row);
  const double normal = multiplier(row);
  double along = 0.0;
  for (int i = 1; i < worst->rows; ++i) along = std::hypot(along, multiplier(row + i));
  const std::string who = name(*worst);
  const std::string what =
      -normal > allowed
          ? "would have to pull with " + to_text(-normal) + " N; allowed: contacts that press"
          : "would slip: it needs a friction of " + to_text(along) + " N at a normal force of " +
                to_text(normal) + " N; allowed: up to " + to_text(worst->friction()) + " times that";
  throw failure(state_, purpose_ + ": " + who + " " + what, outside(*worst, l_), {who});
}

void RestingModel::check_open_contacts(double tolerance) const {
  Constraint contact;
  for (Index component = 0; component < assembly_->components().size(); ++component) {
    for (const ContactPair& pair : detector_.pairs(component)) {
      if (std::any_of(supports_.begin(), supports_.end(),
                      [&](const Support& support) { return support.pair == pair; })) {
        continue;
      }
      detector_.contact(pair, state_.view(), evaluation_, places_, contact);
      if (contact.gap >= -tolerance) continue;
      const std::string who = detector_.name(contact.key);
      throw failure(state_,
                    purpose_ + ": " + who + " is entered by " + to_text(-contact.gap) +
                        " m; allowed: contacts that are closed at the start, or stay open",
                    -contact.gap, {who});
    }
  }
}

JointReaction RestingModel::reaction(const Joint& joint) const {
  const JointKind& kind = *assembly_->joint_kinds()[joint.kind];
  std::vector<double> multipliers(kind.rows());
  for (Index i = 0; i < kind.rows(); ++i) multipliers[i] = multiplier(at(joint.row + i));
  return kind.reaction({state_.view(), evaluation_.rotation.data()}, joint.slot, multipliers.data());
}

}  // namespace carom

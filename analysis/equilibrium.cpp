// Problem: where does a model stay at rest?

#include <carom/analysis/equilibrium.h>
#include <carom/analysis/resting_model.h>
#include <carom/core/assembly.h>
#include <carom/core/errors.h>
#include <carom/core/part_check.h>

#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace carom {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

double largest(const VectorXd& numbers) {
  return numbers.size() > 0 ? numbers.lpNorm<Eigen::Infinity>() : 0.0;
}
double largest(const MatrixXd& numbers) {
  return numbers.size() > 0 ? numbers.lpNorm<Eigen::Infinity>() : 0.0;
}

void check(const EquilibriumOptions& options) {
  const auto refuse = [](const char* option, const std::string& value, const char* allowed) {
    throw ModelError(std::string("equilibrium: ") + option + " is " + value + "; allowed: " + allowed);
  };
  if (!(std::isfinite(options.contact_tolerance) && options.contact_tolerance >= 0.0)) {
    refuse("contact_tolerance", to_text(options.contact_tolerance), "finite and >= 0 m");
  }
  if (!(std::isfinite(options.tolerance) && options.tolerance > 0.0)) {
    refuse("tolerance", to_text(options.tolerance), "finite and > 0");
  }
  if (options.most_steps < 1) refuse("most_steps", std::to_string(options.most_steps), ">= 1");
}

/// The search: where it stands, and what counts there.
class Search {
public:
  Search(RestingModel& model, const EquilibriumOptions& options)
      : model_(&model), options_(&options), stop_(options.stop_when) {}

  int run() {
    model_->balance();
    double before = std::numeric_limits<double>::infinity();
    for (int step = 0;; ++step) {
      stop_.check();
      model_->differentiate(by_position_, by_velocity_);
      size_ = model_->size();
      // Forces of springs that balance are large where their sum is not.
      force_ = std::max(largest(model_->loads()),
                        largest(VectorXd(model_->constraints().rows().transpose() * model_->multipliers())));
      scale_ = std::max(force_, largest(by_position_) * size_);
      const MatrixXd free = model_->directions();
      const VectorXd x = newton_step(free);
      const double now = off();
      const bool found = now <= options_->tolerance;
      const bool settled = found && (now > 0.5 * before || now == 0.0);
      if (settled || step == options_->most_steps || !advance(x, now)) {
        if (free_motion_.size() > 0) refuse_free_motion(found);
        if (!found) give_up();
        return step;
      }
      before = now;
    }
  }

  /// Forces this small may be rounding [N].
  [[nodiscard]] double rounding() const { return std::max(1e-9 * force_, 1e-14 * scale_); }

private:
  /// How far from equilibrium: forces against their size, gaps against theirs.
  [[nodiscard]] double off() const {
    const double forces = scale_ > 0.0 ? model_->left().norm() / scale_ : 0.0;
    return std::hypot(forces, model_->constraints().gaps().norm() / size_);
  }

  /// With the directions N that constraints leave, x = x_c + N y:
  ///     G x_c = -g,   N^T K N y = -N^T (f + G^T l + K x_c),   K = d(f + G^T l)/dx.
  /// Directions without stiffness (a spring under no tension has none sideways) move as the force there
  /// pushes, if it does.
  [[nodiscard]] VectorXd newton_step(const MatrixXd& free) {
    free_motion_.resize(0);
    VectorXd x = VectorXd::Zero(model_->lengths().size());
    if (model_->constraints().rows().rows() > 0) x = model_->close(VectorXd(-model_->constraints().gaps()));
    if (free.cols() == 0) return x;
    const MatrixXd stiffness = free.transpose() * by_position_ * free;
    const Eigen::JacobiSVD<MatrixXd> svd(stiffness, Eigen::ComputeThinU | Eigen::ComputeThinV);
    const VectorXd force = free.transpose() * (model_->left() + by_position_ * x);
    // Below this part of the stiffness that there is, or of the forces over the coordinates, is rounding.
    constexpr double nothing = 1e-11;
    constexpr double first_try = 0.1;
    VectorXd y = VectorXd::Zero(stiffness.cols()), push = y;
    for (Eigen::Index i = 0; i < stiffness.cols(); ++i) {
      const double along = svd.matrixU().col(i).dot(force);
      if (svd.singularValues()[i] > nothing * scale_ / size_) {
        y -= along / svd.singularValues()[i] * svd.matrixV().col(i);
      } else {
        free_motion_ = free * svd.matrixV().col(i);
        push += along * svd.matrixU().col(i);
      }
    }
    if (push.norm() > options_->tolerance * scale_) y += first_try * size_ / push.norm() * push;
    return x + free * y;
  }

  /// Moves along x as far as that leads nearer to equilibrium; false if nowhere.
  bool advance(VectorXd x, double now) {
    constexpr double farthest_turn = 0.5;  // rad, or m at a length scale of 1 m and coordinates up to that
    constexpr int most_halvings = 40;
    const double reach = largest(x) / std::max(size_, 1.0), turn = largest_turn(x);
    const double longest = std::max(reach, turn);
    if (longest > farthest_turn) x *= farthest_turn / longest;
    const RestingModel::Place from = model_->place();
    for (int halving = 0; halving < most_halvings; ++halving, x *= 0.5) {
      stop_.check();
      model_->move(from, x);
      model_->balance();
      const double then = off();
      if (then < (1.0 - 1e-4) * now) return true;
    }
    model_->move(from, VectorXd::Zero(x.size()));
    model_->balance();
    return false;
  }

  [[nodiscard]] double largest_turn(const VectorXd& x) const {
    double turn = 0.0;
    for (const BodySlot slot : model_->state().layout()->bodies()) {
      const auto dimension = static_cast<Index>(model_->state().layout()->dimension());
      for (Index i = dimension; i < slot.v_size; ++i) {
        const auto place = static_cast<Eigen::Index>(slot.v + i);
        turn = std::max(turn, std::abs(x[place] / model_->lengths()[place]));
      }
    }
    return turn;
  }

  [[noreturn]] void refuse_free_motion(bool balanced) const {
    const VectorXd& motion = free_motion_;
    constexpr double takes_part = 1e-3;
    const double most = largest(motion);
    Eigen::Index worst = 0;
    motion.cwiseAbs().maxCoeff(&worst);
    std::vector<std::string> names{model_->body_name(worst)};
    for (Eigen::Index i = 0; i < motion.size(); ++i) {
      std::string name = model_->body_name(i);
      if (std::abs(motion[i]) <= takes_part * most) continue;
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(std::move(name));
    }
    std::string message;
    for (std::size_t i = 0; i < names.size() && i < 3; ++i) message += (i == 0 ? "" : ", ") + names[i];
    if (names.size() > 3) message += " and others";
    message += " can move without being held back";
    if (!balanced) message += ", out of balance by " + to_text(largest(model_->left())) + " N";
    message += "; allowed: models that loads and joints hold";
    model_->fail(message, largest(model_->left()), names);
  }

  [[noreturn]] void give_up() const {
    const VectorXd left = model_->left();
    Eigen::Index worst = 0;
    if (model_->constraints().gaps().size() > 0 &&
        largest(model_->constraints().gaps()) / size_ > (scale_ > 0.0 ? largest(left) / scale_ : 0.0)) {
      const double gap = model_->constraints().gaps().cwiseAbs().maxCoeff(&worst);
      const std::string who = model_->constraints().row_name(worst);
      model_->fail("none found, " + who + " cannot be closed, it is off by " + to_text(gap) +
                       "; allowed: a start near an equilibrium",
                   gap, {who});
    }
    left.cwiseAbs().maxCoeff(&worst);
    const std::string who = model_->body_name(worst);
    model_->fail("none found, " + who + " is out of balance by " + to_text(std::abs(left[worst])) +
                     " N; allowed: a start near an equilibrium",
                 std::abs(left[worst]), {who});
  }

  RestingModel* model_;
  const EquilibriumOptions* options_;
  StopRequest stop_;
  MatrixXd by_position_, by_velocity_;
  VectorXd free_motion_;  // one without stiffness; empty if there is none
  double size_ = 1.0, scale_ = 0.0, force_ = 0.0;
};

}  // namespace

const JointForce& Equilibrium::force(JointId joint) const {
  const auto found =
      std::find_if(joints.begin(), joints.end(), [&](const JointForce& one) { return one.joint == joint; });
  if (found == joints.end())
    throw ModelError("equilibrium: no force of this joint; allowed: a joint with rows");
  return *found;
}

Equilibrium find_equilibrium(const Assembly& assembly, const State& start,
                             const EquilibriumOptions& options) {
  check(options);
  RestingModel model(assembly, start, options.contact_tolerance, "equilibrium");
  Search search(model, options);
  Equilibrium result;
  result.steps = search.run();
  model.check_supports(search.rounding());
  model.check_open_contacts(options.contact_tolerance);

  result.state = model.state();
  result.residual = largest(model.left());
  for (Eigen::Index row = 0; row < model.constraints().gaps().size(); ++row) {
    result.gap = std::max(result.gap, std::abs(model.gap(row)));
  }
  for (const RestingConstraints::Joint& joint : model.constraints().joints()) {
    JointForce force;
    force.joint = joint.id;
    for (Index i = 0; i < assembly.joint_kinds()[joint.kind]->rows(); ++i) {
      force.multipliers.push_back(model.multiplier(static_cast<Eigen::Index>(joint.row + i)));
    }
    force.reaction = model.reaction(joint);
    result.joints.push_back(std::move(force));
  }
  for (const RestingConstraints::Support& support : model.constraints().supports()) {
    ContactForce force;
    force.key = support.at.key;
    force.name = model.constraints().name(support);
    const auto row = static_cast<Eigen::Index>(support.row);
    force.normal = support.at.of_joint.length * std::max(model.multiplier(row), 0.0);  // a moment of a stop
    for (int i = 1; i < support.rows; ++i) {
      force.tangential[static_cast<std::size_t>(i - 1)] = model.multiplier(row + i);
    }
    force.friction = support.friction();
    result.contacts.push_back(std::move(force));
  }
  return result;
}

Equilibrium find_equilibrium(const System& system, const EquilibriumOptions& options) {
  const Assembly assembly(system);
  return find_equilibrium(assembly, assembly.initial_state(), options);
}

}  // namespace carom

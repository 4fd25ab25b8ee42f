// Problem: what joints add to the motion of an island: their reactions, friction in them, jumps of what
// drives them.

#include <carom/contact/rank_revealing_qr.h>
#include <carom/integrators/bound_iteration.h>
#include <carom/integrators/island_motion.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace carom {

namespace {

/// Impulses of least norm that change velocities as those of a problem's answer do: without their part along
/// the null vectors of W. Of an answer that is not unique solvers find any, these are always the same.
std::vector<double> least_impulses(const ContactProblem& problem, std::span<const double> impulses) {
  constexpr double dependent = 1e-11;  // pivots of W below this part of the largest are rounding
  const auto n = static_cast<std::size_t>(problem.rows());
  RankRevealingQr factors;
  factors.factor(problem.matrix(), n, n, dependent);
  std::vector<double> least(impulses.begin(), impulses.end());
  std::vector<std::vector<double>> null;
  const auto remove_part = [](const std::vector<double>& along, std::vector<double>& from) {
    const double part = std::inner_product(from.begin(), from.end(), along.begin(), 0.0);
    for (std::size_t i = 0; i < from.size(); ++i) from[i] -= part * along[i];
  };
  for (std::size_t index = 0; index + factors.rank() < n; ++index) {
    std::vector<double> vector(n);
    factors.null_vector(index, vector);
    for (int pass = 0; pass < 2; ++pass) {  // the second for what rounding left
      for (const std::vector<double>& other : null) remove_part(other, vector);
    }
    const double length = std::sqrt(std::inner_product(vector.begin(), vector.end(), vector.begin(), 0.0));
    for (double& number : vector) number /= length;
    null.push_back(std::move(vector));
  }
  for (const std::vector<double>& vector : null) remove_part(vector, least);
  return least;
}

}  // namespace

/// Forces of contacts, with friction in joints bound by the forces that follow.
bool IslandMotion::add_pressed_reactions() {
  MotionWorkspace& work = *work_;
  const Range v = assembly_->islands()[island_].v;
  work.free.resize(work.acceleration.size());
  std::copy(work.acceleration.begin() + v.begin, work.acceleration.begin() + v.end,
            work.free.begin() + v.begin);
  BoundIteration iteration;
  for (int i = 0; i < BoundIteration::most_repetitions; ++i) {
    std::copy(work.free.begin() + v.begin, work.free.begin() + v.end, work.acceleration.begin() + v.begin);
    double change = 0.0;
    iteration.begin();
    if (!press_once(iteration, change)) return false;
    if (iteration.settled(change)) return true;
    if (!iteration.accelerates()) continue;
    std::size_t bound = 0;
    for (ClosedContact& contact : closed_.list()) {
      if (pressure_.bears(contact.at)) contact.at.pressed = iteration.guess(bound++);
    }
  }
  return false;
}

/// Forces of contacts at given bounds of friction in joints, and the bounds that follow from them.
bool IslandMotion::press_once(BoundIteration& iteration, double& change) {
  if (!closed_.add_reactions(*assembly_, work_->acceleration.data())) return false;
  const JointView at{work_->trial.view(), work_->evaluation.rotation.data()};
  const std::span<const double> multipliers = joint_multipliers();
  pressure_.take(multipliers.data(), 1.0, largest_load());
  for (ClosedContact& contact : closed_.list()) {
    if (!pressure_.bears(contact.at)) continue;
    const double before = contact.at.pressed;
    change = std::max(change, pressure_.press(contact.at, at));
    iteration.add(before, contact.at.pressed);
  }
  return true;
}

bool IslandMotion::update_bounds(std::vector<ClosedContact>& contacts, std::vector<ForceMargin>& margins,
                                 BoundIteration& iteration, double& change) {
  MotionWorkspace& work = *work_;
  const Range v = assembly_->islands()[island_].v;
  work.free.resize(work.acceleration.size());
  std::copy(work.acceleration.begin() + v.begin, work.acceleration.begin() + v.end,
            work.free.begin() + v.begin);
  closed_.list().swap(contacts);
  const bool found = press_once(iteration, change);
  std::copy(work.free.begin() + v.begin, work.free.begin() + v.end, work.acceleration.begin() + v.begin);
  closed_.margins(margins);
  closed_.list().swap(contacts);
  return found;
}

/// Loads without reactions: forces small against them are rounding.
double IslandMotion::largest_load() const {
  const Range v = assembly_->islands()[island_].v;
  double largest = 0.0;
  for (Index i = v.begin; i < v.end; ++i) largest = std::max(largest, std::abs(work_->momentum[i]));
  return largest;
}

bool IslandMotion::solve(ContactCluster& cluster, std::span<Contact> contacts, SolverChain& chain) {
  if (pressure_.empty()) return cluster.solve(chain).usable();
  // Of answers that are not unique one may follow another for ever.
  return settle_bounds(cluster, contacts, chain, false) ||
         (cluster.report().usable() && settle_bounds(cluster, contacts, chain, true));
}

bool IslandMotion::settle_bounds(ContactCluster& cluster, std::span<Contact> contacts, SolverChain& chain,
                                 bool least) {
  MotionWorkspace& work = *work_;
  const Range v = assembly_->islands()[island_].v;
  const JointView at{work.trial.view(), work.evaluation.rotation.data()};
  std::vector<double>& answer = work.of_velocity;
  work.multipliers.resize(joints_.size());
  BoundIteration iteration;
  for (int i = 0; i < BoundIteration::most_repetitions; ++i) {
    if (!cluster.solve(chain).usable()) return false;
    std::fill(answer.begin() + v.begin, answer.begin() + v.end, 0.0);
    if (least) {
      const std::vector<double> found(cluster.impulses().begin(), cluster.impulses().end());
      cluster.set_impulses(least_impulses(cluster.problem(), found));
      cluster.add_loads(1.0, answer.data());
      cluster.set_impulses(found);
    } else {
      cluster.add_loads(1.0, answer.data());
    }
    joints_.apply_inverse_mass(answer.data());
    joints_.hold(JointLevel::change, answer.data(), work.multipliers.data());
    pressure_.take(work.multipliers.data(), 0.0);
    double change = 0.0;
    iteration.begin();
    for (std::size_t c = 0; c < contacts.size(); ++c) {
      if (!pressure_.bears(contacts[c])) continue;
      const double before = contacts[c].pressed;
      change = std::max(change, pressure_.press(contacts[c], at));
      iteration.add(before, contacts[c].pressed);
      cluster.press(c);
    }
    if (iteration.settled(change)) return true;
    if (!iteration.accelerates()) continue;
    std::size_t bound = 0;
    for (std::size_t c = 0; c < contacts.size(); ++c) {
      if (!pressure_.bears(contacts[c])) continue;
      contacts[c].pressed = iteration.guess(bound++);
      cluster.press(c);
    }
  }
  return false;
}

std::span<const double> IslandMotion::joint_multipliers() {
  MotionWorkspace& work = *work_;
  std::vector<double>& answer = work.of_velocity;
  const Range v = assembly_->islands()[island_].v;
  std::copy(work.momentum.begin() + v.begin, work.momentum.begin() + v.end, answer.begin() + v.begin);
  for (const ClosedContact& contact : closed_.list()) {
    contact.at.add_transposed(0, contact.normal, answer.data());
    contact.at.add_transposed(1, contact.tangential, answer.data());
  }
  assembly_->for_bodies(island_, [&](const BodyKind& kind, Range slots, Index, Index at, Index) {
    kind.apply_inverse_mass(slots, answer.data() + at, answer.data() + at);
  });
  work.multipliers.resize(joints_.size());
  joints_.hold(JointLevel::acceleration, answer.data(), work.multipliers.data());
  return work.multipliers;
}

void IslandMotion::couple(ContactCluster& cluster) {
  if (!joints_.empty()) cluster.couple(joints_);
}

void IslandMotion::apply(const ContactCluster& cluster, double* velocity) const {
  if (joints_.empty()) {
    cluster.apply(velocity);
  } else {
    cluster.apply_coupled(velocity);
  }
}

bool IslandMotion::follow_jump(std::span<double> y, double noise, double& work) {
  if (!joints_.depends_on_time()) return false;
  MotionWorkspace& space = *work_;
  const Range v = assembly_->islands()[island_].v;
  std::vector<double>& change = space.of_velocity;
  std::copy(space.trial.v.begin() + v.begin, space.trial.v.begin() + v.end, change.begin() + v.begin);
  space.multipliers.resize(joints_.size());
  joints_.hold(JointLevel::velocity, change.data(), space.multipliers.data());
  double largest = 0.0;
  for (Index i = v.begin; i < v.end; ++i) {
    change[i] -= space.trial.v[i];
    largest = std::max(largest, std::abs(change[i]) * space.lengths[i]);
  }
  if (!(largest > noise)) return false;
  assembly_->for_bodies(island_, [&](const BodyKind& kind, Range slots, Index, Index at, Index) {
    kind.apply_mass(slots, change.data() + at, space.momentum.data() + at);
  });
  for (Index i = v.begin; i < v.end; ++i) {
    work += (space.trial.v[i] + 0.5 * change[i]) * space.momentum[i];
    y[q_size_ + (i - v.begin)] += change[i];
  }
  return true;
}

std::vector<std::string> IslandMotion::projected_by() {
  // Of the largest impulse: less is what others cause.
  constexpr double considerable = 0.1;
  MotionWorkspace& work = *work_;
  const Range v = assembly_->islands()[island_].v;
  std::copy(work.trial.v.begin() + v.begin, work.trial.v.begin() + v.end, work.of_velocity.begin() + v.begin);
  work.multipliers.assign(joints_.size(), 0.0);
  joints_.hold(JointLevel::velocity, work.of_velocity.data(), work.multipliers.data());
  double largest = 0.0;
  for (const double impulse : work.multipliers) largest = std::max(largest, std::abs(impulse));
  std::vector<std::string> names;
  for (std::size_t joint = 0; joint < joints_.joints(); ++joint) {
    bool takes_part = false;
    for (Index row = joints_.first_row(joint); row < joints_.first_row(joint + 1); ++row) {
      takes_part = takes_part || (largest > 0.0 && std::abs(work.multipliers[row]) >= considerable * largest);
    }
    if (takes_part) names.push_back(assembly_->system().name(joints_.joint(joints_.first_row(joint))));
  }
  if (!names.empty()) return names;
  for (const ClosedContact& contact : closed_.list()) names.push_back(finder_->name(contact.at.key));
  return names;
}

std::string IslandMotion::driven_by() const {
  std::string text;
  for (Index k = 0; k < assembly_->joint_kinds().size(); ++k) {
    if (!assembly_->joint_kinds()[k]->depends_on_time()) continue;
    const Range range = assembly_->joints(island_, k);
    for (Index joint = range.begin; joint < range.end; ++joint) {
      text += (text.empty() ? "; bodies are driven by " : ", ") +
              assembly_->system().name(assembly_->joint_id(k, joint));
    }
  }
  return text;
}

}  // namespace carom

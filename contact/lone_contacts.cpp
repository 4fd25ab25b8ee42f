// Problem: the law of contact and impact (island_problem.cpp) for contacts that have nothing in common, which
// are all that bodies on a floor have.

#include <carom/contact/contact_velocity.h>
#include <carom/contact/free_velocity.h>
#include <carom/contact/lone_contacts.h>
#include <carom/contact/one_body_products.h>
#include <carom/contact/solvers/single_contact.h>

namespace carom {

namespace {

/// True of a planar contact of one body, which turns. \param last body of the one before it, or `none`
bool may_be_alone(const Constraint& at, Index last) {
  return at.rows == 2 && at.bodies == 1 &&
         at.blocks[0].columns == static_cast<int>(one_body::of_planar_body) &&
         (last == none || at.body() > last);
}

}  // namespace

/// Numbers of its problem. False where a row moves nothing.
bool LoneContacts::state(const Constraint& at, const BodyMasses& masses, const LoneVelocities& velocity,
                         LoneAnswer& answer, Response& response, PlanarContact& problem) {
  std::array<double, 4> w;
  one_body::answer_contact(at, masses, response.data(), w.data());
  if (w[0] == 0.0 || w[3] == 0.0) return false;
  const std::array<double, 2> before = times_both_rows(at, velocity.before);
  answer.before = {before[0] - at.surface_velocity[0], before[1] - at.surface_velocity[1]};
  const std::array<double, 2> e{at.law.normal_restitution, at.law.tangential_restitution};
  answer.b = vector_of_contact(at, velocity.free, answer.before.data(), e.data());
  problem = {w[0], w[1], w[3], answer.b[0], answer.b[1], at.friction};
  return true;
}

/// False of a contact that is not regular.
bool LoneContacts::solve(const PlanarContact& problem, LoneAnswer& answer, RegularCounts& counts) {
  const CertifiedImpulse found = solve_regular_contact(problem);
  if (!found.usable || !(found.residual <= accepted_residual)) return false;
  answer.impulse = {found.impulse.normal, found.impulse.tangential};
  answer.residual = found.residual;
  answer.mode = found.mode;
  counts.count(found.residual, found.degenerate);
  return true;
}

bool LoneContacts::solve(std::span<const Constraint> constraints, const MassResponse& masses,
                         const LoneVelocities& velocity) {
  clear();
  const std::size_t count = constraints.size();
  if (answers_.size() < count) {
    answers_.resize(count);
    responses_.resize(count);
    problems_.resize(count);
  }
  RegularCounts counts;
  Index last = none;
  for (std::size_t i = 0; i < count; ++i) {
    const Constraint& at = constraints[i];
    if (!may_be_alone(at, last)) return false;
    last = at.body();
    const BodyMasses own = masses.alone(last);
    if (own.mass == nullptr || own.layout != BodyMasses::Layout::planar_bodies) return false;
    if (!state(at, own, velocity, answers_[i], responses_[i], problems_[i])) return false;
  }
  // Apart, so that the processor takes up the next while divisions of one are under way.
  for (std::size_t i = 0; i < count; ++i) {
    if (!solve(problems_[i], answers_[i], counts)) return false;
  }
  for (std::size_t i = 0; i < count; ++i) {
    one_body::add_alone<static_cast<int>(one_body::of_planar_body)>(
        responses_[i].data(), answers_[i].impulse, 1.0, velocity.change + constraints[i].blocks[0].v);
  }
  constraints_ = constraints;
  counts_.add(counts);
  return true;
}

}  // namespace carom

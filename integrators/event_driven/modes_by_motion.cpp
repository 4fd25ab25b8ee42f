// Problem: what do contacts do whose forces are not unique?

#include <carom/integrators/event_driven/modes_by_motion.h>

#include <algorithm>
#include <cmath>

namespace carom {

void open_where_parting(const DecidedContacts& decided, std::span<Candidate> candidates) {
  for (std::size_t c = 0; c < decided.contacts.size(); ++c) {
    Candidate& candidate = candidates[decided.taking_part[c]];
    if (candidate.mode == ContactMode::open || decided.contacts[c].has_dry_friction()) continue;
    if (decided.contacts[c].normal_acceleration(decided.acceleration) > decided.small)
      candidate.mode = ContactMode::open;
  }
}

namespace {

/// True of a contact that may have friction of any size and direction: it does not slip and does not start
/// to.
bool is_still(const DecidedContacts& decided, std::size_t c, const Candidate& candidate) {
  const Constraint& contact = decided.contacts[c];
  const bool rolling = contact.type == ConstraintType::rolling;
  if (candidate.mode == ContactMode::open || contact.friction == 0.0) return false;
  if (contact.rows < 2 && !rolling) return false;
  if (candidate.slip != 0.0 || candidate.starts_slipping || candidate.frictionless) return false;
  return std::abs(contact.tangential_acceleration(decided.acceleration)) <= decided.small;
}

}  // namespace

void stick_where_still(const DecidedContacts& decided, std::span<Candidate> candidates) {
  for (std::size_t c = 0; c < decided.contacts.size(); ++c) {
    Candidate& candidate = candidates[decided.taking_part[c]];
    if (is_still(decided, c, candidate)) candidate.mode = ContactMode::stick;
  }
}

void fix_extreme_friction(const DecidedContacts& decided, const IslandProblem& problem,
                          std::span<Candidate> candidates) {
  constexpr double rounding = 1e-9;  // answers are certified to 1e-12
  for (std::size_t c = 0; c < decided.contacts.size(); ++c) {
    Candidate& candidate = candidates[decided.taking_part[c]];
    const Constraint& contact = decided.contacts[c];
    // Static friction larger than sliding friction would change the force.
    const bool rolling = contact.type == ConstraintType::rolling;
    if (!is_still(decided, c, candidate)) continue;
    if (!rolling && (contact.has_dry_friction() || contact.law.has_static_friction())) continue;
    const auto row = static_cast<std::size_t>(problem.first_row(rolling ? c - 1 : c));
    const auto along = static_cast<std::size_t>(problem.first_row(c) + contact.tangent_row());
    const double normal = problem.impulses()[row], tangential = problem.impulses()[along];
    if (!(normal > 0.0)) continue;
    const double bound = contact.friction * normal, size = std::abs(tangential);
    if (size > rounding * bound && size < (1.0 - rounding) * bound) {
      candidate.mode = ContactMode::stick;
      continue;
    }
    if (rolling && size <= rounding * bound) continue;  // held without a moment
    candidate.mode = tangential < 0.0 ? ContactMode::slip_positive : ContactMode::slip_negative;
    candidate.frictionless = size <= rounding * bound;
  }
}

bool forces_may_move(std::span<const Constraint> contacts, std::span<const std::size_t> taking_part,
                     std::span<const Candidate> candidates) {
  std::size_t closed = 0;
  bool slides = false;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const Candidate& candidate = candidates[taking_part[c]];
    if (candidate.mode == ContactMode::open) continue;
    if (contacts[c].type != ConstraintType::rolling) ++closed;
    const bool rubs = !candidate.frictionless && contacts[c].friction != 0.0;
    slides = slides || (rubs && candidate.mode != ContactMode::stick);
  }
  return slides && closed > 1;
}

double motion_apart(const IslandProblem& problem, std::span<const ActiveContact> closed,
                    MotionComparison& memory) {
  const std::span<const Constraint> contacts = problem.constraints();
  const std::size_t rows = problem.problem().vector().size();
  memory.force.assign(rows, 0.0);
  memory.answered.resize(rows);
  memory.given.resize(rows);
  auto at = closed.begin();
  for (std::size_t c = 0; c < contacts.size() && at != closed.end(); ++c) {
    if (contacts[c].key != at->at.key) continue;
    const auto row = static_cast<std::size_t>(problem.first_row(c));
    if (!contacts[c].has_dry_friction()) memory.force[row] = at->normal;
    if (contacts[c].rows > 1 || contacts[c].has_dry_friction())
      memory.force[row + static_cast<std::size_t>(contacts[c].tangent_row())] = at->tangential;
    ++at;
  }
  problem.problem().velocities(problem.impulses(), memory.answered);
  problem.problem().velocities(memory.force, memory.given);
  double apart = 0.0;
  for (std::size_t i = 0; i < rows; ++i)
    apart = std::max(apart, std::abs(memory.given[i] - memory.answered[i]));
  return apart;
}

}  // namespace carom

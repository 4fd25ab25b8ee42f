// Problem: what do contacts do whose forces are not unique?

#include <carom/integrators/event_driven/modes_by_motion.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace carom {

double size_without_contact(const IslandProblem& problem) {
  const ContactProblem& stated = problem.problem();
  double size = 0.0;
  for (int row = 0; row < stated.rows(); ++row) {
    const auto at = static_cast<std::size_t>(row);
    size = std::max(size, std::abs(stated.vector()[at]));
    const RowSet& set = stated.sets()[at];
    const bool is_given = set.kind == SetKind::interval && set.lower == set.upper;
    if (is_given) size = std::max(size, std::abs(stated.diagonal(row) * set.lower));
  }
  return size;
}

double size_by_rounding(const IslandProblem& problem) {
  constexpr double rounding = 16.0 * std::numeric_limits<double>::epsilon();
  const std::span<const double> force = problem.impulses();
  double largest = 0.0;
  for (int row = 0; row < static_cast<int>(force.size()); ++row) {
    const double by_force = problem.problem().diagonal(row) * force[static_cast<std::size_t>(row)];
    largest = std::max(largest, std::abs(by_force));
  }
  return rounding / SlipDirections::no_acceleration * largest;
}

void open_where_parting(const DecidedContacts& decided, std::span<Candidate> candidates) {
  for (std::size_t c = 0; c < decided.contacts.size(); ++c) {
    Candidate& candidate = candidates[decided.taking_part[c]];
    if (candidate.mode == ContactMode::open) continue;
    if (decided.contacts[c].normal_acceleration(decided.acceleration) > decided.small)
      candidate.mode = ContactMode::open;
  }
}

void open_where_carried_off(const DecidedContacts& decided, const IslandProblem& problem,
                            std::span<Candidate> candidates) {
  for (std::size_t c = 0; c < decided.contacts.size(); ++c) {
    Candidate& candidate = candidates[decided.taking_part[c]];
    const Constraint& contact = decided.contacts[c];
    if (candidate.mode != ContactMode::stick || contact.rows < 2 || contact.friction == 0.0) continue;
    const int normal = problem.first_row(c);
    const double force = problem.impulses()[static_cast<std::size_t>(normal)];
    if (force * problem.problem().diagonal(normal) > decided.small) continue;
    if (std::abs(contact.tangential_acceleration(decided.acceleration)) > decided.small)
      candidate.mode = ContactMode::open;
  }
}

namespace {

/// True of a contact that may have friction of any size and direction: it does not slip and does not start
/// to.
bool is_still(const DecidedContacts& decided, std::size_t c, const Candidate& candidate) {
  const Constraint& contact = decided.contacts[c];
  if (candidate.mode == ContactMode::open || contact.friction == 0.0) return false;
  if (contact.tangents() == 0 || contact.has_given_bound()) return false;
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
    if (!is_still(decided, c, candidate)) continue;
    // Friction that falls at once when sliding begins would change the force.
    const bool drops = contact.law.has_static_friction() && !contact.law.falls_with_speed();
    if (drops) continue;
    const auto row = static_cast<std::size_t>(problem.first_row(c - contact.attached));
    const auto along = static_cast<std::size_t>(problem.first_row(c) + contact.tangent_row());
    const double normal = problem.impulses()[row], tangential = problem.impulses()[along];
    if (!(normal > 0.0)) continue;
    const double bound = contact.friction * normal, size = std::abs(tangential);
    if (size > rounding * bound && size < (1.0 - rounding) * bound) {
      candidate.mode = ContactMode::stick;
      continue;
    }
    if (contact.attached && size <= rounding * bound) continue;  // held without a moment
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
    if (!contacts[c].attached) ++closed;
    const bool rubs = !candidate.frictionless && contacts[c].friction != 0.0;
    slides = slides || (rubs && candidate.mode != ContactMode::stick);
  }
  return slides && closed > 1;
}

bool law_allows(std::span<const ActiveContact> closed, std::span<const ForceMargin> margins) {
  return std::all_of(margins.begin(), margins.end(), [&](const ForceMargin& margin) {
    double largest = 0.0;
    for (std::size_t i = margin.first; i < margin.last; ++i)
      largest = std::max(largest, std::abs(closed[i].normal));
    return margin.margin >= -clear_force * largest;
  });
}

namespace {

/// Normal and tangential numbers of one contact.
using ForceNumbers = std::array<double, numbers_of_force>;

/// Writes numbers of closed contacts, normal and tangential, to the rows of a problem; 0 elsewhere.
template <class F>
void place_numbers(const IslandProblem& problem, std::span<const ActiveContact> closed, F&& numbers_of,
                   std::vector<double>& rows) {
  const std::span<const Constraint> contacts = problem.constraints();
  rows.assign(problem.problem().vector().size(), 0.0);
  std::size_t at = 0;
  for (std::size_t c = 0; c < contacts.size() && at < closed.size(); ++c) {
    if (contacts[c].key != closed[at].at.key) continue;
    const auto row = static_cast<std::size_t>(problem.first_row(c));
    const ForceNumbers numbers = numbers_of(at++);
    rows[row] = numbers[0];  // of a row without normal the tangential number takes its place
    for_tangents(contacts[c], [&](std::size_t k, int tangent) {
      rows[row + static_cast<std::size_t>(tangent)] = numbers[1 + k];
    });
  }
}

/// Largest difference between the accelerations that two lists of forces lead to.
double largest_difference(const IslandProblem& problem, std::span<const double> a, std::span<const double> b,
                          MotionComparison& memory) {
  memory.answered.resize(a.size());
  memory.given.resize(a.size());
  problem.problem().velocities(a, memory.answered);
  problem.problem().velocities(b, memory.given);
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    largest = std::max(largest, std::abs(memory.given[i] - memory.answered[i]));
  return largest;
}

/// Largest acceleration by changes of forces that no constraint feels.
double motion_left_open(const IslandProblem& problem, std::span<const ActiveContact> closed,
                        const ActiveSet& set, MotionComparison& memory) {
  double force = 0.0, largest = 0.0;
  for (const ActiveContact& contact : closed) force = std::max(force, std::abs(contact.normal));
  set.for_open_forces([&](std::size_t first, std::span<const double> numbers) {
    double size = 0.0;
    for (const double number : numbers) size = std::max(size, std::abs(number));
    const auto change = [&](std::size_t i) {
      ForceNumbers changed{};
      if (i < first || numbers_of_force * (i - first) >= numbers.size()) return changed;
      const double* const number = numbers.data() + numbers_of_force * (i - first);
      for (std::size_t k = 0; k < changed.size(); ++k) changed[k] = force / size * number[k];
      return changed;
    };
    place_numbers(problem, closed, change, memory.force);
    memory.none.assign(memory.force.size(), 0.0);
    largest = std::max(largest, largest_difference(problem, memory.none, memory.force, memory));
  });
  return largest;
}

}  // namespace

double motion_apart(const IslandProblem& problem, std::span<const ActiveContact> closed, const ActiveSet& set,
                    MotionComparison& memory) {
  const auto forces = [&](std::size_t i) {
    const TangentDirection::Numbers& tangential = closed[i].tangential;
    return ForceNumbers{closed[i].normal, tangential[0], tangential[1]};
  };
  place_numbers(problem, closed, forces, memory.force);
  const double apart = largest_difference(problem, problem.impulses(), memory.force, memory);
  return std::max(apart, motion_left_open(problem, closed, set, memory));
}

}  // namespace carom

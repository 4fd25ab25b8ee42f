// Problem: does a moment hold what may roll, and does rolling take the forces from a contact?

#include <carom/integrators/event_driven/rolling_modes.h>

#include <cmath>

namespace carom {

ContactMode mode_of_rolling(const IslandProblem& problem, std::size_t c, ContactMode contact,
                            const TangentDirection& slip, std::span<const double> force) {
  if (contact == ContactMode::open) return ContactMode::open;
  if (!slip.is_zero()) return slip.mode(1);
  const ContactProblem& stated = problem.problem();
  const int row = problem.first_row(c);
  const double normal = force[static_cast<std::size_t>(problem.first_row(c - 1))];
  const double bound = (1.0 - mode_threshold) * problem.constraints()[c].friction * normal;
  if (std::abs(force[static_cast<std::size_t>(row)]) < bound) return ContactMode::stick;
  double along = stated.vector()[static_cast<std::size_t>(row)], size = std::abs(along);
  for (int i = 0; i < stated.rows(); ++i) {
    const double part = stated.w(row, i) * force[static_cast<std::size_t>(i)];
    along += part;
    size += std::abs(part);
  }
  return mode_by_sign(std::abs(along) > mode_threshold * size ? along : 0.0);
}

void follow_contacts(const SlipDirections& slips, std::span<Candidate> candidates) {
  for (std::size_t i = 1; i < candidates.size(); ++i) {
    Candidate& rolling = candidates[i];
    if (!rolling.at.attached) continue;
    if (candidates[i - 1].mode == ContactMode::open) {
      rolling.mode = ContactMode::open;
    } else if (rolling.mode == ContactMode::open) {
      rolling.mode = slips[i].direction.mode(rolling.at.tangents());
    }
  }
}

void name_cause(const IslandProblem& problem, std::span<const std::size_t> taking_part,
                const SlipDirections& slips, std::span<Candidate> candidates) {
  const ContactProblem& stated = problem.problem();
  const std::span<const Constraint> contacts = problem.constraints();
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const std::size_t i = taking_part[c];
    if (contacts[c].normals == 0) continue;
    const int row = problem.first_row(c);
    candidates[i].stiffness = stated.w(row, row);
    const auto add_friction = [&](std::size_t constraint) {
      const TangentDirection& slip = slips[taking_part[constraint]].direction;
      for_tangents(contacts[constraint], [&](std::size_t k, int tangent) {
        const double ratio = -slip[k] * contacts[constraint].friction;
        candidates[i].stiffness += ratio * stated.w(row, problem.first_row(constraint) + tangent);
      });
    };
    add_friction(c);
    if (c + 1 < contacts.size() && contacts[c + 1].attached) add_friction(c + 1);
    candidates[i].free_acceleration = stated.vector()[static_cast<std::size_t>(row)];
  }
}

}  // namespace carom

// Problem: which contacts slip, and where to, while the answer says otherwise for some?

#include <carom/integrators/event_driven/slip_directions.h>

#include <algorithm>
#include <cmath>

namespace carom {

std::size_t groups_of(std::span<const Candidate> candidates) {
  return static_cast<std::size_t>(
      std::count_if(candidates.begin(), candidates.end(),
                    [](const Candidate& candidate) { return !candidate.at.attached; }));
}

void SlipDirections::start(std::span<const Candidate> candidates) {
  slips_.assign(candidates.size(), {});
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Candidate& candidate = candidates[i];
    if (candidate.frictionless) {
      slips_[i].direction = TangentDirection::of_sign(1.0);
    } else if (candidate.slip != 0.0) {
      slips_[i].direction = TangentDirection::of_sign(candidate.slip);
    } else if (candidate.starts_slipping) {
      slips_[i].direction = TangentDirection::of_sign(-std::copysign(1.0, candidate.exhausted_friction));
    }
    slips_[i].open = candidate.releases;
  }
}

bool SlipDirections::forget_ends(std::span<const Candidate> candidates) {
  bool changed = false;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    SlipDirection& slip = slips_[i];
    const bool begins = !slip.direction.is_zero() && candidates[i].slip == 0.0 && !candidates[i].frictionless;
    if (!begins && !slip.open) continue;
    slip = {.direction = begins ? TangentDirection{} : slip.direction, .reverted = true};
    changed = true;
  }
  return changed;
}

bool SlipDirections::revise(std::span<const Candidate> candidates, const ContactProblem& problem, double size,
                            const double* acceleration) {
  bool changed = false;
  double farthest = 0.0;
  // Accelerations by friction that is exhausted to within its rounding only.
  double stiffest = 0.0, exhausted = 0.0;
  for (int row = 0; row < problem.rows(); ++row) {
    stiffest = std::max(stiffest, problem.w(row, row));
  }
  for (const Candidate& candidate : candidates) exhausted += candidate.noise * stiffest;
  SlipDirection* astray = nullptr;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Candidate& candidate = candidates[i];
    SlipDirection& slip = slips_[i];
    const double opening = candidate.at.normal_acceleration(acceleration);
    const double along = acceleration_along(candidate.at, slip.direction, acceleration);
    if (slip.open) {
      if (candidate.stays_open) continue;
      if (opening >= -no_acceleration * std::max(size, std::abs(opening))) continue;
      slip.open = false;
      changed = true;
    } else if (const TangentDirection decided = TangentDirection::of_mode(candidate.mode);
               slip.direction.is_zero() && !decided.is_zero()) {
      slip.direction = decided;
      changed = changed || candidate.at.law.has_static_friction();  // else the friction is right already
    } else if (candidate.slip == 0.0 && !candidate.frictionless && !slip.reverted &&
               candidate.mode != ContactMode::open && along < -std::max(no_acceleration * size, exhausted)) {
      // One at a time: it may be what takes the others along.
      if (astray != nullptr && std::abs(along) <= farthest) continue;
      astray = &slip;
      farthest = std::abs(along);
    }
  }
  if (changed || astray == nullptr) return changed;
  astray->direction = {};
  astray->reverted = true;
  return true;
}

}  // namespace carom

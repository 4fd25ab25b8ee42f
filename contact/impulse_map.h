#pragma once

/// \file
/// The way back from the impulses P of constraints to the bodies: velocities, loads, work. An impulse P along
/// a row with the velocities gamma^- before and gamma^+ after does the work P (gamma^- + gamma^+)/2 (exact
/// for the kinetic energy); that of all rows together is what the law of impact gains or takes.

#include <carom/contact/island_response.h>
#include <carom/core/constraint.h>
#include <carom/core/export.h>

#include <cmath>
#include <span>
#include <utility>

namespace carom {

/// Work of an impulse [J]. \param impulse [N s] \param before,after velocities along it [m/s]
[[nodiscard]] inline double impulse_work(double impulse, double before, double after) {
  return 0.5 * impulse * (before + after);
}

/// Work of the impulses of one problem, and the size of what it is the sum of.
struct ImpulseWork {
  /// Rounding of the sum of works, against its scale: a gain above it is real.
  static constexpr double rounding = 1e-13;

  /// Friction in joints has the restitution of the contact less this part of it (impact_restitution.h): half
  /// of that of |P gamma^-| is what its impulse may gain.
  static constexpr double joint_restitution_lack = 1e-11;

  double gain = 0.0;    ///< sum of works [J]
  double scale = 0.0;   ///< sum of the magnitudes of its parts [J]
  double lacked = 0.0;  ///< what friction in joints gains at most as its restitution is a little less [J]

  /// Adds an impulse; returns its work [J].
  double add(double impulse, double before, double after) {
    const double work = impulse_work(impulse, before, after);
    gain += work;
    scale += std::abs(impulse) * (std::abs(before) + std::abs(after));
    return work;
  }
  /// Allows for the restitution of friction in a joint. \param impulse,before as in add()
  void allow_for_joint_friction(double impulse, double before) {
    lacked += 0.5 * joint_restitution_lack * std::abs(impulse * before);
  }
  /// Largest sum that is no gain [J].
  [[nodiscard]] double tolerance() const { return rounding * scale + lacked; }
  /// True if energy is gained by the law.
  [[nodiscard]] bool is_gain() const { return gain > tolerance(); }
};

/// One answer of one problem. A view: constraints, matrix and numbers must outlive it.
class CAROM_API ImpulseMap {
public:
  /// \param first_row of each constraint \param before velocities gamma^- \param impulses P, both by row
  ImpulseMap(std::span<const Constraint> constraints, std::span<const int> first_row,
             const IslandResponse& response, std::span<const double> before, std::span<const double> impulses)
      : constraints_(constraints),
        first_row_(first_row),
        response_(&response),
        before_(before),
        impulses_(impulses) {}

  /// v += scale B H^T P. \param velocity of all bodies
  void add_velocities(double* velocity, double scale = 1.0) const {
    response_->add(impulses_, velocity, scale);
  }
  /// Calls f(block) for each body; where W is left in factors once, else perhaps more often.
  template <class F>
  void for_bodies(F&& f) const {
    if (response_->factors.answer_alone()) {
      for (const FactorMaker::Slot& slot : response_->factors.slots()) f(slot.block);
      return;
    }
    Index last = none;
    for (const Constraint& constraint : constraints_) {
      for (std::size_t b = 0; b < static_cast<std::size_t>(constraint.bodies); ++b) {
        const Constraint::Block& block = constraint.blocks[b];
        if (std::exchange(last, block.body) != block.body) f(block);
      }
    }
  }
  /// f += scale H^T P. \param load over all velocities
  void add_loads(double scale, double* load) const;
  /// Impulse along a row of a constraint.
  [[nodiscard]] double impulse(std::size_t constraint, int row) const {
    return impulses_[place(constraint, row)];
  }
  /// Velocity along it before.
  [[nodiscard]] double before(std::size_t constraint, int row) const {
    return before_[place(constraint, row)];
  }
  /// By how much the bodies differ in what impulses make of their velocities: about the ratio of their
  /// masses; 1 where W is left in factors. Allocates.
  [[nodiscard]] double mass_ratio() const;

private:
  [[nodiscard]] std::size_t place(std::size_t constraint, int row) const {
    return static_cast<std::size_t>(first_row_[constraint] + row);
  }

  std::span<const Constraint> constraints_;
  std::span<const int> first_row_;
  const IslandResponse* response_;
  std::span<const double> before_, impulses_;
};

}  // namespace carom

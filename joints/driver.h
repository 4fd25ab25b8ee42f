#pragma once

/// \file
/// Parts that act on the coordinate of a joint: drivers prescribe it, motors apply a load along it,
/// stops limit it.

#include <carom/core/force_kind.h>
#include <carom/core/joint_kind.h>
#include <carom/core/time_course.h>
#include <carom/joints/actuator.h>
#include <carom/joints/on_coordinate.h>

#include <functional>
#include <limits>
#include <string_view>
#include <vector>

namespace carom {

class DriverKind;
class MotorKind;
class StopKind;

/// Prescribes the coordinate of a joint as a function of time. Its work is external work. Rates that are not
/// given are computed by differences (core/numerics/time_difference.h); functions must then be smooth between
/// breaks.
struct Driver {
  static constexpr Role role = Role::joint;
  using Kind = DriverKind;

  JointId joint{};                                    ///< whose coordinate (required)
  std::function<double(double time)> position{};      ///< the coordinate [rad, m] (required)
  std::function<double(double time)> velocity{};      ///< its rate
  std::function<double(double time)> acceleration{};  ///< and that of the rate
  /// When the velocity or acceleration jumps or a function has a kink, ascending [s]. The position is
  /// continuous: a jump of it is a SolverError.
  std::vector<double> breaks{};
};

/// All drivers of a system.
class CAROM_API DriverKind final : public OnCoordinate<Driver, DriverKind, JointKind> {
public:
  static constexpr std::string_view part_label() { return "driver"; }

  /// Checks and stores a driver. Throws ModelError.
  void add(const Driver& part, const PartCheck& check);

  [[nodiscard]] std::string_view label() const override { return part_label(); }
  [[nodiscard]] Index rows() const override { return 1; }
  void pattern(Index joint, JointRow* out) const override;
  void evaluate(const JointView& at, Index joint, JointRow* out) const override;
  void derivatives(const JointView& at, Index joint, JointRowDerivative* out) const override;
  [[nodiscard]] bool depends_on_time() const override { return true; }
  [[nodiscard]] bool prescribes(Index) const override { return true; }
  [[nodiscard]] LawPoint prescribed(Index joint, double time) const override;
  void discontinuity_times(Index joint, std::vector<double>& out) const override;
  /// The force of a driver is given as the moment of its reaction: it acts along the coordinate.
  [[nodiscard]] JointReaction reaction(const JointView& at, Index joint,
                                       const double* multipliers) const override;
  void fingerprint(Fingerprint& print) const override;
};

/// A load along the coordinate of a joint as a function of time, coordinate and rate: the torque on `to` of a
/// revolute joint, the force on `to` along the axis of a prismatic one. Its work is external work.
struct Motor {
  static constexpr Role role = Role::force;
  using Kind = MotorKind;

  JointId joint{};               ///< along whose coordinate (required)
  ActuatorLaw torque{};          ///< [N m, N] (required)
  std::vector<double> breaks{};  ///< when the law jumps or has a kink in time, ascending [s]
};

/// All motors of a system.
class CAROM_API MotorKind final : public OnCoordinate<Motor, MotorKind, ForceKind> {
public:
  static constexpr std::string_view part_label() { return "motor"; }

  /// Checks and stores a motor. Throws ModelError.
  void add(const Motor& part, const PartCheck& check);

  [[nodiscard]] std::string_view label() const override { return part_label(); }
  [[nodiscard]] bool books_dissipative() const override { return false; }
  void evaluate(const EvaluationContext& at, Range elements, const Loads& loads) const override;
  [[nodiscard]] double potential(const EvaluationContext&, Range) const override { return 0.0; }
  void discontinuity_times(Index element, std::vector<double>& out) const override;
  void fingerprint(Fingerprint& print) const override;
};

/// Limits of the coordinate of a joint, lower <= x <= upper: unilateral, with a coefficient of restitution,
/// in both modes. The impulse or force of a stop acts along the coordinate, and is positive where it opens
/// the gap.
struct Stop {
  static constexpr Role role = Role::joint;
  using Kind = StopKind;

  JointId joint{};                                          ///< whose coordinate (required)
  double lower = -std::numeric_limits<double>::infinity();  ///< [rad, m]; one of the two is required
  double upper = std::numeric_limits<double>::infinity();   ///< [rad, m]
  double restitution = 0.0;                                 ///< e in [0, 1]
};

/// All stops of a system.
class CAROM_API StopKind final : public OnCoordinate<Stop, StopKind, JointKind> {
public:
  static constexpr std::string_view part_label() { return "stop"; }

  /// Checks and stores a stop. Throws ModelError.
  void add(const Stop& part, const PartCheck& check);

  [[nodiscard]] std::string_view label() const override { return part_label(); }
  [[nodiscard]] Index rows() const override { return 0; }
  void pattern(Index, JointRow*) const override {}
  void evaluate(const JointView&, Index, JointRow*) const override {}
  void derivatives(const JointView&, Index, JointRowDerivative*) const override {}
  [[nodiscard]] Index limits() const override { return 2; }
  [[nodiscard]] bool has_limit(Index joint, Index which) const override;
  void limit(const JointView& at, Index joint, Index which, JointLimit& out) const override;
  [[nodiscard]] std::string_view limit_label(Index which) const override {
    return which == 0 ? "lower" : "upper";
  }
  [[nodiscard]] JointReaction reaction(const JointView&, Index, const double*) const override { return {}; }
  void fingerprint(Fingerprint& print) const override;
};

namespace planar {
using carom::Driver;
using carom::Motor;
using carom::Stop;
}  // namespace planar
namespace spatial {
using carom::Driver;
using carom::Motor;
using carom::Stop;
}  // namespace spatial

}  // namespace carom

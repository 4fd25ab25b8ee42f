#pragma once

/// \file
/// The kinds of drivers, motors and stops.

#include <carom/core/force_kind.h>
#include <carom/core/joint_kind.h>
#include <carom/joints/driver.h>
#include <carom/joints/on_coordinate.h>

#include <string_view>
#include <vector>

namespace carom {

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

}  // namespace carom

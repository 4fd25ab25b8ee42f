#pragma once

/// \file
/// Gaps of the bodies of an assembled model, which its joints bind (gap_source.h).

#include <carom/contact/detection/body_touches.h>
#include <carom/contact/detection/detector.h>
#include <carom/contact/gap_source.h>
#include <carom/contact/separation.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint_set.h>
#include <carom/core/dynamics/components_response.h>
#include <carom/core/dynamics/joint_constraints.h>
#include <carom/core/export.h>

#include <optional>
#include <span>
#include <vector>

namespace carom {

/// Bodies that may be moved, how they answer, and the gaps that are to be opened.
struct MovableBodies {
  const Assembly& assembly;
  const Detector& detector;
  const GroundPlaces& places;         ///< shapes on ground, at the time of the state
  std::span<const Range> components;  ///< ascending; with contacts of bodies all that these may touch
  /// Joints of those components that have some, ascending.
  std::span<JointConstraints* const> joints{};
  std::span<const Constraint> taking_part{};  ///< contacts whose gaps are to be opened
  bool all = false;                           ///< all gaps, those that a displacement closes included
  bool touch = false;                         ///< contacts of bodies with each other take part
};

/// Gaps of the contacts of movable bodies. Keeps memory.
class CAROM_API AssemblyGaps final : public GapSource {
public:
  /// Takes bodies and where they are. The state and the position group of `evaluation`, up to date now,
  /// follow what is moved; all must outlive the calls that follow.
  void bind(const MovableBodies& bodies, State& state, Evaluation& evaluation);

  [[nodiscard]] std::span<Constraint> find(double margin) override;
  [[nodiscard]] Index bodies() const override;
  [[nodiscard]] Index first_together(Index body) const override;
  [[nodiscard]] Range velocities() const override;
  [[nodiscard]] const std::vector<double>& lengths() const override { return lengths_; }
  [[nodiscard]] double rounding() const override;
  void begin() override;
  [[nodiscard]] std::span<const Range> select(std::span<const Constraint> contacts) override;
  [[nodiscard]] BodyResponse& response() override;
  void move(const double* displacement) override;
  void update() override;
  [[nodiscard]] bool is_off(double depth) override;
  void close_joints(const double* displacement, double* sum) override;

private:
  void select(Index body);
  [[nodiscard]] Range coordinates(Range components) const;

  std::optional<MovableBodies> bodies_;
  State* state_ = nullptr;
  Evaluation* evaluation_ = nullptr;
  std::optional<ComponentsResponse> response_;
  BodyContactSearch search_;
  ConstraintSet contacts_;
  std::vector<ConstraintKey> wanted_;          // contacts that take part, ascending
  std::vector<double> unmoved_;                // q from which displacements are
  std::vector<double> lengths_;                // of the assembly
  std::vector<Index> at_hand_;                 // bodies, ascending
  std::vector<Range> velocities_;              // theirs
  std::vector<JointConstraints*> mechanisms_;  // their joints, ascending
  std::vector<double> moved_, rows_;
};

/// Moves all bodies of a model out of all that they have sunk into. \param places of shapes on ground at the
/// time of the state \param gaps keeps the contacts that the result tells of \param evaluation its position
/// group is up to date, and is so again
CAROM_API Separation separate_all(const Assembly& assembly, const Detector& detector,
                                  const GroundPlaces& places, AssemblyGaps& gaps, SolverChain& chain,
                                  State& state, Evaluation& evaluation);

}  // namespace carom

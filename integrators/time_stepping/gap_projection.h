#pragma once

/// \file
/// Bodies that have sunk into shapes on ground are moved out by the smallest displacement in the sense of
/// their masses:  minimise |d|_M  such that  g(q + d) >= 0  for the gaps g of the contacts of a body. At an
/// estimate d the gaps are taken as linear; the multipliers y of the next estimate d' = M^-1 G^T y solve
///     W y + g(q + d) - G d >= 0,  y >= 0,  complementary,   W = G M^-1 G^T.
/// Where joints bind the bodies, with rows J and gaps j, they move together: M^-1 leaves room for K of
/// core/dynamics/joint_constraints.h, and  d' = K G^T y + d0  with the smallest d0 for which  J d0 = J d -
/// j(q + d).

#include <carom/contact/delassus.h>
#include <carom/contact/detection/detector.h>
#include <carom/contact/island_partition.h>
#include <carom/contact/solvers/contact_problem.h>
#include <carom/contact/solvers/solver_chain.h>
#include <carom/core/assembly.h>
#include <carom/core/dynamics/joint_constraints.h>
#include <carom/core/export.h>

#include <span>
#include <vector>

namespace carom {

/// Moves the bodies of one component. Keeps memory only.
class CAROM_API GapProjection {
public:
  /// Outcome of a projection.
  struct Result {
    bool moved = false;                ///< a body was moved
    double shift = 0.0;                ///< largest displacement of a body, angles weighed by its size [m]
    double depth = 0.0;                ///< gaps of this size are rounding [m]
    const Constraint* left = nullptr;  ///< deepest contact that could not be opened
    /// The contacts of its bodies that had to be open together, it among them. Valid, as `left`, until the
    /// next projection.
    std::span<const Constraint> together{};
  };
  /// Gaps that are to be opened.
  struct Which {
    std::span<const Constraint> taking_part{};  ///< these, in the order of the detector,
    bool all = false;                           ///< or all, those that a displacement closes included
  };

  /// Moves bodies until the gaps asked for are at most rounding below zero; those that keep a body from
  /// falling back end there, still closed. Shapes on ground are at `places`. The position group of
  /// `evaluation` must be up to date, and is so afterwards. \param joints of the component; may be empty
  Result project(const Assembly& assembly, Index component, const Detector& detector,
                 const GroundPlaces& places, const Which& which, SolverChain& chain, State& state,
                 Evaluation& evaluation, JointConstraints& joints);

private:
  void find(Index component, const Detector& detector, const GroundPlaces& places, const Which& which,
            double margin, const State& state, const Evaluation& evaluation);
  void state_problem(std::span<const Constraint> contacts, BodyResponse& response);
  /// Makes a better estimate for one body; false if there is none.
  bool move_body(const Assembly& assembly, std::span<const Constraint> contacts, SolverChain& chain,
                 State& state, double depth);

  /// Likewise for all bodies of a component that joints bind.
  bool move_bound(const Assembly& assembly, Index component, std::span<const Constraint> contacts,
                  SolverChain& chain, State& state, const Evaluation& evaluation, double depth,
                  JointConstraints& joints);

  std::vector<Constraint> found_, contacts_;
  IslandPartition partition_;
  std::vector<ImpulseDirection> normals_;
  Delassus delassus_;
  ContactProblem problem_;
  std::vector<double> unmoved_;       // q
  std::vector<double> displacement_;  // d, over all velocities
  std::vector<double> lengths_;       // of the assembly
  std::vector<double> multipliers_, moved_;
  std::vector<double> towards_, of_joints_;  // d0; multipliers of joints
};

}  // namespace carom

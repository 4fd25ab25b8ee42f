#pragma once

/// \file
/// Bodies that have sunk into shapes on ground, or into each other, are moved apart by the smallest
/// displacement in the sense of their masses:  minimise |d|_M  such that  g(q + d) >= 0  for the gaps g of
/// the contacts of an island. At an estimate d the gaps are taken as linear; the multipliers y of the next
/// estimate d' = M^-1 G^T y solve
///     W y + g(q + d) - G d >= 0,  y >= 0,  complementary,   W = G M^-1 G^T.
/// Where joints bind bodies, with rows J and gaps j, they move together: M^-1 leaves room for K of
/// core/dynamics/joint_constraints.h, and  d' = K G^T y + d0  with the smallest d0 for which  J d0 = J d -
/// j(q + d).

#include <carom/contact/delassus.h>
#include <carom/contact/detection/body_contacts.h>
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

/// Moves bodies. Keeps memory only.
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
    std::span<const Constraint> taking_part{};  ///< these,
    bool all = false;                           ///< or all, those that a displacement closes included
    bool of_bodies = false;                     ///< those of bodies with each other too
  };
  /// Bodies that may be moved, and how they answer.
  struct Bodies {
    const Assembly& assembly;
    const Detector& detector;
    const GroundPlaces& places;  ///< shapes on ground, at the time of the state
    Range components;            ///< consecutive; with contacts of bodies all that these may touch
    /// Joints of those of them that have some, ascending.
    std::span<JointConstraints* const> joints{};
  };

  /// Moves bodies until the gaps asked for are at most rounding below zero; those that keep a body from
  /// falling back end there, still closed. The position group of `evaluation` must be up to date, and is so
  /// afterwards.
  Result project(const Bodies& bodies, const Which& which, SolverChain& chain, State& state,
                 Evaluation& evaluation);

private:
  void start(const Bodies& bodies, const Which& which, Range v, const State& state);
  void find(const Bodies& bodies, const Which& which, double margin, const State& state,
            const Evaluation& evaluation);
  [[nodiscard]] bool has_moved(const Bodies& bodies, std::span<const Constraint> contacts);
  [[nodiscard]] bool has_pushed(const ConstraintKey& key) const;
  void note_pushes(std::span<const Constraint> contacts);
  [[nodiscard]] bool is_off(const State& state, const Evaluation& evaluation, double depth) const;
  bool move(const Bodies& bodies, std::span<const Constraint> contacts, SolverChain& chain, State& state,
            const Evaluation& evaluation, double depth);
  void close_joints(const State& state, const Evaluation& evaluation);

  std::vector<Constraint> contacts_;
  BodyContactSearch search_;
  // Of contacts, ascending.
  struct {
    std::vector<ConstraintKey> wanted;  // those that take part
    std::vector<ConstraintKey> pushed;  // those that pushed in the last pass
  } keys_;
  IslandPartition partition_;
  std::vector<ImpulseDirection> normals_;
  Delassus delassus_;
  ContactProblem problem_;
  std::vector<double> unmoved_;       // q
  std::vector<double> displacement_;  // d, over all velocities
  std::vector<double> lengths_;       // of the assembly
  std::vector<double> towards_;       // the next d, of the island at hand
  std::vector<double> multipliers_, moved_;
  std::vector<Index> of_island_;               // its bodies, ascending
  std::vector<JointConstraints*> mechanisms_;  // its joints, ascending
};

}  // namespace carom

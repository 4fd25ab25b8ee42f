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
#include <carom/contact/gap_source.h>
#include <carom/contact/island_partition.h>
#include <carom/contact/solvers/contact_problem.h>
#include <carom/contact/solvers/solver_chain.h>
#include <carom/core/constraint.h>
#include <carom/core/export.h>

#include <span>
#include <vector>

namespace carom {

/// Outcome of a separation.
struct Separation {
  bool moved = false;                ///< a body was moved
  double shift = 0.0;                ///< largest displacement of a body, angles weighed by its size [m]
  double depth = 0.0;                ///< gaps of this size are rounding [m]
  const Constraint* left = nullptr;  ///< deepest contact that could not be opened
  /// The contacts of its bodies that had to be open together, it among them. Valid, as `left`, until gaps are
  /// found again.
  std::span<const Constraint> together{};
};

/// Moves bodies apart. Keeps memory only.
class CAROM_API Separator {
public:
  /// Moves the bodies of a source until all its gaps are at most rounding below zero; those that keep a body
  /// from falling back end there, still closed. \param chain solves for the multipliers
  Separation separate(GapSource& gaps, SolverChain& chain);

private:
  void start(GapSource& gaps);
  void look(std::span<const Constraint> together, double& worst, Separation& out) const;
  [[nodiscard]] bool has_moved() const;
  [[nodiscard]] bool has_pushed(const ConstraintKey& key) const;
  void note_pushes(std::span<const Constraint> contacts);
  bool move(GapSource& gaps, std::span<const Constraint> contacts, SolverChain& chain, double depth);

  IslandPartition partition_;
  std::vector<ConstraintKey> pushed_;  // contacts that pushed in the last pass, ascending
  std::vector<ImpulseDirection> normals_;
  Delassus delassus_;
  ContactProblem problem_;
  std::vector<double> displacement_;  // d, over all velocities
  std::vector<double> towards_;       // the next d, of the island at hand
  std::vector<double> multipliers_;
  std::span<const Range> at_hand_;  // velocities of its bodies
};

}  // namespace carom

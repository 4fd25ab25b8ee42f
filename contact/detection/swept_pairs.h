#pragma once

/// \file
/// Pairs that may close on a path: the broad phase of a path. Of two outlines the boxes around all that they
/// sweep overlap, and a bound of the rate of their gap does not exclude that it is zero somewhere.

#include <carom/contact/detection/body_pair_bound.h>
#include <carom/contact/detection/body_pairs.h>
#include <carom/contact/detection/box.h>
#include <carom/contact/detection/broad_phase.h>
#include <carom/contact/detection/chosen_bodies.h>
#include <carom/contact/detection/contact_pair.h>
#include <carom/contact/detection/detector.h>
#include <carom/contact/detection/first_closing.h>
#include <carom/contact/detection/state_path.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint_set.h>
#include <carom/core/export.h>
#include <carom/core/function_ref.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace carom {

/// Two outlines that may come near each other on a path: of two bodies, or of a body and a piece of the
/// ground.
struct NearOutlines {
  Index a = none;      ///< of a body, its number in BodyOutlines
  Index b = none;      ///< of another body; none: a piece
  Index piece = none;  ///< number in GroundPieces
  friend bool operator==(const NearOutlines&, const NearOutlines&) = default;
};

/// A pair that may close on a path.
struct SweptPair {
  ContactPair pair;
  NearOutlines outlines;          ///< of a pair with an outline; of several pieces of one on ground the first
  BodyPairBound bound;            ///< of a pair with an outline
  std::array<Index, 3> bodies{};  ///< those that move it
  Index body_count = 0;
  ConstraintKey key;  ///< of its contact where the path begins
  double gap = 0.0;   ///< there [m]
  /// Bound of the rate of its gap on the path, as long as sharp outlines do not overlap: the gap of a corner
  /// in an outline jumps where another side becomes its own. Infinite: not known [m/s].
  double fastest = 0.0;
  double sixth = 0.0;  ///< of a pair without an outline: ClosingRule::sixth [m/s^6]

  /// The bodies that move it.
  [[nodiscard]] std::span<const Index> moved_by() const { return {bodies.data(), body_count}; }
  /// The pair, with its bounds.
  [[nodiscard]] PairGap gap_of(const Detector& detector) const {
    return {detector, pair, pair.has_outline() ? &bound : nullptr};
  }
};

/// Which pairs without outlines are listed.
enum class FlatPairs : std::uint8_t {
  turning,  ///< points off the centres of mass, with shapes on ground that have no pieces
  all       ///< all points with these, and limits of joints
};

/// Lists the pairs that may close on a path. Of the plane. Keeps memory.
class CAROM_API SweptPairs {
public:
  /// \param assembly,detector must outlive it \param flat which pairs without outlines find_pairs() lists
  SweptPairs(const Assembly& assembly, const Detector& detector, FlatPairs flat);

  /// Boxes around all that the outlines of bodies sweep on a path, by outline. Throws ModelError where a body
  /// is not at a finite place. Valid until the next path.
  /// \param bodies others have boxes of earlier paths
  [[nodiscard]] std::span<const Box<2>> sweep(const StatePath& path, const ChosenBodies& bodies = {});
  /// Lists all outlines whose boxes around what they sweep on a path overlap. Throws ModelError where a body
  /// is not at a finite place. The list is valid until the next call. \param bodies whose outlines are listed
  [[nodiscard]] std::span<const NearOutlines> find_outlines(const StatePath& path,
                                                            const ChosenBodies& bodies = {});
  /// Lists all pairs whose gap may be zero, or less, on the path of the last find_outlines(). The list is
  /// valid until the next call. \param looks false of a pair that is left out
  [[nodiscard]] std::span<const SweptPair> find_pairs(const StatePath& path,
                                                      FunctionRef<bool(const ContactPair&)> looks);

private:
  [[nodiscard]] Box<2> box_of(const StatePath& path, Index outline) const;
  [[nodiscard]] Box<2> box_in(const StatePath& path, Index outline, Index shape) const;
  void place(const StatePath& path, const ChosenBodies& bodies);
  void add(const StatePath& path, const ContactPair& pair, const NearOutlines& outlines);
  /// Points of one body with one shape on ground that has no pieces; or a limit of a joint.
  struct FlatGroup {
    Range pairs;
    double arm = 0.0, reach = 0.0;  // of the points, and with their radius [m]
  };
  void list_flat(const Assembly& assembly, FlatPairs which);
  [[nodiscard]] bool may_close(const StatePath& path, const FlatGroup& group) const;
  [[nodiscard]] double fastest(const StatePath& path, const SweptPair& of) const;
  void bound_point(const StatePath& path, SweptPair& of) const;

  const Detector* detector_;
  BodyPairs between_bodies_;
  BroadPhase<2> broad_;
  std::vector<ContactPair> flat_;  // without outlines
  std::vector<FlatGroup> flat_groups_;
  std::vector<Box<2>> boxes_;                // swept, of all outlines of bodies
  std::array<std::vector<Vec<2>>, 2> ends_;  // vertices of all outlines of bodies at both ends
  std::vector<Index> near_;                  // pieces on ground
  std::vector<NearOutlines> outlines_;
  std::vector<ContactPair> candidates_;
  SingleConstraint contact_;
  std::vector<SweptPair> list_;
};

}  // namespace carom

#pragma once

/// \file
/// All outlines of a model by number: those of bodies come first, those on ground behind them. So do their
/// vertices.

#include <carom/contact/detection/body_outlines.h>
#include <carom/contact/detection/feature_region.h>
#include <carom/contact/detection/ground_pieces.h>
#include <carom/contact/detection/ground_shapes.h>
#include <carom/contact/detection/outline_features.h>
#include <carom/contact/detection/pair_rows.h>
#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/core/state.h>

namespace carom {

/// Outlines of the bodies of an assembly, and of pieces of the shapes on ground, each in its own frame.
class CAROM_API OutlineList {
public:
  /// Throws ModelError where a body's polygon is not convex. \param assembly outlives it \param lengths to
  /// which features are told apart \param between_bodies whether bodies may touch each other: otherwise those
  /// of bodies are listed only where there are pieces on ground
  OutlineList(const Assembly& assembly, const FeatureLengths& lengths, bool between_bodies);

  /// The assembly.
  [[nodiscard]] const Assembly& assembly() const { return *assembly_; }
  /// Bodies in the order of assembly.
  [[nodiscard]] const BodySlots& slots() const { return assembly_->layout()->bodies(); }
  /// Outlines of bodies.
  [[nodiscard]] const BodyOutlines& of_bodies() const { return bodies_; }
  /// Pieces of shapes on ground, and their outlines.
  [[nodiscard]] const GroundPieces& on_ground() const { return pieces_; }
  /// All shapes on ground.
  [[nodiscard]] const GroundShapes& shapes() const { return shapes_; }
  /// True if bodies may touch pieces of the ground.
  [[nodiscard]] bool ground_touches() const { return pieces_.size() != 0 && !bodies_.empty(); }

  /// True of an outline on ground.
  [[nodiscard]] bool is_on_ground(Index outline) const { return outline >= bodies_.list().size(); }
  /// Number among the outlines on ground of one that is there.
  [[nodiscard]] Index on_ground(Index outline) const {
    return outline - static_cast<Index>(bodies_.list().size());
  }
  /// Number of an outline on ground among all.
  [[nodiscard]] Index of_ground(Index on_ground) const {
    return static_cast<Index>(bodies_.list().size()) + on_ground;
  }
  /// Names of an outline and of its vertices. Places of vertices are those among the vertices of bodies, or
  /// of those on ground.
  [[nodiscard]] const OutlineFeatures& features(Index outline) const {
    if (is_on_ground(outline)) return pieces_.outlines()[on_ground(outline)];
    return bodies_.list()[outline];
  }
  /// Outline of a vertex.
  [[nodiscard]] Index outline_of(Index vertex) const {
    const Index on_ground = ground_vertex(vertex);
    return on_ground == none ? bodies_.outline_of(vertex) : of_ground(pieces_.outline_of(on_ground));
  }
  /// Number of a vertex on ground among all vertices.
  [[nodiscard]] Index of_ground_vertex(Index on_ground) const {
    return static_cast<Index>(bodies_.vertices().size()) + on_ground;
  }
  /// Number among the vertices on ground of one that is there; `none` of a vertex of a body.
  [[nodiscard]] Index ground_vertex(Index vertex) const {
    const auto of_bodies = static_cast<Index>(bodies_.vertices().size());
    return vertex < of_bodies ? none : vertex - of_bodies;
  }
  /// An outline as a side of a contact. \param places of all shapes on ground
  [[nodiscard]] PairSide side(Index outline, const StateView& state, const GroundPlaces& places) const;

protected:
  /// Forgets the outlines of bodies: nothing touches them.
  void forget_bodies() { bodies_ = {}; }

private:
  const Assembly* assembly_;
  GroundShapes shapes_;
  GroundPieces pieces_;
  BodyOutlines bodies_;
};

}  // namespace carom

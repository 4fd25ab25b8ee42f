#include <carom/contact/detection/covered_side.h>
#include <carom/contact/detection/covering_ground.h>
#include <carom/contact/detection/outline_pair.h>

namespace carom {

CoveringGround::CoveringGround(const GroundShapes& shapes, const GroundPieces& pieces) {
  for (Index i = 0; i < pieces.outlines().size(); ++i) {
    const GroundOutline& outline = pieces.outlines()[i];
    const bool is_solid = outline.form == GroundPiece::Form::solid && outline.radius == 0.0;
    if (!is_solid || outline.vertices.size() < 3) continue;
    all_.push_back(i);
    if (shapes.moves(outline.shape)) moving_.push_back(i);
  }
}

HiddenSide CoveringGround::side(const SharpCorner& corner, Index shape, const ContactFilter& filter,
                                const GroundPlaces& places, const GroundShapes& shapes,
                                const GroundPieces& pieces) const {
  HiddenSide hidden = HiddenSide::neither;
  for (const Index i : shapes.moves(shape) ? all_ : moving_) {
    const GroundOutline& outline = pieces.outlines()[i];
    if (outline.shape == shape || !may_touch(filter, shapes.filter(outline.shape))) continue;
    const PlaneFrame frame(shapes.motion(outline.shape, places));
    SharpCorner inside = corner;
    inside.at = frame.inside(corner.at);
    const double near = pieces.lengths().corner;
    const Vec<2> below = outline.box.min - inside.at, above = inside.at - outline.box.max;
    if (below.cwiseMax(above).maxCoeff() > near) continue;
    inside.before = frame.inside(corner.before);
    inside.behind = frame.inside(corner.behind);
    hidden = hidden_by_both(hidden, side_covered_by(pieces.view(i), inside, pieces.lengths()));
  }
  return hidden;
}

}  // namespace carom

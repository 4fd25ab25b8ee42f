// Problem: pairs of features of bodies and of ground, and how the two sides of one stand.

#include <carom/contact/detection/covering_ground.h>
#include <carom/contact/detection/outline_pair.h>
#include <carom/contact/detection/piece_contacts.h>

namespace carom {

OutlinePair PieceContacts::outline_pair(const ContactPair& pair, const StateView& state,
                                        const Evaluation& evaluation, const GroundPlaces& places) const {
  const PlaneFrame of_body(assembly_->layout()->bodies()[pair.body], state, evaluation),
      of_ground(shapes_.motion(pair.ground_shape, places));
  OutlinePair out;
  out.lengths = pieces_.lengths();
  if (pair.ground_outline != none) {
    out.vertex_frame = of_body;
    out.outline_frame = of_ground;
    out.vertex = outlines_.vertices()[pair.feature];
    out.around = outlines_.described(outlines_.list()[outlines_.outline_of(pair.feature)]);
    out.outline = pieces_.view(pair.ground_outline);
    out.is_hollow = pieces_.outlines()[pair.ground_outline].is_hollow();
    if (pieces_.outlines()[pair.ground_outline].is_chain()) out.chain = pieces_.chain(pair.ground_outline);
  } else {
    const GroundOutline& on_ground = pieces_.outlines()[pieces_.outline_of(pair.ground_vertex)];
    out.vertex_frame = of_ground;
    out.outline_frame = of_body;
    out.vertex = pieces_.vertices()[pair.ground_vertex];
    out.around = {pieces_.around(pair.ground_vertex), on_ground.radius};
    out.outline = outlines_.described(outlines_.list()[pair.outline]);
  }
  const auto corners = corners_that_meet(out);
  if (!corners) return out;
  const bool is_outline = pair.ground_outline != none;
  const BodyOutline& body = outlines_.list()[is_outline ? outlines_.outline_of(pair.feature) : pair.outline];
  const SharpCorner& corner = is_outline ? corners->of_outline : corners->of_vertex;
  (is_outline ? out.hidden : out.hidden_of_vertex) =
      covering_.side(corner, pair.ground_shape, body.filter, places, shapes_, pieces_);
  return out;
}

/// Each vertex of a body against each outline on ground; and, where the body has edges or is a point, each
/// corner of the ground against each outline of the body. Of two round ends one is enough.
void PieceContacts::append_pairs(Index component, std::vector<ContactPair>& out) const {
  const Range bodies = assembly_->bodies_of({component, component + 1});
  for (Index i = begin_[bodies.begin]; i < begin_[bodies.end]; ++i) {
    const BodyOutline& a = outlines_.list()[i];
    for (Index on_ground = 0; on_ground < pieces_.outlines().size(); ++on_ground) {
      const GroundOutline& b = pieces_.outlines()[on_ground];
      if (!may_touch(a, b)) continue;
      const ContactPair pair{.body = a.body, .ground_shape = b.shape};
      const bool is_peg = b.form == GroundPiece::Form::solid && b.vertices.size() == 1;
      for (Index vertex = a.vertices.begin; vertex < a.vertices.end; ++vertex) {
        if (is_peg && a.vertices.size() > 1) break;
        out.push_back(pair);
        out.back().feature = vertex;
        out.back().ground_outline = on_ground;
      }
      const bool point_at_corners = a.is_point() && b.radius == 0.0 && !is_peg;
      if ((a.vertices.size() == 1 && !point_at_corners) || b.is_hollow()) continue;
      for (Index vertex = b.vertices.begin; vertex < b.vertices.end; ++vertex) {
        if (!pieces_.is_corner(vertex)) continue;
        out.push_back(pair);
        out.back().outline = i;
        out.back().ground_vertex = vertex;
      }
    }
  }
}

}  // namespace carom

#include <carom/bodies/shape_polygon.h>
#include <carom/contact/detection/ground_solids.h>

namespace carom::planar {

std::vector<GroundPiece> Wall::pieces(const PartCheck& check) const {
  check.finite({from.data(), 2}, "from", "m");
  check.finite({to.data(), 2}, "to", "m");
  check.non_negative(radius, "radius", "m");
  if (from == to) check.refuse("to", "the same point as from", "another point");
  return {{.form = GroundPiece::Form::solid, .points = {from, to}, .radius = radius}};
}

std::vector<GroundPiece> Block::pieces(const PartCheck& check) const {
  const Polygon polygon{.vertices = vertices, .radius = radius};
  polygon.check(check);
  return {{.form = GroundPiece::Form::solid, .points = polygon.outline(check).vertices, .radius = radius}};
}

std::vector<GroundPiece> Peg::pieces(const PartCheck& check) const {
  check.finite({centre.data(), 2}, "centre", "m");
  check.positive(radius, "radius", "m");
  return {{.form = GroundPiece::Form::solid, .points = {centre}, .radius = radius}};
}

}  // namespace carom::planar

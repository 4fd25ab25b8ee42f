#include <carom/contact/detection/corner_meeting.h>
#include <carom/contact/detection/gap_vertex_edge.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace carom {

namespace {

// Directions that differ by less are one: rows that say the same, but for rounding of what they lead to
// [rad].
constexpr double one_direction = 1e-6;

double turn_between(const Vec<2>& a, const Vec<2>& b) { return a[0] * b[1] - a[1] * b[0]; }

/// Outward normals of the two edges at a corner.
struct CornerNormals {
  Vec<2> before, behind;
  bool exist = false;

  explicit CornerNormals(const SharpCorner& of) {
    const std::array<Vec<2>, 3> chain{of.before, of.at, of.behind};
    const OutlineEdge in({std::span(chain).first(2), 0.0}, 0), out({std::span(chain).last(2), 0.0}, 0);
    before = in.normal();
    behind = out.normal();
    exist = in.length > 0.0 && out.length > 0.0;
  }
};

/// True if a direction is one of those from one direction counter-clockwise to another.
bool is_from_to(const Vec<2>& from, const Vec<2>& direction, const Vec<2>& to) {
  constexpr double rounding = 1e-12;  // two directions that coincide are both between each other
  return turn_between(from, direction) >= -rounding && turn_between(direction, to) >= -rounding &&
         direction.dot(from + to) >= -rounding;
}

/// Edge of a corner, from its vertex on or up to it, as an outline of two vertices.
std::array<Vec<2>, 2> edge_of(const SharpCorner& corner, bool is_behind) {
  if (is_behind) return {corner.at, corner.behind};
  return {corner.before, corner.at};
}

}  // namespace

std::optional<CommonCone> common_cone(const SharpCorner& a, const SharpCorner& b) {
  if (a.hidden != HiddenSide::neither || b.hidden != HiddenSide::neither) return {};
  const CornerNormals of_a(a), of_b(b);
  if ((!a.is_point && !of_a.exist) || (!b.is_point && !of_b.exist) || (a.is_point && b.is_point)) return {};
  const ConeEnd a_lower{-of_a.before, true, false}, a_upper{-of_a.behind, true, true};
  const ConeEnd b_lower{of_b.before, false, false}, b_upper{of_b.behind, false, true};
  const auto is_of_a = [&](const ConeEnd& end) {
    return a.is_point || is_from_to(a_lower.normal, end.normal, a_upper.normal);
  };
  const auto is_of_b = [&](const ConeEnd& end) {
    return b.is_point || is_from_to(b_lower.normal, end.normal, b_upper.normal);
  };
  CommonCone cone;
  if (!b.is_point && is_of_a(b_lower)) {
    cone.lower = b_lower;
  } else if (!a.is_point && is_of_b(a_lower)) {
    cone.lower = a_lower;
  } else {
    return {};
  }
  if (!b.is_point && is_of_a(b_upper)) {
    cone.upper = b_upper;
  } else if (!a.is_point && is_of_b(a_upper)) {
    cone.upper = a_upper;
  } else {
    return {};
  }
  if (turn_between(cone.lower.normal, cone.upper.normal) <= one_direction) return {};
  return cone;
}

GapPoint gap_along(const ConeEnd& end, const SharpCorner& a, const SharpCorner& b) {
  const SharpCorner &of_edge = end.is_of_a ? a : b, &other = end.is_of_a ? b : a;
  const std::array<Vec<2>, 2> edge = edge_of(of_edge, end.is_behind);
  const ConvexOutline corner{{&other.at, 1}, 0.0};
  GapPoint gap = gap_of_edge_of_a({edge, 0.0}, 0, corner, 0);
  gap.feature_a = end.is_behind ? of_edge.edge_behind : of_edge.edge_before;
  gap.feature_b = other.vertex;
  return end.is_of_a ? gap : gap.swapped();
}

namespace {

/// True if corners of which neither stands beyond the edge that the other one touches meet.
bool do_meet(const GapPoint& first, const GapPoint& second, const CornerMeeting& meeting) {
  // Corners that touched along both ends drift apart by little in a step; one that slides past the other
  // along an edge is deep behind the other edge, which is not to push it.
  constexpr double drift = 1e4;  // places that count as one
  if (meeting.lasts && std::abs(first.gap - second.gap) <= drift * meeting.same_place) return true;
  if (std::min(first.within, second.within) < -meeting.same_place) return false;
  if (std::abs(first.gap - second.gap) <= meeting.same_place) return true;
  // Back along the way that it came, the corner stood in the place of the other one; it did not slide there
  // along an edge.
  constexpr double slides = 1e-3;  // part of a speed that is none across an edge
  const Vec<2>& v = meeting.velocity;
  const double speed = v.norm();
  const bool closes = std::max(first.normal.dot(v), second.normal.dot(v)) < -slides * speed;
  return closes && std::abs(turn_between(meeting.a.at - meeting.b.at, v)) <= meeting.same_place * speed;
}

/// The edge that goes on in a neighbour, at a corner that has a hidden side.
ConeEnd open_end(const SharpCorner& corner, bool is_of_a) {
  const bool is_behind = corner.hidden == HiddenSide::before;
  const CornerNormals normals(corner);
  const Vec<2>& outwards = is_behind ? normals.behind : normals.before;
  return {is_of_a ? Vec<2>(-outwards) : outwards, is_of_a, is_behind};
}

}  // namespace

bool leave_hidden_side(GapPoint& contact, const CornerMeeting& meeting) {
  const SharpCorner &a = meeting.a, &b = meeting.b;
  const bool is_of_a = b.hidden == HiddenSide::neither;
  if ((is_of_a && a.hidden == HiddenSide::neither) || contact.gap > meeting.same_place) return true;
  if (a.hidden == HiddenSide::both || b.hidden == HiddenSide::both) return false;
  const auto is_along = [](const Vec<2>& one, const Vec<2>& other) {
    return std::abs(turn_between(one, other)) <= one_direction && one.dot(other) > 0.0;
  };
  const ConeEnd open = open_end(is_of_a ? a : b, is_of_a);
  if (!is_of_a && a.hidden != HiddenSide::neither && !is_along(open_end(a, true).normal, open.normal))
    return false;
  if (is_along(contact.normal, open.normal)) return true;
  contact = gap_along(open, a, b);
  return contact.within >= -meeting.same_place;
}

std::optional<GapPoint> second_contact(GapPoint& first, const CornerMeeting& meeting) {
  const SharpCorner &a = meeting.a, &b = meeting.b;
  const std::optional<CommonCone> cone = common_cone(a, b);
  if (!cone) return {};
  const auto is_first = [&](const ConeEnd& end) {
    const Index edge = end.is_of_a ? first.feature_a : first.feature_b;
    const SharpCorner& of = end.is_of_a ? a : b;
    return end.is_of_a == (first.kind == GapKind::edge_of_a) &&
           edge == (end.is_behind ? of.edge_behind : of.edge_before);
  };
  const bool of_corners = first.kind == GapKind::vertices;
  if (of_corners && !meeting.lasts && first.gap > meeting.same_place) return {};
  const bool is_lower = of_corners || is_first(cone->lower);
  if (!is_lower && !is_first(cone->upper)) return {};
  if (of_corners) first = gap_along(cone->lower, a, b);
  GapPoint second = gap_along(is_lower ? cone->upper : cone->lower, a, b);
  if (!of_corners && !do_meet(first, second, meeting)) return {};
  if (!cone->is_of_one()) return second;
  const bool lower_first = is_lower ? is_lower_first(first, second, meeting.same_place)
                                    : is_lower_first(second, first, meeting.same_place);
  if (lower_first != is_lower) std::swap(first, second);
  second.feature_a = a.vertex;
  second.feature_b = b.vertex;
  return second;
}

std::optional<GapPoint> along_other_face(const GapPoint& contact, const CornerMeeting& meeting) {
  const SharpCorner &a = meeting.a, &b = meeting.b;
  const bool is_other_of_a = contact.kind == GapKind::edge_of_b;
  const CornerNormals normals(is_other_of_a ? a : b);
  if (contact.kind == GapKind::vertices || !normals.exist) return {};
  const Vec<2> outwards = is_other_of_a ? Vec<2>(-contact.normal) : contact.normal;  // of what has the face
  constexpr double cosine_of_parallel = 0.9;
  for (const bool is_behind : {false, true}) {
    const Vec<2>& face = is_behind ? normals.behind : normals.before;
    if (face.dot(outwards) < cosine_of_parallel) continue;
    if (std::abs(turn_between(face, outwards)) <= one_direction) continue;
    const GapPoint other = gap_along({outwards, is_other_of_a, is_behind}, a, b);
    if (std::abs(other.gap - contact.gap) <= meeting.same_place) return other;
  }
  return {};
}

}  // namespace carom

// Faces of polylines on ground: they are the ground that they are part of, and nothing snags where they join.

#include <carom/contact/detection/gap_face.h>
#include <carom/contact/detection/narrow_phase.h>

#include "tests/contact/detection/convex_reference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace {

using namespace carom;
using carom_test::OwnedOutline;
using carom_test::Random;
using carom_test::random_outline;

using Gaps = std::array<GapPoint, 2>;
constexpr double tolerance = 2e-14;

struct FaceContact {
  std::size_t face;
  GapPoint at;
};

// Faces along vertices, free space on the left of who walks along them; of a closed line on the outside if it
// is clockwise.
std::vector<GroundFace> faces_along(const std::vector<Vec<2>>& vertices, bool is_closed, double depth) {
  const std::size_t n = vertices.size(), count = is_closed ? n : n - 1;
  std::vector<GroundFace> faces;
  for (std::size_t i = 0; i < count; ++i) {
    faces.push_back({vertices[(i + 2) % n], vertices[(i + 1) % n], vertices[i], vertices[(i + n - 1) % n],
                     !is_closed && i + 1 == count, !is_closed && i == 0, depth});
  }
  return faces;
}

std::vector<FaceContact> find(const OwnedOutline& a, const std::vector<GroundFace>& faces, double margin) {
  std::vector<FaceContact> out;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    Gaps found;
    const int count = find_gaps(PlacedOutline(a.view()), PlacedOutline(faces[i]), margin, found);
    for (int k = 0; k < count; ++k) out.push_back({i, found[static_cast<std::size_t>(k)]});
  }
  return out;
}

double least_gap(const std::vector<FaceContact>& contacts) {
  double least = std::numeric_limits<double>::infinity();
  for (const FaceContact& contact : contacts) least = std::min(least, contact.at.gap);
  return least;
}

OwnedOutline box(double x, double y, double half_width, double half_height) {
  return {{{x - half_width, y - half_height},
           {x + half_width, y - half_height},
           {x + half_width, y + half_height},
           {x - half_width, y + half_height}},
          0.0};
}

TEST(GapFace, FacesOfAHillAreTheHill) {
  Random random(21);
  int overlapping = 0, with_two = 0;
  for (int i = 0; i < 20000 && !HasFailure(); ++i) {
    SCOPED_TRACE(i);
    OwnedOutline hill = random_outline(random);
    if (hill.vertices.size() < 3) continue;
    hill.radius = 0.0;
    for (Vec<2>& vertex : hill.vertices) vertex *= 3.0;
    const std::vector<Vec<2>> clockwise(hill.vertices.rbegin(), hill.vertices.rend());
    const std::vector<GroundFace> faces = faces_along(clockwise, true, 0.2);
    OwnedOutline a = random_outline(random).moved(0.0, random.vec<2>(5.0));
    Gaps expected;
    constexpr double far = 100.0, margin = 0.1;
    ASSERT_GE(find_gaps(a.view(), hill.view(), far, expected), 1);
    // To a distance at which the cores overlap a little, or not.
    const double wanted = random.uniform(random.below(2) == 0 ? -0.05 : -0.002, 0.02) - a.radius;
    a = a.moved(0.0, (wanted - expected[0].gap) * expected[0].normal);
    const int count = find_gaps(a.view(), hill.view(), margin, expected);
    if (count == 0 || expected[0].gap + a.radius < -0.1) continue;
    const auto contacts = find(a, faces, margin);
    ASSERT_FALSE(contacts.empty());
    // Of an overlap the least one is among those of the faces; of a distance it is the least of them.
    if (expected[0].gap + a.radius > 0.0) {
      EXPECT_NEAR(least_gap(contacts), expected[0].gap, tolerance);
    }
    // Each of them is among those of the faces, but a second one at a large angle, or in an overlap, which a
    // neighbour may stand for; of a bar across the ground either one.
    const double core = expected[0].gap + a.radius;
    const bool is_flat = count == 2 && expected[0].normal.dot(expected[1].normal) > 0.99 && core > 0.0;
    const bool is_bar_across = a.vertices.size() == 2 && core < 0.0;
    const auto is_found = [&](const GapPoint& at) {
      return std::any_of(contacts.begin(), contacts.end(), [&](const FaceContact& contact) {
        return std::abs(contact.at.gap - at.gap) <= tolerance &&
               (contact.at.point_a - at.point_a).norm() <= 1e-12;
      });
    };
    EXPECT_TRUE(is_found(expected[0]) || (is_bar_across && count == 2 && is_found(expected[1])));
    if (is_flat) {
      EXPECT_TRUE(is_found(expected[1]));
    }
    overlapping += expected[0].gap + a.radius < 0.0 ? 1 : 0;
    with_two += is_flat ? 1 : 0;
  }
  EXPECT_GT(overlapping, 1000);
  EXPECT_GT(with_two, 200);
}

TEST(GapFace, AboveTerrainTheGapIsTheDistance) {
  Random random(22);
  int compared = 0;
  for (int i = 0; i < 5000 && !HasFailure(); ++i) {
    SCOPED_TRACE(i);
    std::vector<Vec<2>> line;
    for (int k = 0; k < 12; ++k)
      line.push_back({k - 6.0 + random.uniform(-0.3, 0.3), random.uniform(-0.5, 0.5)});
    const OwnedOutline a = random_outline(random).moved(0.0, {random.uniform(-2, 2), random.uniform(0.5, 3)});
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k + 1 < line.size(); ++k) {
      const OwnedOutline segment{{line[k], line[k + 1]}, 0.0};
      Gaps found;
      ASSERT_GE(find_gaps(a.view(), segment.view(), 100.0, found), 1);
      least = std::min(least, found[0].gap);
    }
    const bool is_above =
        std::all_of(a.vertices.begin(), a.vertices.end(), [](const Vec<2>& v) { return v[1] > 0.5; });
    const bool is_free = least + a.radius > 1e-6 && (is_above || least + a.radius > 0.0);
    if (!is_free || !is_above) continue;
    ++compared;
    const auto contacts = find(a, faces_along(line, false, 0.1), 10.0);
    ASSERT_FALSE(contacts.empty());
    EXPECT_NEAR(least_gap(contacts), least, tolerance);
  }
  EXPECT_GT(compared, 2000);
}

// A box that lies across the joints of faces in one line touches with its two corners, each once, upwards.
TEST(GapFace, NothingSnagsWhereFacesJoinInALine) {
  Random random(23);
  for (int i = 0; i < 3000 && !HasFailure(); ++i) {
    SCOPED_TRACE(i);
    const double angle = i % 3 == 0 ? 0.0 : random.uniform(-3.0, 3.0);
    std::vector<Vec<2>> line;
    double x = -2.0;
    for (int k = 0; k < 40; ++k, x += random.uniform(0.05, 0.3)) line.push_back({x, 0.0});
    const double depth = i % 2 == 0 ? 1e-6 : 0.0;
    double at = random.uniform(-1.0, 1.0);
    if (i % 5 == 0) at = line[14][0] + 0.5;  // a corner exactly on a joint
    const OwnedOutline turned = OwnedOutline{line, 0.0}.moved(angle, Vec<2>::Zero());
    const auto contacts = find(box(at, 0.25 - depth, 0.5, 0.25).moved(angle, Vec<2>::Zero()),
                               faces_along(turned.vertices, false, 0.1), 1e-9);
    ASSERT_EQ(contacts.size(), 2U);
    const Vec<2> up(-std::sin(angle), std::cos(angle));
    EXPECT_NE(contacts[0].at.feature_a, contacts[1].at.feature_a);
    for (const FaceContact& contact : contacts) {
      EXPECT_LE(contact.at.feature_a, 1U);
      EXPECT_EQ(contact.at.feature_b, 2U);
      EXPECT_NEAR(contact.at.gap, -depth, 2e-15);
      EXPECT_LE((contact.at.normal - up).norm(), 1e-14);
    }
  }
}

// Over the corners of rough ground a disc's normals are never outside those of the two faces, and it always
// touches.
TEST(GapFace, NormalsAtCornersLieBetweenThoseOfTheFaces) {
  Random random(24);
  std::vector<Vec<2>> line;
  for (int k = 0; k < 30; ++k) line.push_back({k - 15.0, 0.3 * std::sin(0.9 * k)});
  const auto faces = faces_along(line, false, 0.1);
  int at_corners = 0;
  for (int i = 0; i < 20000 && !HasFailure(); ++i) {
    const OwnedOutline disc{{{random.uniform(-10.0, 10.0), random.uniform(0.5, 1.2)}}, 0.5};
    for (const FaceContact& contact : find(disc, faces, 0.1)) {
      const auto normal = [&](std::size_t face) {
        const Vec<2> along = (faces[face].head - faces[face].tail).normalized();
        return Vec<2>(along[1], -along[0]);
      };
      const Vec<2> own = normal(contact.face), &n = contact.at.normal;
      if (contact.at.kind == GapKind::edge_of_b) {
        EXPECT_LE((n - own).norm(), 1e-15);
        continue;
      }
      ++at_corners;
      EXPECT_EQ(contact.at.feature_b, 1U);
      const Vec<2> next = normal(contact.face - 1);  // faces run against the line
      EXPECT_GE(own[0] * n[1] - own[1] * n[0], -1e-14);
      EXPECT_GE(n[0] * next[1] - n[1] * next[0], -1e-8);
    }
  }
  EXPECT_GT(at_corners, 200);
}

TEST(GapFace, ABoxOverhangingAnEdgeTouchesAtTheEdge) {
  const auto faces = faces_along({{-3, 0}, {0, 0}, {1, -2}}, false, 0.5);
  for (const double depth : {0.0, 0.01}) {
    const auto contacts = find(box(-0.2, 0.5 - depth, 1.0, 0.5), faces, 1e-9);
    ASSERT_EQ(contacts.size(), 2U);
    for (const FaceContact& contact : contacts) {
      EXPECT_NEAR(contact.at.gap, -depth, 1e-15);
      EXPECT_EQ(contact.at.normal, Vec<2>(0, 1));
      const double x = contact.at.kind == GapKind::edge_of_a ? 0.0 : -1.2;
      EXPECT_NEAR(contact.at.point_b[0], x, 1e-15);
    }
    EXPECT_NE(contacts[0].at.kind, contacts[1].at.kind);
  }
}

TEST(GapFace, InAnInnerCornerBothFacesTouch) {
  const auto faces = faces_along({{-3, 0}, {0, 0}, {0, 3}}, false, 1.0);
  for (const double depth : {-0.01, 0.0, 0.01, 0.3}) {  // the centre of a disc, and a corner
    const OwnedOutline disc{{{-0.25 + depth, 0.25 - 0.5 * depth}}, 0.25};
    auto contacts = find(disc, faces, 0.02);
    ASSERT_EQ(contacts.size(), 2U) << depth;
    EXPECT_NEAR(contacts[0].at.gap, -0.5 * depth, 1e-15);
    EXPECT_NEAR(contacts[1].at.gap, -depth, 1e-15);
    EXPECT_EQ(contacts[1].at.normal, Vec<2>(-1, 0));
    contacts = find(box(-0.5 + depth, 0.25 - 0.5 * depth, 0.5, 0.25), faces, 0.02);
    ASSERT_EQ(contacts.size(), 4U) << depth;
  }
}

TEST(GapFace, EndsOfOpenGroundAreRound) {
  const auto faces = faces_along({{-3, 0}, {0, 0}}, false, 0.5);
  const auto contacts = find(OwnedOutline{{{0.3, 0.4}}, 0.25}, faces, 0.3);
  ASSERT_EQ(contacts.size(), 1U);
  EXPECT_NEAR(contacts[0].at.gap, 0.25, 1e-15);
  EXPECT_LE((contacts[0].at.normal - Vec<2>(0.6, 0.8)).norm(), 1e-15);
  EXPECT_TRUE(find(OwnedOutline{{{0.3, -0.1}}, 0.25}, faces, 0.3).empty());
  EXPECT_EQ(find(OwnedOutline{{{-3.3, 0.4}}, 0.25}, faces, 0.3).size(), 1U);
}

TEST(GapFace, WhatIsTooDeepDoesNotTouch) {
  const auto faces = faces_along({{-3, 0}, {3, 0}}, false, 0.5);
  EXPECT_EQ(find(OwnedOutline{{{0, -0.49}}, 0.0}, faces, 0.0).size(), 1U);
  EXPECT_TRUE(find(OwnedOutline{{{0, -0.51}}, 0.0}, faces, 0.0).empty());
  EXPECT_TRUE(find(box(0, -2, 0.5, 0.5), faces, 0.0).empty());
}

}  // namespace

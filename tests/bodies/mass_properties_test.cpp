#include <carom/bodies/mass_properties.h>
#include <carom/core/part_check.h>

#include "tests/model_error.h"
#include "tests/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

void expect_equal(const MassProperties<2>& a, const MassProperties<2>& b, double relative) {
  const double length = std::sqrt(b.inertia / b.mass);
  EXPECT_NEAR(a.mass, b.mass, relative * b.mass);
  EXPECT_NEAR(a.inertia, b.inertia, relative * b.inertia);
  EXPECT_LE((a.centre - b.centre).norm(), relative * (length + b.centre.norm()));
}

std::vector<Vec<2>> moved(std::vector<Vec<2>> points, double angle, const Vec<2>& offset) {
  const double c = std::cos(angle), s = std::sin(angle);
  for (Vec<2>& p : points) p = Vec<2>(c * p[0] - s * p[1], s * p[0] + c * p[1]) + offset;
  return points;
}

std::vector<Vec<2>> rectangle(double width, double height) {
  return {
      {-width / 2, -height / 2}, {width / 2, -height / 2}, {width / 2, height / 2}, {-width / 2, height / 2}};
}

TEST(MassProperties, NothingIsGivenUnlessMade) {
  const MassProperties<2> nothing;
  EXPECT_TRUE(std::isnan(nothing.mass));
  EXPECT_TRUE(std::isnan(nothing.inertia));
}

TEST(MassProperties, ClosedForms) {
  EXPECT_DOUBLE_EQ(disc(3.0, 2.0).inertia, 6.0);
  EXPECT_DOUBLE_EQ(ring(3.0, 2.0).inertia, 12.0);
  EXPECT_DOUBLE_EQ(solid_sphere(3.0, 2.0).inertia, 4.8);
  EXPECT_DOUBLE_EQ(thin_shell(3.0, 2.0).inertia, 8.0);
  EXPECT_DOUBLE_EQ(rod(3.0, 2.0).inertia, 1.0);
  EXPECT_DOUBLE_EQ(box(6.0, 2.0, 4.0).inertia, 10.0);
  for (const MassProperties<2>& made : {disc(3.0, 2.0), ring(3.0, 2.0), solid_sphere(3.0, 2.0),
                                        thin_shell(3.0, 2.0), rod(3.0, 2.0), box(3.0, 2.0, 4.0)}) {
    EXPECT_EQ(made.mass, 3.0);
    EXPECT_EQ(made.centre, Vec<2>(0.0, 0.0));
  }
}

TEST(MassProperties, SpheresAreStacksOfDiscsAndRings) {
  // Slices of a sphere of radius 1 at heights z: discs (rings) of radius sqrt(1 - z^2). Midpoint rule over
  // z, exact for the cubic at most integrand of the shell; error 1 / (24 n^2) of the sphere's.
  constexpr int count = 1000;
  std::vector<MassProperties<2>> discs, rings;
  for (int i = 0; i < count; ++i) {
    const double z = (2.0 * i + 1.0) / count - 1.0;
    const double radius = std::sqrt(1.0 - z * z);
    discs.push_back(disc(0.75 * radius * radius * 2.0 / count, radius));
    rings.push_back(ring(1.0 / count, radius));  // bands of equal height have equal areas
  }
  EXPECT_NEAR(compose(discs).inertia, solid_sphere(1.0, 1.0).inertia, 1e-6);
  EXPECT_NEAR(compose(rings).inertia, thin_shell(1.0, 1.0).inertia, 1e-6);
}

TEST(MassProperties, RefuseImpossibleMassesAndSizes) {
  struct Maker {
    std::string name, size;
    std::function<MassProperties<2>(double, double)> make;
  };
  const std::vector<Maker> makers{
      {"disc", "radius", disc},
      {"ring", "radius", ring},
      {"solid_sphere", "radius", solid_sphere},
      {"thin_shell", "radius", thin_shell},
      {"rod", "length", rod},
      {"box", "width", [](double mass, double size) { return box(mass, size, 1.0); }},
      {"box", "height", [](double mass, double size) { return box(mass, 1.0, size); }},
  };
  for (const Maker& maker : makers) {
    for (const double bad : {0.0, -2.0, nan, infinity, -infinity}) {
      EXPECT_MODEL_ERROR(maker.make(bad, 1.0), maker.name + ": mass is " + to_text(bad) + " kg",
                         "finite and > 0");
      EXPECT_MODEL_ERROR(maker.make(1.0, bad), maker.name + ": " + maker.size + " is " + to_text(bad) + " m",
                         "finite and > 0");
    }
    EXPECT_MODEL_ERROR(maker.make(1.0, 1e200), maker.name + ": " + maker.size + " is 1e+200 m",
                       "a magnitude up to 1e+150");
    EXPECT_MODEL_ERROR(maker.make(1.0, 1e100), maker.name + ": moment of inertia is ", "up to 1e+150");
  }
  EXPECT_MODEL_ERROR(disc(1.0, 1e-200), "disc: moment of inertia is 0 kg m^2", "> 0");
  EXPECT_MODEL_ERROR(point_mass(-1.0), "point_mass: mass is -1 kg");
}

TEST(Polygon, TriangleHasItsClosedForm) {
  // Right triangle with legs a, b: centroid (a/3, b/3), I = m (a^2 + b^2) / 18.
  const MassProperties<2> triangle = polygon(2.0, {{0, 0}, {3, 0}, {0, 6}});
  expect_equal(triangle, {.mass = 2.0, .inertia = 5.0, .centre = {1.0, 2.0}}, 4 * epsilon);
}

TEST(Polygon, RectangleIsABoxWhereverItIsAndHoweverItIsTurned) {
  carom_test::Random random(51);
  for (int repeat = 0; repeat < 200; ++repeat) {
    const double width = random.uniform(0.1, 3.0), height = random.uniform(0.1, 3.0);
    const Vec<2> offset = random.vec<2>(5.0);
    std::vector<Vec<2>> points = moved(rectangle(width, height), random.uniform(-3.0, 3.0), offset);
    MassProperties<2> expected = box(1.5, width, height);
    expected.centre = offset;
    // The vertices are rounded at the size of the offset, 5 * sqrt(2), against sides down to 0.1.
    constexpr double rounding = 7.1 / 0.1 * 8 * epsilon;
    expect_equal(polygon(1.5, points), expected, rounding);
    std::reverse(points.begin(), points.end());
    expect_equal(polygon(1.5, points), expected, rounding);
    std::rotate(points.begin(), points.begin() + 1, points.end());
    expect_equal(polygon(1.5, points), expected, rounding);
  }
}

TEST(Polygon, RegularOneTendsToADiscByItsClosedForm) {
  for (const int count : {3, 4, 5, 12, 1000}) {
    std::vector<Vec<2>> points;
    for (int i = 0; i < count; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / count;
      points.emplace_back(2.0 * std::cos(angle), 2.0 * std::sin(angle));
    }
    // I = m r^2 / 6 (1 + 2 cos^2(pi/n)).
    const double c = std::cos(std::numbers::pi / count);
    const MassProperties<2> made = polygon(3.0, points);
    EXPECT_NEAR(made.inertia, 3.0 * 4.0 / 6.0 * (1.0 + 2.0 * c * c),
                6.0 * 4 * epsilon * std::sqrt(count) * 4);
    EXPECT_LE(made.centre.norm(), 2.0 * 16 * epsilon);
  }
}

TEST(Polygon, FarFromTheOriginLosesNothing) {
  const Vec<2> far(1048576.0, -524288.0);  // powers of two: the vertices stay exact
  const std::vector<Vec<2>> points{{0, 0}, {2, 0.5}, {1.25, 3}, {-0.75, 2}};
  const MassProperties<2> here = polygon(1.0, points), there = polygon(1.0, moved(points, 0.0, far));
  EXPECT_EQ(here.inertia, there.inertia);
  EXPECT_LE((there.centre - far - here.centre).norm(), 2.0 * epsilon * far.norm());
}

TEST(Polygon, SliverIsARod) {
  // A billionth as wide as long, along a diagonal.
  const std::vector<Vec<2>> points{{0, 0}, {1, 1}, {1 - 0x1p-30, 1 + 0x1p-30}, {-0x1p-30, 0x1p-30}};
  MassProperties<2> expected = box(1.0, std::sqrt(2.0), 0x1p-30 * std::sqrt(2.0));
  expected.centre = {0.5 - 0x1p-31, 0.5 + 0x1p-31};
  expect_equal(polygon(1.0, points), expected, 8 * epsilon);
}

TEST(Polygon, LShapeIsTwoBoxes) {
  const MassProperties<2> whole = polygon(5.0, {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}});
  const MassProperties<2> parts =
      compose({shifted(box(3.0, 3.0, 1.0), {1.5, 0.5}), shifted(box(2.0, 1.0, 2.0), {0.5, 2.0})});
  expect_equal(whole, parts, 8 * epsilon);
  EXPECT_GT(whole.centre[0], 0.0);
}

TEST(Polygon, NotConvexOneIsItsTriangles) {
  // A star of random radii: the triangles to the origin make it, though it is seen from its first vertex.
  carom_test::Random random(52);
  for (int repeat = 0; repeat < 100; ++repeat) {
    const int count = 5 + static_cast<int>(random.below(20));
    std::vector<Vec<2>> points;
    for (int i = 0; i < count; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / count, radius = random.uniform(0.1, 2.0);
      points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    std::vector<MassProperties<2>> triangles;
    double area = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec<2>& a = points[i];
      const Vec<2>& b = points[(i + 1) % points.size()];
      const double part = (a[0] * b[1] - a[1] * b[0]) / 2.0;
      triangles.push_back(polygon(part, {{0, 0}, a, b}));
      area += part;
    }
    expect_equal(polygon(area, points), compose(triangles), 1e3 * epsilon);
  }
}

TEST(Polygon, RepeatedVerticesChangeNothing) {
  const MassProperties<2> once = polygon(1.0, {{0, 0}, {2, 0}, {2, 1}});
  expect_equal(polygon(1.0, {{0, 0}, {2, 0}, {2, 0}, {2, 1}, {0, 0}}), once, 4 * epsilon);
}

TEST(Polygon, RefusesWhatIsNone) {
  EXPECT_MODEL_ERROR(polygon(1.0, {}), "polygon: number of vertices is 0", "at least 3");
  EXPECT_MODEL_ERROR(polygon(1.0, {{0, 0}, {1, 0}}), "polygon: number of vertices is 2", "at least 3");
  EXPECT_MODEL_ERROR(polygon(0.0, rectangle(1, 1)), "polygon: mass is 0 kg", "finite and > 0");
  EXPECT_MODEL_ERROR(polygon(1.0, {{0, 0}, {1, 0}, {0, nan}}), "polygon: vertex 2 is (0, nan) m", "finite");
  EXPECT_MODEL_ERROR(polygon(1.0, {{infinity, 0}, {1, 0}, {0, 1}}), "polygon: vertex 0 is (inf, 0) m");
  EXPECT_MODEL_ERROR(polygon(1.0, {{0, 0}, {1, 1}, {3, 3}}), "polygon: area is 0 m^2", "above rounding");
  EXPECT_MODEL_ERROR(polygon(1.0, {{1, 2}, {1, 2}, {1, 2}}), "polygon: area is 0 m^2");
  EXPECT_MODEL_ERROR(polygon(1.0, {{0, 0}, {0.1, 0.1}, {0.3, 0.3}}), "polygon: area is", "above rounding");
  EXPECT_MODEL_ERROR(polygon(1.0, {{0, 0}, {1e200, 0}, {0, 1e200}}), "polygon: vertex 1 is (1e+200, 0) m",
                     "a magnitude up to 1e+150");
  EXPECT_MODEL_ERROR(polygon(1.0, {{0, 0}, {1e100, 0}, {0, 1e100}}), "polygon: moment of inertia is");
  // A bow tie, whose area is not zero.
  EXPECT_MODEL_ERROR(polygon(1.0, {{0, 0}, {2, 2}, {2, 0}, {0, 1}}), "polygon: outline is crossing itself",
                     "sides 0 and 2", "a simple polygon");
}

TEST(Compose, TwoBoxesAreABigBox) {
  const MassProperties<2> whole =
      compose({shifted(box(1.0, 1.0, 2.0), {-0.5, 7.0}), shifted(box(3.0, 3.0, 2.0), {1.5, 7.0})});
  MassProperties<2> expected = box(4.0, 4.0, 2.0);
  expected.centre = {1.0, 7.0};
  expect_equal(whole, expected, 8 * epsilon);
}

TEST(Compose, PointMassesAreADumbbell) {
  // Reduced mass times the square of the distance.
  const MassProperties<2> whole =
      compose({shifted(point_mass(1.0), {0, 1}), shifted(point_mass(3.0), {0, -3})});
  expect_equal(whole, {.mass = 4.0, .inertia = 0.75 * 16.0, .centre = {0, -2}}, 4 * epsilon);
}

TEST(Compose, DoesNotDependOnTheGrouping) {
  carom_test::Random random(53);
  for (int repeat = 0; repeat < 100; ++repeat) {
    std::vector<MassProperties<2>> parts;
    for (int i = 0; i < 6; ++i) {
      parts.push_back(shifted(disc(random.uniform(0.1, 2.0), random.uniform(0.1, 2.0)), random.vec<2>(3.0)));
    }
    const MassProperties<2> nested = compose(
        {compose({parts[5], parts[0]}), compose({compose({parts[3], parts[1]}), parts[4]}), parts[2]});
    expect_equal(compose(parts), nested, 64 * epsilon);
  }
}

TEST(Compose, OnePartStaysAsItIs) {
  const MassProperties<2> part = shifted(disc(2.0, 0.5), {3.0, -4.0});
  const MassProperties<2> whole = compose({part});
  EXPECT_EQ(whole.mass, part.mass);
  EXPECT_EQ(whole.inertia, part.inertia);
  EXPECT_EQ(whole.centre, part.centre);
}

TEST(Compose, RefusesNothingAndImpossibleParts) {
  EXPECT_MODEL_ERROR(compose({}), "compose: number of parts is 0", "at least 1");
  const MassProperties<2> good = disc(1.0, 1.0);
  EXPECT_MODEL_ERROR(compose({good, MassProperties<2>{}}), "compose: part 1 mass is nan kg",
                     "finite and > 0");
  MassProperties<2> bad = good;
  bad.inertia = -1.0;
  EXPECT_MODEL_ERROR(compose({bad, good}), "compose: part 0 moment of inertia is -1 kg m^2", ">= 0");
  bad = good;
  bad.centre[1] = infinity;
  EXPECT_MODEL_ERROR(compose({good, good, bad}), "compose: part 2 centre is (0, inf) m", "finite");
  EXPECT_MODEL_ERROR(shifted(good, {1e200, 0.0}), "shifted: offset is (1e+200, 0) m", "up to 1e+150");
  EXPECT_MODEL_ERROR(compose({good, shifted(good, {1e100, 0.0})}), "compose: moment of inertia is",
                     "up to 1e+150");
}

TEST(Shifted, MovesTheCentreOnly) {
  const MassProperties<2> moved = shifted(shifted(rod(2.0, 3.0), {1.0, 2.0}), {0.5, -1.0});
  EXPECT_EQ(moved.centre, Vec<2>(1.5, 1.0));
  EXPECT_EQ(moved.mass, 2.0);
  EXPECT_EQ(moved.inertia, rod(2.0, 3.0).inertia);
  EXPECT_MODEL_ERROR(shifted(rod(1.0, 1.0), {nan, 0.0}), "shifted: offset is (nan, 0) m", "finite");
  EXPECT_MODEL_ERROR(shifted(MassProperties<2>{}, {0.0, 0.0}), "shifted: mass is nan kg");
}

TEST(Centred, PutsTheCentreAtTheOrigin) {
  const MassProperties<2> made = centred(polygon(2.0, {{0, 0}, {3, 0}, {0, 6}}));
  EXPECT_EQ(made.centre, Vec<2>(0.0, 0.0));
  EXPECT_DOUBLE_EQ(made.inertia, 5.0);
  EXPECT_MODEL_ERROR(centred(MassProperties<2>{}), "centred: mass is nan kg");
}

TEST(InertiaAbout, IsTheParallelAxisTheorem) {
  EXPECT_DOUBLE_EQ(inertia_about(rod(3.0, 2.0), {1.0, 0.0}), 4.0);     // rod about its end: m l^2 / 3
  EXPECT_DOUBLE_EQ(inertia_about(disc(2.0, 1.5), {0.0, -1.5}), 6.75);  // disc about its rim: 3/2 m r^2
  const MassProperties<2> away = shifted(disc(2.0, 1.5), {4.0, 5.0});
  EXPECT_DOUBLE_EQ(inertia_about(away, away.centre), away.inertia);
  EXPECT_MODEL_ERROR(inertia_about(away, {0.0, nan}), "inertia_about: point is (0, nan) m");
  EXPECT_MODEL_ERROR(inertia_about(MassProperties<2>{}, {0.0, 0.0}), "inertia_about: mass is nan kg");
}

TEST(InertiaAbout, OfPartsAddsUp) {
  carom_test::Random random(54);
  for (int repeat = 0; repeat < 100; ++repeat) {
    const MassProperties<2> a = shifted(disc(random.uniform(0.1, 2.0), 1.0), random.vec<2>(2.0));
    const MassProperties<2> b = shifted(box(random.uniform(0.1, 2.0), 1.0, 2.0), random.vec<2>(2.0));
    const Vec<2> point = random.vec<2>(2.0);
    const double sum = inertia_about(a, point) + inertia_about(b, point);
    EXPECT_NEAR(inertia_about(compose({a, b}), point), sum, 16 * epsilon * sum);
  }
}

}  // namespace

#include <carom/bodies/particle.h>
#include <carom/bodies/rigid_body.h>
#include <carom/bodies/shape_disc.h>
#include <carom/contact/detection/half_space.h>
#include <carom/core/dot.h>
#include <carom/core/force_element.h>
#include <carom/core/system.h>
#include <carom/joints/applied_load.h>
#include <carom/joints/driver.h>
#include <carom/joints/gravity.h>
#include <carom/joints/revolute.h>
#include <carom/joints/rod.h>
#include <carom/joints/spring_damper.h>

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

// An element on three bodies.
struct Triple {
  static constexpr Role role = Role::force;
  static constexpr int dimension = 2;
  static constexpr std::string_view label = "triple";
  std::vector<BodyId> on{};
  std::vector<BodyId> bodies() const { return on; }
  void loads(const ElementView<2>&, ElementLoads<2>&) const {}
};

System scene() {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  const BodyId upper = system.add(Particle{.mass = 0.5}, "upper");
  const BodyId lower = system.add(Particle{.mass = 2.0, .contact = false}, "lower");
  const BodyId plate = system.add(RigidBody{.mass = disc(1.0, 1.0)});
  system.add(SpringDamper{.from = upper, .to = lower}, "link");
  system.add(SpringDamper{.from = ground, .to = {plate, {0.5, 0.0}}});
  system.add(AppliedForce{.on = plate, .force = [](double) { return Vec<2>(1.0, 0.0); }}, "wind");
  system.add(Disc{.body = plate, .radius = 1.0}, "rim");
  system.add(HalfPlane{.normal = {0, 1}},
             Surface{.friction = 0.25, .normal_restitution = 1.0, .tangential_restitution = 0.5}, "floor");
  system.add(HalfPlane{.normal = {1, 0}}, "wall");
  return system;
}

int count(const std::string& text, const std::string& word) {
  int found = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + word.size()))
    ++found;
  return found;
}

#define EXPECT_LINE(text, line) EXPECT_EQ(count(text, line), 1) << line << " in\n" << text

TEST(ToDot, AnEmptySystemIsAnEmptyGraph) {
  const std::string text = to_dot(System());
  EXPECT_TRUE(text.starts_with("graph carom {"));
  EXPECT_TRUE(text.ends_with("}\n"));
  EXPECT_EQ(count(text, "label"), 0);
}

TEST(ToDot, BodiesAreNodesGroupedByComponent) {
  const std::string text = to_dot(scene());
  EXPECT_EQ(count(text, "subgraph cluster_"), 2);
  EXPECT_LINE(text, "body0 [label=\"particle 'upper'\\n0.5 kg\"");
  EXPECT_LINE(text, "body1 [label=\"particle 'lower'\\n2 kg\"");
  EXPECT_LINE(text, "body2 [label=\"rigid body #2\\n1 kg\"");
  const std::size_t second = text.find("cluster_1"), end = text.find("  }", second);
  EXPECT_LT(text.find("body1 ["), second);
  EXPECT_GT(text.find("body2 ["), second);
  EXPECT_LT(text.find("body2 ["), end);
}

TEST(ToDot, ElementsAreEdgesLoadsOrNotes) {
  System system = scene();
  const std::vector<BodyId> all = system.bodies();
  system.add(Triple{.on = {all[0], all[1], ground}});
  const std::string text = to_dot(system);
  EXPECT_LINE(text, "element0 [label=\"gravity #0\", shape=note]");
  EXPECT_LINE(text, "body0 -- body1 [label=\"spring-damper 'link'\"]");
  EXPECT_LINE(text, "ground -- body2 [label=\"spring-damper #2\"]");
  EXPECT_LINE(text, "element3 [label=\"applied force 'wind'\", shape=plaintext]");
  EXPECT_LINE(text, "element3 -- body2;");
  EXPECT_LINE(text, "element4 [label=\"triple #4\", shape=diamond]");
  EXPECT_LINE(text, "element4 -- body0;");
  EXPECT_LINE(text, "element4 -- body1;");
  EXPECT_LINE(text, "element4 -- ground;");
}

TEST(ToDot, JointsAreBoldEdges) {
  System system;
  const BodyId a = system.add(RigidBody{.mass = disc(1.0, 1.0)}),
               b = system.add(RigidBody{.mass = disc(1.0, 1.0)});
  const BodyId arm = system.add(RigidBody{.mass = disc(1.0, 1.0)});
  const JointId pin = system.add(Revolute{.from = ground, .to = arm}, "hub");
  system.add(Revolute{.from = arm, .to = a});
  system.add(Gear{.from = a, .to = b, .ratio = 0.5, .carrier = arm});
  system.add(Gear{.from = a, .to = b, .ratio = 2.0}, "fixed");
  system.add(Driver{.joint = pin, .position = [](double t) { return t; }}, "crank");
  system.add(Motor{.joint = pin, .torque = [](double, double, double) { return 1.0; }});
  const std::string text = to_dot(system);
  EXPECT_LINE(text, "  ground -- body2 [label=\"revolute joint 'hub'\", style=bold];\n");
  EXPECT_LINE(text, "  body2 -- body0 [label=\"revolute joint #1\", style=bold];\n");
  EXPECT_LINE(text, "  joint2 [label=\"gear pair #2\", shape=diamond];\n");
  for (const char* const body : {"body0", "body1", "body2"}) {
    EXPECT_LINE(text, "  joint2 -- " + std::string(body) + " [style=bold];\n");
  }
  EXPECT_LINE(text, "  body0 -- body1 [label=\"gear pair 'fixed'\", style=bold];\n");
  EXPECT_LINE(text, "  ground -- body2 [label=\"driver 'crank'\\non revolute joint 'hub'\", style=bold];\n");
  EXPECT_LINE(text, "  ground -- body2 [label=\"motor #0\\non revolute joint 'hub'\"];\n");
  EXPECT_LINE(text, "  ground [");
  EXPECT_EQ(count(text, "subgraph cluster_"), 1);  // joints bind bodies to one component
}

TEST(ToDot, TheGroundAppearsOnlyWhereItIsUsed) {
  EXPECT_LINE(to_dot(scene()), "  ground [");
  System free;
  const BodyId a = free.add(Particle{.mass = 1.0}), b = free.add(Particle{.mass = 1.0});
  free.add(SpringDamper{.from = a, .to = b});
  EXPECT_EQ(count(to_dot(free), "ground"), 0);
}

TEST(ToDot, WhatMayTouchIsJoinedByDashesThatNameTheLaw) {
  const std::string text = to_dot(scene());
  EXPECT_LINE(text, "body2 -- shape0 [style=dotted]");
  EXPECT_LINE(text, "body0 -- obstacle0 [style=dashed, label=\"mu 0.25, e_n 1, e_t 0.5\"]");
  EXPECT_LINE(text, "shape0 -- obstacle0 [style=dashed, label=\"mu 0.25, e_n 1, e_t 0.5\"]");
  EXPECT_LINE(text, "body0 -- obstacle1 [style=dashed, label=\"no law\", color=red");
  EXPECT_EQ(count(text, "body1 -- obstacle"), 0);  // it has no contact point
  EXPECT_EQ(count(text, "body2 -- obstacle"), 0);  // its shape touches
}

TEST(ToDot, RemovedPartsAreGone) {
  System system = scene();
  system.remove(system.element("link"));
  system.remove(system.body("lower"));
  const std::string text = to_dot(system);
  EXPECT_EQ(count(text, "body1"), 0);
  EXPECT_EQ(count(text, "link"), 0);
}

TEST(ToDot, NamesAreEscaped) {
  System system;
  system.add(Particle{.mass = 1.0}, "a \"b\" \\N c\n<d> & }; &lt;\t");
  EXPECT_LINE(to_dot(system), "label=\"particle 'a \\\"b\\\" \\\\N c\\n<d> &amp; }; &amp;lt; '\\n1 kg\"");
}

TEST(ToDot, GraphvizDrawsIt) {
  if (std::system("dot -V >/dev/null 2>&1") != 0) GTEST_SKIP() << "Graphviz is not installed";
  System system = scene();
  system.add(Rod{.from = {ground, {0, 5}}, .to = system.body("upper")}, "rod & \\N");
  system.add(Particle{.mass = 1.0}, "odd \"\\N\\\" & name\n{|}; --");
  const std::filesystem::path stem = std::filesystem::path(testing::TempDir()) / "carom_dot_test";
  const std::string source = stem.string() + ".dot", picture = stem.string() + ".svg";
  std::ofstream(source) << to_dot(system);
  const std::string messages = stem.string() + ".txt";
  const std::string command = "dot -Tsvg '" + source + "' -o '" + picture + "' 2>'" + messages + "'";
  EXPECT_EQ(std::system(command.c_str()), 0);
  std::ifstream drawn(picture), said(messages);
  const std::string svg{std::istreambuf_iterator<char>(drawn), {}};
  EXPECT_EQ((std::string{std::istreambuf_iterator<char>(said), {}}), "");
  EXPECT_NE(svg.find("</svg>"), std::string::npos);
  EXPECT_NE(svg.find("upper"), std::string::npos);
  EXPECT_NE(svg.find("odd &quot;\\N\\&quot; &amp; name"), std::string::npos);
  for (const std::string& file : {source, picture, messages}) std::filesystem::remove(file);
}

}  // namespace

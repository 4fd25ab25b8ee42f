// Describing many parts of any kind, and making a simulation of them, takes time in proportion to their
// number.

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

double cpu_time() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Wheels on pins in a row, with something on each.
System wheels(int count, const std::function<void(System&, BodyId, JointId, int)>& add) {
  System system;
  for (int i = 0; i < count; ++i) {
    const BodyId wheel = system.add(RigidBody{.mass = disc(1.0, 0.3), .position = {1.0 * i, 1.0}},
                                    "wheel " + std::to_string(i));
    const JointId pin = system.add(Revolute{.from = {ground, {1.0 * i, 1.0}}, .to = wheel});
    add(system, wheel, pin, i);
  }
  return system;
}

TEST(DescriptionCost, GrowsWithTheNumberOfParts) {
  const std::map<std::string, std::function<void(System&, BodyId, JointId, int)>> kinds{
      {"driver",
       [](System& system, BodyId, JointId pin, int) {
         system.add(Driver{.joint = pin,
                           .position = [](double t) { return t; },
                           .velocity = [](double) { return 1.0; },
                           .acceleration = [](double) { return 0.0; }});
       }},
      {"motor",
       [](System& system, BodyId, JointId pin, int) {
         system.add(Motor{.joint = pin, .torque = [](double, double, double) { return 1.0; }});
       }},
      {"stop",
       [](System& system, BodyId, JointId pin, int) { system.add(Stop{.joint = pin, .upper = 2.0}); }},
      {"friction", [](System& system, BodyId, JointId pin,
                      int) { system.add(JointFriction{.joint = pin, .bound = 0.1}); }},
      {"friction by force", [](System& system, BodyId, JointId pin,
                               int) { system.add(JointFriction{.joint = pin, .coefficient = 0.1}); }},
      {"shape",
       [](System& system, BodyId wheel, JointId, int) { system.add(Disc{.body = wheel, .radius = 0.3}); }},
      {"spring",
       [](System& system, BodyId wheel, JointId, int i) {
         system.add(SpringDamper{.from = ground, .to = wheel, .stiffness = 1.0, .free_length = 0.0},
                    "spring " + std::to_string(i));
       }},
      {"named", [](System& system, BodyId wheel, JointId,
                   int i) { system.add(Point{.body = wheel}, "p" + std::to_string(i)); }},
  };
  // Eight times the parts: some ten times the time, where the square would be 64 times.
  constexpr int few = 500, many = 8 * few;
  constexpr double most = 28.0;
  for (const auto& [name, add] : kinds) {
    const auto time_of = [&, &add = add](int count) {
      double least = 1e9;
      for (int repetition = 0; repetition < 3; ++repetition) {
        const double start = cpu_time();
        System system = wheels(count, add);
        system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.0, .normal_restitution = 0.0});
        const System copy = system;
        EXPECT_EQ(copy.joints().size(), system.joints().size());
        least = std::min(least, cpu_time() - start);
      }
      return least;
    };
    const double small = std::max(time_of(few), 1e-4);
    EXPECT_LT(time_of(many), most * small) << name;
  }
}

}  // namespace

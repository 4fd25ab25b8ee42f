// The derivative of a component's rates beside central differences of them: forces of every sort, joints with
// drivers, contacts that stick and slip.

#include <carom/carom.h>
#include <carom/contact/active_set.h>
#include <carom/contact/detection/detector.h>
#include <carom/core/assembly.h>
#include <carom/integrators/event_driven/smooth_motion.h>
#include <carom/integrators/flow/newton_matrix.h>

#include "tests/integrators/joint_scenes.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

/// The one component of a model, with the contacts named by their place among its pairs closed.
class OneComponent {
public:
  struct Closed {
    std::size_t pair;
    ContactMode mode;
  };

  explicit OneComponent(System system, const std::vector<Closed>& closed = {})
      : assembly_(std::move(system)),
        detector_(assembly_),
        memory_(assembly_),
        motion_(assembly_, detector_, {{0}, {}}, options_, memory_) {
    EXPECT_EQ(assembly_.components().size(), 1u);
    for (const auto& [pair, mode] : closed) {
      ActiveContact contact;
      contact.pair = motion_.model().pairs.at(pair);
      contact.mode = mode;
      motion_.active().list().push_back(contact);
    }
    y_.resize(motion_.size());
    motion_.model().unknowns.gather(assembly_.initial_state(), y_);
  }
  /// Moves all numbers off what they were, joints open a little.
  void disturb(double size) {
    for (std::size_t i = 0; i < y_.size(); ++i) y_[i] += size * std::sin(1.0 + 3.0 * static_cast<double>(i));
  }
  [[nodiscard]] std::vector<double>& y() { return y_; }
  [[nodiscard]] SmoothMotion& motion() { return motion_; }

  /// (I - gamma df/dy) by differences, of coordinates and velocities.
  [[nodiscard]] Eigen::MatrixXd by_differences(double time, double gamma) {
    const std::size_t n = coordinates();
    Eigen::MatrixXd matrix(n, n);
    std::vector<double> y = y_, ahead(y_.size()), behind(y_.size());
    for (std::size_t j = 0; j < n; ++j) {
      // A step for large numbers, weighed with the error of the difference.
      constexpr double step = 1e-5;
      y[j] = y_[j] + step;
      motion_.rates(time, y.data(), ahead.data());
      y[j] = y_[j] - step;
      motion_.rates(time, y.data(), behind.data());
      y[j] = y_[j];
      for (std::size_t i = 0; i < n; ++i) {
        matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
            (i == j ? 1.0 : 0.0) - gamma * (ahead[i] - behind[i]) / (2.0 * step);
      }
    }
    return matrix;
  }
  /// Its inverse by the derivative.
  [[nodiscard]] Eigen::MatrixXd inverse(double time, double gamma) {
    const std::size_t n = coordinates();
    NewtonMatrix matrix(motion_.size(), motion_.integrals());
    motion_.jacobian(time, y_.data(), matrix.entries());
    EXPECT_TRUE(matrix.take());
    EXPECT_TRUE(matrix.factor(gamma));
    Eigen::MatrixXd inverse(n, n);
    std::vector<double> x(motion_.size());
    for (std::size_t j = 0; j < n; ++j) {
      std::fill(x.begin(), x.end(), 0.0);
      x[j] = 1.0;
      matrix.solve(x.data(), x.data());
      for (std::size_t i = 0; i < n; ++i) {
        inverse(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = x[i];
      }
    }
    return inverse;
  }

private:
  [[nodiscard]] std::size_t coordinates() const {
    return motion_.size() - static_cast<std::size_t>(motion_.model().unknowns.work_count());
  }

  Assembly assembly_;
  Detector detector_;
  EventDriven options_{.method = FlowMethod::bdf};
  MotionMemory memory_;
  SmoothMotion motion_;
  std::vector<double> y_;
};

void expect_right(OneComponent& component, double time = 0.3) {
  for (const double gamma : {1e-3, 0.03}) {
    const Eigen::MatrixXd matrix = component.by_differences(time, gamma);
    const Eigen::MatrixXd product = component.inverse(time, gamma) * matrix;
    const auto n = product.rows();
    // The differences err by 1e-10 of their scale, which solving magnifies by the condition.
    const double condition = matrix.inverse().norm() * matrix.norm();
    EXPECT_LE((product - Eigen::MatrixXd::Identity(n, n)).cwiseAbs().maxCoeff(), 1e-9 * condition)
        << gamma << ", condition " << condition;
    // So far below gamma that what is missing would be seen.
    EXPECT_LT(1e-9 * condition, 0.1 * gamma);
  }
}

BodyId plate(System& system, const Vec<2>& position, double angle, const Vec<2>& velocity, double spin) {
  return system.add(RigidBody{.mass = {.mass = 1.3, .inertia = 0.4},
                              .position = position,
                              .angle = angle,
                              .velocity = velocity,
                              .spin = spin});
}

TEST(SmoothMotionJacobian, ForcesOfEverySort) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  const BodyId a = plate(system, {0.0, 0.0}, 0.3, {0.4, -0.2}, 1.5);
  const BodyId b = plate(system, {1.5, 0.4}, -0.8, {-0.3, 0.7}, -0.6);
  const BodyId c = system.add(Particle{.mass = 0.7, .position = {0.4, 1.8}, .velocity = {0.2, 0.1}});
  system.add(SpringDamper{.from = {a, {0.2, 0.1}},
                          .to = {b, {-0.3, 0.2}},
                          .stiffness = 80.0,
                          .damping = 3.0,
                          .free_length = 0.7});
  system.add(SpringDamper{.from = {b, {0.1, 0.4}}, .to = c, .stiffness = 50.0, .damping = 2.0});
  system.add(NonlinearSpring{.from = {a, {-0.1, 0.3}},
                             .to = c,
                             .force = [](double l) { return 20.0 * l * l * l; },
                             .potential_of = [](double l) { return 5.0 * l * l * l * l; },
                             .damping = 1.0});
  system.add(Cable{.from = a, .to = b, .stiffness = 60.0, .free_length = 0.5});
  system.add(TorsionalSpring{.from = a, .to = b, .stiffness = 9.0, .damping = 0.5});
  Bushing bushing{.from = {a, {0.2, 0.0}}, .to = {b, {0.0, 0.1}}};
  bushing.stiffness.diagonal() << 30.0, 10.0, 4.0;
  bushing.damping.diagonal() << 1.0, 2.0, 0.3;
  system.add(bushing);
  system.add(Drag{.on = {a, {0.3, 0.3}}, .linear = 0.8, .quadratic = 1.2});
  system.add(AppliedForce{.on = {b, {0.3, -0.2}}, .force = [](double t) { return Vec<2>(t, 3.0); }});
  system.add(FollowerLoad{.on = {a, {0.1, -0.2}}, .force = [](double) { return Vec<2>(2.0, 1.0); }});
  system.add(LinearActuator{.from = a, .to = {b, {0.2, 0.2}}, .force = [](double, double l, double rate) {
                              return 5.0 - 8.0 * l - rate;
                            }});
  system.add(RotaryActuator{
      .from = a, .to = b, .torque = [](double, double angle, double rate) { return -angle - 0.5 * rate; }});
  OneComponent component(std::move(system));
  expect_right(component);
}

/// Swings of joint scenes, whose bodies get springs that pull on what binds them.
void expect_joints_right(System system, const std::vector<BodyId>& bodies) {
  for (const BodyId body : bodies) {
    system.add(SpringDamper{.from = {ground, {0.3, 1.7}}, .to = body, .stiffness = 40.0, .damping = 2.0});
  }
  OneComponent component(std::move(system));
  expect_right(component);
  component.disturb(0.05);
  expect_right(component);
}

TEST(SmoothMotionJacobian, PendulumsAndClosedChains) {
  for (joint_scenes::Scene scene : {joint_scenes::particle_pendulum(), joint_scenes::rod_pendulum(4),
                                    joint_scenes::slider_crank(), joint_scenes::windows(2)}) {
    expect_joints_right(std::move(scene.system), scene.bodies);
  }
}

TEST(SmoothMotionJacobian, EveryJoint) {
  const auto with = [](const std::function<void(System&, BodyId, BodyId, BodyId)>& add) {
    System system;
    system.add(Gravity{{0.0, -9.81}});
    const BodyId a = plate(system, {0.0, 0.0}, 0.3, {0.4, -0.2}, 1.5);
    const BodyId b = plate(system, {1.5, 0.4}, -0.8, {-0.3, 0.7}, -0.6);
    const BodyId c = plate(system, {0.4, 1.8}, 0.5, {0.2, 0.1}, 0.9);
    system.add(SpringDamper{.from = b, .to = c, .stiffness = 30.0, .damping = 1.0, .free_length = 1.0});
    add(system, a, b, c);
    expect_joints_right(std::move(system), {a, b, c});
  };
  const auto swing = [](double t) { return 0.3 * std::sin(3.0 * t); };
  with([&](System& system, BodyId a, BodyId b, BodyId) {
    system.add(Weld{.from = {a, {0.2, 0.1}}, .to = {b, {-0.4, 0.2}}});
  });
  with([&](System& system, BodyId a, BodyId b, BodyId) {
    const JointId pin = system.add(Revolute{.from = {a, {0.2, 0.1}}, .to = {b, {-0.4, 0.2}}});
    system.add(Driver{.joint = pin, .position = swing});
  });
  with([&](System& system, BodyId a, BodyId b, BodyId) {
    const JointId slide =
        system.add(Prismatic{.from = {a, {0.2, 0.1}}, .to = {b, {-0.4, 0.2}}, .axis = {1.0, 0.4}});
    system.add(Driver{.joint = slide, .position = swing});
  });
  with([&](System& system, BodyId a, BodyId b, BodyId) {
    const JointId slot =
        system.add(PointOnLine{.from = {a, {0.2, 0.1}}, .to = {b, {-0.4, 0.2}}, .axis = {1.0, 0.4}});
    system.add(Motor{.joint = slot, .torque = [](double, double x, double u) { return 3.0 - x - 0.2 * u; }});
  });
  with([&](System& system, BodyId a, BodyId b, BodyId) {
    system.add(Rolling{.from = {a, {0.2, 0.1}}, .to = {b, {0.1, 0.2}}, .normal = {-0.2, 1.0}, .radius = 0.5});
  });
  with([&](System& system, BodyId a, BodyId b, BodyId) {
    system.add(Rod{.from = {a, {0.2, 0.1}}, .to = {b, {-0.4, 0.2}}});
  });
  with([&](System& system, BodyId a, BodyId b, BodyId c) {
    system.add(Revolute{.from = {a, {0.2, 0.1}}, .to = {b, {-0.4, 0.2}}});
    system.add(Revolute{.from = {a, {-0.2, 0.1}}, .to = {c, {-0.4, 0.2}}});
    system.add(Gear{.from = b, .to = c, .ratio = -2.0, .carrier = a});
  });
}

/// A plate on a slope with both lower corners, held by a spring.
System plate_on_slope(double stribeck_speed) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.point = {0, 0}, .normal = incline(0.2)}, Surface{.friction = 0.2,
                                                                         .normal_restitution = 0.0,
                                                                         .static_friction = 0.4,
                                                                         .stribeck_speed = stribeck_speed});
  const BodyId body = plate(system, {0.0, 0.5}, -0.2, {0.8, -0.16}, 0.0);
  system.add(Polygon{.body = body, .vertices = {{-0.6, -0.5}, {0.6, -0.5}, {0.6, 0.5}, {-0.6, 0.5}}});
  system.add(SpringDamper{.from = {ground, {2.0, 3.0}},
                          .to = {body, {0.3, 0.5}},
                          .stiffness = 8.0,
                          .damping = 1.0,
                          .free_length = 2.5});
  return system;
}

TEST(SmoothMotionJacobian, ContactsThatStickAndSlip) {
  using Modes = std::vector<OneComponent::Closed>;
  const auto stick = ContactMode::stick, slip = ContactMode::slip_positive;
  for (const Modes& modes : {Modes{{0, stick}}, Modes{{1, slip}}, Modes{{0, slip}, {1, slip}},
                             Modes{{0, stick}, {1, stick}}, Modes{{0, ContactMode::slip_negative}}}) {
    OneComponent component(plate_on_slope(0.5), modes);
    expect_right(component);
    // Two corners that slip follow from each other only where they lie on the slope.
    component.y()[3] += 0.3;
    component.y()[5] += modes.size() == 1 ? 0.4 : 0.0;
    expect_right(component);
  }
}

TEST(SmoothMotionJacobian, RollingResistance) {
  // Behind the contact its resistance, held or at its bound.
  const auto stick = ContactMode::stick, slip = ContactMode::slip_positive, back = ContactMode::slip_negative;
  for (const auto& [contact, rolling] :
       {std::pair(stick, stick), {stick, slip}, {slip, back}, {slip, stick}}) {
    System system;
    system.add(Gravity{{0.0, -9.81}});
    const Surface law{.friction = 0.3, .normal_restitution = 0.0, .rolling_resistance = 0.05};
    system.set_default_law(law);
    system.add(HalfPlane{.normal = {0.1, 1.0}}, law);
    const BodyId body = plate(system, {0.0, 0.5}, 0.2, {0.8, -0.1}, 0.3);
    system.add(Disc{.body = body, .radius = 0.4, .centre = {0.1, 0.05}});
    system.add(SpringDamper{.from = {ground, {0.0, 2.0}}, .to = {body, {0.4, 0.1}}, .stiffness = 30.0});
    OneComponent component(std::move(system), {{0, contact}, {1, rolling}});
    ASSERT_TRUE(component.motion().active().list()[1].pair.rolling);
    expect_right(component);
  }
}

TEST(SmoothMotionJacobian, ContactsOfWhatJointsBind) {
  for (const ContactMode mode : {ContactMode::stick, ContactMode::slip_positive}) {
    System system;
    system.add(Gravity{{0.0, -9.81}});
    system.add(HalfPlane{.point = {0, 0}, .normal = {0.1, 1.0}},
               Surface{.friction = 0.3, .normal_restitution = 0.0});
    const BodyId foot = plate(system, {0.0, 0.5}, 0.2, {0.8, -0.1}, 0.3);
    const BodyId arm = plate(system, {1.0, 0.9}, 0.5, {0.4, 0.1}, -0.7);
    system.add(Segment{.body = foot, .from = {-0.3, -0.5}, .to = {0.5, 0.4}});
    system.add(Revolute{.from = {foot, {0.5, 0.4}}, .to = {arm, {-0.5, 0.0}}});
    system.add(SpringDamper{.from = {ground, {0.0, 2.0}}, .to = {arm, {0.4, 0.1}}, .stiffness = 30.0});
    OneComponent component(std::move(system), {{0, mode}});
    expect_right(component);
    component.disturb(0.05);
    expect_right(component);
  }
}

TEST(SmoothMotionJacobian, FrictionInJoints) {
  // By a constant, and by the force that presses: along a slot, in a pin, in a slide with two rows.
  for (const double coefficient : {0.0, 0.2}) {
    for (int joint = 0; joint < 3; ++joint) {
      System system;
      system.add(Gravity{{0.0, -9.81}});
      const BodyId a = plate(system, {0.0, 0.0}, 0.3, {0.4, -0.2}, 1.5);
      const BodyId b = plate(system, {1.5, 0.4}, -0.8, {-0.3, 0.7}, -0.6);
      const End<2> from(a, {0.2, 0.1}), to(b, {-0.4, 0.2});
      const Vec<2> axis(1.0, 0.4);
      const JointId id = joint == 0   ? system.add(PointOnLine{.from = from, .to = to, .axis = axis})
                         : joint == 1 ? system.add(Revolute{.from = from, .to = to})
                                      : system.add(Prismatic{.from = from, .to = to, .axis = axis});
      system.add(JointFriction{.joint = id, .bound = 3.0, .coefficient = coefficient});
      system.add(SpringDamper{.from = {ground, {0.0, 2.0}}, .to = {a, {0.4, 0.1}}, .stiffness = 30.0});
      system.add(SpringDamper{.from = {ground, {2.0, 1.0}}, .to = b, .stiffness = 20.0});
      for (const ContactMode mode : {ContactMode::slip_positive, ContactMode::stick}) {
        OneComponent component(system, {{0, mode}});
        expect_right(component);
      }
    }
  }
}

TEST(SmoothMotionJacobian, InternalVariables) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  const BodyId a = plate(system, {0.0, 0.0}, 0.3, {0.4, -0.2}, 1.5);
  const BodyId b = plate(system, {1.5, 0.4}, -0.8, {-0.3, 0.7}, -0.6);
  system.add(MaxwellElement{.from = {a, {0.2, 0.1}},
                            .to = {b, {-0.3, 0.2}},
                            .stiffness = 80.0,
                            .damping = 3.0,
                            .free_length = 0.7,
                            .lengthening = 0.1});
  system.add(Rod{.from = {a, {0.2, 0.1}}, .to = {b, {-0.4, 0.2}}});
  OneComponent component(std::move(system));
  expect_right(component);
  component.disturb(0.05);
  expect_right(component);
}

}  // namespace

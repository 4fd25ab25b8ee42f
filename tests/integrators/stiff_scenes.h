#pragma once

// Random models that plain sweeps often cannot step: chains of springs and of rods that fall on floors and
// into V's, stiff nets, pendulums on stiff springs, bars held by stiff springs (h^2 k/m up to 1e4 and more);
// with friction in contact and in joints.

#include "tests/random.h"

#include <carom/carom.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace carom_test {

class StiffScene {
public:
  explicit StiffScene(std::uint64_t seed) : random_(seed) {
    using namespace carom;
    using namespace carom::planar;
    system_.add(Gravity{{0.0, -9.81}});
    add_ground();
    switch (seed % 5) {
      case 0:
        add_chain_of_springs();
        break;
      case 1:
        add_chain_of_rods();
        break;
      case 2:
        add_net();
        break;
      case 3:
        add_pendulum();
        break;
      default:
        add_bars();
    }
    options_.step = std::pow(10.0, random_.uniform(-3.3, -2.0));
    options_.tolerance = 1e-11;
    options_.max_sweeps = 100;
    if (random_.below(4) == 0) options_.force_rule = ForceRule::energy_momentum;
    if (random_.below(4) == 0) options_.project_gaps = true;
  }

  [[nodiscard]] const carom::System& system() const { return system_; }
  [[nodiscard]] const carom::TimeStepping& options() const { return options_; }
  [[nodiscard]] bool has_springs() const { return has_springs_; }

private:
  void add_ground() {
    using namespace carom;
    using namespace carom::planar;
    const double restitution = random_.below(2) == 0 ? 0.0 : random_.uniform(0.0, 0.6);
    const Surface surface{.friction = random_.below(4) == 0 ? 0.0 : random_.uniform(0.0, 0.8),
                          .normal_restitution = restitution,
                          .tangential_restitution = restitution};
    if (random_.below(2) == 0) {
      system_.add(HalfPlane{.point = {0.0, 0.0}, .normal = incline(random_.uniform(-0.3, 0.3))}, surface);
      return;
    }
    system_.add(HalfPlane{.point = {0.0, 0.0}, .normal = incline(random_.uniform(-0.7, 0.0))}, surface);
    system_.add(HalfPlane{.point = {0.0, 0.0}, .normal = incline(random_.uniform(0.0, 0.7))}, surface);
  }
  double stiffness() { return std::pow(10.0, random_.uniform(2.0, 8.0)); }
  double damping() { return random_.below(2) == 0 ? 0.0 : std::pow(10.0, random_.uniform(-1.0, 3.0)); }
  carom::BodyId particle(const carom::Vec<2>& at) {
    return system_.add(carom::planar::Particle{
        .mass = random_.uniform(0.2, 2.0), .position = at, .velocity = random_.vec<2>(0.5)});
  }
  void spring(const carom::End<2>& from, const carom::End<2>& to, double stiff, double damped,
              double length) {
    has_springs_ = true;
    system_.add(carom::planar::SpringDamper{
        .from = from, .to = to, .stiffness = stiff, .damping = damped, .free_length = length});
  }

  void add_chain_of_springs() {
    const unsigned count = 3 + random_.below(10);
    const double stiff = stiffness(), damped = damping(), slope = random_.uniform(-0.5, 0.5);
    const double link = random_.uniform(0.1, 0.3), height = random_.uniform(0.2, 0.8);
    carom::BodyId before;
    carom::Vec<2> last;
    for (unsigned i = 0; i < count; ++i) {
      const double x = link * (i - 0.5 * (count - 1));
      const carom::Vec<2> at(x, height + std::abs(x) * 0.9 + slope * x);
      const carom::BodyId point = particle(at);
      if (i > 0) spring(before, point, stiff, damped, (at - last).norm());
      before = point;
      last = at;
    }
  }

  void add_chain_of_rods() {
    using namespace carom;
    using namespace carom::planar;
    const unsigned count = 2 + random_.below(7);
    const double length = random_.uniform(0.15, 0.4), height = 0.2 + 0.9 * 0.5 * length * count;
    const bool hung = random_.below(3) == 0, has_dry_friction = random_.below(2) == 0,
               bounded = random_.below(3) == 0;
    BodyId before;
    for (unsigned i = 0; i < count; ++i) {
      const double x = length * (i - 0.5 * (count - 1));
      const BodyId bar =
          system_.add(RigidBody{.mass = rod(random_.uniform(0.2, 2.0), length), .position = {x, height}});
      system_.add(Segment{.body = bar, .from = {-0.5 * length, 0.0}, .to = {0.5 * length, 0.0}});
      JointId pin;
      if (i > 0)
        pin = system_.add(Revolute{.from = {before, {0.5 * length, 0.0}}, .to = {bar, {-0.5 * length, 0.0}}});
      if (i == 0 && hung) {
        pin = system_.add(
            Revolute{.from = {ground, {x - 0.5 * length, height}}, .to = {bar, {-0.5 * length, 0.0}}});
      }
      if (pin.valid() && has_dry_friction) add_friction(pin);
      if (pin.valid() && bounded) add_limit(pin);
      before = bar;
    }
    if (random_.below(3) == 0) {  // something stiff between the ends of the chain and the ground
      const Vec<2> last(0.5 * length * (count - 1), height);
      const Vec<2> fixed(0.0, height + 0.5);
      spring({ground, fixed}, before, stiffness(), damping(), (last - fixed).norm());
    }
  }
  void add_friction(carom::JointId pin) {
    const bool pressed = random_.below(2) == 0;
    system_.add(carom::planar::JointFriction{.joint = pin,
                                             .bound = random_.uniform(0.0, 0.3),
                                             .coefficient = pressed ? random_.uniform(0.0, 0.01) : 0.0,
                                             .static_factor = random_.below(2) == 0 ? 1.0 : 1.2});
  }
  void add_limit(carom::JointId pin) {
    system_.add(carom::planar::Stop{.joint = pin, .lower = -1.0, .upper = 1.0, .restitution = 0.2});
  }

  void add_net() {
    const unsigned columns = 3 + random_.below(3), rows = 2 + random_.below(3);
    const double stiff = stiffness(), damped = damping(), grid = 0.1, height = random_.uniform(0.1, 0.5);
    std::vector<carom::BodyId> points;
    std::vector<carom::Vec<2>> places;
    for (unsigned j = 0; j < rows; ++j) {
      for (unsigned i = 0; i < columns; ++i) {
        const double x = grid * (i - 0.5 * (columns - 1));
        places.emplace_back(x + random_.uniform(-0.01, 0.01), height + 0.3 + grid * j);
        points.push_back(particle(places.back()));
      }
    }
    const auto join = [&](unsigned a, unsigned b) {
      spring(points[a], points[b], stiff, damped, (places[a] - places[b]).norm());
    };
    for (unsigned j = 0; j < rows; ++j) {
      for (unsigned i = 0; i < columns; ++i) {
        const unsigned at = j * columns + i;
        if (i + 1 < columns) join(at, at + 1);
        if (j + 1 < rows) join(at, at + columns);
        if (i + 1 < columns && j + 1 < rows) join(at, at + columns + 1);
      }
    }
  }

  void add_pendulum() {
    const unsigned count = 1 + random_.below(3);
    carom::End<2> before(carom::ground, {random_.uniform(-0.3, 0.3), random_.uniform(0.8, 1.6)});
    carom::Vec<2> at = before.point;
    for (unsigned i = 0; i < count; ++i) {
      const carom::Vec<2> way =
          random_.uniform(0.2, 0.6) * carom::Vec<2>(random_.below(2) == 0 ? 1.0 : -1.0, 0.2);
      at += way;
      const carom::BodyId bob = particle(at);
      spring(before, bob, stiffness(), damping(), way.norm());
      before = carom::End<2>(bob);
    }
  }

  void add_bars() {
    using namespace carom;
    using namespace carom::planar;
    const unsigned count = 1 + random_.below(3);
    const double stiff = stiffness(), damped = damping();
    End<2> before(ground, {-0.4, 1.0});
    Vec<2> last(-0.4, 1.0);
    for (unsigned i = 0; i < count; ++i) {
      const double length = random_.uniform(0.2, 0.5);
      const Vec<2> at(0.7 * i, 1.0);
      const double angle = random_.uniform(-0.3, 0.3);
      const Vec<2> arm(0.5 * length * std::cos(angle), 0.5 * length * std::sin(angle));
      const BodyId bar = system_.add(RigidBody{.mass = rod(random_.uniform(0.2, 2.0), length),
                                               .position = at,
                                               .angle = angle,
                                               .velocity = random_.vec<2>(0.5),
                                               .spin = random_.uniform(-2.0, 2.0)});
      system_.add(Segment{.body = bar, .from = {-0.5 * length, 0.0}, .to = {0.5 * length, 0.0}});
      if (i > 0 || random_.below(2) == 0) {
        spring(before, {bar, {-0.5 * length, 0.0}}, stiff, damped, (at - arm - last).norm());
      }
      last = at + arm;
      before = End<2>(bar, {0.5 * length, 0.0});
    }
  }

  Random random_;
  carom::System system_;
  carom::TimeStepping options_;
  bool has_springs_ = false;
};

}  // namespace carom_test

#pragma once

// Random models within up to six half-planes, with what is needed to look at their gaps without the library's
// own contact search.

#include "tests/random.h"

#include <carom/carom.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace carom_test {

class EventScene {
public:
  explicit EventScene(std::uint64_t seed) : random_(seed) {
    using namespace carom;
    if (random_.below(6) != 0) system_.add(planar::Gravity{{random_.uniform(-2.0, 2.0), -9.81}});
    add_walls();
    const unsigned count = 1 + random_.below(3);
    for (unsigned i = 0; i < count; ++i) add_body();
    for (unsigned i = 0; i + 1 < count; ++i) {
      if (random_.below(2) == 0) add_spring(touching_[i].body, touching_[i + 1].body);
    }
  }

  [[nodiscard]] const carom::System& system() const { return system_; }

  /// The least gap of all corners and discs with all walls [m].
  [[nodiscard]] double least_gap(const carom::State& state) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Touching& at : touching_) {
      const carom::Vec<2> centre = state.position(at.body);
      const double angle = at.points.empty() ? 0.0 : state.angle(at.body);
      least = std::min(least, gap(at, centre, angle));
    }
    return least;
  }

private:
  struct Touching {
    carom::BodyId body;
    std::vector<carom::Vec<2>> points;  // of its frame; none: the centre
    double radius;
  };
  struct Wall {
    carom::Vec<2> normal;
    double distance;
  };

  [[nodiscard]] double gap(const Touching& at, const carom::Vec<2>& centre, double angle,
                           std::size_t walls = std::numeric_limits<std::size_t>::max()) const {
    const double c = std::cos(angle), s = std::sin(angle);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < std::min(walls, walls_.size()); ++i) {
      const Wall& wall = walls_[i];
      const double height = wall.normal.dot(centre) + wall.distance - at.radius;
      if (at.points.empty()) least = std::min(least, height);
      for (const carom::Vec<2>& p : at.points) {
        const carom::Vec<2> arm(c * p[0] - s * p[1], s * p[0] + c * p[1]);
        least = std::min(least, height + wall.normal.dot(arm));
      }
    }
    return least;
  }

  carom::Surface surface() {
    // Round values too: they are where modes meet.
    const auto coefficient = [this] {
      const double choice = random_.uniform(0.0, 1.0);
      return choice < 0.2 ? 0.0 : choice > 0.85 ? 1.0 : random_.uniform(0.0, 1.0);
    };
    carom::Surface result{.friction = random_.below(6) == 0 ? 0.0 : random_.uniform(0.0, 1.5),
                          .normal_restitution = coefficient(),
                          .tangential_restitution = coefficient()};
    if (random_.below(4) == 0) {
      result.static_friction = result.friction + random_.uniform(0.0, 0.5);
      if (random_.below(2) == 0) result.stribeck_speed = random_.uniform(0.01, 1.0);
    }
    return result;
  }

  // A floor, and walls around the origin at 0.8 m to 2 m.
  void add_walls() {
    const unsigned count = 1 + random_.below(6);
    for (unsigned i = 0; i < count; ++i) {
      const double slope =
          i == 0 ? (random_.below(3) == 0 ? 0.0 : random_.uniform(-0.7, 0.7)) : random_.uniform(-3.2, 3.2);
      Wall wall{carom::planar::incline(slope), random_.uniform(0.8, 2.0)};
      walls_.push_back(wall);
      system_.add(carom::planar::HalfPlane{.point = -wall.distance * wall.normal, .normal = wall.normal},
                  surface());
    }
  }

  void add_body() {
    using namespace carom;
    using namespace carom::planar;
    const bool still = random_.below(5) == 0;
    Vec<2> position = random_.vec<2>(0.4), velocity = random_.vec<2>(still ? 0.0 : 4.0);
    const double mass = std::pow(10.0, random_.uniform(-1.0, 1.0)), size = random_.uniform(0.05, 0.35);
    double angle = random_.below(4) == 0 ? 0.0 : random_.uniform(-3.0, 3.0);
    double spin = still ? 0.0 : random_.uniform(-10.0, 10.0);
    Touching at{{}, {}, 0.0};
    MassProperties<2> properties;
    const unsigned kind = random_.below(4);
    if (kind == 1) {
      properties = disc(mass, size);
      at.points = {Vec<2>::Zero()};
      at.radius = size;
    } else if (kind == 2) {
      properties = rod(mass, 2.0 * size);
      at.points = {{-size, 0.0}, {size, 0.0}};
    } else if (kind == 3) {
      const double height = size * random_.uniform(0.2, 1.0);
      properties = box(mass, 2.0 * size, 2.0 * height);
      at.points = {{-size, -height}, {size, -height}, {size, height}, {-size, height}};
    }
    if (random_.below(4) == 0) {
      // Lies, stands or slides on the floor.
      const Wall& floor = walls_[0];
      if (random_.below(2) == 0) angle = std::atan2(-floor.normal[0], floor.normal[1]);
      // Of the floor alone: another wall may be nearer. Twice, to take the rounding out.
      for (int i = 0; i < 2; ++i) position -= gap(at, position, angle, 1) * floor.normal;
      const Vec<2> along(floor.normal[1], -floor.normal[0]);
      velocity = random_.below(2) == 0 ? Vec<2>(Vec<2>::Zero()) : Vec<2>(velocity.dot(along) * along);
      spin = 0.0;
    }
    if (gap(at, position, angle) < -1e-12) {  // another wall is in the way
      position = Vec<2>::Zero();
    }
    if (kind == 0) {
      at.body = system_.add(Particle{.mass = mass, .position = position, .velocity = velocity});
    } else {
      at.body = system_.add(RigidBody{
          .mass = properties, .position = position, .angle = angle, .velocity = velocity, .spin = spin});
      if (kind == 1) system_.add(Disc{.body = at.body, .radius = size});
      if (kind == 2) system_.add(Segment{.body = at.body, .from = at.points[0], .to = at.points[1]});
      if (kind == 3) system_.add(Polygon{.body = at.body, .vertices = at.points});
    }
    touching_.push_back(at);
  }

  void add_spring(carom::BodyId from, carom::BodyId to) {
    using namespace carom;
    const auto end = [&](BodyId id) {
      return system_.has_orientation(id) && random_.below(2) == 0 ? End<2>(id, random_.vec<2>(0.2))
                                                                  : End<2>(id);
    };
    system_.add(
        planar::SpringDamper{.from = random_.below(6) == 0 ? End<2>(ground, random_.vec<2>(0.5)) : end(from),
                             .to = end(to),
                             .stiffness = std::pow(10.0, random_.uniform(0.0, 3.0)),
                             .damping = random_.below(2) == 0 ? 0.0 : random_.uniform(0.0, 2.0),
                             .free_length = random_.below(3) == 0 ? 0.0 : random_.uniform(0.0, 1.0)});
  }

  Random random_;
  carom::System system_;
  std::vector<Wall> walls_;
  std::vector<Touching> touching_;
};

}  // namespace carom_test

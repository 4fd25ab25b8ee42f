#pragma once

// Random scenes in which things strike what stiff couplings hold: chains of discs, boxes and particles on
// springs, dampers, bushings and motors, with and without joints, on the ground and among loose bodies.

#include "tests/random.h"

#include <carom/carom.h>

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace carom_test {

/// A random scene. A number makes a scene, the same each time. Bodies begin apart from each other and from
/// the ground, couplings unloaded.
class StruckCouplings {
public:
  /// \param decades stiffnesses are from 1 N/m to ten to this power, dampings and gains to half of it
  explicit StruckCouplings(std::uint64_t number, double decades = 8.0) : random_(number), decades_(decades) {
    using namespace carom;
    using namespace carom::planar;
    if (random_.below(3) > 0) system_.add(Gravity{{0.0, -9.81}});
    system_.set_default_law(surface());
    if (random_.below(5) > 0) {
      system_.add(HalfPlane{.normal = incline(random_.below(2) == 0 ? 0.0 : random_.uniform(-0.3, 0.3))});
    }
    const unsigned chains = 1 + random_.below(2), loose = 1 + random_.below(3);
    for (unsigned chain = 0; chain < chains; ++chain) add_chain(1.0 + row_height * chain);
    for (unsigned i = 0; i < loose; ++i) {
      // From below, from above, or between the chains; towards the middle.
      const Vec<2> place(random_.uniform(-0.5, 0.5) + 0.9 * (i - 1.0), i % 2 == 0 ? 0.4 : 2.2);
      Vec<2> velocity = random_.vec<2>(1.0);
      velocity[1] += i % 2 == 0 ? 3.0 : -1.0;
      add_body(place, velocity);
    }
  }

  [[nodiscard]] const carom::System& system() const { return system_; }
  [[nodiscard]] bool has_joints() const { return has_joints_; }

private:
  static constexpr double spacing = 0.45, row_height = 0.6;

  carom::Surface surface() {
    const unsigned kind = random_.below(5);
    const double e = kind == 0 ? 0.0 : kind == 1 ? 1.0 : random_.uniform(0.0, 1.0);
    return {.friction = random_.below(4) == 0 ? 0.0 : random_.uniform(0.0, 0.9),
            .normal_restitution = e,
            .tangential_restitution = random_.below(2) * e};
  }
  double stiffness() { return std::pow(10.0, random_.uniform(0.0, decades_)); }
  double damping() {
    return random_.below(3) == 0 ? 0.0 : std::pow(10.0, random_.uniform(0.0, 0.5 * decades_));
  }

  /// A disc, a box, or, where `turns` is not asked for, a particle.
  carom::BodyId add_body(const carom::Vec<2>& place, const carom::Vec<2>& velocity, bool turns = false) {
    using namespace carom;
    using namespace carom::planar;
    const double mass = std::pow(10.0, random_.uniform(-1.0, 0.7)), size = random_.uniform(0.06, 0.14);
    const unsigned form = random_.below(turns ? 4 : 5);
    if (form == 4) return system_.add(Particle{.mass = mass, .position = place, .velocity = velocity});
    const bool is_disc = form < 2;
    const double angle = is_disc ? 0.0 : random_.uniform(-1.5, 1.5);
    const BodyId body =
        system_.add(RigidBody{.mass = is_disc ? disc(mass, size) : box(mass, 2.0 * size, 1.4 * size),
                              .position = place,
                              .angle = angle,
                              .velocity = velocity,
                              .spin = random_.uniform(-2.0, 2.0)});
    if (is_disc) {
      system_.add(Disc{.body = body, .radius = size});
    } else {
      const double x = size, y = 0.7 * size;
      system_.add(Polygon{.body = body, .vertices = {{-x, -y}, {x, -y}, {x, y}, {-x, y}}});
    }
    turns_.push_back(body);
    angles_.push_back(angle);
    return body;
  }

  /// Bodies in a row, each connected to the one before; the first and the last to the ground at times.
  void add_chain(double height) {
    using namespace carom;
    const unsigned count = 1 + random_.below(4);
    const bool hung = count == 1 || random_.below(3) == 0, jointed = random_.below(3) == 0;
    BodyId before;
    Vec<2> last(-0.5 * spacing * (count + 1), height);
    for (unsigned i = 0; i < count; ++i) {
      const Vec<2> place = Vec<2>(spacing * (i - 0.5 * (count - 1)), height) + random_.vec<2>(0.05);
      const BodyId body = add_body(place, random_.vec<2>(0.3), true);
      if (i > 0 || hung) connect(i == 0 ? ground : before, last, body, place, jointed);
      before = body;
      last = place;
    }
    if (random_.below(4) == 0) couple(before, last, ground, last + Vec<2>(0.4, 0.1));
  }

  void connect(carom::BodyId a, const carom::Vec<2>& at_a, carom::BodyId b, const carom::Vec<2>& at_b,
               bool jointed) {
    if (jointed && random_.below(2) == 0) return join(a, at_a, b, at_b);
    couple(a, at_a, b, at_b);
    if (random_.below(3) == 0) couple(a, at_a, b, at_b);
  }

  carom::End<2> end(carom::BodyId body, const carom::Vec<2>& centre, const carom::Vec<2>& point) const {
    if (body == carom::ground) return {body, point};
    for (std::size_t i = 0; i < turns_.size(); ++i) {
      if (turns_[i] != body) continue;
      const double c = std::cos(angles_[i]), s = std::sin(angles_[i]);
      const carom::Vec<2> arm = point - centre;
      return {body, {c * arm[0] + s * arm[1], c * arm[1] - s * arm[0]}};
    }
    return {body, {0.0, 0.0}};
  }

  void join(carom::BodyId a, const carom::Vec<2>& at_a, carom::BodyId b, const carom::Vec<2>& at_b) {
    using namespace carom::planar;
    has_joints_ = true;
    const carom::Vec<2> middle = 0.5 * (at_a + at_b);
    const carom::JointId pin =
        random_.below(3) == 0
            ? system_.add(Rod{.from = end(a, at_a, at_a), .to = end(b, at_b, at_b)})
            : system_.add(Revolute{.from = end(a, at_a, middle), .to = end(b, at_b, middle)});
    static_cast<void>(pin);
    if (random_.below(2) == 0) {
      system_.add(TorsionalSpring{.from = a,
                                  .to = b,
                                  .stiffness = stiffness(),
                                  .damping = damping(),
                                  .free_angle = angle_between(a, b)});
    }
  }
  double angle_of(carom::BodyId body) const {
    for (std::size_t i = 0; i < turns_.size(); ++i) {
      if (turns_[i] == body) return angles_[i];
    }
    return 0.0;
  }
  double angle_between(carom::BodyId a, carom::BodyId b) const { return angle_of(b) - angle_of(a); }

  void couple(carom::BodyId a, const carom::Vec<2>& at_a, carom::BodyId b, const carom::Vec<2>& at_b) {
    using namespace carom;
    using namespace carom::planar;
    const bool centred = random_.below(2) == 0;
    const Vec<2> from = centred ? at_a : Vec<2>(at_a + random_.vec<2>(0.06)),
                 to = centred ? at_b : Vec<2>(at_b + random_.vec<2>(0.06));
    switch (random_.below(5)) {
      case 0:
      case 1:
        system_.add(SpringDamper{.from = end(a, at_a, from),
                                 .to = end(b, at_b, to),
                                 .stiffness = stiffness(),
                                 .damping = damping(),
                                 .free_length = (to - from).norm()});
        return;
      case 2: {
        const double k = stiffness(), c = damping(), arm = random_.uniform(0.02, 0.2);
        const double angle = angle_of(a);
        const Vec<2> way = at_b - at_a;
        system_.add(
            Bushing{.from = end(a, at_a, at_a),
                    .to = end(b, at_b, at_b),
                    .stiffness = diagonal(k, arm),
                    .damping = diagonal(c, arm),
                    .rest = {std::cos(angle) * way[0] + std::sin(angle) * way[1],
                             std::cos(angle) * way[1] - std::sin(angle) * way[0], angle_between(a, b)}});
        return;
      }
      case 3: {
        // A motor: force against a speed that is wanted.
        const double gain = std::pow(10.0, random_.uniform(0.0, 0.5 * decades_)),
                     wanted = random_.uniform(-1.0, 1.0);
        system_.add(
            LinearActuator{.from = end(a, at_a, from),
                           .to = end(b, at_b, to),
                           .force = [=](double, double, double rate) { return gain * (wanted - rate); },
                           .force_by_rate = [=](double, double, double) { return -gain; }});
        couple_softly(end(a, at_a, from), end(b, at_b, to), (to - from).norm());
        return;
      }
      default: {
        const double gain = std::pow(10.0, random_.uniform(-1.0, 0.5 * decades_ - 1.0)),
                     wanted = random_.uniform(-5.0, 5.0);
        system_.add(RotaryActuator{.from = a, .to = b, .torque = [=](double, double, double rate) {
                                     return gain * (wanted - rate);
                                   }});
        couple_softly(end(a, at_a, from), end(b, at_b, to), (to - from).norm());
        return;
      }
    }
  }
  void couple_softly(const carom::End<2>& from, const carom::End<2>& to, double length) {
    system_.add(carom::planar::SpringDamper{
        .from = from, .to = to, .stiffness = stiffness(), .damping = damping(), .free_length = length});
  }
  static carom::Mat<3> diagonal(double number, double arm) {
    carom::Mat<3> matrix = carom::filled_matrix<3>(0.0);
    matrix(0, 0) = matrix(1, 1) = number;
    matrix(2, 2) = number * arm * arm;
    return matrix;
  }

  Random random_;
  double decades_;
  carom::System system_;
  std::vector<carom::BodyId> turns_;
  std::vector<double> angles_;
  bool has_joints_ = false;
};

}  // namespace carom_test

// The scenes in Siconos (https://nonsmooth.gricad-pages.univ-grenoble-alpes.fr/siconos): Moreau and Jean's
// time stepping.

#include "rigid_world.h"

#include <SiconosConfig.h>

#include <Friction_cst.h>
#include <SiconosKernel.hpp>

namespace compare {
namespace {

/// Gap of a disc over a plane, and the velocities of its lowest point along normal and tangent.
class DiscOverPlane final : public LagrangianScleronomousR {
public:
  DiscOverPlane(const Plane& plane, const Disc& disc) : plane_(plane), disc_(disc) {
    setJachqPtr(std::make_shared<SimpleMatrix>(2, 3));
  }

  void computeh(const BlockVector& q, BlockVector&, SiconosVector& y) final {
    const Lever to = lever(q.getValue(2));
    y.setValue(0,
               plane_.nx * (q.getValue(0) + to.x - plane_.x) + plane_.ny * (q.getValue(1) + to.y - plane_.y));
    y.setValue(1, 0.0);
  }

  void computeJachq(const BlockVector& q, BlockVector&) final {
    const Lever to = lever(q.getValue(2));
    const double tx = plane_.ny, ty = -plane_.nx;
    SimpleMatrix& rows = *jachq();
    rows.setValue(0, 0, plane_.nx);
    rows.setValue(0, 1, plane_.ny);
    rows.setValue(0, 2, to.x * plane_.ny - to.y * plane_.nx);
    rows.setValue(1, 0, tx);
    rows.setValue(1, 1, ty);
    rows.setValue(1, 2, to.x * ty - to.y * tx);
  }

private:
  struct Lever {
    double x, y;
  };
  [[nodiscard]] Lever lever(double angle) const {
    const double c = std::cos(angle), s = std::sin(angle);
    return {c * disc_.x - s * disc_.y - disc_.radius * plane_.nx,
            s * disc_.x + c * disc_.y - disc_.radius * plane_.ny};
  }

  Plane plane_;
  Disc disc_;
};

/// Points of theirs stay together.
class PinnedPoints final : public LagrangianScleronomousR {
public:
  explicit PinnedPoints(const Pin& pin) : pin_(pin) {
    setJachqPtr(std::make_shared<SimpleMatrix>(2, pin.before < 0 ? 3 : 6));
  }

  void computeh(const BlockVector& q, BlockVector&, SiconosVector& y) final {
    y.zero();
    add(q, 0, pin_.after_x, 1.0, y);
    if (pin_.before >= 0) add(q, 3, pin_.before_x, -1.0, y);
  }

  void computeJachq(const BlockVector& q, BlockVector&) final {
    add(q, 0, pin_.after_x, 1.0);
    if (pin_.before >= 0) add(q, 3, pin_.before_x, -1.0);
  }

private:
  /// Adds the place of a point of the body whose coordinates begin at `first`.
  static void add(const BlockVector& q, unsigned int first, double point, double sign, SiconosVector& y) {
    const double angle = q.getValue(first + 2);
    y.setValue(0, y.getValue(0) + sign * (q.getValue(first) + point * std::cos(angle)));
    y.setValue(1, y.getValue(1) + sign * (q.getValue(first + 1) + point * std::sin(angle)));
  }
  void add(const BlockVector& q, unsigned int first, double point, double sign) {
    const double angle = q.getValue(first + 2);
    SimpleMatrix& rows = *jachq();
    rows.setValue(0, first, sign);
    rows.setValue(1, first + 1, sign);
    rows.setValue(0, first + 2, -sign * point * std::sin(angle));
    rows.setValue(1, first + 2, sign * point * std::cos(angle));
  }

  Pin pin_;
};

class SiconosWorld final : public RigidWorld {
public:
  SiconosWorld(double step, double theta) : RigidWorld(step), theta_(theta) {}

  void add_plane(const Plane& plane) final { planes_.push_back(plane); }

  void add_body(Mass mass, const Body& at, const std::vector<Disc>& discs) final {
    const auto vector = [](double x, double y, double z) {
      auto made = std::make_shared<SiconosVector>(3);
      made->setValue(0, x);
      made->setValue(1, y);
      made->setValue(2, z);
      return made;
    };
    auto masses = std::make_shared<SimpleMatrix>(3, 3);
    masses->zero();
    masses->setValue(0, 0, mass.mass);
    masses->setValue(1, 1, mass.mass);
    masses->setValue(2, 2, mass.inertia > 0.0 ? mass.inertia : mass.mass);  // a particle hardly turns
    auto body = std::make_shared<LagrangianLinearTIDS>(vector(at.x, at.y, at.angle),
                                                       vector(at.vx, at.vy, at.spin), masses);
    loads_.push_back(vector(0.0, -mass.mass * gravity, 0.0));
    body->setFExtPtr(loads_.back());
    model_->insertDynamicalSystem(body);
    for (const Disc& disc : discs) {
      for (const Plane& plane : planes_) {
        auto law = std::make_shared<NewtonImpactFrictionNSL>(plane.restitution, 0.0, plane.friction, 2);
        auto contact = std::make_shared<Interaction>(law, std::make_shared<DiscOverPlane>(plane, disc));
        model_->link(contact, body);
      }
    }
    bodies_.push_back(body);
  }

  void add_spring(const net::Spring& spring) final { springs_.push_back(spring); }

  void add_pin(const Pin& pin) final {
    auto joint = std::make_shared<Interaction>(std::make_shared<EqualityConditionNSL>(2),
                                               std::make_shared<PinnedPoints>(pin));
    const auto body = [&](int i) { return bodies_[static_cast<std::size_t>(i)]; };
    if (pin.before < 0) {
      model_->link(joint, body(pin.after));
    } else {
      model_->link(joint, body(pin.after), body(pin.before));
    }
    is_pinned_ = true;
  }

  void finish() final {
    std::shared_ptr<OneStepNSProblem> problem = std::make_shared<Equality>();
    if (!is_pinned_) problem = std::make_shared<FrictionContact>(2, SICONOS_FRICTION_2D_NSGS);
    simulation_ = std::make_shared<TimeStepping>(model_, std::make_shared<TimeDiscretisation>(0.0, step()),
                                                 std::make_shared<MoreauJeanOSI>(theta_), problem);
    simulation_->initialize();
  }

  [[nodiscard]] std::vector<Body> bodies() const final {
    std::vector<Body> all;
    for (const auto& body : bodies_) all.push_back(state(*body));
    return all;
  }

private:
  static Body state(const LagrangianLinearTIDS& body) {
    const SiconosVector &q = *body.q(), &v = *body.velocity();
    return {q.getValue(0), q.getValue(1), q.getValue(2), v.getValue(0), v.getValue(1), v.getValue(2)};
  }

  void make_step() final {
    if (!springs_.empty()) pull();
    simulation_->computeOneStep();
    simulation_->nextStep();
  }

  /// Loads of the particles: their weights and the springs at the start of the step.
  void pull() {
    for (const auto& load : loads_) {
      load->setValue(0, 0.0);
      load->setValue(1, -net::mass * gravity);
    }
    for (const net::Spring& spring : springs_) {
      const net::Pull pull = net::pull(spring, state(*bodies_[spring.from]), state(*bodies_[spring.to]));
      SiconosVector &from = *loads_[spring.from], &to = *loads_[spring.to];
      from.setValue(0, from.getValue(0) + pull.x);
      from.setValue(1, from.getValue(1) + pull.y);
      to.setValue(0, to.getValue(0) - pull.x);
      to.setValue(1, to.getValue(1) - pull.y);
    }
  }

  static constexpr double longest = 100.0;  // end of the time axis [s]

  double theta_;
  bool is_pinned_ = false;
  std::vector<std::shared_ptr<SiconosVector>> loads_;
  std::vector<net::Spring> springs_;
  std::vector<Plane> planes_;
  std::vector<std::shared_ptr<LagrangianLinearTIDS>> bodies_;
  std::shared_ptr<NonSmoothDynamicalSystem> model_ = std::make_shared<NonSmoothDynamicalSystem>(0.0, longest);
  std::shared_ptr<TimeStepping> simulation_;
};

auto world_of(double theta) {
  return [theta](double step) { return std::make_unique<SiconosWorld>(step, theta); };
}

}  // namespace

Engine engine() {
  Engine siconos{.name = "Siconos" COMPARE_VERSION, .cases = {}, .missing = {}, .references = {}};
  for (const Scene scene : {Scene::tables, Scene::balls, Scene::bar}) {
    siconos.cases.push_back(rigid_case(scene, "`MoreauJeanOSI`, theta 0.5, `NSGS`", true, world_of(0.5)));
  }
  // With 0.5, explicit forces of springs would gain energy.
  siconos.cases.push_back(rigid_case(
      Scene::net, "`MoreauJeanOSI`, theta 1, `NSGS`, springs as forces of the user", true, world_of(1.0)));
  siconos.cases.push_back(
      rigid_case(Scene::chain, "`MoreauJeanOSI`, theta 0.5, pins by the user", true, world_of(0.5)));
  siconos.cases.push_back(
      rigid_case(Scene::chain, "`MoreauJeanOSI`, theta 1, pins by the user", false, world_of(1.0)));
  return siconos;
}

}  // namespace compare

// The chain in Simbody (https://simtk.org/projects/simbody), in joint coordinates. Its contact is compliant,
// with a restitution that depends on the speed, so that the other scenes have no counterpart.

#include "driver.h"

#include <simbody/Simbody.h>

namespace compare {
namespace {

class SimbodyWorld final : public World {
public:
  explicit SimbodyWorld(double accuracy) {
    SimTK::Force::Gravity(forces_, matter_, SimTK::Vec3(0.0, -gravity, 0.0));
    const SimTK::Real inertia = chain::of_rod.inertia;
    const SimTK::MassProperties rod(chain::mass, SimTK::Vec3(0.0), SimTK::Inertia(inertia, inertia, inertia));
    const SimTK::Body::Rigid body(rod);
    const SimTK::Vec3 half(0.5 * chain::length, 0.0, 0.0);
    for (int i = 0; i < chain::rods; ++i) {
      SimTK::MobilizedBody& before =
          i == 0 ? static_cast<SimTK::MobilizedBody&>(matter_.Ground()) : rods_.back();
      rods_.emplace_back(before, SimTK::Transform(i == 0 ? SimTK::Vec3(0.0) : half), body,
                         SimTK::Transform(SimTK::Vec3(-half)));
    }
    const SimTK::State state = system_.realizeTopology();
    integrator_ = std::make_unique<SimTK::RungeKuttaMersonIntegrator>(system_);
    if (accuracy > 0.0) integrator_->setAccuracy(accuracy);
    stepper_ = std::make_unique<SimTK::TimeStepper>(system_, *integrator_);
    stepper_->initialize(state);
  }

  void advance(double time) final { stepper_->stepTo(time); }

  [[nodiscard]] std::vector<Body> bodies() const final {
    std::vector<double> angles, rates;
    double angle = 0.0, rate = 0.0;
    const SimTK::State& state = stepper_->getState();
    for (const SimTK::MobilizedBody::Pin& rod : rods_) {
      angles.push_back(angle += rod.getAngle(state));
      rates.push_back(rate += rod.getRate(state));
    }
    return chain::bodies(angles, rates);
  }

private:
  SimTK::MultibodySystem system_;
  SimTK::SimbodyMatterSubsystem matter_{system_};
  SimTK::GeneralForceSubsystem forces_{system_};
  std::vector<SimTK::MobilizedBody::Pin> rods_;
  std::unique_ptr<SimTK::RungeKuttaMersonIntegrator> integrator_;
  std::unique_ptr<SimTK::TimeStepper> stepper_;
};

Case make_case(const std::string& options, bool as_it_comes, double accuracy) {
  return {Scene::chain, options, as_it_comes, [accuracy](const Scale&, int) -> std::unique_ptr<World> {
            return std::make_unique<SimbodyWorld>(accuracy);
          }};
}

}  // namespace

Engine engine() {
  int major = 0, minor = 0, build = 0;
  SimTK_version_simbody(&major, &minor, &build);
  Engine simbody{.name = "Simbody " + std::to_string(major) + "." + std::to_string(minor),
                 .cases = {},
                 .missing = {},
                 .references = {}};
  simbody.cases.push_back(make_case("`RungeKuttaMerson`, accuracy 1e-3", true, 0.0));
  simbody.cases.push_back(make_case("`RungeKuttaMerson`, accuracy 1e-7", false, 1e-7));
  for (const Scene scene : {Scene::tables, Scene::net, Scene::balls, Scene::bar}) {
    simbody.missing.push_back({scene, "contact is compliant: its restitution depends on the speed"});
  }
  return simbody;
}

}  // namespace compare

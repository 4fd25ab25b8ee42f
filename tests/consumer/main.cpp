// A user's program, built against a copy of carom from outside its tree: a pair of particles on a spring
// falls on the floor, pulled by a force element of the user's own. What crosses the library's boundary is
// here: parts, a state in both directions, a user's virtual functions, an exception, a file: a contact
// problem is saved to the path given as first argument.

#include <carom/carom.h>

#include <cmath>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

using namespace carom;
using namespace carom::planar;

namespace {

// Pulls a body towards the axis x = 0.
struct Magnet {
  static constexpr Role role = Role::force;
  static constexpr int dimension = 2;
  BodyId body;
  double stiffness = 0.0;

  std::vector<BodyId> bodies() const { return {body}; }
  void loads(const ElementView<2>& at, ElementLoads<2>& out) const {
    out.conservative(body, Vec<2>(-stiffness * at.position(body).x(), 0.0));
  }
  double potential(const ElementView<2>& at) const {
    return 0.5 * stiffness * std::pow(at.position(body).x(), 2);
  }
};

int failures = 0;

void expect(bool holds, const char* what) {
  if (holds) return;
  std::cerr << "consumer: not so: " << what << "\n";
  ++failures;
}

}  // namespace

int main(int count, char** arguments) {
  constexpr double g = 9.81;

  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.point = {0.0, 0.0}, .normal = {0.0, 1.0}},
             Surface{.friction = 0.1, .normal_restitution = 0.5, .tangential_restitution = 0.0});
  const BodyId lower = system.add(Particle{.mass = 1.0, .position = {0.5, 1.0}}, "lower");
  const BodyId upper = system.add(Particle{.mass = 1.0, .position = {0.5, 1.5}}, "upper");
  system.add(
      SpringDamper{.from = lower, .to = upper, .stiffness = 200.0, .damping = 1.0, .free_length = 0.5});
  system.add(Magnet{.body = lower, .stiffness = 3.0});

  try {
    system.add(Particle{.mass = -1.0});
    expect(false, "a negative mass is refused");
  } catch (const ModelError& error) {
    expect(std::string(error.what()).find("mass") != std::string::npos, "the error names the mass");
  }

  Simulation simulation(std::move(system), TimeStepping{.step = 1e-3});
  simulation.run_until(0.25);
  const Eigen::Vector2d fallen =
      0.5 * (simulation.state().position(lower) + simulation.state().position(upper));
  expect(std::abs(fallen.y() - (1.25 - 0.5 * g * 0.25 * 0.25)) < 1e-10, "the centre of mass falls freely");
  expect(fallen.x() < 0.5, "the user's element pulls");

  State state = simulation.state();
  state.velocity(upper) += Eigen::Vector2d(0.2, 0.0);
  simulation.set_state(state);
  state = State();
  expect(simulation.state().velocity(upper).x() > 0.1, "a changed state is taken");

  simulation.run_until(1.0);
  const EnergyLedger& energy = simulation.energy();
  expect(simulation.state().position(lower).y() > -0.02, "the floor holds");
  expect(energy.total() < energy.initial(), "the impact takes energy");
  expect(std::abs(energy.residual()) < 1e-10 * energy.scale(), "the energy ledger closes");

  if (count > 1) {
    ContactProblem problem;  // a particle strikes a floor
    problem.reset(2);
    problem.w(0, 0) = problem.w(1, 1) = 1.0;
    problem.vector()[0] = -1.0;
    problem.vector()[1] = 0.5;
    problem.sets()[1] = {.kind = SetKind::bounded_interval, .bound = 0, .coefficient = 0.2};
    problem.group();
    problem.save(arguments[1]);
    expect(ContactProblem::load(arguments[1]).w(1, 1) == 1.0, "a contact problem is read back");
  }
  return failures == 0 ? 0 : 1;
}

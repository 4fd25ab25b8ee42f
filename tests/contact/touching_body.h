#pragma once

// One rigid body whose points touch half-planes, without a simulation.

#include <carom/carom.h>
#include <carom/contact/detection/detector.h>
#include <carom/contact/island_problem.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint_set.h>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace carom_test {

using namespace carom;
using namespace carom::planar;

/// A body of 1 kg whose points touch a half-plane each.
struct Touch {
  Vec<2> point, normal;
  Surface law;
};

/// The body with its constraints, and solvers of their impacts.
class TouchingBody {
public:
  explicit TouchingBody(const std::vector<Touch>& touches) : assembly_(body_that(touches)) {
    const State state = assembly_.initial_state();
    Evaluation evaluation = make_evaluation(assembly_);
    evaluate_positions(assembly_, 0, state.view(), evaluation);
    Detector(assembly_).find(0, state.view(), evaluation, 0.0, contacts_);
    for (Constraint& contact : contacts_) contact.friction = contact.law.friction;
  }

  /// States an impact from a velocity; solve() solves it.
  IslandProblem impact(const std::array<double, 3>& velocity, bool plastic_jams) {
    IslandProblem problem(IslandOptions{.plastic_jams = plastic_jams});
    state(problem, velocity);
    return problem;
  }
  /// States an impact of all its contacts.
  void state(IslandProblem& problem, const std::array<double, 3>& velocity) {
    problem.build(contacts_, velocity.data());
    MassResponse masses(assembly_);
    problem.respond(masses);
    problem.set_free_velocity(velocity.data());
  }
  /// Change of kinetic energy by its impulses [J].
  double gain(const IslandProblem& problem, const std::array<double, 3>& velocity) const {
    std::array<double, 3> after = velocity;
    problem.map().add_velocities(after.data());
    const std::array<double, 3> masses{1.0, 1.0, inertia};
    double change = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      change += 0.5 * masses[i] * (after[i] * after[i] - velocity[i] * velocity[i]);
    }
    return change;
  }
  [[nodiscard]] const ConstraintSet& contacts() const { return contacts_; }
  /// States the impact of some of its contacts, and solves it.
  bool solve(IslandProblem& problem, std::span<const Constraint> contacts,
             const std::array<double, 3>& velocity) {
    problem.build(contacts, velocity.data());
    MassResponse masses(assembly_);
    problem.respond(masses);
    problem.set_free_velocity(velocity.data());
    return problem.solve(chain).usable();
  }
  SolverChain chain;

private:
  static constexpr double inertia = 0.1;  // [kg m^2]

  static System body_that(const std::vector<Touch>& touches) {
    System system;
    const BodyId body = system.add(RigidBody{.mass = {.mass = 1.0, .inertia = inertia}});
    unsigned group = 1;
    for (const Touch& touch : touches) {
      const ContactFilter alone{.groups = group, .touches = group};
      system.add(Point{.body = body, .position = touch.point, .filter = alone});
      system.add(
          HalfPlane{.point = touch.point + 1e-9 * touch.normal, .normal = touch.normal, .filter = alone},
          touch.law);
      group *= 2;
    }
    return system;
  }

  Assembly assembly_;
  ConstraintSet contacts_;
};

}  // namespace carom_test

#include <carom/bodies/particle.h>
#include <carom/bodies/rigid_body.h>
#include <carom/core/difference_derivatives.h>
#include <carom/core/force_element.h>

#include "tests/random.h"
#include <carom/testing/loaded_model.h>

#include <gtest/gtest.h>

#include <Eigen/Core>

#include <cmath>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom::energy_test::LoadedModel;

// Forces between a particle and a rigid body whose derivatives are known: quadratic in position, velocity and
// angle, so that central differences have no error but rounding; a sine for the truncation error.
struct Known {
  static constexpr Role role = Role::force;
  static constexpr int dimension = 2;
  BodyId particle, plate;
  std::vector<BodyId> bodies() const { return {particle, ground, plate, particle}; }
  void loads(const ElementView<2>& at, ElementLoads<2>& out) const {
    const Vec<2> x = at.position(particle), v = at.velocity(particle);
    out.conservative(particle, {3.0 * x[0] * x[1], 0.0});
    out.dissipative(particle, {0.0, -2.0 * v[1] * v[1] + at.time()});
    out.external(plate, {at.spin(plate) * x[0], 0.0});
    out.external_torque(plate, std::sin(at.angle(plate)) + 4.0 * v[0]);
  }
};

class DifferenceDerivativesTest : public testing::Test {
protected:
  static System make_system() {
    System system;
    system.add(Particle{.mass = 1.0});  // a bystander, so that offsets are not zero
    const BodyId particle = system.add(Particle{.mass = 1.0, .position = {2, -3}, .velocity = {0.5, 40.0}});
    const BodyId plate = system.add(RigidBody{.mass = disc(1.0, 1.0), .angle = 0.7, .spin = -1.5});
    system.add(Known{.particle = particle, .plate = plate});
    return system;
  }
  // Derivatives as matrices over all velocities.
  struct Matrices {
    Eigen::MatrixXd by_position, by_velocity;
  };
  Matrices assemble(const std::vector<LoadDerivative>& entries) const {
    const auto size = static_cast<Eigen::Index>(model.state.v.size());
    Matrices m{Eigen::MatrixXd::Zero(size, size), Eigen::MatrixXd::Zero(size, size)};
    for (const LoadDerivative& entry : entries) {
      m.by_position(entry.row, entry.column) += entry.by_position;
      m.by_velocity(entry.row, entry.column) += entry.by_velocity;
    }
    return m;
  }
  EvaluationContext context() const { return {model.assembly, model.state.view(), model.evaluation, 1}; }

  LoadedModel model{make_system()};
  const ForceKind& kind = *model.assembly.force_kinds()[0];
};

TEST_F(DifferenceDerivativesTest, MeetKnownDerivatives) {
  std::vector<LoadDerivative> entries;
  difference_derivatives(kind, context(), 0, entries);
  const Matrices found = assemble(entries);
  Matrices known = assemble({});
  const Layout& layout = *model.assembly.layout();
  const Index p = layout.slot({1, model.assembly.system().token()}).v;
  const Index b = layout.slot({2, model.assembly.system().token()}).v;
  known.by_position(p, p) = 3.0 * -3.0;
  known.by_position(p, p + 1) = 3.0 * 2.0;
  known.by_velocity(p + 1, p + 1) = -4.0 * 40.0;
  known.by_position(b, p) = -1.5;
  known.by_velocity(b, b + 2) = 2.0;
  known.by_position(b + 2, b + 2) = std::cos(0.7);
  known.by_velocity(b + 2, p) = 4.0;
  // Rounding: epsilon times the force over the step, 18 N and 6e-6 m; 3200 N and 40 * 6e-6 m/s.
  EXPECT_LE((found.by_position - known.by_position).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LE((found.by_velocity - known.by_velocity).cwiseAbs().maxCoeff(), 1e-8);
}

TEST_F(DifferenceDerivativesTest, AppendEachPairOnceAndChangeNothing) {
  const State before = model.state;
  const std::vector<double> rotation = model.evaluation.rotation;
  std::vector<LoadDerivative> entries(1, LoadDerivative{9, 9, 9.0, 9.0});
  difference_derivatives(kind, context(), 0, entries);
  ASSERT_EQ(entries.size(), 1U + 5U * 5U);
  EXPECT_EQ(entries[0].by_position, 9.0);
  for (std::size_t i = 1; i < entries.size(); ++i) {
    for (std::size_t j = i + 1; j < entries.size(); ++j) {
      EXPECT_FALSE(entries[i].row == entries[j].row && entries[i].column == entries[j].column);
    }
  }
  EXPECT_EQ(model.state.q, before.q);
  EXPECT_EQ(model.state.v, before.v);
  EXPECT_EQ(model.evaluation.rotation, rotation);
}

TEST_F(DifferenceDerivativesTest, OneForManyElementsGivesTheSame) {
  DifferenceDerivatives differences(context());
  std::vector<LoadDerivative> once, again;
  differences.append(kind, 0, once);
  differences.append(kind, 0, again);
  ASSERT_EQ(once.size(), again.size());
  for (std::size_t i = 0; i < once.size(); ++i) {
    EXPECT_EQ(once[i].by_position, again[i].by_position);
    EXPECT_EQ(once[i].by_velocity, again[i].by_velocity);
  }
}

TEST_F(DifferenceDerivativesTest, AreWhatAKindGivesThatHasNoneOfItsOwn) {
  EXPECT_FALSE(kind.has_derivatives());
  std::vector<LoadDerivative> own, differences;
  kind.derivatives(context(), 0, own);
  difference_derivatives(kind, context(), 0, differences);
  ASSERT_EQ(own.size(), differences.size());
  for (std::size_t i = 0; i < own.size(); ++i) EXPECT_EQ(own[i].by_position, differences[i].by_position);
}

}  // namespace

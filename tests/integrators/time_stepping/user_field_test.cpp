// Fields of users that do not depend on bodies, but are external, or change with time: the step of constant
// loads is not for them.

#include <carom/carom.h>
#include <carom/core/assembly.h>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

enum class Course { constant, oscillating };

constexpr double frequency = 5.0;  // [rad/s]

template <Course course>
class WindKind;

/// The same force on every body, which is booked as external.
template <Course course>
struct Wind {
  static constexpr Role role = Role::force;
  using Kind = WindKind<course>;
  Vec<2> force{};  ///< at time 0 [N]
};

template <Course course>
class WindKind final : public ForceKind {
public:
  static constexpr int part_dimension() { return 2; }
  static constexpr std::string_view part_label() { return "wind"; }
  void add(const Wind<course>& part, const PartCheck&) { parts_.push_back(part); }

  [[nodiscard]] std::unique_ptr<ForceKind> clone() const override {
    return std::make_unique<WindKind>(*this);
  }
  [[nodiscard]] std::unique_ptr<ForceKind> arranged(std::span<const Index> order,
                                                    const Layout&) const override {
    auto copy = std::make_unique<WindKind>();
    for (const Index slot : order) copy->parts_.push_back(parts_[slot]);
    return copy;
  }
  void remove(Index slot) override { parts_.erase(parts_.begin() + slot); }
  [[nodiscard]] std::string_view label() const override { return part_label(); }
  [[nodiscard]] int dimension() const override { return 2; }
  [[nodiscard]] Index size() const override { return static_cast<Index>(parts_.size()); }
  [[nodiscard]] bool is_field() const override { return true; }
  [[nodiscard]] bool works_in_parts() const override { return true; }
  void ends(Index, std::vector<BodyId>&) const override {}
  [[nodiscard]] bool is_constant() const override { return true; }
  [[nodiscard]] bool depends_on_time() const override { return course == Course::oscillating; }
  void evaluate(const EvaluationContext& at, Range elements, const Loads& loads) const override {
    const double share = course == Course::oscillating ? std::cos(frequency * at.state.time) : 1.0;
    const Range bodies = at.bodies.empty() ? at.assembly.components()[at.component].bodies : at.bodies;
    for (Index element = elements.begin; element < elements.end; ++element) {
      for (Index body = bodies.begin; body < bodies.end; ++body) {
        const Index v = at.layout.bodies()[body].v;
        for (Index i = 0; i < 2; ++i) loads.external[v + i] += share * parts_[element].force[i];
      }
    }
  }
  [[nodiscard]] double potential(const EvaluationContext&, Range) const override { return 0.0; }
  void fingerprint(Fingerprint& print) const override {
    for (const Wind<course>& part : parts_) print.add({part.force.data(), 2});
  }

private:
  std::vector<Wind<course>> parts_;
};

template <Course course>
Simulation blown(int particles) {
  System system;
  system.add(Wind<course>{{0.7, -5.0}});
  for (int i = 0; i < particles; ++i) system.add(Particle{.mass = 2.0, .position = {1.0 * i, 0.0}});
  return {std::move(system), TimeStepping{.step = 1e-3}};
}

TEST(UserField, WorkOfAConstantExternalLoadIsExternal) {
  Simulation simulation = blown<Course::constant>(3);
  simulation.run_until(1.0);
  const double work = 3.0 * 0.5 * (0.7 * 0.7 + 5.0 * 5.0) / 2.0;  // (F t)^2 / 2 m
  EXPECT_NEAR(simulation.energy().flow(EnergyFlow::external), work, 1e-12 * work);
  EXPECT_NEAR(simulation.energy().flow(EnergyFlow::coupling_discretisation), 0.0, 1e-12 * work);
}

TEST(UserField, ALoadThatChangesWithTimeDoes) {
  Simulation simulation = blown<Course::oscillating>(3);
  simulation.run_until(1.0);
  const double mean = std::sin(frequency) / frequency / 2.0;  // integral of the course, over the mass
  for (std::size_t i = 0; i < 3; ++i) {
    // The trapezoidal rule: h^2/12 times the change of the rate of the load.
    const double error = 1e-6 / 12.0 * frequency;
    EXPECT_NEAR(simulation.state().v[2 * i], 0.7 * mean, error);
    EXPECT_NEAR(simulation.state().v[2 * i + 1], -5.0 * mean, 5.0 * error);
  }
}

}  // namespace

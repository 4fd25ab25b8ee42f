// One planar impact of one body: the library, certified, beside a closed form written by hand for this
// purpose. Both start from the same flat numbers and end with impulses and velocities after. `per_impact` in
// seconds.

#include <carom/carom.h>
#include <carom/contact/island_problem.h>
#include <carom/contact/solvers/single_contact.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint_set.h>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <stdexcept>
#include <vector>

namespace {

// Lever from the centre of mass to the contact, velocities of the contact before; n normal, t tangential.
struct Impact {
  double mass, inertia;
  double lever_n, lever_t;
  double before_n, before_t;
  double normal_restitution, tangential_restitution, friction;
};

struct Result {
  double impulse_n = 0.0, impulse_t = 0.0;
  double after_n = 0.0, after_t = 0.0;
};

// More than a predictor of branches learns by heart, which it does with a few thousand; the numbers are still
// read faster than an impact takes.
constexpr std::size_t most_impacts = 1u << 16u;

// Contacts of uniform bodies that stick, slip both ways and (one in ten) leave.
const std::vector<Impact>& impacts() {
  static const std::vector<Impact> all = [] {
    std::mt19937_64 random(1);
    const auto between = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    std::vector<Impact> list;
    while (list.size() < most_impacts) {
      Impact next{.mass = between(0.5, 2.0),
                  .inertia = between(0.5, 2.0),
                  .lever_n = between(-1.0, 1.0),
                  .lever_t = between(-1.0, 1.0),
                  .before_n = between(-1.0, 0.1),
                  .before_t = between(-1.0, 1.0),
                  .normal_restitution = between(0.0, 1.0),
                  .tangential_restitution = between(0.0, 1.0),
                  .friction = between(0.05, 0.8)};
      list.push_back(next);
    }
    return list;
  }();
  return all;
}

// docs/method.md section 2: open, stick where the sticking impulse lies in the cone, else slip.
[[gnu::noinline]] Result by_hand(const Impact& i) {
  const double inverse_mass = 1.0 / i.mass, inverse_inertia = 1.0 / i.inertia;
  const double w_nn = inverse_mass + i.lever_t * i.lever_t * inverse_inertia;
  const double w_tt = inverse_mass + i.lever_n * i.lever_n * inverse_inertia;
  const double w_nt = -i.lever_n * i.lever_t * inverse_inertia;
  const double b_n = (1.0 + i.normal_restitution) * i.before_n;
  const double b_t = (1.0 + i.tangential_restitution) * i.before_t;
  if (b_n >= 0.0) return {0.0, 0.0, i.before_n, i.before_t};
  const double determinant = w_nn * w_tt - w_nt * w_nt;
  double n = (w_nt * b_t - w_tt * b_n) / determinant;
  double t = (w_nt * b_n - w_nn * b_t) / determinant;
  const double positive = b_n * (w_nt - i.friction * w_tt) - b_t * (w_nn - i.friction * w_nt);
  const double negative = b_t * (w_nn + i.friction * w_nt) - b_n * (w_nt + i.friction * w_tt);
  if (positive < 0.0) {
    n = -b_n / (w_nn - i.friction * w_nt);
    t = -i.friction * n;
  } else if (negative < 0.0) {
    n = -b_n / (w_nn + i.friction * w_nt);
    t = i.friction * n;
  }
  return {n, t, i.before_n + w_nn * n + w_nt * t, i.before_t + w_nt * n + w_tt * t};
}

// The same through the library's door for one planar contact: its numbers, a certified answer.
[[gnu::noinline]] Result by_certified_contact(const Impact& i) {
  const double inverse_mass = 1.0 / i.mass, inverse_inertia = 1.0 / i.inertia;
  const carom::CertifiedImpulse answer =
      carom::solve_certified_contact({.w_nn = inverse_mass + i.lever_t * i.lever_t * inverse_inertia,
                                      .w_nt = -i.lever_n * i.lever_t * inverse_inertia,
                                      .w_tt = inverse_mass + i.lever_n * i.lever_n * inverse_inertia,
                                      .b_n = (1.0 + i.normal_restitution) * i.before_n,
                                      .b_t = (1.0 + i.tangential_restitution) * i.before_t,
                                      .friction = i.friction});
  if (!answer.usable || !(answer.residual <= carom::accepted_residual)) {
    throw std::logic_error("impact not solved");
  }
  return {answer.impulse.normal, answer.impulse.tangential, answer.xi_n - i.normal_restitution * i.before_n,
          answer.xi_t - i.tangential_restitution * i.before_t};
}

// The same through the library's door for any contact problem: matrix, vector, sets, chain of solvers.
class ByLibrary {
public:
  Result operator()(const Impact& i) {
    const double inverse_mass = 1.0 / i.mass, inverse_inertia = 1.0 / i.inertia;
    problem_.reset(2);
    problem_.w(0, 0) = inverse_mass + i.lever_t * i.lever_t * inverse_inertia;
    problem_.w(1, 1) = inverse_mass + i.lever_n * i.lever_n * inverse_inertia;
    problem_.w(0, 1) = problem_.w(1, 0) = -i.lever_n * i.lever_t * inverse_inertia;
    problem_.vector()[0] = (1.0 + i.normal_restitution) * i.before_n;
    problem_.vector()[1] = (1.0 + i.tangential_restitution) * i.before_t;
    problem_.sets()[1].kind = carom::SetKind::bounded_interval;
    problem_.sets()[1].bound = 0;
    problem_.sets()[1].coefficient = i.friction;
    problem_.group();
    if (!chain_.solve(problem_, impulse_).usable()) throw std::logic_error("impact not solved");
    return {impulse_[0], impulse_[1], chain_.velocities()[0] - i.normal_restitution * i.before_n,
            chain_.velocities()[1] - i.tangential_restitution * i.before_t};
  }

private:
  carom::ContactProblem problem_;
  carom::SolverChain chain_;
  std::array<double, 2> impulse_{};
};

// The way of a step: contacts of bodies of an assembly, from velocities before to velocities after.
class ByCluster {
public:
  ByCluster() : assembly_(system()) {
    const auto& bodies = assembly_.layout()->bodies();
    for (std::size_t body = 0; body < impacts().size(); ++body) {
      const Impact& i = impacts()[body];
      carom::Constraint& contact = contacts_.add();
      contact.add_body(static_cast<carom::Index>(body), bodies[body].v, 3);
      contact.start_rows(2);
      contact.law = {i.friction, i.normal_restitution, i.tangential_restitution};
      contact.friction = i.friction;
      // Normal along y, tangent along x.
      const std::array<double, 3> normal{0.0, 1.0, i.lever_t}, tangent{1.0, 0.0, -i.lever_n};
      std::copy(normal.begin(), normal.end(), contact.row(0));
      std::copy(tangent.begin(), tangent.end(), contact.row(1));
      velocity_.insert(velocity_.end(), {i.before_t, i.before_n, 0.0});
    }
  }
  Result operator()(std::size_t body) {
    const carom::Constraint& contact = contacts_[body];
    cluster_.build({&contact, 1}, velocity_.data());
    cluster_.respond(masses_);
    cluster_.set_free_velocity(velocity_.data());
    if (!cluster_.solve(chain_).usable()) throw std::logic_error("impact not solved");
    std::array<double, 3> after{};
    for (std::size_t k = 0; k < 3; ++k) after[k] = velocity_[contact.blocks[0].v + k];
    cluster_.map().add_velocities(after.data() - contact.blocks[0].v);
    return {cluster_.impulses()[0], cluster_.impulses()[1], after[1] + contact.row(0)[2] * after[2],
            after[0] + contact.row(1)[2] * after[2]};
  }

private:
  static carom::System system() {
    carom::System all;
    for (const Impact& i : impacts()) {
      all.add(carom::planar::RigidBody{.mass = {.mass = i.mass, .inertia = i.inertia}});
    }
    return all;
  }

  carom::Assembly assembly_;
  carom::ConstraintSet contacts_;
  std::vector<double> velocity_;
  carom::MassResponse masses_{assembly_};
  carom::IslandProblem cluster_;
  carom::SolverChain chain_;
};

void demand_equal(const Result& a, const Result& b) {
  const std::array<double, 4> difference{a.impulse_n - b.impulse_n, a.impulse_t - b.impulse_t,
                                         a.after_n - b.after_n, a.after_t - b.after_t};
  for (const double d : difference) {
    if (!(std::abs(d) <= 1e-12)) throw std::logic_error("impact by hand and by library differ");
  }
}

template <class F>
void time_impacts(benchmark::State& state, F&& solve) {
  const std::size_t count = impacts().size();
  for (std::size_t i = 0; i < count; ++i) demand_equal(solve(i), by_hand(impacts()[i]));
  for (auto _ : state) {
    for (std::size_t i = 0; i < count; ++i) {
      Result result = solve(i);
      benchmark::DoNotOptimize(result);
    }
  }
  using benchmark::Counter;
  state.counters["per_impact"] =
      Counter(static_cast<double>(count), Counter::kIsIterationInvariantRate | Counter::kInvert);
}

void impact_by_hand(benchmark::State& state) {
  time_impacts(state, [](std::size_t i) { return by_hand(impacts()[i]); });
}
void impact_certified(benchmark::State& state) {
  time_impacts(state, [](std::size_t i) { return by_certified_contact(impacts()[i]); });
}
void impact_by_library(benchmark::State& state) {
  ByLibrary library;
  time_impacts(state, [&](std::size_t i) { return library(impacts()[i]); });
}
void impact_of_body(benchmark::State& state) {
  ByCluster library;
  time_impacts(state, [&](std::size_t i) { return library(i); });
}

BENCHMARK(impact_by_hand);
BENCHMARK(impact_certified);
BENCHMARK(impact_by_library);
BENCHMARK(impact_of_body);

}  // namespace

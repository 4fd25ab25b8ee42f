// Loads of a large component, block by block: once, twice with the second close behind the first, on some
// blocks alone.

#include "examples/scenes/net.h"

#include <carom/carom.h>
#include <carom/core/assembly.h>
#include <carom/core/workers.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace {

using namespace carom;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

class Wind;

struct Blow {
  static constexpr Role role = Role::force;
  using Kind = Wind;
};

/// A wind that blows through all bodies of a component at once, so that no block is done before it.
class Wind final : public ForceKind {
public:
  static constexpr int part_dimension() { return 2; }
  static constexpr std::string_view part_label() { return "wind"; }
  void add(const Blow&, const PartCheck&) {}
  std::unique_ptr<ForceKind> clone() const override { return std::make_unique<Wind>(*this); }
  std::unique_ptr<ForceKind> arranged(std::span<const Index>, const Layout&) const override {
    return clone();
  }
  void remove(Index) override {}
  std::string_view label() const override { return part_label(); }
  int dimension() const override { return 2; }
  Index size() const override { return 1; }
  bool is_field() const override { return true; }
  void ends(Index, std::vector<BodyId>&) const override {}
  void evaluate(const EvaluationContext& at, Range, const Loads& loads) const override {
    const Range v = at.assembly.components()[at.component].v;
    for (Index i = v.begin; i < v.end; ++i)
      loads.external[i] -= 0.1 * at.state.v[i] * std::abs(at.state.v[i]);
  }
  double potential(const EvaluationContext&, Range) const override { return 0.0; }
  void fingerprint(Fingerprint&) const override {}
};

/// A net of fifty blocks in several runs, not at rest.
struct LargeNet {
  explicit LargeNet(bool with_wind) : assembly(described(with_wind)), state(assembly.initial_state()) {
    for (std::size_t i = 0; i < state.v.size(); ++i) state.v[i] = std::sin(static_cast<double>(i));
  }
  static System described(bool with_wind) {
    System system;
    scenes::add_net(system, {.k = 160, .prestress = 0.01});
    if (with_wind) system.add(Blow{});
    return system;
  }

  Assembly assembly;
  State state;
};

/// State that a second sweep might make of the first one's loads.
void move_on(const Block& block, const std::vector<double>& loads, State& state) {
  for (Index i = block.v.begin; i < block.v.end; ++i) {
    state.q[i] += 1e-6 * loads[i];
    state.v[i] += 1e-3 * loads[i];
  }
}

/// Largest difference, in parts of the largest number.
double apart(const std::vector<double>& a, const std::vector<double>& b) {
  double difference = 0.0, size = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference = std::max(difference, std::abs(a[i] - b[i]));
    size = std::max(size, std::abs(b[i]));
  }
  return difference / size;
}

TEST(AssemblyEvaluation, TasksComeBeforeAndAfterTheLoadsOfTheirBlock) {
  for (const bool with_wind : {false, true}) {
    const LargeNet net(with_wind);
    const Evaluation evaluation = make_evaluation(net.assembly);
    const std::size_t size = net.state.v.size();
    std::vector<double> plain(size), loads(size, 1.0), seen(size);
    const auto where = [](std::vector<double>& to) { return Loads{to.data(), to.data(), to.data()}; };
    evaluate_loads(net.assembly, 0, net.state.view(), evaluation, where(plain));

    std::vector<int> firsts(net.assembly.blocks().size()), lasts(firsts);
    const auto first = [&](const Block& block, Index part) {
      EXPECT_EQ(block.v.begin, net.assembly.blocks()[part].v.begin);
      EXPECT_EQ(loads[block.v.begin], 1.0) << "not zeroed yet";
      ++firsts[part];
    };
    const auto last = [&](const Block& block, Index part) {
      std::copy(loads.begin() + block.v.begin, loads.begin() + block.v.end, seen.begin() + block.v.begin);
      ++lasts[part];
    };
    evaluate_loads(net.assembly, 0, net.state.view(), evaluation, where(loads), Workers(), {first, last});
    EXPECT_EQ(firsts, std::vector<int>(firsts.size(), 1));
    EXPECT_EQ(lasts, firsts);
    EXPECT_EQ(seen, loads) << "complete when the last task sees them";
    EXPECT_EQ(loads, plain);
  }
}

TEST(AssemblyEvaluation, TwiceIsOneAfterTheOther) {
  for (const bool with_wind : {false, true}) {
    for (const int threads : {1, 2}) {
      if (threads > 1 && !Workers::several_available()) continue;
      const LargeNet net(with_wind);
      const Evaluation evaluation = make_evaluation(net.assembly);
      const std::size_t size = net.state.v.size();
      std::vector<double> first(size), losses(size), second(size), seen_first(size), seen_second(size);

      State plain = net.state;
      evaluate_loads(net.assembly, 0, plain.view(), evaluation, {first.data(), first.data(), first.data()});
      for (const Block& block : net.assembly.blocks()) move_on(block, first, plain);
      StoredEnergies plain_stored;
      evaluate_loads_and_potentials(net.assembly, 0, plain.view(), evaluation,
                                    {second.data(), losses.data(), second.data()}, plain_stored);

      State state = net.state;
      std::vector<double> loads(size), twice_losses(size);
      StoredEnergies stored;
      const auto note = [&](std::vector<double>& seen) {
        return [&](const Block& block, Index) {
          std::copy(loads.begin() + block.v.begin, loads.begin() + block.v.end, seen.begin() + block.v.begin);
        };
      };
      const auto close = note(seen_first), last = note(seen_second);
      const auto again = [&](const Block& block, Index) { move_on(block, loads, state); };
      evaluate_loads_twice(net.assembly, 0, state.view(), evaluation,
                           {loads.data(), loads.data(), loads.data()}, {.last = close},
                           {loads.data(), twice_losses.data(), loads.data()}, {again, last}, stored,
                           Workers(threads));
      // Eight springs and a wind are summed at each particle, in another order.
      constexpr double rounding = 9 * epsilon;
      EXPECT_LT(apart(seen_first, first), rounding);
      EXPECT_LT(apart(state.v, plain.v), rounding);
      // So a position of up to 16 m may end a unit in the last place apart; eight springs of 10^4 N/m turn
      // that into a load, taken in parts of the largest, 30 N.
      constexpr double moved = rounding + epsilon * 16.0 * 8e4 / 30.0;
      EXPECT_LT(apart(seen_second, second), moved);
      EXPECT_LT(apart(twice_losses, losses), rounding);
      EXPECT_EQ(seen_second, loads) << "complete when the last task sees them";
      EXPECT_NEAR(stored.total(), plain_stored.total(), moved * std::abs(plain_stored.total()));
    }
  }
}

TEST(AssemblyEvaluation, WithinSomeBlocksLoadsAreThoseOfAll) {
  const LargeNet net(false);
  const Evaluation evaluation = make_evaluation(net.assembly);
  const std::size_t size = net.state.v.size();
  std::vector<double> all(size);
  evaluate_loads(net.assembly, 0, net.state.view(), evaluation, {all.data(), all.data(), all.data()});
  const BlockTable& blocks = net.assembly.blocks();
  const Range second_run = net.assembly.blocks().runs()[1];
  Index loaded_across_runs = 0;
  for (Index block = 0; block < blocks.size(); ++block)
    loaded_across_runs += blocks[block].loaded_across_runs ? 1U : 0U;
  ASSERT_GT(loaded_across_runs, 0U);
  ASSERT_LT(loaded_across_runs, blocks.size());

  constexpr double left_alone = 7.0;
  for (const std::vector<Index>& inner : std::vector<std::vector<Index>>{
           {0}, {0, 1}, {0, 3}, {2, second_run.begin + 3}, {second_run.begin + 3, second_run.begin + 5}}) {
    Surroundings around;
    around.inner = inner;
    ASSERT_TRUE(net.assembly.blocks().surround(around));
    EXPECT_EQ(around.inner, inner);
    for (const auto& found : {around.loading, around.touched}) {
      EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
      EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());
      EXPECT_LE(found.size(), inner.size() * 6) << "a row of the net is a third of a block";
    }
    std::vector<double> loads(size, left_alone);
    evaluate_loads_within(net.assembly, 0, around, net.state.view(), evaluation,
                          {loads.data(), loads.data(), loads.data()});
    for (Index block = 0; block < blocks.size(); ++block) {
      const auto is_in = [block](const std::vector<Index>& some) {
        return std::binary_search(some.begin(), some.end(), block);
      };
      for (Index i = blocks[block].v.begin; i < blocks[block].v.end; ++i) {
        if (is_in(inner)) {
          EXPECT_EQ(loads[i], all[i]) << block;
        } else if (!is_in(around.touched)) {
          EXPECT_EQ(loads[i], left_alone) << block;
        }
      }
    }
  }
  const LargeNet windy(true);
  for (Index block = 0; block < blocks.size(); ++block) {
    Surroundings around;
    around.inner = {block};
    EXPECT_EQ(net.assembly.blocks().surround(around), !blocks[block].loaded_across_runs) << block;
    EXPECT_FALSE(windy.assembly.blocks().surround(around)) << "what blows everywhere at once bridges all";
  }
}

}  // namespace

// The broad phase: time per box of one call, beside a grid by hand with cells of one size.
//
// Names: <what>/<N> for N boxes in a square that they fill by half. `per_box` is in seconds, over one call;
// `pairs` is how many pairs there are per box. Boxes of one size, or of sizes from 1 to 100 whose logarithms
// are even, or of size 1 and one in a thousand of size 100. Between calls they move slowly (a thousandth of
// the least size) or fast (all of it), or a hundredth of them fast and the others slowly.

#include <carom/contact/detection/broad_phase.h>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <span>
#include <utility>
#include <vector>

namespace {

using carom::Box;
using carom::BoxPair;
using carom::Index;
using Boxes = std::vector<Box<2>>;

constexpr double slow_way = 1e-3, fast_way = 1.0;  // ways between calls
enum class Sizes { equal, even, few_large };
enum class Motion { slow, fast, few_fast };
constexpr double largest = 100.0;  // of mixed sizes, the least is 1
constexpr double share = 0.5;      // of the square that boxes fill
constexpr int calls = 64;          // sets of boxes that a run goes through, there and back

// Boxes in motion that bounce at the border of their square.
class Field {
public:
  Field(Index count, Sizes sizes, Motion motion) : random_(1) {
    double area = 0.0;
    for (Index i = 0; i < count; ++i) {
      double size = 1.0;
      if (sizes == Sizes::even) size = std::pow(largest, uniform(0.0, 1.0));
      if (sizes == Sizes::few_large && i % 1000 == 500) size = largest;
      area += size * size, sizes_.push_back(size);
    }
    side_ = std::sqrt(area / share);
    boxes_.resize(count);
    for (Index i = 0; i < count; ++i) {
      for (int k = 0; k < 2; ++k) {
        boxes_[i].min[k] = uniform(0.0, side_ - sizes_[i]);
        boxes_[i].max[k] = boxes_[i].min[k] + sizes_[i];
      }
      const double angle = uniform(0.0, 6.28);
      const bool hurries = motion == Motion::fast || (motion == Motion::few_fast && i % 100 == 50);
      const double way = hurries ? fast_way : slow_way;
      velocities_.emplace_back(way * std::cos(angle), way * std::sin(angle));
    }
  }

  void move() {
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      for (int k = 0; k < 2; ++k) {
        const double to = boxes_[i].min[k] + velocities_[i][k];
        if (to < 0.0 || to + sizes_[i] > side_) velocities_[i][k] = -velocities_[i][k];
        boxes_[i].min[k] += velocities_[i][k];
        boxes_[i].max[k] = boxes_[i].min[k] + sizes_[i];
      }
    }
  }

  [[nodiscard]] const Boxes& boxes() const { return boxes_; }
  [[nodiscard]] double side() const { return side_; }

private:
  double uniform(double lower, double upper) {
    return std::uniform_real_distribution<double>(lower, upper)(random_);
  }

  std::mt19937_64 random_;
  double side_ = 0.0;
  std::vector<double> sizes_;
  Boxes boxes_;
  std::vector<carom::Vec<2>> velocities_;
};

// All cells of a square, as large as the largest box; each box in the cell of its least corner. Pairs come as
// they are found, and sorted where that is asked for.
class PlainGrid {
public:
  PlainGrid(double side, double cell) : inverse_(1.0 / cell), columns_(static_cast<Index>(side / cell) + 3) {}

  const std::vector<BoxPair>& find(const Boxes& boxes) {
    begin_.assign(static_cast<std::size_t>(columns_) * columns_ + 1, 0);
    cell_.resize(boxes.size()), entries_.resize(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const auto x = static_cast<Index>(boxes[i].min[0] * inverse_) + 1;
      const auto y = static_cast<Index>(boxes[i].min[1] * inverse_) + 1;
      cell_[i] = y * columns_ + x;
      ++begin_[cell_[i]];
    }
    Index end = 0;
    for (Index& entry : begin_) end += entry, entry = end;
    for (std::size_t i = boxes.size(); i-- > 0;) {
      entries_[--begin_[cell_[i]]] = {boxes[i], static_cast<Index>(i)};
    }
    pairs_.clear();
    for (Index cell = columns_; cell + columns_ < begin_.size() - 1; ++cell) {
      for (Index e = begin_[cell]; e < begin_[cell + 1]; ++e) {
        test(e, e + 1, begin_[cell + 2]);
        test(e, begin_[cell + columns_ - 1], begin_[cell + columns_ + 2]);
      }
    }
    return pairs_;
  }

  const std::vector<BoxPair>& find_sorted(const Boxes& boxes) {
    find(boxes);
    std::sort(pairs_.begin(), pairs_.end());
    return pairs_;
  }

private:
  void test(Index entry, Index from, Index to) {
    const auto& [box, number] = entries_[entry];
    for (Index e = from; e < to; ++e) {
      const auto& [other, partner] = entries_[e];
      if (!carom::overlap(box, other)) continue;
      pairs_.push_back({std::min(number, partner), std::max(number, partner)});
    }
  }

  double inverse_;
  Index columns_;
  std::vector<Index> begin_, cell_;
  std::vector<std::pair<Box<2>, Index>> entries_;
  std::vector<BoxPair> pairs_;
};

// Times calls of `find(boxes)`, the motion between them left out.
template <class F>
void time_calls(benchmark::State& state, Sizes sizes, Motion motion, F&& find) {
  const auto count = static_cast<Index>(state.range(0));
  Field field(count, sizes, motion);
  std::vector<Boxes> sets;
  const int kept = count > 20000 ? calls / 4 : calls;
  for (int i = 0; i < kept; ++i) sets.push_back(field.boxes()), field.move();
  std::size_t pairs = 0, call = 0;
  const auto next = [&]() -> const Boxes& {
    const std::size_t at = call++ % (2 * sets.size() - 2);
    return sets[at < sets.size() ? at : 2 * sets.size() - 2 - at];
  };
  find(next(), field.side());
  for (auto _ : state) pairs += find(next(), field.side());
  using benchmark::Counter;
  state.counters["per_box"] =
      Counter(static_cast<double>(count), Counter::kIsIterationInvariantRate | Counter::kInvert);
  state.counters["pairs"] = Counter(static_cast<double>(pairs) / count, Counter::kAvgIterations);
}

void broad_phase(benchmark::State& state, Sizes sizes, Motion motion) {
  carom::BroadPhase<2> broad;
  broad.reset(static_cast<Index>(state.range(0)));
  time_calls(state, sizes, motion, [&](const Boxes& boxes, double) { return broad.update(boxes).size(); });
}

// Everything from the beginning in each call.
void from_the_beginning(benchmark::State& state, Sizes sizes, Motion motion) {
  carom::BroadPhase<2> broad;
  time_calls(state, sizes, motion, [&](const Boxes& boxes, double) {
    broad.reset(static_cast<Index>(boxes.size()));
    return broad.update(boxes).size();
  });
}

void plain(benchmark::State& state, Sizes sizes, Motion motion, bool sorted) {
  std::vector<PlainGrid> grid;
  time_calls(state, sizes, motion, [&](const Boxes& boxes, double side) {
    if (grid.empty()) grid.emplace_back(side, sizes == Sizes::equal ? 1.0 : largest);
    return (sorted ? grid[0].find_sorted(boxes) : grid[0].find(boxes)).size();
  });
}

void equal_slow(benchmark::State& state) { broad_phase(state, Sizes::equal, Motion::slow); }
void equal_few_fast(benchmark::State& state) { broad_phase(state, Sizes::equal, Motion::few_fast); }
void equal_fast(benchmark::State& state) { broad_phase(state, Sizes::equal, Motion::fast); }
void equal_anew(benchmark::State& state) { from_the_beginning(state, Sizes::equal, Motion::fast); }
void equal_plain(benchmark::State& state) { plain(state, Sizes::equal, Motion::fast, false); }
void equal_plain_sorted(benchmark::State& state) { plain(state, Sizes::equal, Motion::fast, true); }
void mixed_slow(benchmark::State& state) { broad_phase(state, Sizes::even, Motion::slow); }
void mixed_few_fast(benchmark::State& state) { broad_phase(state, Sizes::even, Motion::few_fast); }
void mixed_fast(benchmark::State& state) { broad_phase(state, Sizes::even, Motion::fast); }
void mixed_plain(benchmark::State& state) { plain(state, Sizes::even, Motion::fast, false); }
void few_large_fast(benchmark::State& state) { broad_phase(state, Sizes::few_large, Motion::fast); }
void few_large_plain(benchmark::State& state) { plain(state, Sizes::few_large, Motion::fast, false); }

}  // namespace

#define CAROM_SIZES RangeMultiplier(10)->Range(100, 100000)
BENCHMARK(equal_slow)->CAROM_SIZES;
BENCHMARK(equal_few_fast)->CAROM_SIZES;
BENCHMARK(equal_fast)->CAROM_SIZES;
BENCHMARK(equal_anew)->CAROM_SIZES;
BENCHMARK(equal_plain)->CAROM_SIZES;
BENCHMARK(equal_plain_sorted)->CAROM_SIZES;
BENCHMARK(mixed_slow)->CAROM_SIZES;
BENCHMARK(mixed_few_fast)->CAROM_SIZES;
BENCHMARK(mixed_fast)->CAROM_SIZES;
BENCHMARK(mixed_plain)->CAROM_SIZES;
BENCHMARK(few_large_fast)->CAROM_SIZES;
BENCHMARK(few_large_plain)->RangeMultiplier(10)->Range(100, 10000);

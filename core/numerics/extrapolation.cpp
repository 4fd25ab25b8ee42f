#include <carom/core/numerics/extrapolation.h>

#include <carom/core/numerics/pair.h>

#include <algorithm>
#include <type_traits>
#include <utility>

namespace carom {

namespace {

/// Calls f with the number of steps, 1 to most_extrapolated, as a constant for loops.
template <class F>
void with_count(std::size_t steps, F&& f) {
  const auto try_all = [&]<std::size_t... Fewer>(std::index_sequence<Fewer...>) {
    ((steps == Fewer + 1 ? f(std::integral_constant<std::size_t, Fewer + 1>()) : void()), ...);
  };
  try_all(std::make_index_sequence<most_extrapolated>());
}

/// Binomial coefficients of alternating sign: the polynomial through `Steps` numbers, one step on.
template <std::size_t Steps>
constexpr std::array<double, Steps> weights() {
  std::array<double, Steps> weight{};
  double binomial = Steps;
  for (std::size_t k = 0; k < Steps; ++k) {
    weight[k] = k % 2 == 0 ? binomial : -binomial;
    binomial = binomial * static_cast<double>(Steps - k - 1) / static_cast<double>(k + 2);
  }
  return weight;
}

template <std::size_t Steps>
void extrapolate_by(Range range, const LastNumbers& last, double* guess) {
  constexpr std::array<double, Steps> weight = weights<Steps>();
  for (Index i = range.begin; i < range.end; ++i) {
    double sum = 0.0;
    for (std::size_t k = 0; k < Steps; ++k) sum += weight[k] * last[k][i];
    guess[i] = sum;
  }
}

/// Adds the errors, times weights, that guesses by 1, 2, ... steps would have had at the last one: its
/// backward differences, of two numbers. \param at values of the last steps
template <std::size_t Steps>
void add_errors(std::array<Pair, Steps> at, Pair weight, std::array<Pair, Steps>& errors) {
  for (std::size_t level = 1; level < Steps; ++level) {
    for (std::size_t k = 0; k + level < Steps; ++k) at[k] -= at[k + 1];
    errors[level] += weight * magnitude(at[0]);
  }
}

/// Whose sum is least. \tparam Steps that are known
template <std::size_t Steps>
std::size_t best_of(Range range, const LastNumbers& last, const double* weight) {
  std::array<Pair, Steps> errors{};
  const auto add = [&](Index i, auto&& read) {
    std::array<Pair, Steps> at;
    for (std::size_t k = 0; k < Steps; ++k) at[k] = read(last[k] + i);
    add_errors<Steps>(at, read(weight + i), errors);
  };
  const Index pairs_end = range.begin + range.size() / 2 * 2;
  for (Index i = range.begin; i < pairs_end; i += 2) add(i, [](const double* at) { return load_pair(at); });
  if (pairs_end < range.end) add(pairs_end, [](const double* at) { return Pair{*at, 0.0}; });
  std::size_t best = 1;
  for (std::size_t steps = 2; steps < Steps; ++steps) {
    if (errors[steps][0] + errors[steps][1] < errors[best][0] + errors[best][1]) best = steps;
  }
  return best;
}

}  // namespace

std::size_t best_steps(Range range, const LastNumbers& last, std::size_t steps, const double* weight) {
  std::size_t best = 1;
  with_count(steps, [&](auto count) { best = best_of<count>(range, last, weight); });
  return best;
}

void extrapolate(Range range, const LastNumbers& last, std::size_t steps, double* guess) {
  with_count(steps, [&](auto count) { extrapolate_by<count>(range, last, guess); });
}

}  // namespace carom

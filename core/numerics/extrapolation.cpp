#include <carom/core/numerics/extrapolation.h>

#include <utility>

namespace carom {

namespace {

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

}  // namespace

void extrapolate(Range range, const LastNumbers& last, std::size_t steps, double* guess) {
  const auto by = [&]<std::size_t... Fewer>(std::index_sequence<Fewer...>) {
    ((steps == Fewer + 1 ? extrapolate_by<Fewer + 1>(range, last, guess) : void()), ...);
  };
  by(std::make_index_sequence<most_extrapolated>());
}

}  // namespace carom

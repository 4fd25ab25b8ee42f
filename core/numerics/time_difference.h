#pragma once

/// \file
/// Derivatives of functions of time by finite differences, where they are not given.

#include <carom/core/export.h>

#include <array>
#include <cstddef>
#include <span>
#include <type_traits>

namespace carom {

/// First or second derivative of functions at one time, by the polynomial through seven values (away from
/// discontinuities: central differences of three steps extrapolated to a step of zero). With the step h,
/// 1/4096 s for the first derivative and 1/1024 s for the second, the error for a function f of frequency w
/// [rad/s] and size |f| is
///                 away from discontinuities          beside one           rounding of f, within seconds of
///                 time 0
///     first       (h w)^6/140 w |f|         (h w)^6 w |f|        2e-12 |f|/s,   beside a break 20 times that
///     second      (h w)^6/560 w^2 |f|       3 (h w)^5 w^2 |f|    2e-9 |f|/s^2,  beside a break 80 times that
/// so that frequencies above about 300 rad/s need derivatives in closed form. The rounding error increases
/// with the time like that of f.
class CAROM_API TimeDifference {
public:
  /// \param time where [s]
  /// \param order 1 or 2
  /// \param discontinuities times, ascending, that no difference may reach across [s]; at one of them the
  /// derivative is that after it. Where two are closer than six steps, so are the steps.
  TimeDifference(double time, int order, std::span<const double> discontinuities);

  /// The derivative of f, a function of time with numbers or vectors as values.
  template <class F>
  [[nodiscard]] auto operator()(const F& f) const {
    using Value = std::decay_t<decltype(f(0.0))>;
    // The weights sum to zero: with differences from one value a constant has the derivative 0 exactly.
    const Value middle = f(times_[count / 2]);
    Value sum = weights_[0] * (f(times_[0]) - middle);
    for (std::size_t i = 1; i < count; ++i) {
      if (i != count / 2) sum += weights_[i] * (f(times_[i]) - middle);
    }
    return sum;
  }

private:
  static constexpr std::size_t count = 7;
  std::array<double, count> times_{};
  std::array<double, count> weights_{};
};

}  // namespace carom

#pragma once

/// \file
/// A prescribed quantity at a time, with its rates, given by the user or computed.

#include <carom/core/numerics/time_difference.h>

#include <functional>
#include <vector>

namespace carom {

/// Value, rate and second rate of a quantity at a time.
template <class Value>
struct Course {
  Value value, rate, second;
};

/// Evaluates functions of time; rates that are not given are computed from the others by TimeDifference.
/// \param discontinuities times that no difference may reach across [s]
template <class Value>
Course<Value> course(const std::function<Value(double)>& value, const std::function<Value(double)>& rate,
                     const std::function<Value(double)>& second, double time,
                     const std::vector<double>& discontinuities) {
  const auto derivative = [&](int order, const std::function<Value(double)>& of) {
    return TimeDifference(time, order, discontinuities)(of);
  };
  return {value(time), rate ? rate(time) : derivative(1, value),
          second ? second(time)
          : rate ? derivative(1, rate)
                 : derivative(2, value)};
}

}  // namespace carom

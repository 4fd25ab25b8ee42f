#pragma once

/// \file
/// Derivatives of loads by central differences, for elements that give none and for tests of those that do.

#include <carom/core/evaluation.h>
#include <carom/core/export.h>
#include <carom/core/force_kind.h>

#include <vector>

namespace carom {

/// Step of a central difference relative to the size of what is moved: the cube root of the rounding unit,
/// best where all derivatives are of one size.
inline constexpr double difference_step = 6e-6;

/// df/dx by a central difference with that step times `size` (> 0, the size over which f changes). Error
/// about 1e-10 of f/size.
template <class F>
[[nodiscard]] double difference_quotient(F&& f, double x, double size) {
  const double ahead = x + difference_step * size, behind = x - difference_step * size;
  return (f(ahead) - f(behind)) / (ahead - behind);
}

/// A movable copy of a state, on which loads are evaluated beside it. Make one for many elements.
class CAROM_API DifferenceDerivatives {
public:
  explicit DifferenceDerivatives(const EvaluationContext& at);

  /// Appends the derivatives of the loads of one element, error about 1e-10 of the loads' size.
  void append(const ForceKind& kind, Index element, std::vector<LoadDerivative>& out);

private:
  /// Loads of the element at the moved state, on columns_.
  void loads(const ForceKind& kind, Index element, std::vector<double>& out);

  EvaluationContext at_;
  std::vector<double> q_, v_, force_;
  Evaluation evaluation_;
  std::vector<Index> bodies_, columns_;
  std::vector<double> ahead_, behind_, faster_, slower_;
};

/// Derivatives of the loads of one element by central differences.
CAROM_API void difference_derivatives(const ForceKind& kind, const EvaluationContext& at, Index element,
                                      std::vector<LoadDerivative>& out);

}  // namespace carom

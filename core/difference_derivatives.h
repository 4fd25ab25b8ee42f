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

/// Derivatives of an element with internal variables z beside those of its loads by motion.
struct InternalDerivatives {
  std::vector<LoadDerivative> rates;  ///< of dz/dt by motion; rows are places in State::z
  /// Of loads by z, numbers in `by_position`; columns are places in State::z.
  std::vector<LoadDerivative> loads_by_z;
  /// Of dz/dt by z, numbers in `by_position`; rows and columns are places in State::z.
  std::vector<LoadDerivative> rates_by_z;
};

/// A movable copy of a state, on which loads are evaluated beside it. Make one for many elements.
class CAROM_API DifferenceDerivatives {
public:
  explicit DifferenceDerivatives(const EvaluationContext& at);

  /// Appends the derivatives of the loads of one element, error about 1e-10 of the loads' size.
  void append(const ForceKind& kind, Index element, std::vector<LoadDerivative>& out);
  /// Appends the derivatives of one element that have to do with its internal variables. \param z places of
  /// these
  void append_internal(const ForceKind& kind, Index element, Range z, InternalDerivatives& out);

private:
  /// Sets bodies_ and columns_ to the bodies and columns of the element.
  void find_columns(const ForceKind& kind, Index element);
  /// The moved state, rotations of the element's bodies up to date.
  EvaluationContext moved();
  /// Loads of the element at the moved state, on columns_.
  void loads(const ForceKind& kind, Index element, std::vector<double>& out);
  /// Rates of the internal variables of the element at the moved state.
  void internal_rates(const ForceKind& kind, Index element, Range z, std::vector<double>& out);
  /// Appends the derivatives of numbers by all of columns_. \param rows of the numbers \param evaluate writes
  /// them at the moved state
  template <class F>
  void by_motion(const std::vector<Index>& rows, F&& evaluate, std::vector<LoadDerivative>& out);
  /// Appends the derivatives of numbers by internal variables.
  template <class F>
  void by_internal(const std::vector<Index>& rows, Range z, F&& evaluate, std::vector<LoadDerivative>& out);

  EvaluationContext at_;
  std::vector<double> q_, v_, z_, force_, z_rates_;
  Evaluation evaluation_;
  std::vector<Index> bodies_, columns_;
  std::vector<double> ahead_, behind_, faster_, slower_;
};

/// Appends the derivatives of the loads of all elements of a component but fields, which depend on nothing:
/// in closed form where they are given, else by central differences.
CAROM_API void append_derivatives(const EvaluationContext& at, std::vector<LoadDerivative>& out);

/// Derivatives of the loads of one element by central differences.
CAROM_API void difference_derivatives(const ForceKind& kind, const EvaluationContext& at, Index element,
                                      std::vector<LoadDerivative>& out);

}  // namespace carom

#pragma once

/// \file
/// When does a quantity fall through zero first within a step? It is taken for a polynomial between two
/// looks; where that might hide a root, further looks are taken between them, until the error of the
/// polynomial is shown to be so small that it hides none.

#include <carom/core/export.h>
#include <carom/core/numerics/step_polynomial.h>

#include <array>
#include <limits>
#include <utility>

namespace carom {

/// A quantity at one time of a step.
struct QuantityLook {
  double time = 0.0;
  StepPolynomial::End at;  ///< derivatives with respect to time
  double sixth = 0.0;      ///< bound of its sixth derivative between the looks by turning, if known
};

/// A quantity that can be looked at anywhere in a step.
class CAROM_API WatchedQuantity {
public:
  virtual ~WatchedQuantity() = default;
  /// Value of the quantity at a time, and as many derivatives as are known.
  [[nodiscard]] virtual QuantityLook look(double time) = 0;
};

/// A function of time as a quantity that can be looked at anywhere in a step.
template <class F>
class QuantityOf final : public WatchedQuantity {
public:
  explicit QuantityOf(F look) : look_(std::move(look)) {}
  [[nodiscard]] QuantityLook look(double time) override { return look_(time); }

private:
  F look_;
};

/// How a quantity is searched.
struct FallRule {
  /// Known derivatives: 2 makes a quintic, 1 a cubic of two looks, 0 a quartic of five.
  int derivatives = 2;
  double raise = 0.0;  ///< a fall begins where quantity + raise < 0
  double fine = 0.0;   ///< an error of this size does not matter
  /// The error is that by turning plus four times what a look in the middle shows; else that by turning
  /// alone. Of a quartic it is seen from its five values.
  bool measured = true;
  /// A root is taken for the first one if the error hides none before it; otherwise only where the error is
  /// fine.
  bool clear_falls = true;
  int least_depth = 0;  ///< halvings at least
  /// The largest size of the rate, if known: where values cannot reach zero with it nothing is searched.
  double fastest = std::numeric_limits<double>::infinity();
  int deepest = 14;  ///< halvings at most
};

/// The search in one step.
class CAROM_API FallSearch {
public:
  /// Beyond `until` nothing is of interest.
  FallSearch(WatchedQuantity& quantity, const FallRule& rule, double until)
      : quantity_(&quantity), rule_(rule), until_(until) {}

  /// About the first time at which the quantity falls, infinity if it does not.
  [[nodiscard]] double first(const QuantityLook& from, const QuantityLook& to);

private:
  using Five = std::array<QuantityLook, 5>;
  [[nodiscard]] double between(const QuantityLook& from, const QuantityLook& to, int depth);
  [[nodiscard]] double within(const Five& looks, int depth);
  [[nodiscard]] bool falls_clearly(const StepPolynomial& polynomial, double error) const;
  [[nodiscard]] QuantityLook middle(const QuantityLook& from, const QuantityLook& to);

  WatchedQuantity* quantity_;
  FallRule rule_;
  double until_;
};

}  // namespace carom

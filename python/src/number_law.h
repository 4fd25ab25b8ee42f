#pragma once

// Functions given by numbers: what scene files can say of motions and loads, and what C++ calls without
// Python.

#include "record.h"

#include <array>
#include <cmath>
#include <functional>
#include <vector>

namespace carom_python {

/// (amplitude + growth x) sin(frequency x + phase), x the first argument of the law, often the time.
template <class R>
struct Harmonic {
  R amplitude{};           ///< in the unit of the law
  double frequency = 0.0;  ///< angular frequency [rad/s], where x is a time
  double phase = 0.0;      ///< at x = 0 [rad]
  R growth{};              ///< of the amplitude, in the unit of the law per unit of x

  Harmonic() {
    if constexpr (!std::is_same_v<R, double>) amplitude.setZero(), growth.setZero();
  }
};

/// A function given by numbers: c0 + c1 x + c2 x^2 + ..., harmonics, and terms that are linear in its further
/// arguments.
template <class R>
struct Law {
  std::vector<R> polynomial{};           ///< c0, c1, c2, ..., of the first argument
  std::vector<Harmonic<R>> harmonics{};  ///< added to it
  /// Factors of the further arguments: of an actuator those of coordinate and rate; none of functions of
  /// time.
  std::vector<double> slopes{};

  /// Value without slopes.
  [[nodiscard]] R at(double x) const {
    R value{};
    if constexpr (!std::is_same_v<R, double>) value.setZero();
    for (std::size_t i = polynomial.size(); i-- > 0;) value = R(value * x + polynomial[i]);
    for (const Harmonic<R>& each : harmonics) {
      value += R((each.amplitude + each.growth * x) * std::sin(each.frequency * x + each.phase));
    }
    return value;
  }
};

/// A law as a function of the library.
template <class R, class... A>
struct NumberLaw {
  Law<R> law;
  R operator()(A... arguments) const {
    const std::array<double, sizeof...(A)> x{arguments...};
    R value = law.at(x[0]);
    if constexpr (std::is_same_v<R, double>) {
      for (std::size_t i = 0; i < law.slopes.size(); ++i) value += law.slopes[i] * x[i + 1];
    }
    return value;
  }
};

template <class R>
struct Convert<Harmonic<R>> : BoundRecord<Harmonic<R>> {};
template <class R>
struct Convert<Law<R>> : BoundRecord<Law<R>> {};

/// Reads a law: an instance of Law, a dictionary of its fields, or a constant. Raises TypeError.
/// \param arguments of the function
template <class R>
Law<R> read_law(nb::handle from, std::size_t arguments, std::string_view where) {
  Law<R> law;
  if (nb::isinstance<Law<R>>(from) || PyDict_Check(from.ptr()) != 0) {
    Convert<Law<R>>::load(from, law, where);
    if (law.slopes.size() + 1 <= arguments) return law;
    refuse(where, "a law with at most " + std::to_string(arguments - 1) + " slopes", from);
  }
  law.polynomial.resize(1);
  try {
    Convert<R>::load(from, law.polynomial[0], where);
  } catch (const nb::builtin_exception&) {
    refuse(where,
           "a function of " + std::to_string(arguments) + " number" + (arguments == 1 ? "" : "s") +
               ", a Law or a constant",
           from);
  }
  return law;
}

/// Binds Law and Harmonic of numbers or vectors. \param prefix of their names: "" or "Vector"
template <class R>
void bind_laws_by_numbers(nb::module_& module, const std::string& prefix) {
  static const std::string harmonic = prefix + "Harmonic", law = prefix + "Law";
  bind_record<Harmonic<R>>(module, harmonic.c_str(), {"Harmonic"}, true, [](auto& fields) {
    using H = Harmonic<R>;
    fields("amplitude", &H::amplitude)("frequency", &H::frequency)("phase", &H::phase)("growth", &H::growth);
  });
  bind_record<Law<R>>(module, law.c_str(), {"Law"}, true,
                      [](auto& fields) {
                        fields("polynomial", &Law<R>::polynomial)("harmonics", &Law<R>::harmonics);
                        if constexpr (std::is_same_v<R, double>) fields("slopes", &Law<R>::slopes);
                      })
      .def(
          "__call__", [](const Law<R>& self, double x) { return Convert<R>::cast(self.at(x)); }, nb::arg("x"),
          nb::sig(std::is_same_v<R, double>
                      ? "def __call__(self, x: float) -> float"
                      : "def __call__(self, x: float) -> numpy.typing.NDArray[numpy.float64]"),
          "Its value, further arguments being 0.");
}

}  // namespace carom_python

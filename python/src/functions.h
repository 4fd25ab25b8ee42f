#pragma once

// Functions of the user: Python functions, functions of C by their address (of ctypes and numba), and laws
// given by numbers.

#include "number_law.h"
#include "watch.h"

#include <functional>
#include <memory>
#include <string>

namespace carom_python {

/// A Python object that C++ copies, moves and frees in any thread.
class Shared {
public:
  Shared() = default;
  explicit Shared(nb::object object);
  [[nodiscard]] nb::handle get() const { return object_ ? nb::handle(*object_) : nb::handle(); }

private:
  std::shared_ptr<nb::object> object_;
};

/// A law in Python; takes the interpreter's lock for each call.
template <class R, class... A>
struct PythonLaw {
  Shared function;
  std::string where;
  R operator()(A... arguments) const {
    const nb::gil_scoped_acquire lock;
    return read<R>(call_python([&] { return function.get()(arguments...); }), "result of " + where);
  }
};
/// A law by address: R is a number, or numbers that it writes behind its last argument.
template <class R, class... A>
struct CompiledLaw {
  Shared function;
  void* address = nullptr;
  R operator()(A... arguments) const {
    if constexpr (std::is_same_v<R, double>) {
      return reinterpret_cast<double (*)(A...)>(address)(arguments...);
    } else {
      R result = R::Zero();
      reinterpret_cast<void (*)(A..., double*)>(address)(arguments..., result.data());
      return result;
    }
  }
};

/// Address of a function of ctypes, or of what has one as `ctypes` (numba); null of others. Raises TypeError
/// unless it takes `numbers` of type double and returns one, or nothing and takes a pointer for the result.
void* compiled_address(nb::handle from, std::size_t numbers, bool returns_number, std::string_view where);

/// Functions of numbers.
template <class R, class... A>
struct Convert<std::function<R(A...)>, std::enable_if_t<(std::is_same_v<A, double> && ...)>> {
  static constexpr std::size_t count = sizeof...(A);
  static TypeNames names() {
    std::string numbers;
    for (std::size_t i = 0; i < count; ++i) numbers += i == 0 ? "float" : ", float";
    const std::string type =
        "collections.abc.Callable[[" + numbers + "], " + Convert<R>::names().accepts + "] | None";
    const TypeNames law = Convert<Law<R>>::names();
    return {law.accepts + " | " + Convert<R>::names().accepts + " | " + type, law.gives + " | " + type,
            "law " + law.gives};
  }
  static void load(nb::handle from, std::function<R(A...)>& to, std::string_view where) {
    if (from.is_none()) {
      to = nullptr;
      return;
    }
    if (void* const address = compiled_address(from, count, std::is_same_v<R, double>, where)) {
      to = CompiledLaw<R, A...>{Shared(nb::borrow(from)), address};
      return;
    }
    if (nb::isinstance<Law<R>>(from) || PyCallable_Check(from.ptr()) == 0) {
      to = NumberLaw<R, A...>{read_law<R>(from, count, where)};
      return;
    }
    to = PythonLaw<R, A...>{Shared(nb::borrow(from)), std::string(where)};
  }
  static nb::object cast(const std::function<R(A...)>& value) {
    if (!value) return nb::none();
    if (const auto* law = value.template target<PythonLaw<R, A...>>()) return nb::borrow(law->function.get());
    if (const auto* law = value.template target<CompiledLaw<R, A...>>()) {
      return nb::borrow(law->function.get());
    }
    if (const auto* law = value.template target<NumberLaw<R, A...>>()) return Convert<Law<R>>::cast(law->law);
    return nb::none();
  }
  static bool is_python(const std::function<R(A...)>& value) {
    return value && value.template target<PythonLaw<R, A...>>() != nullptr;
  }
};

/// Asks whether work shall end: called often, with the interpreter's lock taken.
template <>
struct Convert<std::function<bool()>> {
  static TypeNames names() {
    return {"collections.abc.Callable[[], bool] | None", "collections.abc.Callable[[], bool] | None", ""};
  }
  static void load(nb::handle from, std::function<bool()>& to, std::string_view where);
  static nb::object cast(const std::function<bool()>& value);
};

}  // namespace carom_python

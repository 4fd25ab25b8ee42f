#pragma once

// Values of fields between C++ and Python: what is accepted, what is given back, how it is called in
// signatures and in scene files.

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>

#include <carom/core/ids.h>
#include <carom/core/space.h>

#include <array>
#include <complex>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace carom_python {

namespace nb = nanobind;

/// Raises TypeError: "<where> must be <expected>, not <value>".
[[noreturn]] void refuse(std::string_view where, std::string_view expected, nb::handle value);

/// "; the nearest is 'mass'": the known word that is most like a given one; empty where none is like it.
[[nodiscard]] std::string nearest_of(std::string_view word, const std::vector<std::string>& known);

/// How a type of fields is called.
struct TypeNames {
  std::string accepts;  ///< in the signature of a constructor
  std::string gives;    ///< of the property
  std::string json;     ///< form in scene files; empty: none
};

/// Reads and shows values of a type. Specialised, or found by its shape.
template <class T, class Enable = void>
struct Convert;

/// A value of Python as T. Raises TypeError naming `where`.
template <class T>
T read(nb::handle from, std::string_view where) {
  T value{};
  Convert<T>::load(from, value, where);
  return value;
}

/// A path, given as text or as an object with __fspath__.
[[nodiscard]] std::string path_of(nb::handle from);

/// Text of a value, as a stream prints it.
template <class T>
nb::str printed(const T& value) {
  std::ostringstream text;
  text << value;
  const std::string all = text.str();
  return nb::str(all.data(), all.size());
}

/// Names of the values of an enumeration, in their order; specialised where it is bound.
template <class E>
struct EnumNames;

template <>
struct Convert<double> {
  static TypeNames names() { return {"float", "float", "number"}; }
  static void load(nb::handle from, double& to, std::string_view where);
  static nb::object cast(double value) { return nb::float_(value); }
};
template <>
struct Convert<bool> {
  static TypeNames names() { return {"bool", "bool", "boolean"}; }
  static void load(nb::handle from, bool& to, std::string_view where);
  static nb::object cast(bool value) { return nb::bool_(value); }
};
/// Reads an integer within bounds.
std::int64_t load_integer(nb::handle from, std::int64_t least, std::int64_t most, std::string_view where);
template <class T>
struct Convert<T, std::enable_if_t<std::is_integral_v<T> && !std::is_same_v<T, bool>>> {
  static TypeNames names() { return {"int", "int", "integer"}; }
  static void load(nb::handle from, T& to, std::string_view where) {
    to = static_cast<T>(load_integer(from, static_cast<std::int64_t>(std::numeric_limits<T>::min()),
                                     static_cast<std::int64_t>(std::numeric_limits<T>::max()), where));
  }
  static nb::object cast(T value) { return nb::cast(static_cast<std::int64_t>(value)); }
};
template <>
struct Convert<std::string> {
  static TypeNames names() { return {"str", "str", "string"}; }
  static void load(nb::handle from, std::string& to, std::string_view where);
  static nb::object cast(const std::string& value) { return nb::str(value.data(), value.size()); }
};
template <>
struct Convert<std::string_view> {
  static TypeNames names() { return {"str", "str", ""}; }
  static nb::object cast(std::string_view value) { return nb::str(value.data(), value.size()); }
};

/// Reads `count` numbers from a sequence or an array.
void load_numbers(nb::handle from, double* to, std::size_t count, std::string_view where,
                  std::string_view expected);
/// A NumPy array of its own memory, to be filled. \param columns 0: of one dimension
/// \param numbers receives its first number
nb::object new_array(std::size_t rows, std::size_t columns, double*& numbers);
/// A NumPy array of its own memory, a copy of numbers.
nb::object make_array(const double* values, std::size_t rows, std::size_t columns);

template <int D>
struct Convert<carom::Vec<D>> {
  static TypeNames names() {
    return {"numpy.typing.ArrayLike", "numpy.typing.NDArray[numpy.float64]", "vector" + std::to_string(D)};
  }
  static void load(nb::handle from, carom::Vec<D>& to, std::string_view where) {
    load_numbers(from, to.data(), D, where, D == 2 ? "two numbers (x, y)" : "three numbers");
  }
  static nb::object cast(const carom::Vec<D>& value) { return make_array(value.data(), D, 0); }
};
template <>
struct Convert<carom::Mat<3>> {
  static TypeNames names() {
    return {"numpy.typing.ArrayLike", "numpy.typing.NDArray[numpy.float64]", "matrix3"};
  }
  static void load(nb::handle from, carom::Mat<3>& to, std::string_view where);
  static nb::object cast(const carom::Mat<3>& value);
};
template <>
struct Convert<std::complex<double>> {
  static TypeNames names() { return {"complex", "complex", ""}; }
  static nb::object cast(std::complex<double> value) {
    return nb::steal(PyComplex_FromDoubles(value.real(), value.imag()));
  }
};

/// Calls `take` with each item of a sequence that is no string.
void for_items(nb::handle from, std::string_view where, std::string_view expected,
               const std::function<void(nb::handle, std::size_t)>& take);

template <class T>
struct Convert<std::vector<T>> {
  static TypeNames names() {
    const TypeNames item = Convert<T>::names();
    return {"collections.abc.Sequence[" + item.accepts + "]", "list[" + item.gives + "]",
            item.json.empty() ? "" : "list of " + item.json};
  }
  static void load(nb::handle from, std::vector<T>& to, std::string_view where) {
    std::vector<T> read;
    for_items(from, where, "a sequence", [&](nb::handle item, std::size_t i) {
      T value{};
      Convert<T>::load(item, value, std::string(where) + "[" + std::to_string(i) + "]");
      read.push_back(std::move(value));
    });
    to = std::move(read);
  }
  static nb::object cast(const std::vector<T>& values) {
    nb::list list;
    for (const T& value : values) list.append(Convert<T>::cast(value));
    return std::move(list);
  }
};
template <class T, std::size_t N>
struct Convert<std::array<T, N>> {
  static TypeNames names() { return {"", "tuple[" + Convert<T>::names().gives + ", ...]", ""}; }
  static nb::object cast(const std::array<T, N>& values) {
    nb::object tuple = nb::steal(PyTuple_New(static_cast<Py_ssize_t>(N)));
    for (std::size_t i = 0; i < N; ++i) {
      PyTuple_SetItem(tuple.ptr(), static_cast<Py_ssize_t>(i), Convert<T>::cast(values[i]).release().ptr());
    }
    return tuple;
  }
};
template <class T>
struct Convert<std::optional<T>> {
  static TypeNames names() {
    const TypeNames of = Convert<T>::names();
    return {of.accepts + " | None", of.gives + " | None", of.json};
  }
  static void load(nb::handle from, std::optional<T>& to, std::string_view where) {
    if (from.is_none()) {
      to.reset();
      return;
    }
    T value{};
    Convert<T>::load(from, value, where);
    to = std::move(value);
  }
  static nb::object cast(const std::optional<T>& value) {
    return value ? Convert<T>::cast(*value) : nb::none();
  }
};

/// Reads a value of a bound class.
void* load_instance(nb::handle from, const std::type_info& type, std::string_view where,
                    std::string_view expected);

template <class E>
struct Convert<E, std::enable_if_t<std::is_enum_v<E>>> {
  static TypeNames names() {
    return {std::string("carom._core.") + EnumNames<E>::name + " | str",
            std::string("carom._core.") + EnumNames<E>::name, std::string("enum ") + EnumNames<E>::name};
  }
  static void load(nb::handle from, E& to, std::string_view where) {
    std::string allowed = std::string(EnumNames<E>::name) + " (";
    if (nb::try_cast<E>(from, to, false)) return;
    for (const auto& [name, value] : EnumNames<E>::values) {
      if (nb::isinstance<nb::str>(from) && nb::cast<std::string_view>(from) == name) {
        to = value;
        return;
      }
      allowed += (allowed.back() == '(' ? "'" : ", '") + std::string(name) + "'";
    }
    refuse(where, allowed + ")", from);
  }
  static nb::object cast(E value) { return nb::cast(value); }
};

}  // namespace carom_python

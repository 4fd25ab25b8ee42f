#include "convert.h"

#include <nanobind/ndarray.h>

#include <cstring>

namespace carom_python {

void refuse(std::string_view where, std::string_view expected, nb::handle value) {
  std::string shown = nb::cast<std::string>(nb::repr(value));
  if (shown.size() > 60) shown = shown.substr(0, 57) + "...";
  const auto type = nb::cast<std::string>(nb::handle(value.type()).attr("__name__"));
  std::string text(where);
  std::string allowed(expected);
  constexpr std::string_view internal = "_core.";  // users know its types as carom's
  for (std::size_t at = allowed.find(internal); at != std::string::npos; at = allowed.find(internal)) {
    allowed.erase(at, internal.size());
  }
  text.append(" must be ").append(allowed).append(", not ").append(shown).append(" (" + type + ")");
  throw nb::type_error(text.c_str());
}

std::string nearest_of(std::string_view word, const std::vector<std::string>& known) {
  nb::list words;
  for (const std::string& each : known) words.append(nb::str(each.data(), each.size()));
  const nb::object close = nb::module_::import_("difflib").attr("get_close_matches")(
      nb::str(word.data(), word.size()), words, nb::arg("n") = 1);
  return nb::len(close) == 0 ? "" : "; the nearest is '" + nb::cast<std::string>(close[0]) + "'";
}

namespace {

bool is_number(nb::handle from) {
  if (PyFloat_Check(from.ptr())) return true;
  if (PyBool_Check(from.ptr()) || PyUnicode_Check(from.ptr()) || PyComplex_Check(from.ptr())) return false;
  if (PyLong_Check(from.ptr())) return true;
  // Scalars of NumPy; arrays of one number are sequences, and refused.
  return PyNumber_Check(from.ptr()) != 0 && PySequence_Check(from.ptr()) == 0 &&
         PyObject_HasAttrString(from.ptr(), "__float__") != 0;
}

}  // namespace

void Convert<double>::load(nb::handle from, double& to, std::string_view where) {
  if (!is_number(from)) refuse(where, "a number", from);
  const double value = PyFloat_AsDouble(from.ptr());
  if (value == -1.0 && PyErr_Occurred() != nullptr) {
    PyErr_Clear();
    refuse(where, "a number in the range of double", from);
  }
  to = value;
}

void Convert<bool>::load(nb::handle from, bool& to, std::string_view where) {
  if (!PyBool_Check(from.ptr())) refuse(where, "True or False", from);
  to = from.ptr() == Py_True;
}

std::int64_t load_integer(nb::handle from, std::int64_t least, std::int64_t most, std::string_view where) {
  if (PyBool_Check(from.ptr()) || PyIndex_Check(from.ptr()) == 0) refuse(where, "an integer", from);
  const nb::object whole = nb::steal(PyNumber_Index(from.ptr()));
  if (!whole.is_valid()) throw nb::python_error();
  int overflow = 0;
  const long long value = PyLong_AsLongLongAndOverflow(whole.ptr(), &overflow);
  if (overflow != 0 || value < least || value > most) {
    refuse(where, "an integer from " + std::to_string(least) + " to " + std::to_string(most), from);
  }
  return value;
}

void Convert<std::string>::load(nb::handle from, std::string& to, std::string_view where) {
  if (!nb::try_cast(from, to, false)) refuse(where, "a text", from);
}

std::string path_of(nb::handle from) {
  const nb::object text = nb::steal(PyOS_FSPath(from.ptr()));
  if (!text.is_valid()) {
    PyErr_Clear();
    refuse("path", "a text or a path", from);
  }
  return read<std::string>(text, "path");
}

void for_items(nb::handle from, std::string_view where, std::string_view expected,
               const std::function<void(nb::handle, std::size_t)>& take) {
  const bool is_text = PyUnicode_Check(from.ptr()) || PyBytes_Check(from.ptr()) || PyDict_Check(from.ptr());
  if (is_text || PySequence_Check(from.ptr()) == 0) refuse(where, expected, from);
  const nb::object items = nb::steal(PySequence_Fast(from.ptr(), ""));
  if (!items.is_valid()) {
    PyErr_Clear();
    refuse(where, expected, from);
  }
  const Py_ssize_t count = PySequence_Size(items.ptr());
  for (Py_ssize_t i = 0; i < count; ++i) {
    const nb::object item = nb::steal(PySequence_GetItem(items.ptr(), i));
    if (!item.is_valid()) throw nb::python_error();
    take(item, static_cast<std::size_t>(i));
  }
}

void load_numbers(nb::handle from, double* to, std::size_t count, std::string_view where,
                  std::string_view expected) {
  std::array<double, 3> read{};
  std::size_t found = 0;
  for_items(from, where, expected, [&](nb::handle item, std::size_t i) {
    ++found;
    if (i >= count || !is_number(item)) refuse(where, expected, from);
    Convert<double>::load(item, read[i], where);
  });
  if (found != count) refuse(where, expected, from);
  std::memcpy(to, read.data(), count * sizeof(double));
}

nb::object new_array(std::size_t rows, std::size_t columns, double*& numbers) {
  const std::size_t count = columns == 0 ? rows : rows * columns;
  numbers = new double[count > 0 ? count : 1];
  const nb::capsule owner(numbers, [](void* memory) noexcept { delete[] static_cast<double*>(memory); });
  const std::array<std::size_t, 2> shape{rows, columns};
  return nb::cast(nb::ndarray<nb::numpy, double>(numbers, columns == 0 ? 1 : 2, shape.data(), owner));
}

nb::object make_array(const double* values, std::size_t rows, std::size_t columns) {
  const std::size_t count = columns == 0 ? rows : rows * columns;
  double* numbers = nullptr;
  nb::object array = new_array(rows, columns, numbers);
  if (count > 0) std::memcpy(numbers, values, count * sizeof(double));
  return array;
}

void Convert<carom::Mat<3>>::load(nb::handle from, carom::Mat<3>& to, std::string_view where) {
  constexpr const char* expected = "three rows of three numbers";
  carom::Mat<3> read;
  std::size_t rows = 0;
  for_items(from, where, expected, [&](nb::handle item, std::size_t i) {
    std::array<double, 3> row{};
    if (i < 3) load_numbers(item, row.data(), 3, where, expected);
    for (std::size_t j = 0; i < 3 && j < 3; ++j) {
      read(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = row[j];
    }
    ++rows;
  });
  if (rows != 3) refuse(where, expected, from);
  to = read;
}

nb::object Convert<carom::Mat<3>>::cast(const carom::Mat<3>& value) {
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> rows = value;
  return make_array(rows.data(), 3, 3);
}

void* load_instance(nb::handle from, const std::type_info& type, std::string_view where,
                    std::string_view expected) {
  const nb::handle wanted = nb::detail::nb_type_lookup(&type);
  if (PyObject_IsInstance(from.ptr(), wanted.ptr()) != 1) refuse(where, expected, from);
  if (!nb::inst_ready(from)) refuse(where, "complete", from);
  return nb::inst_ptr<void>(from);
}

}  // namespace carom_python

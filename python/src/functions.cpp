#include "functions.h"

namespace carom_python {

Shared::Shared(nb::object object)
    : object_(new nb::object(std::move(object)), [](nb::object* held) {
        if (Py_IsInitialized() == 0) return;  // nothing is left to free it in
        const nb::gil_scoped_acquire lock;
        delete held;
      }) {}

void* compiled_address(nb::handle from, std::size_t numbers, bool returns_number, std::string_view where) {
  nb::object function = nb::borrow(from);
  if (nb::hasattr(from, "ctypes") && nb::hasattr(from, "address")) function = from.attr("ctypes");
  const nb::object modules = nb::steal(PyImport_GetModule(nb::str("ctypes").ptr()));
  if (!modules.is_valid()) return nullptr;  // nobody can have made such a function
  if (!nb::isinstance(function, modules.attr("_CFuncPtr"))) return nullptr;
  const std::string form = returns_number
                               ? "a function of " + std::to_string(numbers) + " doubles that returns a double"
                               : "a function of " + std::to_string(numbers) +
                                     " doubles and a pointer to double, where it writes its result";
  const nb::object real = modules.attr("c_double"), types = function.attr("argtypes");
  const nb::object result = function.attr("restype");
  bool fits = returns_number ? result.is(real) : result.is_none();
  fits = fits && !types.is_none() && nb::len(types) == numbers + (returns_number ? 0 : 1);
  for (std::size_t i = 0; fits && i < numbers; ++i) fits = types[i].is(real);
  if (fits && !returns_number) {
    fits = nb::hasattr(types[numbers], "_type_") && types[numbers].attr("_type_").is(real);
  }
  if (!fits) refuse(where, form + " (argtypes, restype)", from);
  const nb::object address = modules.attr("cast")(function, modules.attr("c_void_p")).attr("value");
  if (address.is_none()) refuse(where, form, from);
  return PyLong_AsVoidPtr(address.ptr());
}

namespace {

struct PythonQuestion {
  Shared function;
  bool operator()() const {
    const nb::gil_scoped_acquire lock;
    const int yes = PyObject_IsTrue(function.get()().ptr());
    if (yes < 0) throw nb::python_error();
    return yes == 1;
  }
};

}  // namespace

void Convert<std::function<bool()>>::load(nb::handle from, std::function<bool()>& to,
                                          std::string_view where) {
  if (from.is_none()) {
    to = nullptr;
    return;
  }
  if (PyCallable_Check(from.ptr()) == 0) refuse(where, "a function without arguments", from);
  to = PythonQuestion{Shared(nb::borrow(from))};
}

nb::object Convert<std::function<bool()>>::cast(const std::function<bool()>& value) {
  const auto* question = value ? value.target<PythonQuestion>() : nullptr;
  return question != nullptr ? nb::borrow(question->function.get()) : nb::none();
}

}  // namespace carom_python

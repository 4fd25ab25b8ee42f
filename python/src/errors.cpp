// Errors: one tree, with the data of the C++ ones.

#include "bind.h"
#include "convert.h"

#include <carom/contact/solvers/contact_problem.h>
#include <carom/core/errors.h>
#include <carom/integrators/run/stop_request.h>

#include <exception>

namespace carom_python {

namespace {

// Kept as long as the program lives.
struct Types {
  nb::handle error, model, solver, file, cancelled;
};
Types types;

nb::handle make(nb::module_& core, const char* name, nb::handle bases, const char* text) {
  nb::dict members;
  members["__doc__"] = text;
  members["__module__"] = "carom";
  const nb::handle type(reinterpret_cast<PyObject*>(&PyType_Type));
  nb::object made = type(name, bases, members);
  core.attr(name) = made;
  return made.release();
}

void raise(const carom::SolverError& error) {
  nb::object made = types.solver(error.what());
  const carom::SolverFailure& failure = error.failure();
  made.attr("time") = failure.time;
  made.attr("step") = failure.step;
  made.attr("suggested_step") = failure.suggested_step;
  made.attr("residual") = failure.residual;
  made.attr("parts") = Convert<std::vector<std::string>>::cast(failure.parts);
  made.attr("problem") = failure.problem ? nb::cast(*failure.problem) : nb::none();
  PyErr_SetObject(types.solver.ptr(), made.ptr());
}

void translate(const std::exception_ptr& thrown, void* /*unused*/) {
  try {
    std::rethrow_exception(thrown);
  } catch (const carom::SolverError& error) {
    raise(error);
  } catch (const carom::ModelError& error) {
    PyErr_SetString(types.model.ptr(), error.what());
  } catch (const carom::FileError& error) {
    PyErr_SetString(types.file.ptr(), error.what());
  } catch (const carom::Cancelled& error) {
    PyErr_SetString(types.cancelled.ptr(), error.what());
  } catch (const carom::Error& error) {
    PyErr_SetString(types.error.ptr(), error.what());
  }
}

}  // namespace

void bind_errors(nb::module_& core) {
  const nb::handle exception(PyExc_Exception), value(PyExc_ValueError), file(PyExc_OSError);
  types.error = make(core, "Error", nb::make_tuple(exception), "Base of everything that carom raises.");
  types.model =
      make(core, "ModelError", nb::make_tuple(types.error, value),
           "An invalid model, state, option or call. The message names the part, the value and what is "
           "allowed.");
  types.solver =
      make(core, "SolverError", nb::make_tuple(types.error),
           "A computation that did not succeed. The simulation is at its last good state. `time` and "
           "`step` [s], `suggested_step` (0 if unknown), `residual`, `parts` (names, the worst first), "
           "`problem` (the contact problem that failed, or None).");
  types.file = make(core, "FileError", nb::make_tuple(types.error, file),
                    "A file that cannot be read or written, or does not fit the model.");
  types.cancelled = make(core, "Cancelled", nb::make_tuple(types.error),
                         "Work that ended because stop_when() said so; it stands at its last good state.");
  nb::register_exception_translator(translate, nullptr);
}

}  // namespace carom_python

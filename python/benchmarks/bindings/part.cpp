// A class with ten methods, bound with nanobind, or with pybind11 (CAROM_PYBIND11): see compare.py.

#include <string>

#ifdef CAROM_PYBIND11
#include <pybind11/pybind11.h>
namespace binding = pybind11;
#define CAROM_MODULE PYBIND11_MODULE
#else
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
namespace binding = nanobind;
#define CAROM_MODULE NB_MODULE
#endif

namespace {

struct Part {
  double mass = 1.0, x = 0.0, y = 0.0;
  int moved = 0;
  std::string name = "part";

  double energy() const { return 0.5 * mass * (x * x + y * y); }
  void move(double dx, double dy) {
    x += dx;
    y += dy;
    ++moved;
  }
  double distance(const Part& other) const { return (x - other.x) + (y - other.y); }
  double scaled(double factor) const { return factor * mass; }
  int moves() const { return moved; }
  const std::string& label() const { return name; }
  void rename(const std::string& to) { name = to; }
  Part copy() const { return *this; }
  bool heavier(const Part& other) const { return mass > other.mass; }
  void reset() {
    x = y = 0.0;
    moved = 0;
  }
};

}  // namespace

CAROM_MODULE(CAROM_MODULE_NAME, module) {
  binding::class_<Part>(module, "Part")
      .def(binding::init<>())
      .def("energy", &Part::energy)
      .def("move", &Part::move, binding::arg("dx"), binding::arg("dy"))
      .def("distance", &Part::distance, binding::arg("other"))
      .def("scaled", &Part::scaled, binding::arg("factor"))
      .def("moves", &Part::moves)
      .def("label", &Part::label)
      .def("rename", &Part::rename, binding::arg("to"))
      .def("copy", &Part::copy)
      .def("heavier", &Part::heavier, binding::arg("other"))
      .def("reset", &Part::reset);
}

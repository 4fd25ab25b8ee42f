#pragma once

// Force elements written in Python: classes that derive from ForceElement.

#include "functions.h"
#include "parts.h"

#include <carom/core/force_element.h>

#include <vector>

namespace carom_python {

/// A force element whose functions are methods of a Python object.
template <int D>
struct PythonElement {
  static constexpr carom::Role role = carom::Role::force;
  static constexpr int dimension = D;
  static constexpr std::string_view label = "force element";

  Shared object;
  std::vector<carom::BodyId> ends{};
  std::vector<double> breaks{};

  [[nodiscard]] std::vector<carom::BodyId> bodies() const { return ends; }
  void loads(const carom::ElementView<D>& at, carom::ElementLoads<D>& out) const;
  [[nodiscard]] double potential(const carom::ElementView<D>& at) const;
  void fingerprint(carom::Fingerprint& print) const;
};

extern template struct PythonElement<2>;
extern template struct PythonElement<3>;

/// Adds an element in Python if `part` is one; else an invalid object.
nb::object add_python_element(carom::System& system, nb::handle part, std::string name);
/// True of an element in Python.
bool is_python_element(nb::handle part);

}  // namespace carom_python

#pragma once

// The System of Python: a carom::System and the parts that were added to it, as they were given.

#include "part_names.h"
#include "types.h"

#include <carom/core/system.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace carom_python {

/// One part as it was added.
struct Entry {
  carom::Role role = carom::Role::body;
  carom::Index serial = carom::none;
  nb::object id;
  nb::object part;                        ///< a copy of its own
  std::optional<carom::Surface> surface;  ///< of an obstacle
  std::string name;
};

/// A law between two materials, by their names.
struct LawEntry {
  std::string a, b;
  carom::Surface surface;
};

/// Parts, materials and laws of a system, in the order in which they were given.
struct Journal {
  std::vector<Entry> entries;
  std::vector<std::string> materials;
  std::vector<LawEntry> laws;
  std::optional<carom::Surface> default_law;
  std::string title;                 ///< what the model is called, as the file it came from; empty: nothing
  std::shared_ptr<PartNames> names;  ///< of parts, for their identities
};

/// A model.
struct Model : Journal {
  carom::System system;
  bool closed = false;  ///< after the edit that it was lent for

  Model() { names = part_names(system.token()); }

  /// The system. Throws ModelError once closed.
  carom::System& get();
};

/// True if a part has functions or an element in Python; the first such is named: "motor #0: torque".
[[nodiscard]] std::string find_python_part(const Journal& journal);
/// Title and numbers of parts: " 'incline.json': 1 body, 2 shapes".
[[nodiscard]] std::string summary_of(const Journal& journal);

}  // namespace carom_python

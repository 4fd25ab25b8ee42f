#pragma once

// Names of the parts of a system, by which its identities show themselves.

#include <carom/core/ids.h>

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace carom_python {

/// Names by the type of identity ("BodyId") and serial number. Copies of a system share them, since they
/// share its identities.
class PartNames {
public:
  /// Notes the name of a part. Where copies of a system have different parts of one number neither is shown.
  void add(std::string_view type, carom::Index serial, const std::string& name);
  /// The name of a part; empty if it has none.
  [[nodiscard]] std::string find(std::string_view type, carom::Index serial) const;

private:
  std::map<std::pair<std::string, carom::Index>, std::string> names_;
};

/// The names of the systems that have a token, made if there are none yet. They live as long as somebody
/// keeps them.
[[nodiscard]] std::shared_ptr<PartNames> part_names(carom::Index token);
/// The name of a part by its identity; empty if it has none, or its system is gone.
[[nodiscard]] std::string find_part_name(std::string_view type, carom::Index token, carom::Index serial);

}  // namespace carom_python

#include "record.h"

#include <algorithm>
#include <iterator>

namespace carom_python {

namespace {

struct Text {
  const char* key;
  const char* text;
};
// Sorted by key; tools/docstrings.py writes it from the headers.
constexpr Text texts[] = {
#include "docstrings.inc"
};

}  // namespace

const char* doc(const std::string& key) {
  const auto* const found = std::lower_bound(
      std::begin(texts), std::end(texts), key,
      [](const Text& entry, const std::string& wanted) { return wanted.compare(entry.key) > 0; });
  return found != std::end(texts) && key == found->key ? found->text : "";
}

}  // namespace carom_python

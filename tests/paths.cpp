#include "tests/paths.h"

namespace carom_test {

std::string source_file(const std::string& name) { return std::string(CAROM_SOURCE_DIR) + "/" + name; }

}  // namespace carom_test

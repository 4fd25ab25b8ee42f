#pragma once

// Where files that tests read are.

#include <string>

namespace carom_test {

/// Path of a file of the project.
std::string source_file(const std::string& name);

/// Path of a file of tests/reference.
inline std::string reference_file(const std::string& name) { return source_file("tests/reference/" + name); }

}  // namespace carom_test

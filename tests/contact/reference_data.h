#pragma once

/// \file
/// The JSON files of tests/reference.

#include <nlohmann/json.hpp>

#include <fstream>
#include <stdexcept>
#include <string>

namespace carom::contact_test {

/// Parsed file `name` of tests/reference; throws std::runtime_error if it is not there.
inline nlohmann::json reference_data(const std::string& name) {
  std::ifstream file(std::string(CAROM_TEST_DATA) + "/" + name);
  if (!file) throw std::runtime_error("no reference file " + name);
  return nlohmann::json::parse(file);
}

}  // namespace carom::contact_test

#pragma once

// The reference problems of tests/reference/*.json (README.md there says where they come from).

#include "tests/paths.h"

#include <carom/core/space.h>

#include <nlohmann/json.hpp>

#include <fstream>
#include <stdexcept>
#include <string>

namespace carom_test {

using Json = nlohmann::json;

inline Json reference_data(const std::string& name) {
  const std::string path = carom_test::reference_file(name);
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path);
  return Json::parse(file);
}

inline carom::Vec<2> vector_of(const Json& at) { return {at[0].get<double>(), at[1].get<double>()}; }

}  // namespace carom_test

// Runs the problems of the validation report and writes its pages and the curves of its pictures.
//
// Usage: carom-validate <folder of curves> <folder of pages> [problem]...

#include "validation/pages.h"
#include "validation/report.h"

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

void write(const fs::path& file, const std::string& text) {
  std::ofstream out(file);
  out << text;
  out.close();
  if (!out) throw std::runtime_error("cannot write " + file.string());
}

}  // namespace

int main(int count, char** arguments) try {
  const std::vector<std::string> names(arguments + 1, arguments + count);
  if (names.size() < 2) throw std::runtime_error("usage: carom-validate <curves> <pages> [problem]...");
  const fs::path curves = names[0], pages = names[1];
  const std::span<const std::string> wanted = std::span(names).subspan(2);
  fs::create_directories(curves);
  fs::create_directories(pages);
  std::vector<validation::Page> all;
  for (const validation::Problem& problem : validation::all_problems) {
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), problem.name) == wanted.end()) continue;
    std::cout << "== " << problem.name << std::endl;
    all.push_back(problem.run());
    const validation::Page& page = all.back();
    write(pages / (page.name + ".md"), page_text(page));
    for (const validation::Curve& curve : page.curves) write(curves / (curve.name + ".csv"), csv_text(curve));
  }
  // Some problems alone are for looking at their pages.
  if (wanted.empty()) write(pages / "README.md", overview_text(all));
  return EXIT_SUCCESS;
} catch (const std::exception& error) {
  std::cerr << "carom-validate: " << error.what() << "\n";
  return EXIT_FAILURE;
}

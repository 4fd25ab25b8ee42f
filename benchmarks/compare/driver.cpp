// The program around a driver:
//   compare_<engine> cases                           lists cases: scene, number, "default" or "tuned",
//   options compare_<engine> reference <file> [--quick]      writes what tight runs show of scenes without
//   closed form compare_<engine> run <case> <file> [--quick]     runs a case: CPU time [ms], error of places
//   [m], of the energy
//                                                    [J]; or "wrong" and the error, if that is not the motion
//   compare_<engine> about <file> [--quick]          energy that each scene (its first start) loses until
//   energies are compared [J]

#include "driver.h"

#include "exact.h"

#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string_view>

namespace compare {
namespace {

/// CPU time of all threads [s].
double cpu_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

int starts_of(Scene scene, const Scale& scale) {
  return scene == Scene::tables || scene == Scene::bar ? scale.starts : 1;
}

struct Timed {
  Seen seen;
  double seconds = 0.0;  // of one start
};

Timed run(const Case& what, const Scale& scale) {
  Timed result;
  const int starts = starts_of(what.scene, scale);
  for (int start = 0; start < starts; ++start) {
    const std::unique_ptr<World> world = what.make(scale, start);
    for (const Look& at : looks(what.scene, scale)) {
      const double begin = cpu_seconds();
      world->advance(at.time);
      result.seconds += (cpu_seconds() - begin) / starts;
      look(what.scene, scale, at, world->bodies(), result.seen);
    }
  }
  return result;
}

void write_reference(const std::vector<Case>& cases, const Scale& scale, const std::string& path) {
  std::FILE* const file = std::fopen(path.c_str(), "w");
  if (file == nullptr) throw std::runtime_error("cannot write " + path);
  const auto write = [&](const std::vector<double>& values) {
    std::fprintf(file, " %zu", values.size());
    for (const double value : values) std::fprintf(file, " %.17g", value);
  };
  for (const Case& what : cases) {
    const Seen seen = run(what, scale).seen;
    std::fprintf(file, "%s", name(what.scene));
    write(seen.places);
    write(seen.energies);
    std::fprintf(file, "\n");
  }
  if (std::fclose(file) != 0) throw std::runtime_error("cannot write " + path);
}

Seen expected(Scene scene, const Scale& scale, const std::string& path) {
  if (has_closed_form(scene)) return exact(scene, scale);
  std::ifstream file(path);
  const auto read = [&](std::vector<double>& values) {
    std::size_t count = 0;
    file >> count;
    values.resize(count);
    for (double& value : values) file >> value;
  };
  std::string word;
  while (file >> word) {
    Seen seen;
    read(seen.places);
    read(seen.energies);
    if (file && word == name(scene)) return seen;
  }
  throw std::runtime_error(std::string("no reference of ") + name(scene) + " in " + path);
}

/// Root mean square of the differences, of `together` numbers at a time.
double error(const std::vector<double>& a, const std::vector<double>& b, std::size_t together) {
  if (a.size() != b.size()) throw std::logic_error("the engine shows another number of bodies");
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum * static_cast<double>(together) / static_cast<double>(a.size()));
}

/// Errors beyond these are another motion, the time of which says nothing: of places [m], of the energy [J].
struct Bound {
  double place, energy;
};
Bound bound_of(Scene scene, const Scale& scale) {
  const double weight_of_net = net::mass * gravity * scale.net_side * scale.net_side;
  switch (scene) {
    case Scene::tables:
      return {0.2, 0.05 * energy(tables::of_ball, tables::start(0))};
    case Scene::net:
      return {0.1, 0.2 * weight_of_net * net::height};
    case Scene::balls:
      return {0.02, 0.2 * scale.balls * balls::mass * gravity * balls::start(1, 0).y};
    case Scene::chain:
      return {1.0, 0.25 * chain::rods * chain::mass * gravity * 0.5 * chain::rods * chain::length};
    case Scene::bar:
      return {1.0, 0.05 * energy(bar::of_bar, bar::start(0))};
  }
  return {};
}

void print_cases(const Engine& engine) {
  for (std::size_t i = 0; i < engine.cases.size(); ++i) {
    const Case& what = engine.cases[i];
    std::printf("%s\t%s\t%zu\t%s\t%s\n", engine.name.c_str(), name(what.scene), i,
                what.as_it_comes ? "default" : "tuned", what.options.c_str());
  }
  for (const Missing& missing : engine.missing) {
    std::printf("%s\t%s\t-\tmissing\t%s\n", engine.name.c_str(), name(missing.scene), missing.why.c_str());
  }
}

void print_run(const Case& what, const Scale& scale, const std::string& path) {
  const Timed timed = run(what, scale);
  const Seen right = expected(what.scene, scale, path);
  const double place = error(timed.seen.places, right.places, 2);
  const double energy = error(timed.seen.energies, right.energies, 1);
  const Bound bound = bound_of(what.scene, scale);
  const bool sane = place <= bound.place && energy <= bound.energy;  // false where an error is no number
  std::printf("%s\t%.6g\t%.3g\t%.3g\n", sane ? "right" : "wrong", 1e3 * timed.seconds, place, energy);
}

void print_about(const Scale& scale, const std::string& path) {
  for (const Scene scene : all_scenes) {
    const double start = energy(scene, scale, bodies_at_start(scene, scale, 0));
    std::printf("%s\t%.6g\n", name(scene), start - expected(scene, scale, path).energies.front());
  }
}

int usage(const char* program) {
  std::fprintf(stderr, "usage: %s cases | reference <file> | run <case> <file> | about <file> [--quick]\n",
               program);
  return 2;
}

int drive(const std::vector<std::string>& arguments, bool quick, const char* program) {
  const Scale scale = Scale::of(quick);
  const std::string verb = arguments.empty() ? "" : arguments[0];
  const Engine with = engine();
  if (verb == "cases" && arguments.size() == 1) {
    print_cases(with);
  } else if (verb == "reference" && arguments.size() == 2) {
    write_reference(with.references, scale, arguments[1]);
  } else if (verb == "run" && arguments.size() == 3) {
    print_run(with.cases.at(std::stoul(arguments[1])), scale, arguments[2]);
  } else if (verb == "about" && arguments.size() == 2) {
    print_about(scale, arguments[1]);
  } else {
    return usage(program);
  }
  return 0;
}

}  // namespace
}  // namespace compare

int main(int argc, char** argv) {
  std::vector<std::string> arguments(argv + 1, argv + argc);
  const bool quick = !arguments.empty() && arguments.back() == "--quick";
  if (quick) arguments.pop_back();
  try {
    return compare::drive(arguments, quick, argv[0]);
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "%s: %s\n", argv[0], failure.what());
    return 1;
  }
}

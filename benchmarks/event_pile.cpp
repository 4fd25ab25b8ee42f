// One random pile in the event-driven mode, as one line of JSON: how far it came, whether it rests, what was
// wrong. scripts/event_piles.py runs many and makes a table.
//
//   event_pile <kind: discs, rounded, sharp> <bodies> <friction> <restitution> <seed> [<end> [s]]

#include "tests/integrators/event_driven/random_piles.h"

#include <carom/carom.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <iomanip>
#include <iostream>
#include <numeric>
#include <string>
#include <vector>

namespace {

using namespace random_piles;

/// Overlap, account and energy at the output states of a run.
struct Watch {
  double deepest = -1.0;  // overlap [m]
  double residual = 0.0;  // of the energy account, of what flowed
  double gain = 0.0;      // of energy beyond what there was before [J]
  double least = 1e300;   // energy so far [J]
};

void look(const Simulation& now, const RandomPile& pile, Watch& watch) {
  watch.deepest = std::max(watch.deepest, pile.deepest(now.state()));
  const EnergyLedger& energy = now.energy();
  watch.residual = std::max(watch.residual, std::abs(energy.residual()) / energy.scale());
  const double total = energy.kinetic() + energy.potential();
  if (watch.least < 1e300) watch.gain = std::max(watch.gain, total - watch.least);
  watch.least = std::min(watch.least, total);
}

std::string without_quotes(std::string text) {
  std::replace(text.begin(), text.end(), '"', '\'');
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

PileOptions options_of(const std::vector<std::string>& words) {
  PileOptions options;
  options.discs_only = words[0] == "discs";
  options.sharp = words[0] == "sharp";
  options.bodies = std::stoi(words[1]);
  options.friction = std::stod(words[2]);
  options.restitution = std::stod(words[3]);
  options.seed = std::stoull(words[4]);
  return options;
}

void print(const Simulation& simulation, const Watch& watch, const std::string& error) {
  double height = 0.0;
  const std::vector<BodyId> bodies = simulation.system().bodies();
  for (const BodyId body : bodies) height += simulation.state().position(body)[1];
  const auto& events = simulation.statistics().events;
  std::cout << std::setprecision(6) << "{\"time\": " << simulation.time()
            << ", \"cpu\": " << static_cast<double>(std::clock()) / CLOCKS_PER_SEC
            << ", \"kinetic\": " << simulation.energy().kinetic()
            << ", \"height\": " << height / static_cast<double>(bodies.size())
            << ", \"deepest\": " << watch.deepest << ", \"residual\": " << watch.residual
            << ", \"gain\": " << watch.gain
            << ", \"events\": " << std::accumulate(events.begin(), events.end(), std::int64_t{0})
            << ", \"jams\": " << events[static_cast<std::size_t>(EventKind::impact_without_collision)]
            << ", \"error\": \"" << without_quotes(error) << "\"}" << std::endl;
}

int run(const std::vector<std::string>& words) {
  const RandomPile pile(options_of(words));
  const double end = words.size() > 5 ? std::stod(words[5]) : 2.0;
  EventDriven mode{.interval = 0.01, .record_events = false};
  if (const char* folder = std::getenv("CAROM_FAILURES")) mode.failure_directory = folder;
  Simulation simulation(pile.system(), mode);
  Watch watch;
  simulation.observe([&](const Simulation& now) { look(now, pile, watch); });
  std::string error;
  try {
    simulation.run_until(end);
  } catch (const SolverError& failure) {
    error = failure.what();
  }
  print(simulation, watch, error);
  return error.empty() ? 0 : 1;
}

}  // namespace

int main(int count, char** arguments) {
  const std::vector<std::string> words(arguments + 1, arguments + count);
  if (words.size() < 5 || words.size() > 6) {
    std::cerr << "usage: event_pile <discs|rounded|sharp> <bodies> <friction> <restitution> <seed> [<end>]\n";
    return 2;
  }
  return run(words);
}

// 500 discs fall into a box and come to rest on each other.
//
//   bodies       discs of radius 0.05 m +- 10 %, m_i q_i'' = m_i g + impulses of contact, friction turns them
//   contact      of discs with each other, floor and walls: gap >= 0, e_n = e_t = 0, mu = 0.5
//   each step    one contact problem for all discs that touch each other, directly or through others:
//                P in C(P), -(W P + b) in the normal cone of C at P, W = H M^-1 H^T
//   solved by    nonlinear conjugate gradients over sweeps (up to 50 contacts: exactly), from the impulses of
//   the
//                step before; every answer has its residual
//   time stepping h = 1e-3 s
//
// While the pile collapses, the sweeps end at their budget, and the step says how good its answer is. Once it
// is at rest, each step is certified to 1e-10, and the energy account closes to rounding throughout.
//
// Usage: 08_discs_in_a_box <folder>: writes course.csv (energies, contacts and residuals over time), and
// discs_1.csv to discs_4.csv (places, radii and largest forces of the discs at four times) there.

#include <carom/carom.h>

#include "examples/scenes/discs.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <string>
#include <vector>

namespace {

constexpr double step = 1e-3;                     // [s]
constexpr double times[] = {0.2, 0.5, 0.8, 3.0};  // [s], of the pictures; the last is the end

/// Writes where the discs are, and the largest normal force on each, averaged over the step.
void write_discs(const carom::Simulation& now, const std::vector<carom::BodyId>& discs,
                 const scenes::Discs& scene, const std::string& path) {
  std::vector<double> force(discs.size(), 0.0);
  for (const carom::ContactRecord& contact : now.report().contacts) {
    const double size = contact.impulse[0] / step;
    for (const carom::BodyId body : {contact.body, contact.other}) {
      if (body.valid()) force[body.serial] = std::max(force[body.serial], size);
    }
  }
  std::ofstream file(path);
  if (!file) throw carom::FileError("'" + path + "' cannot be written");
  file << "x [m],y [m],angle [rad],radius [m],force [N]\n" << std::setprecision(17);
  for (std::size_t i = 0; i < discs.size(); ++i) {
    const auto place = now.state().position(discs[i]);
    const double radius = scene.radius * (1.0 + scene.spread * scenes::scattered(static_cast<int>(i)));
    file << place[0] << ',' << place[1] << ',' << now.state().angle(discs[i]) << ',' << radius << ','
         << force[discs[i].serial] << '\n';
  }
}

/// Writes a row a step: energies, contacts, and the largest residual.
void write_row(const carom::Simulation& now, std::ofstream& file) {
  double residual = 0.0;
  for (const carom::ContactRecord& contact : now.report().contacts) {
    residual = std::max(residual, contact.residual);
  }
  const carom::EnergyLedger& energy = now.energy();
  file << now.time() << ',' << energy.kinetic() << ',' << energy.potential() << ','
       << energy.flow(carom::EnergyFlow::impact_normal) + energy.flow(carom::EnergyFlow::contact_normal)
       << ',' << energy.flow(carom::EnergyFlow::impact_tangential) + energy.flow(carom::EnergyFlow::sliding)
       << ',' << now.report().contacts.size() << ',' << residual << '\n';
}

}  // namespace

int main(int count, char** arguments) try {
  const std::filesystem::path folder = count > 1 ? arguments[1] : ".";
  std::filesystem::create_directories(folder);

  const scenes::Discs scene;
  carom::System system;
  const std::vector<carom::BodyId> discs = scenes::add_discs(system, scene);
  carom::Simulation simulation(system, carom::TimeStepping{.step = step});
  std::ofstream course(folder / "course.csv");
  course << std::setprecision(17)
         << "time [s],kinetic [J],potential [J],lost normal [J],lost tangential [J],contacts,residual\n";
  simulation.observe([&](const carom::Simulation& now) { write_row(now, course); });
  int picture = 0;
  for (const double time : times) {
    simulation.run_until(time);
    write_discs(simulation, discs, scene,
                (folder / ("discs_" + std::to_string(++picture) + ".csv")).string());
  }

  const carom::Statistics& statistics = simulation.statistics();
  const carom::ChainStatistics& solved = simulation.contact_statistics();
  double on_floor = 0.0, weight = 0.0;
  for (const carom::ContactRecord& contact : simulation.report().contacts) {
    if (contact.obstacle == system.obstacle("floor")) on_floor += contact.impulse[0] / step;
  }
  for (std::size_t i = 0; i < discs.size(); ++i) {
    const double radius = scene.radius * (1.0 + scene.spread * scenes::scattered(static_cast<int>(i)));
    weight += scene.density * 3.14159265358979323846 * radius * radius * scenes::discs_gravity;
  }
  std::cout << std::setprecision(10) << "At t = " << simulation.time()
            << " s: " << simulation.report().contacts.size() << " contacts\n"
            << "  normal forces on the floor " << on_floor << " N, weight of all discs " << weight
            << " N (the rest rubs on the walls)\n"
            << "  deepest overlap of the run " << -statistics.deepest_gap << " m\n"
            << "Contact problems: " << solved.problems << ", of these " << solved.accepted_at_cap
            << " taken at the end of the budget; largest residual " << statistics.worst_residual << "\n"
            << simulation.energy() << "\n";
  return EXIT_SUCCESS;
} catch (const std::exception& error) {
  std::cerr << "08_discs_in_a_box: " << error.what() << "\n";
  return EXIT_FAILURE;
}

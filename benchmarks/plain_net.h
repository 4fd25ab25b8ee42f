#pragma once

/// \file
/// The net as one would write it by hand for this purpose alone: flat arrays, springs with the two particles
/// they join, no use made of the grid.

#include "examples/scenes/net.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace benchmarks {

/// Arrays over the particles are interleaved: x, y, x, y, ...
struct PlainNet {
  struct Spring {
    double stiffness, damping, free_length;
    std::uint32_t from, to;  // where the coordinates of the two particles begin
  };
  std::vector<double> q, v, force, mass;
  std::vector<double> q0, v0, force0, before, earlier,
      acted;      // of plain_step(): at the start, and one and two steps ago
  int known = 0;  // how many of the last three are known
  std::vector<Spring> springs;

  explicit PlainNet(const scenes::Net& net);

  [[nodiscard]] std::size_t size() const { return mass.size(); }
};

/// Forces at q, v. Compiled for the instruction set that the library is compiled for.
void plain_forces(PlainNet& net);
/// Forces, then v += h F/m, q += h v: one explicit step.
void plain_sweep(PlainNet& net, double step);
/// One explicit step: forces, then v += h F/m, q += h v. AVX2 and FMA are allowed.
void plain_sweep_avx2(PlainNet& net, double step);
/// One explicit step: forces, then v += h F/m, q += h v. AVX2 and FMA are allowed, and springs are in blocks
/// so that root and division run on four springs at once.
void plain_sweep_blocked_avx2(PlainNet& net, double step);
/// One explicit step: forces, then v += h F/m, q += h v. Springs are in blocks, for the instruction set of
/// the library.
void plain_sweep_blocked(PlainNet& net, double step);
/// One step of the trapezoidal rule, sweeps until the next one would change positions and h times velocities
/// by less than `tolerance` [m]; forces at its end are guessed from those of the last three. No contact, no
/// energy ledger. Returns the sweeps.
int plain_step(PlainNet& net, double step, double tolerance);
/// Whether this machine has AVX2 and FMA.
bool has_avx2();

}  // namespace benchmarks

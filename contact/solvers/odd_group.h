#pragma once

/// \file
/// A contact of a large problem that is solved by itself (sweep_packs.h): every set, any number of solutions.

#include <carom/contact/solvers/sweep_packs.h>

#include <array>

namespace carom {

/// Solves a group for its own impulses, and keeps the velocities up to date; writes P and g. A planar contact
/// takes of several solutions the one nearest to its impulses, so that sweeps do not jump between them; from
/// nothing that is the one with the least normal impulse, as solve_planar_contact() orders them. Without a
/// solution its rows are solved one after the other. Nothing moves what cannot move: its impulses stay.
void solve(OddGroup& odd, SlotVelocity* velocity);

/// u += H^T times impulses of the group.
void push(const OddGroup& odd, const std::array<double, 2>& impulse, SlotVelocity* velocity);

/// As pack_kernel::judge().
void judge(const OddGroup& odd, const SlotVelocity* velocity, double& error, double& size);

}  // namespace carom

#pragma once

/// \file
/// The inner loops of sweeps: four regular contacts at a time.

#include <carom/contact/solvers/sweep_packs.h>

#include <span>

namespace carom {
struct ImpulseChange;
}

namespace carom::pack_kernel {

/// Solves each pack in turn for its own impulses, with the decision of solve_planar_contact(): open where no
/// impulse is needed, else stick, W_ii dP = -xi, where that lies in the cone of friction, else slip along its
/// edge. Writes P and g. \param velocity by slot, kept up to date
[[nodiscard]] ImpulseChange sweep(std::span<ContactPack> packs, SlotVelocity* velocity);

/// u += H^T P. \param velocity by slot
void push(std::span<const ContactPack> packs, SlotVelocity* velocity);

/// Raises `error` to the largest |P - proj_C(P - rho xi)| and `size` to the largest |P|; both become infinite
/// or NaN where a number is none. \param velocity of these impulses
void judge(std::span<const ContactPack> packs, const SlotVelocity* velocity, double& error, double& size);

}  // namespace carom::pack_kernel

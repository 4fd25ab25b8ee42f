// Problem: visit thousands of contacts, each solved exactly, in a few nanoseconds each.

#include <carom/contact/solvers/contact_sweeps.h>

#include <carom/contact/solvers/odd_group.h>
#include <carom/contact/solvers/pack_kernel.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

void ContactSweeps::begin(const ContactProblem& problem, std::span<const double> impulse) {
  packs_.build(problem, impulse);
  velocity_.resize(packs_.slots());
  before_.resize(packs_.slots());
  direction_.resize(packs_.slots());
  make_velocities();
  before_ = velocity_;
}

void ContactSweeps::make_velocities() {
  std::fill(velocity_.begin(), velocity_.end(), SlotVelocity{});
  pack_kernel::push(packs_.packs(), velocity_.data());
  for (const OddGroup& odd : packs_.odd()) push(odd, odd.p, velocity_.data());
  made_anew_ = true;
}

ImpulseChange ContactSweeps::sweep() {
  made_anew_ = false;
  ImpulseChange change = pack_kernel::sweep(packs_.packs(), velocity_.data());
  for (OddGroup& odd : packs_.odd()) {
    solve(odd, velocity_.data());
    for (const double g : odd.g) {
      change.square += g * g;
      change.largest = std::max(change.largest, std::abs(g));
    }
  }
  return change;
}

void ContactSweeps::restart() {
  for (ContactPack& pack : packs_.packs()) {
    pack.d_n = pack.g_n;
    pack.d_t = pack.g_t;
  }
  for (OddGroup& odd : packs_.odd()) odd.d = odd.g;
  for (std::size_t slot = 0; slot < velocity_.size(); ++slot) {
    direction_[slot].v = velocity_[slot].v - before_[slot].v;
    before_[slot] = velocity_[slot];
  }
}

void ContactSweeps::step(double beta) {
  made_anew_ = false;
  const Lanes factor{beta, beta, beta, beta};
  for (ContactPack& pack : packs_.packs()) {
    const Lanes n = factor * pack.d_n, t = factor * pack.d_t;
    pack.p_n += n;
    pack.p_t += t;
    pack.d_n = n + pack.g_n;
    pack.d_t = t + pack.g_t;
  }
  for (OddGroup& odd : packs_.odd()) {
    for (std::size_t row = 0; row < 2; ++row) {
      const double part = beta * odd.d[row];
      odd.p[row] += part;
      odd.d[row] = part + odd.g[row];
    }
  }
  for (std::size_t slot = 0; slot < velocity_.size(); ++slot) {
    Lanes &u = velocity_[slot].v, &d = direction_[slot].v;
    const Lanes change = u - before_[slot].v, part = factor * d;
    d = part + change;
    u += part;
    before_[slot].v = u;
  }
}

double ContactSweeps::judge() {
  if (!made_anew_) make_velocities();
  double error = 0.0, size = 0.0;
  pack_kernel::judge(packs_.packs(), velocity_.data(), error, size);
  for (const OddGroup& odd : packs_.odd()) carom::judge(odd, velocity_.data(), error, size);
  scale_ = std::max(size, packs_.load_scale());
  if (!std::isfinite(error + scale_)) return std::numeric_limits<double>::infinity();
  return error > 0.0 ? error / scale_ : 0.0;
}

}  // namespace carom

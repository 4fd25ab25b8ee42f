// Problem: solve four contacts without a body in common at once.
//
// With the local b = xi - W_ii P of a contact, its solution in the three modes is
//     open     P = 0                                            where b_n >= 0
//     stick    P + dP, W_ii dP = -xi                            where |P_t| <= mu P_n
//     slip     P_n = -b_n / (W_nn -+ mu W_nt), P_t = -+mu P_n   else, against the P_t of stick
// Regular contacts have one solution (SweepPacks), so the order of the questions does not matter. Changes are
// made from xi, not from b: at a solution xi is small, and so is its rounding.

#include <carom/contact/solvers/contact_sweeps.h>
#include <carom/contact/solvers/pack_kernel.h>

#include <algorithm>

#if defined(__GNUC__)
// Lanes stay within this source, inlined: no call depends on how they would be passed.
#pragma GCC diagnostic ignored "-Wpsabi"
#endif

#define CAROM_INLINE [[gnu::always_inline]] inline

namespace carom::pack_kernel {

namespace {

// Four velocities, number by number: x of all, y of all, rotation of all.
struct Gathered {
  Lanes x, y, z;
};

CAROM_INLINE void transpose(const Lanes& r0, const Lanes& r1, const Lanes& r2, const Lanes& r3,
                            Gathered& out) {
  const Lanes even01 = __builtin_shufflevector(r0, r1, 0, 4, 2, 6),
              odd01 = __builtin_shufflevector(r0, r1, 1, 5, 3, 7);
  const Lanes even23 = __builtin_shufflevector(r2, r3, 0, 4, 2, 6),
              odd23 = __builtin_shufflevector(r2, r3, 1, 5, 3, 7);
  out.x = __builtin_shufflevector(even01, even23, 0, 1, 4, 5);
  out.y = __builtin_shufflevector(odd01, odd23, 0, 1, 4, 5);
  out.z = __builtin_shufflevector(even01, even23, 2, 3, 6, 7);
}

CAROM_INLINE void gather(const SlotVelocity* velocity, const std::array<std::int32_t, lane_count>& slot,
                         Gathered& out) {
  transpose(velocity[slot[0]].v, velocity[slot[1]].v, velocity[slot[2]].v, velocity[slot[3]].v, out);
}

CAROM_INLINE void scatter(SlotVelocity* velocity, const std::array<std::int32_t, lane_count>& slot,
                          const Gathered& u) {
  const Lanes none{};
  const Lanes xy01 = __builtin_shufflevector(u.x, u.y, 0, 4, 1, 5),
              zn01 = __builtin_shufflevector(u.z, none, 0, 4, 1, 5);
  const Lanes xy23 = __builtin_shufflevector(u.x, u.y, 2, 6, 3, 7),
              zn23 = __builtin_shufflevector(u.z, none, 2, 6, 3, 7);
  velocity[slot[0]].v = __builtin_shufflevector(xy01, zn01, 0, 1, 4, 5);
  velocity[slot[1]].v = __builtin_shufflevector(xy01, zn01, 2, 3, 6, 7);
  velocity[slot[2]].v = __builtin_shufflevector(xy23, zn23, 0, 1, 4, 5);
  velocity[slot[3]].v = __builtin_shufflevector(xy23, zn23, 2, 3, 6, 7);
}

CAROM_INLINE Lanes along(const std::array<Lanes, 6>& h, const Gathered& first, const Gathered& second) {
  return (h[0] * first.x + h[1] * first.y + h[2] * first.z) +
         (h[3] * second.x + h[4] * second.y + h[5] * second.z);
}

CAROM_INLINE Lanes larger(const Lanes& a, const Lanes& b) { return a > b ? a : b; }

// A NaN in the first argument stays.
CAROM_INLINE Lanes magnitude(const Lanes& a) { return a < 0.0 ? -a : a; }

CAROM_INLINE void add_impulses(const ContactPack& pack, const Lanes& n, const Lanes& t, Gathered& first,
                               Gathered& second) {
  first.x += pack.h_n[0] * n + pack.h_t[0] * t;
  first.y += pack.h_n[1] * n + pack.h_t[1] * t;
  first.z += pack.h_n[2] * n + pack.h_t[2] * t;
  second.x += pack.h_n[3] * n + pack.h_t[3] * t;
  second.y += pack.h_n[4] * n + pack.h_t[4] * t;
  second.z += pack.h_n[5] * n + pack.h_t[5] * t;
}

// Impulses of a pack that solve its contacts at velocities xi.
CAROM_INLINE void solve(const ContactPack& pack, const Lanes& xi_n, const Lanes& xi_t, Lanes& n, Lanes& t) {
  const Lanes zero{};
  const Lanes p_n = pack.p_n, p_t = pack.p_t, mu = pack.friction;
  const Lanes stick_n = p_n - (pack.i_nn * xi_n + pack.i_nt * xi_t);
  const Lanes stick_t = p_t - (pack.i_nt * xi_n + pack.i_tt * xi_t);
  const LaneMask negative = stick_t < zero;
  const Lanes edge = negative ? -mu : mu;
  const Lanes inverse = negative ? pack.slip_positive : pack.slip_negative;
  const Lanes slip_n = larger(p_n - (xi_n + pack.w_nt * (edge * p_n - p_t)) * inverse, zero);
  const LaneMask slips = magnitude(stick_t) > mu * stick_n;
  const LaneMask open = xi_n >= pack.w_nn * p_n + pack.w_nt * p_t;
  n = slips ? slip_n : larger(stick_n, zero);
  t = slips ? edge * slip_n : stick_t;
  n = open ? zero : n;
  t = open ? zero : t;
}

CAROM_INLINE void sweep_all(std::span<ContactPack> packs, SlotVelocity* velocity, ImpulseChange& change) {
  Lanes square{}, largest{};
  for (ContactPack& pack : packs) {
    Gathered first, second;
    gather(velocity, pack.first, first);
    gather(velocity, pack.second, second);
    const Lanes xi_n = along(pack.h_n, first, second) + pack.b_n;
    const Lanes xi_t = along(pack.h_t, first, second) + pack.b_t;
    Lanes n, t;
    solve(pack, xi_n, xi_t, n, t);
    const Lanes g_n = n - pack.p_n, g_t = t - pack.p_t;
    pack.p_n = n;
    pack.p_t = t;
    pack.g_n = g_n;
    pack.g_t = g_t;
    square += g_n * g_n + g_t * g_t;
    largest = larger(larger(magnitude(g_n), magnitude(g_t)), largest);
    add_impulses(pack, g_n, g_t, first, second);
    scatter(velocity, pack.first, first);
    scatter(velocity, pack.second, second);
  }
  change.square = (square[0] + square[1]) + (square[2] + square[3]);
  change.largest = std::max(std::max(largest[0], largest[1]), std::max(largest[2], largest[3]));
}

CAROM_INLINE void push_all(std::span<const ContactPack> packs, SlotVelocity* velocity) {
  for (const ContactPack& pack : packs) {
    Gathered first, second;
    gather(velocity, pack.first, first);
    gather(velocity, pack.second, second);
    add_impulses(pack, pack.p_n, pack.p_t, first, second);
    scatter(velocity, pack.first, first);
    scatter(velocity, pack.second, second);
  }
}

CAROM_INLINE void judge_all(std::span<const ContactPack> packs, const SlotVelocity* velocity, double& error,
                            double& size) {
  const Lanes zero{};
  Lanes worst{}, sum{}, most{};
  for (const ContactPack& pack : packs) {
    Gathered first, second;
    gather(velocity, pack.first, first);
    gather(velocity, pack.second, second);
    const Lanes xi_n = along(pack.h_n, first, second) + pack.b_n;
    const Lanes xi_t = along(pack.h_t, first, second) + pack.b_t;
    const Lanes limit = pack.friction * larger(pack.p_n, zero);
    const Lanes moved_n = larger(pack.p_n - pack.rho * xi_n, zero);
    Lanes moved_t = pack.p_t - pack.rho * xi_t;
    moved_t = moved_t < -limit ? -limit : moved_t;
    moved_t = moved_t > limit ? limit : moved_t;
    const Lanes error_n = magnitude(pack.p_n - moved_n), error_t = magnitude(pack.p_t - moved_t);
    worst = larger(larger(error_n, error_t), worst);
    most = larger(larger(magnitude(pack.p_n), magnitude(pack.p_t)), most);
    sum += xi_n + xi_t + pack.p_n + pack.p_t;  // carries a NaN along where maxima drop it
  }
  const double any = 0.0 * ((sum[0] + sum[1]) + (sum[2] + sum[3]));
  for (int lane = 0; lane < lane_count; ++lane) {
    error = std::max(error, worst[lane]);
    size = std::max(size, most[lane]);
  }
  error += any;
}

#if defined(__x86_64__) && defined(__GNUC__)
// The same arithmetic, and the same bits, in registers of four numbers where the machine has them.
#define CAROM_WIDE __attribute__((target("avx2")))
CAROM_WIDE void sweep_wide(std::span<ContactPack> packs, SlotVelocity* velocity, ImpulseChange& change) {
  sweep_all(packs, velocity, change);
}
CAROM_WIDE void push_wide(std::span<const ContactPack> packs, SlotVelocity* velocity) {
  push_all(packs, velocity);
}
CAROM_WIDE void judge_wide(std::span<const ContactPack> packs, const SlotVelocity* velocity, double& error,
                           double& size) {
  judge_all(packs, velocity, error, size);
}
const bool wide = __builtin_cpu_supports("avx2") != 0;
#else
constexpr bool wide = false;
void sweep_wide(std::span<ContactPack>, SlotVelocity*, ImpulseChange&) {}
void push_wide(std::span<const ContactPack>, SlotVelocity*) {}
void judge_wide(std::span<const ContactPack>, const SlotVelocity*, double&, double&) {}
#endif

}  // namespace

ImpulseChange sweep(std::span<ContactPack> packs, SlotVelocity* velocity) {
  ImpulseChange change;
  wide ? sweep_wide(packs, velocity, change) : sweep_all(packs, velocity, change);
  return change;
}

void push(std::span<const ContactPack> packs, SlotVelocity* velocity) {
  wide ? push_wide(packs, velocity) : push_all(packs, velocity);
}

void judge(std::span<const ContactPack> packs, const SlotVelocity* velocity, double& error, double& size) {
  wide ? judge_wide(packs, velocity, error, size) : judge_all(packs, velocity, error, size);
}

}  // namespace carom::pack_kernel

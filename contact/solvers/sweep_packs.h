#pragma once

/// \file
/// The contacts of a large problem as sweeps visit them: four that share no body at a time, structure of
/// arrays.
///
/// Rows are scaled by the roots of the inverse masses, H' = H M^-1/2, so that W = H' H'^T and no mass is
/// left: body velocities u' = M^1/2 u change by H'^T dP.

#include <carom/contact/solvers/contact_problem.h>
#include <carom/core/numerics/lanes.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace carom {

/// Scaled velocity of a body; the fourth number is none. Aligned as registers of four numbers want it, which
/// the compiler takes care of only where it is told that there are some.
struct alignas(32) SlotVelocity {
  Lanes v{};
};

/// Four regular contacts (a normal row with its friction row, or a lone row P >= 0) without a body in common.
/// Places that are not used are zero: such a contact keeps P = 0.
struct alignas(32) ContactPack {
  std::array<Lanes, 6> h_n, h_t;       // scaled rows: three numbers of the first slot, three of the second
  Lanes b_n, b_t;                      // of the vector b
  Lanes friction;                      // coefficient mu
  Lanes w_nn, w_nt;                    // of its block of W
  Lanes i_nn, i_nt, i_tt;              // inverse of the block; without friction of w_nn alone
  Lanes slip_positive, slip_negative;  // 1 / (W_nn -+ mu W_nt)
  Lanes rho;                           // of the residual
  Lanes p_n, p_t;                      // impulses P
  Lanes g_n, g_t;                      // their change in the last sweep
  Lanes d_n, d_t;                      // direction of the conjugate gradients
  std::array<std::int32_t, lane_count> first, second;  // slots; that of nobody where there is none
  std::array<std::int32_t, lane_count> group;          // -1: not used
};

/// A group that is solved by itself: of three slots, an interval, in a known direction of slip, immovable,
/// with several solutions or none, or with slots that answer together.
struct OddGroup {
  int group = 0, rows = 0;
  std::size_t first = 0;                     // its first row, in
  const ResponseFactors* factors = nullptr;  // whose bound slots it reaches; null: none
  std::array<int, std::size_t{ResponseFactors::most_slots}> slot{};
  std::array<std::array<double, 9>, 2> h{};  // scaled
  double w_nn = 0.0, w_nt = 0.0, w_tt = 0.0, rho = 0.0;
  std::array<double, 2> b{}, p{}, g{}, d{};
  std::array<RowSet, 2> set{};
};

/// Order and numbers of the contacts of one problem. The order depends on which contacts are regular, which
/// bodies they have and which of these move: as long as that is the same the places are, and only numbers are
/// written. In the order of the problem each goes to the first of up
/// to 24 packs that are being filled and have none of its bodies, which is a greedy colouring; what finds
/// none of them goes alone. Packs are visited in the order in which they were begun.
class SweepPacks {
public:
  /// Lays a problem in factors out, with impulses to start from. Allocates only while problems grow.
  void build(const ContactProblem& problem, std::span<const double> impulse);
  /// Writes the impulses back, by row.
  void write(const ContactProblem& problem, std::span<double> impulse) const;

  /// Packs, in the order in which they are visited.
  [[nodiscard]] std::span<ContactPack> packs() { return {packs_.data(), pack_count_}; }
  [[nodiscard]] std::span<const ContactPack> packs() const { return {packs_.data(), pack_count_}; }
  /// Groups that are in no pack, visited behind the packs.
  [[nodiscard]] std::span<OddGroup> odd() { return odd_; }
  [[nodiscard]] std::span<const OddGroup> odd() const { return odd_; }
  /// Slots of the problem, and one that stands for no body and does not move.
  [[nodiscard]] std::size_t slots() const { return scale_.size(); }
  /// Largest |b| / trace W_ii [N s].
  [[nodiscard]] double load_scale() const { return load_scale_; }

private:
  static constexpr int most_open = 24;
  struct Group;

  // Where a group of the last problem went, and what that was decided by.
  struct Place {
    std::int32_t first = 0, second = 0;  // slots
    std::int32_t pack = -1;              // -1: none, it is odd
    int lane = 0;
  };

  [[nodiscard]] bool scale_masses(const ResponseFactors& factors);
  [[nodiscard]] bool has_places(const ContactProblem& problem) const;
  [[nodiscard]] bool fill_places(const ContactProblem& problem, std::span<const double> impulse);
  void find_places(const ContactProblem& problem, std::span<const double> impulse);
  void find_least_trace(const ContactProblem& problem);
  [[nodiscard]] Group read(const ContactProblem& problem, std::size_t g, std::span<const double> impulse);
  static void read_bound(const ResponseFactors& factors, Group& group);
  [[nodiscard]] static bool is_regular(const Group& group);
  [[nodiscard]] bool moves(std::size_t slot) const {
    return scale_[slot].v[0] > 0.0 || scale_[slot].v[2] > 0.0;
  }
  [[nodiscard]] std::int32_t find_room(const Group& group, int& lane);
  void close(std::size_t open);
  static void name(const Group& group, ContactPack& pack, int lane);
  static void put(const Group& group, ContactPack& pack, int lane);
  void add_odd(const Group& group);

  // A pack that is being filled.
  struct Open {
    std::int32_t pack = -1;
    int used = 0;
  };
  std::vector<ContactPack> packs_;
  std::size_t pack_count_ = 0;
  std::array<Open, std::size_t{most_open}> open_{};
  std::vector<Place> places_;  // by group
  std::vector<OddGroup> odd_;
  std::vector<SlotVelocity> scale_;   // roots of inverse masses; 1 of slots that answer together
  std::vector<std::uint32_t> taken_;  // by slot: open packs that have it
  double load_scale_ = 0.0, least_trace_ = 0.0, immovable_rho_ = 1.0;
};

}  // namespace carom

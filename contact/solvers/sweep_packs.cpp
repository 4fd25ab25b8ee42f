// Problem: put contacts into an order and a form in which four can be solved at once.

#include <carom/contact/solvers/sweep_packs.h>

#include <carom/contact/solvers/planar_certificate.h>
#include <carom/contact/solvers/residual.h>
#include <carom/contact/solvers/single_contact.h>
#include <carom/core/numerics/fetch_ahead.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace carom {

// One group of a problem as it is read.
struct SweepPacks::Group {
  int number = 0, rows = 0, slots = 0;
  std::size_t first = 0;                     // row
  const ResponseFactors* factors = nullptr;  // null: no bound slots
  std::array<int, std::size_t{ResponseFactors::most_slots}> slot{};
  std::array<std::array<double, 9>, 2> h{};  // scaled
  double w_nn = 0.0, w_nt = 0.0, w_tt = 0.0, rho = 0.0;
  std::array<double, 2> b{}, p{};
  const RowSet* set = nullptr;
};

/// True if there are as many slots as before, and the same of them move.
bool SweepPacks::scale_masses(const ResponseFactors& factors) {
  constexpr std::size_t columns = ResponseFactors::columns;
  const std::size_t count = factors.slots();
  bool same = scale_.size() == count + 1;
  scale_.resize(count + 1);
  for (std::size_t slot = 0; slot < count; ++slot) {
    const double* const mass = factors.inverse_mass.data() + columns * slot;
    const bool moved = moves(slot);
    scale_[slot].v = Lanes{std::sqrt(mass[0]), std::sqrt(mass[1]), std::sqrt(mass[2]), 0.0};
    if (factors.is_bound(slot)) scale_[slot].v = Lanes{1.0, 1.0, 1.0, 0.0};
    same = same && moves(slot) == moved;
  }
  scale_[count] = {};
  return same;
}

/// Where a group cannot move, rho is that of the most movable one (residual.h).
void SweepPacks::find_least_trace(const ContactProblem& problem) {
  const double largest = largest_trace(problem);
  least_trace_ = largest * negligible_trace;
  immovable_rho_ = largest > 0.0 ? 1.0 / largest : 1.0;
}

/// Block of W of a group with bound slots.
void SweepPacks::read_bound(const ResponseFactors& factors, Group& group) {
  group.factors = &factors;
  group.w_nn = factors.diagonal(group.first);
  if (group.rows < 2) return;
  group.w_nt = factors.entry(group.first + 1, group.first);
  group.w_tt = factors.diagonal(group.first + 1);
}

/// Raises the scale of the loads by its own.
SweepPacks::Group SweepPacks::read(const ContactProblem& problem, std::size_t g,
                                   std::span<const double> impulse) {
  constexpr std::size_t columns = ResponseFactors::columns;
  const RowGroup& at = problem.groups()[g];
  const auto first = static_cast<std::size_t>(at.first);
  const ResponseFactors::Row* const rows = problem.factors().rows.data() + first;
  Group group;
  group.number = static_cast<int>(g);
  group.rows = at.size;
  group.set = problem.sets().data() + first;
  const std::size_t nobody = scale_.size() - 1;
  for (std::size_t i = 0; i < ResponseFactors::most_slots; ++i) {
    const bool used = rows[0].slot[i] != ResponseFactors::no_slot;
    const std::size_t slot = used ? static_cast<std::size_t>(rows[0].slot[i]) : nobody;
    group.slot[i] = static_cast<int>(slot);
    if (!used) continue;
    ++group.slots;
    for (std::size_t k = 0; k < columns; ++k) {
      const double scale = scale_[slot].v[k], n = rows[0].h[columns * i + k] * scale;
      group.h[0][columns * i + k] = n;
      group.w_nn += n * n;
      if (at.size < 2) continue;
      const double t = rows[1].h[columns * i + k] * scale;
      group.h[1][columns * i + k] = t;
      group.w_nt += n * t;
      group.w_tt += t * t;
    }
  }
  group.first = first;
  if (!problem.factors().answers(first).empty()) read_bound(problem.factors(), group);
  const double trace = group.w_nn + group.w_tt;
  group.rho = trace > least_trace_ ? 1.0 / trace : immovable_rho_;
  for (std::size_t row = 0; row < static_cast<std::size_t>(at.size); ++row) {
    group.b[row] = problem.vector()[first + row];
    group.p[row] = impulse[first + row];
    load_scale_ = std::max(load_scale_, std::abs(group.b[row]) * group.rho);
  }
  return group;
}

/// Whether a unique solution follows from the formulas of a pack, whatever the others do.
bool SweepPacks::is_regular(const Group& group) {
  if (group.slots > 2 || group.factors != nullptr || group.set[0].kind != SetKind::half_line ||
      !(group.w_nn > 0.0))
    return false;
  if (group.rows == 1) return true;
  if (group.set[1].kind != SetKind::bounded_interval) return false;
  const double friction = group.set[1].coefficient;
  if (friction == 0.0) return true;
  const double coupling = friction * std::abs(group.w_nt),
               determinant = group.w_nn * group.w_tt - group.w_nt * group.w_nt;
  return group.w_nn - coupling > degenerate_margin * (group.w_nn + coupling) &&
         determinant > degenerate_margin * group.w_nn * group.w_tt;
}

/// First open pack without the bodies of a group; a new one where there is none.
std::int32_t SweepPacks::find_room(const Group& group, int& lane) {
  const auto first = static_cast<std::size_t>(group.slot[0]),
             second = static_cast<std::size_t>(group.slot[1]);
  const auto at = static_cast<std::size_t>(std::countr_one(taken_[first] | taken_[second]));
  const auto begin = [&] {
    if (pack_count_ == packs_.size()) packs_.emplace_back();
    packs_[pack_count_].group.fill(-1);
    return static_cast<std::int32_t>(pack_count_++);
  };
  lane = 0;
  if (at >= most_open) return begin();
  Open& open = open_[at];
  if (open.pack < 0) open = {begin(), 0};
  lane = open.used++;
  if (moves(first)) taken_[first] |= 1u << at;
  if (moves(second)) taken_[second] |= 1u << at;
  return open.pack;
}

/// Free places of a pack are filled with contacts of nobody. Its bodies may be in the next one.
void SweepPacks::close(std::size_t open) {
  ContactPack& pack = packs_[static_cast<std::size_t>(open_[open].pack)];
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    if (pack.group[lane] < 0) continue;
    taken_[static_cast<std::size_t>(pack.first[lane])] &= ~(1u << open);
    taken_[static_cast<std::size_t>(pack.second[lane])] &= ~(1u << open);
  }
  open_[open] = {};
}

/// Writes who is at a place,
void SweepPacks::name(const Group& group, ContactPack& pack, int lane) {
  const auto place = static_cast<std::size_t>(lane);
  pack.group[place] = group.number;
  pack.first[place] = group.slot[0];
  pack.second[place] = group.slot[1];
}

/// and the numbers.
void SweepPacks::put(const Group& group, ContactPack& pack, int lane) {
  for (std::size_t k = 0; k < 6; ++k) {
    pack.h_n[k][lane] = group.h[0][k];
    pack.h_t[k][lane] = group.h[1][k];
  }
  pack.b_n[lane] = group.b[0];
  pack.b_t[lane] = group.b[1];
  pack.p_n[lane] = group.p[0];
  pack.p_t[lane] = group.p[1];
  pack.w_nn[lane] = group.w_nn;
  pack.w_nt[lane] = group.w_nt;
  pack.rho[lane] = group.rho;
  const double friction = group.rows == 1 ? 0.0 : group.set[1].coefficient;
  const double inverse = group.w_nn > 0.0 ? 1.0 / group.w_nn : 0.0;
  pack.friction[lane] = friction;
  if (friction > 0.0) {
    const double determinant = 1.0 / (group.w_nn * group.w_tt - group.w_nt * group.w_nt);
    pack.i_nn[lane] = group.w_tt * determinant;
    pack.i_nt[lane] = -group.w_nt * determinant;
    pack.i_tt[lane] = group.w_nn * determinant;
    pack.slip_positive[lane] = 1.0 / (group.w_nn - friction * group.w_nt);
    pack.slip_negative[lane] = 1.0 / (group.w_nn + friction * group.w_nt);
  } else {
    pack.i_nn[lane] = pack.slip_positive[lane] = pack.slip_negative[lane] = inverse;
    pack.i_nt[lane] = pack.i_tt[lane] = 0.0;
  }
}

void SweepPacks::add_odd(const Group& group) {
  OddGroup& odd = odd_.emplace_back();
  odd.group = group.number;
  odd.rows = group.rows;
  odd.first = group.first;
  odd.factors = group.factors;
  odd.slot = group.slot;
  odd.h = group.h;
  odd.w_nn = group.w_nn;
  odd.w_nt = group.w_nt;
  odd.w_tt = group.w_tt;
  odd.rho = group.rho;
  odd.b = group.b;
  odd.p = group.p;
  std::copy_n(group.set, group.rows, odd.set.begin());
}

void SweepPacks::build(const ContactProblem& problem, std::span<const double> impulse) {
  const bool same_slots = scale_masses(problem.factors());
  find_least_trace(problem);
  if (same_slots && has_places(problem) && fill_places(problem, impulse)) return;
  find_places(problem, impulse);
}

/// True if the places are those of a problem whose groups have the same slots.
bool SweepPacks::has_places(const ContactProblem& problem) const {
  const std::span<const RowGroup> groups = problem.groups();
  if (groups.size() != places_.size()) return false;
  const auto nobody = static_cast<std::int32_t>(scale_.size() - 1);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const std::array<int, 3>& slot = problem.factors().rows[static_cast<std::size_t>(groups[g].first)].slot;
    const std::int32_t second = slot[1] == ResponseFactors::no_slot ? nobody : slot[1];
    if (slot[0] != places_[g].first || second != places_[g].second) return false;
  }
  return true;
}

/// Writes numbers where the same groups were. False if another one is regular now.
bool SweepPacks::fill_places(const ContactProblem& problem, std::span<const double> impulse) {
  constexpr std::size_t ahead = 8;  // groups
  odd_.clear();
  load_scale_ = 0.0;
  for (std::size_t g = 0; g < places_.size(); ++g) {
    const Place& place = places_[g];
    const std::size_t later = g + ahead;
    if (later < places_.size() && places_[later].lane == 0 && places_[later].pack >= 0) {
      fetch_ahead(std::span(packs_), static_cast<std::size_t>(places_[later].pack));
    }
    const Group group = read(problem, g, impulse);
    if (is_regular(group) != (place.pack >= 0)) return false;
    if (place.pack < 0) {
      add_odd(group);
    } else {
      put(group, packs_[static_cast<std::size_t>(place.pack)], place.lane);
    }
  }
  return true;
}

void SweepPacks::find_places(const ContactProblem& problem, std::span<const double> impulse) {
  taken_.assign(scale_.size(), 0);
  pack_count_ = 0;
  open_.fill({});
  places_.clear();
  odd_.clear();
  load_scale_ = 0.0;
  for (std::size_t g = 0; g < problem.groups().size(); ++g) {
    const Group group = read(problem, g, impulse);
    Place& place = places_.emplace_back();
    place.first = group.slot[0];
    place.second = group.slot[1];
    if (!is_regular(group)) {
      add_odd(group);
      continue;
    }
    place.pack = find_room(group, place.lane);
    ContactPack& pack = packs_[static_cast<std::size_t>(place.pack)];
    name(group, pack, place.lane);
    put(group, pack, place.lane);
    if (place.lane + 1 < lane_count) continue;
    const auto full =
        std::find_if(open_.begin(), open_.end(), [&](const Open& open) { return open.pack == place.pack; });
    close(static_cast<std::size_t>(full - open_.begin()));
  }
  Group nobody;
  nobody.number = -1;
  nobody.slot.fill(static_cast<int>(scale_.size()) - 1);
  nobody.rows = 1;
  for (ContactPack& pack : packs()) {
    for (int lane = 0; lane < lane_count; ++lane) {
      if (pack.group[static_cast<std::size_t>(lane)] >= 0) continue;
      name(nobody, pack, lane);
      put(nobody, pack, lane);
    }
  }
}

void SweepPacks::write(const ContactProblem& problem, std::span<double> impulse) const {
  const auto groups = problem.groups();
  for (const ContactPack& pack : packs()) {
    for (int lane = 0; lane < lane_count; ++lane) {
      const int group = pack.group[static_cast<std::size_t>(lane)];
      if (group < 0) continue;
      const RowGroup& at = groups[static_cast<std::size_t>(group)];
      impulse[static_cast<std::size_t>(at.first)] = pack.p_n[lane];
      if (at.size > 1) impulse[static_cast<std::size_t>(at.first) + 1] = pack.p_t[lane];
    }
  }
  for (const OddGroup& odd : odd_) {
    const auto first = static_cast<std::size_t>(groups[static_cast<std::size_t>(odd.group)].first);
    std::copy_n(odd.p.begin(), odd.rows, impulse.begin() + static_cast<std::ptrdiff_t>(first));
  }
}

}  // namespace carom

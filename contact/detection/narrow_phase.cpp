// Problem: which closed form finds the gap of two outlines?

#include <carom/contact/detection/gap_chain.h>
#include <carom/contact/detection/gap_convex.h>
#include <carom/contact/detection/gap_discs.h>
#include <carom/contact/detection/gap_face.h>
#include <carom/contact/detection/gap_inside_circle.h>
#include <carom/contact/detection/narrow_phase.h>

#include <algorithm>

namespace carom {

namespace {

/// An entry for outlines in the other order.
template <class Entry>
struct Swapped {
  static int find(const PlacedOutline& a, const PlacedOutline& b, double margin,
                  std::array<GapPoint, 2>& out) {
    const int count = Entry::find(b, a, margin, out);
    std::for_each_n(out.begin(), count, [](GapPoint& gap) { gap = gap.swapped(); });
    return count;
  }
  static GapPoint follow(const PlacedOutline& a, Index feature_a, const PlacedOutline& b, Index feature_b) {
    return Entry::follow(b, feature_b, a, feature_a).swapped();
  }
};

constexpr NarrowPhase& entry_of(NarrowPhaseTable& table, OutlineForm a, OutlineForm b) {
  return table[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)];
}

/// Enters an entry for two forms, and another one for the other order.
template <class Entry, class OtherOrder = Swapped<Entry>>
constexpr void enter(NarrowPhaseTable& table, OutlineForm a, OutlineForm b) {
  entry_of(table, b, a) = {&OtherOrder::find, &OtherOrder::follow};
  entry_of(table, a, b) = {&Entry::find, &Entry::follow};
}

/// All closed forms, a line each. Of several lines for the same forms the last one counts.
constexpr NarrowPhaseTable all_entries() {
  using enum OutlineForm;
  NarrowPhaseTable table{};
  enter<GapDiscs>(table, disc, disc);
  enter<GapConvex, GapConvex>(table, disc, polygon);
  enter<GapConvex>(table, polygon, polygon);
  enter<GapInsideCircle>(table, disc, hollow);
  enter<GapInsideCircle>(table, polygon, hollow);
  enter<GapFace>(table, disc, face);
  enter<GapFace>(table, polygon, face);
  enter<GapChain>(table, disc, chain);
  return table;
}

/// True if two bodies of any forms have an entry, in either order, and each of them with any piece of the
/// ground.
constexpr bool is_complete(NarrowPhaseTable table) {
  using enum OutlineForm;
  for (const OutlineForm a : {disc, polygon}) {
    for (const OutlineForm b : {disc, polygon, hollow, face}) {
      if (entry_of(table, a, b).find == nullptr || entry_of(table, b, a).find == nullptr) return false;
    }
  }
  return entry_of(table, disc, chain).find != nullptr;
}
static_assert(is_complete(all_entries()));

}  // namespace

constexpr NarrowPhaseTable narrow_phase_table = all_entries();

}  // namespace carom

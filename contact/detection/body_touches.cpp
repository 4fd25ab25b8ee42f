// Problem: which bodies touch each other, and where.

#include <carom/contact/detection/body_touches.h>
#include <carom/contact/detection/contacts_of_two.h>
#include <carom/contact/detection/corner_meeting.h>
#include <carom/contact/detection/gap_discs.h>
#include <carom/contact/detection/narrow_phase.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <span>

namespace carom {

namespace {

constexpr double any_gap = std::numeric_limits<double>::infinity();

/// Outlines of the contacts of the step before. Mostly those contacts are the same as in the step before
/// that.
void look_up_lasting(const Outlines& outlines, std::span<const ConstraintKey> keys,
                     BodyContactSearch& memory) {
  const std::vector<BodyOutline>& list = outlines.of_bodies().list();
  if (std::equal(memory.lasting.begin(), memory.lasting.end(), keys.begin(), keys.end())) return;
  memory.lasting.assign(keys.begin(), keys.end());
  memory.pairs_of_lasting.clear();
  for (const ConstraintKey& key : keys) {
    if (key.b.owner == FeatureKey::Owner::obstacle) continue;
    const std::optional<ContactPair> pair = outlines.pair_of(key);
    if (!pair) continue;
    Index a = outlines.outline_of(pair->feature), b = pair->outline;
    if (list[b].key < list[a].key) std::swap(a, b);
    memory.pairs_of_lasting.emplace_back(a, b);
  }
}

/// Vertices and bodies of all outlines where they are.
void place(const BodyOutlines& outlines, const BodySlots& bodies, const ContactQuery& query,
           BodyContactSearch& memory) {
  const std::vector<BodyOutline>& list = outlines.list();
  memory.placed.resize(outlines.vertices().size());
  memory.sides.resize(list.size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (!query.bodies.has(list[i].body)) continue;
    const BodySlot slot = bodies[list[i].body];
    outlines.place(list[i], slot, query.state, query.evaluation,
                   memory.placed.data() + list[i].vertices.begin);
    const double* const centre = query.state.q + slot.q;
    memory.sides[i] = {list[i].body, slot.v, static_cast<int>(slot.v_size), {centre[0], centre[1]}};
  }
}

/// Pairs that touched in the step before and whose boxes do not overlap any more.
void add_lasting_pairs(const Outlines& outlines, const ContactQuery& query, BodyContactSearch& memory) {
  const std::vector<BodyOutline>& list = outlines.of_bodies().list();
  auto& pairs = memory.pairs;
  const std::size_t known = pairs.size();
  look_up_lasting(outlines, query.lasting->keys(), memory);
  for (const std::pair<Index, Index>& pair : memory.pairs_of_lasting) {
    if (!query.bodies.has(list[pair.first].body) || !query.bodies.has(list[pair.second].body)) continue;
    if (are_within(memory.boxes[pair.first], memory.boxes[pair.second], query.margin)) continue;
    if (outlines.laws().may_touch(list[pair.first], list[pair.second])) pairs.push_back(pair);
  }
  if (pairs.size() == known) return;
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

/// Pairs of outlines, that of the lesser key first: those whose boxes overlap, and those that touched in the
/// step before.
void collect_pairs(const Outlines& outlines, const ContactQuery& query, BodyContactSearch& memory) {
  const std::vector<BodyOutline>& list = outlines.of_bodies().list();
  auto& pairs = memory.pairs;
  pairs.clear();
  // Boxes of bodies that are not chosen stay where they were.
  memory.boxes.resize(list.size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (!query.bodies.has(list[i].body)) continue;
    memory.boxes[i] = box_around(placed_outline(list[i], memory).vertices, list[i].radius);
  }
  if (memory.broad.size() != list.size()) {
    std::vector<Index> owners;
    owners.reserve(list.size());
    for (const BodyOutline& outline : list) owners.push_back(outline.body);
    memory.broad.reset(owners);
  }
  const auto add = [&](Index i, Index j) {
    if (!query.bodies.has(list[i].body) || !query.bodies.has(list[j].body)) return;
    if (!outlines.laws().all_bodies_may_touch() && !outlines.laws().may_touch(list[i], list[j])) return;
    if (outlines.of_bodies().are_in_order_of_keys() ? j < i : list[j].key < list[i].key) std::swap(i, j);
    pairs.emplace_back(i, j);
  };
  const std::span<const BoxPair> near = memory.broad.update(memory.boxes, query.margin);
  pairs.reserve(near.size());
  for (const BoxPair& pair : near) add(pair.first, pair.second);
  if (!std::is_sorted(pairs.begin(), pairs.end())) std::sort(pairs.begin(), pairs.end());
  if (query.lasting != nullptr) add_lasting_pairs(outlines, query, memory);
}

/// Adds the contacts of two outlines.
void add(const Outlines& outlines, Index i, Index j, const ContactQuery& query, BodyContactSearch& memory) {
  const std::vector<BodyOutline>& list = outlines.of_bodies().list();
  const double margin = query.lasting == nullptr ? query.margin : any_gap;
  const ConvexOutline of_a = placed_outline(list[i], memory), of_b = placed_outline(list[j], memory);
  const auto add_if_any = [&](const GapPoint& gap, bool of_corners) {
    const bool touches = gap.gap <= query.margin, is_apart = gap.gap > query.margin;
    if (!touches && !is_apart) return false;  // no number
    Touch& touch = memory.touching.emplace_back(Touch{i, j, gap, 0.0, of_corners});
    if (touches || outlines.lasts(touch, query, memory.trial)) return true;
    memory.touching.pop_back();
    return false;
  };
  std::array<GapPoint, 2> found;
  // Of discs there are most: their entry is called as it is.
  const bool are_discs = of_a.size() == 1 && of_b.size() == 1;
  const int count = are_discs ? GapDiscs::find(PlacedOutline(of_a), PlacedOutline(of_b), margin, found)
                              : find_gaps(of_a, of_b, margin, found);
  if (of_a.radius + of_b.radius > 0.0) {  // round: no corners meet
    for (int k = 0; k < count; ++k) add_if_any(found[static_cast<std::size_t>(k)], false);
    return;
  }
  if (count == 0) return;
  const double same_place = outlines.on_ground().lengths().corner;
  const auto corners_near = [&](const GapPoint& gap) -> std::optional<CornerMeeting> {
    if (!is_near_corner(gap, same_place)) return {};
    return meeting_of_bodies(outlines, {i, j, gap}, query, memory);
  };
  const auto have_one_name = [&](const GapPoint& one, const GapPoint& other) {
    return outlines.key_of(i, j, one) == outlines.key_of(i, j, other);
  };
  const auto add_one = [&](const GapPoint& gap, bool of_corners, TwoOutlines::Adds adds) {
    if (adds == TwoOutlines::Adds::if_it_touches) return add_if_any(gap, of_corners);
    memory.touching.push_back({i, j, gap, 0.0, of_corners});
    return true;
  };
  list_contacts({found.data(), static_cast<std::size_t>(count)},
                {corners_near, have_one_name, add_one, same_place});
}

}  // namespace

std::span<const Touch> find_body_touches(const Outlines& outlines, const ContactQuery& query,
                                         BodyContactSearch& memory) {
  memory.touching.clear();
  if (!outlines.bodies_touch()) return {};
  place(outlines.of_bodies(), outlines.slots(), query, memory);
  collect_pairs(outlines, query, memory);
  for (const auto& [i, j] : memory.pairs) add(outlines, i, j, query, memory);
  return memory.touching;
}

void write_rows(const Outlines& outlines, const Touch& touch, const BodyContactSearch& memory,
                const StateView& state, Constraint& out) {
  out.start_contact();
  out.key = outlines.key_of(touch.a, touch.b, touch.gap);
  out.law = outlines.law(touch.a, touch.b);
  out.friction = out.law.friction;
  fill_rows(memory.sides[touch.a], memory.sides[touch.b], touch.gap, out);
  if (out.law.has_static_friction()) out.friction = out.law.friction_at(out.sliding_speed(state.v));
  out.allowed_approach = touch.allowed_approach;
}

}  // namespace carom

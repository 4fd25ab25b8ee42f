// Problem: which bodies touch each other, where, and by which law.

#include <carom/contact/detection/body_contacts.h>
#include <carom/contact/detection/contacts_of_two.h>
#include <carom/contact/detection/corner_meeting.h>
#include <carom/contact/detection/feature_margin.h>
#include <carom/contact/detection/touching_kinds.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace carom {

namespace {

constexpr double any_gap = std::numeric_limits<double>::infinity();

/// Materials of shapes of bodies, and of particles that touch.
std::vector<MaterialId> materials_of_bodies(const System& system) {
  std::vector<MaterialId> all;
  const auto add = [&](MaterialId material) {
    if (std::find(all.begin(), all.end(), material) == all.end()) all.push_back(material);
  };
  for (const auto& entry : system.shape_kinds().entries()) {
    for (Index slot = 0; slot < entry.serials.size(); ++slot) add(entry.kind->material(slot));
  }
  if (all.empty()) return all;  // points do not touch points
  for (const auto& entry : system.body_kinds().entries()) {
    for (Index slot = 0; slot < entry.serials.size(); ++slot) {
      if (entry.kind->has_contact_point(slot)) add(entry.kind->material(slot));
    }
  }
  return all;
}

bool has_law_between_bodies(const System& system) {
  const std::vector<MaterialId> materials = materials_of_bodies(system);
  for (const MaterialId a : materials) {
    for (const MaterialId b : materials) {
      if (system.law(a, b)) return true;
    }
  }
  return false;
}

/// Outlines of the contacts of the step before. Mostly those contacts are the same as in the step before
/// that.
void look_up_lasting(const BodyOutlines& outlines, std::span<const ConstraintKey> keys,
                     BodyContactSearch& memory) {
  if (std::equal(memory.lasting.begin(), memory.lasting.end(), keys.begin(), keys.end())) return;
  memory.lasting.assign(keys.begin(), keys.end());
  memory.pairs_of_lasting.clear();
  for (const ConstraintKey& key : keys) {
    const std::optional<ContactPair> pair = outlines.pair_of(key);
    if (!pair) continue;
    Index a = outlines.outline_of(pair->feature), b = pair->outline;
    if (outlines.list()[b].key < outlines.list()[a].key) std::swap(a, b);
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
    const BodySlot slot = bodies[list[i].body];
    outlines.place(list[i], slot, query.state, query.evaluation,
                   memory.placed.data() + list[i].vertices.begin);
    const double* const centre = query.state.q + slot.q;
    memory.sides[i] = {list[i].body, slot.v, static_cast<int>(slot.v_size), {centre[0], centre[1]}};
  }
}

/// Writes which contact it is, and its law.
void name_contact(const ConstraintKey& key, const Surface& law, Constraint& out) {
  out.key = key;
  out.law = law;
  out.friction = law.friction;
}

/// Laws of all pairs of materials, row-major.
std::vector<std::optional<Surface>> laws_between(const std::vector<MaterialId>& materials,
                                                 const System& system) {
  std::vector<std::optional<Surface>> laws;
  for (const MaterialId a : materials) {
    for (const MaterialId b : materials) laws.push_back(system.law(a, b));
  }
  return laws;
}

}  // namespace

BodyContacts::BodyContacts(const Assembly& assembly, const FeatureLengths& lengths)
    : assembly_(&assembly), lengths_(lengths) {
  if (assembly.layout()->dimension() != 2 || !has_law_between_bodies(assembly.system())) return;
  outlines_ = BodyOutlines(assembly);
  laws_ = laws_between(outlines_.materials(), assembly.system());
  filter_ = PairFilter(assembly);
  const std::vector<BodyOutline>& list = outlines_.list();
  const auto by_kind = [this](const BodyOutline& a, const BodyOutline& b) { return kinds_may_touch(a, b); };
  const TouchingKinds kinds = touching_kinds(list, filter_, by_kind);
  if (!kinds.any) {
    outlines_ = BodyOutlines();
    return;
  }
  needs_rotations_ = outlines_.any_off_centre();
  all_may_touch_ = kinds.all;
  in_order_of_keys_ = std::is_sorted(list.begin(), list.end(),
                                     [](const auto& one, const auto& other) { return one.key < other.key; });
  for (const std::optional<Surface>& law : laws_) {
    if (law) law_facts_.add(*law);
  }
}

const Surface* BodyContacts::law(const BodyOutline& a, const BodyOutline& b) const {
  const std::optional<Surface>& found = laws_[a.material * outlines_.materials().size() + b.material];
  return found ? &*found : nullptr;
}

/// Whether outlines like these may touch, whose ever they are.
bool BodyContacts::kinds_may_touch(const BodyOutline& a, const BodyOutline& b) const {
  return law(a, b) != nullptr && !(a.is_point() && b.is_point()) && carom::may_touch(a.filter, b.filter);
}

bool BodyContacts::may_touch(const BodyOutline& a, const BodyOutline& b) const {
  return kinds_may_touch(a, b) && a.body != b.body && !filter_.is_excluded(a.body, b.body);
}

/// Pairs of outlines, that of the lesser key first: those whose boxes overlap, and those that touched in the
/// step before.
void BodyContacts::collect_pairs(const ContactQuery& query, BodyContactSearch& memory) const {
  const std::vector<BodyOutline>& list = outlines_.list();
  auto& pairs = memory.pairs;
  pairs.clear();
  memory.boxes.clear();
  for (const BodyOutline& outline : list) {
    memory.boxes.push_back(box_around(placed_outline(outline, memory).vertices, outline.radius));
  }
  if (memory.broad.size() != list.size()) {
    std::vector<Index> owners;
    owners.reserve(list.size());
    for (const BodyOutline& outline : list) owners.push_back(outline.body);
    memory.broad.reset(owners);
  }
  const auto add = [&](Index i, Index j) {
    if (!all_may_touch_ && !may_touch(list[i], list[j])) return;
    if (in_order_of_keys_ ? j < i : list[j].key < list[i].key) std::swap(i, j);
    pairs.emplace_back(i, j);
  };
  const std::span<const BoxPair> near = memory.broad.update(memory.boxes, query.margin);
  pairs.reserve(near.size());
  for (const BoxPair& pair : near) add(pair.first, pair.second);
  if (!std::is_sorted(pairs.begin(), pairs.end())) std::sort(pairs.begin(), pairs.end());
  if (query.lasting != nullptr) add_lasting_pairs(query, memory);
}

/// Pairs that touched in the step before and whose boxes do not overlap any more.
void BodyContacts::add_lasting_pairs(const ContactQuery& query, BodyContactSearch& memory) const {
  auto& pairs = memory.pairs;
  const std::size_t known = pairs.size();
  look_up_lasting(outlines_, query.lasting->keys(), memory);
  for (const std::pair<Index, Index>& pair : memory.pairs_of_lasting) {
    if (are_within(memory.boxes[pair.first], memory.boxes[pair.second], query.margin)) continue;
    if (may_touch(outlines_.list()[pair.first], outlines_.list()[pair.second])) pairs.push_back(pair);
  }
  if (pairs.size() == known) return;
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

std::span<const BodyTouch> BodyContacts::find_touching(const ContactQuery& query,
                                                       BodyContactSearch& memory) const {
  memory.touching.clear();
  if (empty()) return {};
  place(outlines_, assembly_->layout()->bodies(), query, memory);
  collect_pairs(query, memory);
  for (const auto& [i, j] : memory.pairs) add(i, j, query, memory);
  return memory.touching;
}

void BodyContacts::find(const ContactQuery& query, BodyContactSearch& memory, ConstraintSet& out) const {
  for (const BodyTouch& touch : find_touching(query, memory)) write(touch, query.state, out.add_contact());
}

/// Adds the contacts of two outlines.
void BodyContacts::add(Index i, Index j, const ContactQuery& query, BodyContactSearch& memory) const {
  const BodyOutline &a = outlines_.list()[i], &b = outlines_.list()[j];
  const double margin = query.lasting == nullptr ? query.margin : any_gap;
  const ConvexOutline of_a = placed_outline(a, memory), of_b = placed_outline(b, memory);
  const auto add_if_any = [&](const BodyTouch& touch) {
    const std::size_t before = memory.touching.size();
    if (touch.gap.gap <= query.margin) memory.touching.push_back(touch);
    if (touch.gap.gap > query.margin && query.lasting != nullptr &&
        query.lasting->contains(key_of(a, b, touch.gap)))
      add_lasting({i, j, touch.gap, touch.gap.gap / query.lasting->step(), touch.of_corners}, query, memory);
    return memory.touching.size() > before;
  };
  if (of_a.size() == 1 && of_b.size() == 1 && margin == any_gap) {
    return static_cast<void>(add_if_any({i, j, gap_of_vertices(of_a, 0, of_b, 0), 0.0}));
  }
  std::array<GapPoint, 2> found;
  const int count = find_gaps(of_a, of_b, margin, found);
  if (count == 0) return;
  const auto corners_near = [&](const GapPoint& gap) -> std::optional<CornerMeeting> {
    if (of_a.radius + of_b.radius > 0.0 || !is_near_corner(gap, lengths_.corner)) return {};
    return meeting_near({i, j, gap}, query, memory);
  };
  const auto have_one_name = [&](const GapPoint& one, const GapPoint& other) {
    return key_of(a, b, one) == key_of(a, b, other);
  };
  const auto add_one = [&](const GapPoint& gap, bool of_corners, TwoOutlines::Adds adds) {
    const BodyTouch touch{i, j, gap, 0.0, of_corners};
    if (adds == TwoOutlines::Adds::if_it_touches) return add_if_any(touch);
    memory.touching.push_back(touch);
    return true;
  };
  list_contacts({found.data(), static_cast<std::size_t>(count)},
                {corners_near, have_one_name, add_one, lengths_.corner});
}

/// Adds a contact of the step before that is a little open, where turning explains that.
void BodyContacts::add_lasting(BodyTouch touch, const ContactQuery& query, BodyContactSearch& memory) const {
  Constraint& contact = memory.trial;
  contact.start_contact();
  write(touch, query.state, contact);
  if (query.lasting->lasts(contact.key, touch.gap.gap, std::abs(contact.drift[0]), touch.of_corners)) {
    memory.touching.push_back(touch);
  }
}

void BodyContacts::write(const BodyTouch& touch, const StateView& state, Constraint& out) const {
  const BodyOutline &a = outlines_.list()[touch.a], &b = outlines_.list()[touch.b];
  fill(key_of(a, b, touch.gap), a, b, touch.gap, state, out);
  out.allowed_approach = touch.allowed_approach;
}

void BodyContacts::write_rows(const BodyTouch& touch, const BodyContactSearch& memory, const StateView& state,
                              Constraint& out) const {
  const BodyOutline &a = outlines_.list()[touch.a], &b = outlines_.list()[touch.b];
  const ConstraintKey key = key_of(a, b, touch.gap);
  out.start_contact();
  name_contact(key, *law(a, b), out);
  fill_rows(memory.sides[touch.a], memory.sides[touch.b], touch.gap, out);
  if (out.law.has_static_friction()) out.friction = out.law.friction_at(out.sliding_speed(state.v));
  out.allowed_approach = touch.allowed_approach;
}

void BodyContacts::fill(const ConstraintKey& key, const BodyOutline& a, const BodyOutline& b,
                        const GapPoint& gap, const StateView& state, Constraint& out) const {
  const BodySlots& bodies = assembly_->layout()->bodies();
  name_contact(key, *law(a, b), out);
  fill_pair_rows(PairSide::of_body(bodies[a.body], a.body, a.radius, state),
                 PairSide::of_body(bodies[b.body], b.body, b.radius, state), gap, out);
  if (out.law.has_static_friction()) out.friction = out.law.friction_at(out.sliding_speed(state.v));
}

PairSides BodyContacts::sides(const ContactPair& pair, const StateView& state,
                              const Evaluation& evaluation) const {
  const BodySlots& bodies = assembly_->layout()->bodies();
  const BodyOutline &a = outlines_.list()[outlines_.outline_of(pair.feature)],
                    &b = outlines_.list()[pair.outline];
  return {.at = outline_pair(pair, state, evaluation),
          .of_vertex = PairSide::of_body(bodies[a.body], a.body, a.radius, state),
          .of_outline = PairSide::of_body(bodies[b.body], b.body, b.radius, state),
          .vertex = a.vertex(pair.feature - a.vertices.begin),
          .surface = b.surface(),
          .law = law(a, b),
          .vertex_is_first = !(b.key < a.key)};
}

}  // namespace carom

#include <carom/core/nearest_name.h>
#include <carom/core/stored_parts.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <utility>

namespace carom {

namespace {

Index next_token() {
  // The one global: tells systems apart so that a foreign identity is refused. No result depends on it.
  static std::atomic<Index> counter{1};
  return counter.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace

System::System() : token_(next_token()) {}
// Here, so that programs do not compile them: they copy and destroy all kinds of parts.
System::System(const System& other)
    : token_(other.token_),
      dimension_(other.dimension_),
      stored_(other.stored_.get() == nullptr ? nullptr : new Stored(*other.stored_)) {}
System::System(System&& other) noexcept = default;
System& System::operator=(const System& other) {
  System copy(other);
  *this = std::move(copy);
  return *this;
}
System& System::operator=(System&& other) noexcept = default;
System::~System() = default;

const System::Stored& System::stored() const {
  static const Stored nothing;
  return stored_.get() == nullptr ? nothing : *stored_;
}
System::Stored& System::stored() {
  if (stored_.get() == nullptr) stored_ = Owner<Stored>(new Stored);
  return *stored_;
}

const Registry<BodyKind>& System::body_kinds() const { return stored().bodies; }
const Registry<ForceKind>& System::force_kinds() const { return stored().forces; }
const Registry<JointKind>& System::joint_kinds() const { return stored().joints; }
const Registry<ShapeKind>& System::shape_kinds() const { return stored().shapes; }
const Registry<GroundShapeKind>& System::ground_shape_kinds() const { return stored().ground_shapes; }

std::vector<ContactDecision> System::contact_decisions() const {
  std::vector<ContactDecision> all;
  for (const auto& [pair, allowed] : stored().contact_decisions)
    all.push_back({{pair.first, token_}, {pair.second, token_}, allowed});
  return all;
}

template <class Identity, class K>
std::vector<Identity> System::identities(const Registry<K>& registry) const {
  std::vector<Identity> all;
  for (const Index serial : registry.serials()) all.push_back({serial, token_});
  return all;
}

std::vector<BodyId> System::bodies() const { return identities<BodyId>(stored().bodies); }
std::vector<ElementId> System::elements() const { return identities<ElementId>(stored().forces); }
std::vector<JointId> System::joints() const { return identities<JointId>(stored().joints); }
std::vector<ShapeId> System::shapes() const { return identities<ShapeId>(stored().shapes); }
std::vector<ObstacleId> System::obstacles() const { return identities<ObstacleId>(stored().ground_shapes); }

template <class Identity, class K>
std::string System::name_in(Role role, const Registry<K>& registry, Identity id) const {
  if (!id.valid()) return "part that was never given";
  if (id.token != token_) return "part of another system";
  const K* const kind = registry.kind_ever(id.serial);
  if (kind == nullptr) return "part that was never given";
  const auto names = stored().names.find(role);
  std::string given;
  if (names != stored().names.end()) {
    if (const auto found = names->second.find(id.serial); found != names->second.end()) given = found->second;
  }
  return describe(kind->label(), given, id.serial);
}

std::string System::name(BodyId id) const {
  return id == ground ? "ground" : name_in(Role::body, stored().bodies, id);
}
std::string System::name(ElementId id) const { return name_in(Role::force, stored().forces, id); }
std::string System::name(JointId id) const { return name_in(Role::joint, stored().joints, id); }
std::string System::name(ShapeId id) const { return name_in(Role::shape, stored().shapes, id); }
std::string System::name(ObstacleId id) const { return name_in(Role::obstacle, stored().ground_shapes, id); }

std::string System::given_name(BodyId id) const {
  if (id == ground) return {};
  if (id.token != token_ || stored().bodies.kind_ever(id.serial) == nullptr) {
    PartCheck("name of a body", *this).body(id, "body", false);
  }
  const auto names = stored().names.find(Role::body);
  if (names == stored().names.end()) return {};
  const auto found = names->second.find(id.serial);
  return found == names->second.end() ? std::string{} : found->second;
}

Index System::by_name(Role role, std::string_view name, std::string_view what) const {
  std::vector<std::string_view> known;
  if (const auto names = stored().serials_by_name.find(role); names != stored().serials_by_name.end()) {
    if (const auto found = names->second.find(name); found != names->second.end()) return found->second;
    for (const auto& [text, serial] : names->second) known.push_back(text);
  }
  refuse_name(what, name, known);
}

BodyId System::body(std::string_view name) const { return {by_name(Role::body, name, "body"), token_}; }
ElementId System::element(std::string_view name) const {
  return {by_name(Role::force, name, "element"), token_};
}
JointId System::joint(std::string_view name) const { return {by_name(Role::joint, name, "joint"), token_}; }
ShapeId System::shape(std::string_view name) const { return {by_name(Role::shape, name, "shape"), token_}; }
ObstacleId System::obstacle(std::string_view name) const {
  return {by_name(Role::obstacle, name, "obstacle"), token_};
}

bool System::has_orientation(BodyId id) const {
  PartCheck("orientation of a body", *this).body(id, "body", true);
  return id != ground && stored().bodies.kind_of(id.serial).has_orientation();
}

bool System::contains(BodyId id) const { return id.token == token_ && stored().bodies.contains(id.serial); }
bool System::contains(ElementId id) const {
  return id.token == token_ && stored().forces.contains(id.serial);
}
bool System::contains(JointId id) const { return id.token == token_ && stored().joints.contains(id.serial); }
bool System::contains(ShapeId id) const { return id.token == token_ && stored().shapes.contains(id.serial); }
bool System::contains(ObstacleId id) const {
  return id.token == token_ && stored().ground_shapes.contains(id.serial);
}
bool System::contains(MaterialId id) const {
  return id.token == token_ && id.serial < stored().surfaces.size();
}

BodyId System::body_of(ShapeId shape) const {
  if (shape.token == token_) {
    if (const auto place = stored().shapes.place(shape.serial); place.slot != none)
      return stored().shapes.entries()[place.entry].kind->body(place.slot);
    if (const auto found = stored().former_carriers.find(shape.serial);
        found != stored().former_carriers.end())
      return found->second;
  }
  throw ModelError("body of a shape: shape is " + name(shape) + "; allowed: a shape of this system");
}

template <class Identity, class K>
void System::remove_from(Role role, Registry<K>& registry, Identity id, std::string_view what) {
  if (id.token != token_ || !registry.contains(id.serial)) {
    const std::string number = id.valid() ? " #" + std::to_string(id.serial) : " that was never given";
    throw ModelError("removal of " + std::string(what) + number +
                     ": it is not in this system; allowed: a part of this system");
  }
  registry.remove(id.serial);
  // The part keeps its name in messages; another one may take it.
  if (const auto found = stored().names[role].find(id.serial); found != stored().names[role].end()) {
    stored().serials_by_name[role].erase(found->second);
  }
}

void System::remove(BodyId id) {
  if (id == ground) throw ModelError("ground: cannot be removed; allowed: a body of this system");
  std::vector<BodyId> ends;
  for (const auto& entry : stored().forces.entries()) {
    for (Index slot = 0; slot < entry.serials.size(); ++slot) {
      ends.clear();
      entry.kind->ends(slot, ends);
      if (std::find(ends.begin(), ends.end(), id) == ends.end()) continue;
      throw ModelError(name(id) + ": cannot be removed, " + name(ElementId{entry.serials[slot], token_}) +
                       " acts on it; allowed: a body without force elements");
    }
  }
  for (const auto& entry : stored().joints.entries()) {
    for (Index slot = 0; slot < entry.serials.size(); ++slot) {
      ends.clear();
      entry.kind->ends(slot, ends);
      if (std::find(ends.begin(), ends.end(), id) == ends.end()) continue;
      throw ModelError(name(id) + ": cannot be removed, " + name(JointId{entry.serials[slot], token_}) +
                       " binds it; allowed: a body without joints");
    }
  }
  for (const auto& entry : stored().shapes.entries()) {
    for (Index slot = 0; slot < entry.serials.size(); ++slot) {
      if (entry.kind->body(slot) != id) continue;
      throw ModelError(name(id) + ": cannot be removed, " + name(ShapeId{entry.serials[slot], token_}) +
                       " is fixed to it; allowed: a body without shapes");
    }
  }
  remove_from(Role::body, stored().bodies, id, "body");
  stored().kept.erase(id.serial);
  std::erase_if(stored().contact_decisions, [&](const auto& decision) {
    return decision.first.first == id.serial || decision.first.second == id.serial;
  });
}
void System::remove(ElementId id) { remove_from(Role::force, stored().forces, id, "element"); }
void System::remove(JointId id) {
  const auto refuse = [&](const std::string& by) {
    throw ModelError(name(id) + ": cannot be removed, " + by +
                     " acts on its coordinate; allowed: a joint without drivers, motors and stops");
  };
  for (const auto& entry : stored().forces.entries()) {
    for (Index slot = 0; slot < entry.serials.size(); ++slot) {
      if (id.valid() && entry.kind->on_joint(slot) == id)
        refuse(name(ElementId{entry.serials[slot], token_}));
    }
  }
  for (const auto& entry : stored().joints.entries()) {
    for (Index slot = 0; slot < entry.serials.size(); ++slot) {
      if (id.valid() && entry.kind->on_joint(slot) == id) refuse(name(JointId{entry.serials[slot], token_}));
    }
  }
  remove_from(Role::joint, stored().joints, id, "joint");
}
void System::remove(ShapeId id) {
  const BodyId carrier = contains(id) ? body_of(id) : BodyId{};
  remove_from(Role::shape, stored().shapes, id, "shape");
  stored().former_carriers.emplace(id.serial, carrier);
}
void System::remove(ObstacleId id) {
  remove_from(Role::obstacle, stored().ground_shapes, id, "obstacle");
  stored().surfaces.remove_own(id.serial);
}

void System::keep_place(BodyId body, bool keep) {
  PartCheck("place to keep", *this).body(body, "body", false);
  if (keep) {
    stored().kept.insert(body.serial);
  } else {
    stored().kept.erase(body.serial);
  }
}

bool System::keeps_place(BodyId body) const {
  PartCheck("place to keep", *this).body(body, "body", false);
  return stored().kept.contains(body.serial);
}

void System::close_joints(bool however_far) { stored().closes_joints = however_far; }

bool System::closes_joints() const { return stored().closes_joints; }

std::pair<Index, Index> System::two_bodies(BodyId a, BodyId b) const {
  const PartCheck check("contact of two bodies", *this);
  for (const BodyId body : {a, b}) check.body(body, "body", false);
  if (a == b) check.refuse("second body", name(b) + ", the first", "another body");
  return std::minmax(a.serial, b.serial);
}

void System::allow_contact(BodyId a, BodyId b, std::optional<bool> allowed) {
  const std::pair<Index, Index> pair = two_bodies(a, b);
  if (allowed) {
    stored().contact_decisions.insert_or_assign(pair, *allowed);
  } else {
    stored().contact_decisions.erase(pair);
  }
}

std::optional<bool> System::is_contact_allowed(BodyId a, BodyId b) const {
  const auto found = stored().contact_decisions.find(two_bodies(a, b));
  return found == stored().contact_decisions.end() ? std::nullopt : std::optional(found->second);
}

MaterialId System::material(std::string_view name) {
  if (name.empty()) throw ModelError("material: name is empty; allowed: a name");
  return {stored().surfaces.material(name), token_};
}

void System::between(MaterialId a, MaterialId b, const Surface& surface) {
  for (const MaterialId id : {a, b}) {
    if (!contains(id)) throw ModelError("surface: material is unknown; allowed: a material of this system");
  }
  PartCheck("surface between '" + stored().surfaces.name(a.serial) + "' and '" +
                stored().surfaces.name(b.serial) + "'",
            *this)
      .surface(surface);
  stored().surfaces.set(a.serial, b.serial, surface);
}

void System::set_default_law(const Surface& surface) {
  PartCheck("default law of contact", *this).surface(surface);
  stored().surfaces.set_default(surface);
}

std::optional<Surface> System::find_law(const ContactSide& a, const ContactSide& b) const {
  const Surface* const found = stored().surfaces.find(a, b);
  return found == nullptr ? std::nullopt : std::optional(*found);
}

std::optional<Surface> System::law(MaterialId a, MaterialId b) const {
  for (const MaterialId id : {a, b}) PartCheck("law of contact", *this).material(id);
  return find_law({.material = a.serial}, {.material = b.serial});
}

std::optional<Surface> System::law(MaterialId a, ObstacleId obstacle) const {
  if (!contains(obstacle))
    throw ModelError("law of contact: obstacle is " + refused_name(*this, obstacle) +
                     "; allowed: one of this system");
  PartCheck("law of contact", *this).material(a);
  const auto place = stored().ground_shapes.place(obstacle.serial);
  const MaterialId b = stored().ground_shapes.entries()[place.entry].kind->material(place.slot);
  return find_law({.material = a.serial}, {.material = b.serial, .own = obstacle.serial});
}

std::uint64_t System::fingerprint() const {
  Fingerprint print;
  print.add(static_cast<std::uint64_t>(dimension_));
  // Data that came later, here filters and decisions, count where they are not the default only: fingerprints
  // of models without them stay.
  const auto add_filters = [&print](const auto& entry) {
    for (Index slot = 0; slot < entry.serials.size(); ++slot) {
      const ContactFilter filter = entry.kind->filter(slot);
      if (filter == ContactFilter{}) continue;
      print.add("filter");
      for (const Index number : {slot, filter.groups, filter.touches}) print.add(std::uint64_t{number});
    }
  };
  const auto add_kinds = [&print](const auto& registry, const auto& add_more) {
    for (const auto& entry : registry.entries()) {
      if (entry.serials.empty()) continue;  // all its parts were removed
      print.add(entry.kind->label());
      print.add(std::uint64_t{entry.serials.size()});
      for (Index slot = 0; slot < entry.serials.size(); ++slot) {
        print.add(std::uint64_t{entry.serials[slot]});
      }
      entry.kind->fingerprint(print);
      add_more(entry);
    }
  };
  const auto nothing_more = [](const auto&) {};
  add_kinds(stored().bodies, add_filters);
  add_kinds(stored().forces, nothing_more);
  add_kinds(stored().joints, nothing_more);
  add_kinds(stored().shapes, add_filters);
  add_kinds(stored().ground_shapes, add_filters);
  stored().surfaces.fingerprint(print);
  if (!stored().contact_decisions.empty()) print.add("contacts of two bodies");
  for (const auto& [pair, allowed] : stored().contact_decisions) {
    for (const Index number : {pair.first, pair.second, Index{allowed}}) print.add(std::uint64_t{number});
  }
  return print.value();
}

}  // namespace carom

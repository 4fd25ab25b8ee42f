#include <carom/core/system_notes.h>

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
      bodies_(other.bodies_),
      forces_(other.forces_),
      joints_(other.joints_),
      shapes_(other.shapes_),
      ground_shapes_(other.ground_shapes_),
      notes_(other.notes_ ? std::make_unique<Notes>(*other.notes_) : nullptr) {}
System::System(System&& other) noexcept = default;
System& System::operator=(const System& other) {
  System copy(other);
  *this = std::move(copy);
  return *this;
}
System& System::operator=(System&& other) noexcept = default;
System::~System() = default;

const System::Notes& System::notes() const {
  static const Notes nothing;
  return notes_ ? *notes_ : nothing;
}
System::Notes& System::notes() {
  if (!notes_) notes_ = std::make_unique<Notes>();
  return *notes_;
}

std::vector<ContactDecision> System::contact_decisions() const {
  std::vector<ContactDecision> all;
  for (const auto& [pair, allowed] : notes().contact_decisions)
    all.push_back({{pair.first, token_}, {pair.second, token_}, allowed});
  return all;
}

template <class Identity, class K>
std::vector<Identity> System::identities(const Registry<K>& registry) const {
  std::vector<Identity> all;
  for (const Index serial : registry.serials()) all.push_back({serial, token_});
  return all;
}

std::vector<BodyId> System::bodies() const { return identities<BodyId>(bodies_); }
std::vector<ElementId> System::elements() const { return identities<ElementId>(forces_); }
std::vector<JointId> System::joints() const { return identities<JointId>(joints_); }
std::vector<ShapeId> System::shapes() const { return identities<ShapeId>(shapes_); }
std::vector<ObstacleId> System::obstacles() const { return identities<ObstacleId>(ground_shapes_); }

template <class Identity, class K>
std::string System::name_in(Role role, const Registry<K>& registry, Identity id) const {
  if (!id.valid()) return "part that was never given";
  if (id.token != token_) return "part of another system";
  const K* const kind = registry.kind_ever(id.serial);
  if (kind == nullptr) return "part that was never given";
  const auto names = notes().names.find(role);
  std::string given;
  if (names != notes().names.end()) {
    if (const auto found = names->second.find(id.serial); found != names->second.end()) given = found->second;
  }
  return describe(kind->label(), given, id.serial);
}

std::string System::name(BodyId id) const {
  return id == ground ? "ground" : name_in(Role::body, bodies_, id);
}
std::string System::name(ElementId id) const { return name_in(Role::force, forces_, id); }
std::string System::name(JointId id) const { return name_in(Role::joint, joints_, id); }
std::string System::name(ShapeId id) const { return name_in(Role::shape, shapes_, id); }
std::string System::name(ObstacleId id) const { return name_in(Role::obstacle, ground_shapes_, id); }

std::string System::given_name(BodyId id) const {
  if (id == ground) return {};
  if (id.token != token_ || bodies_.kind_ever(id.serial) == nullptr) {
    PartCheck("name of a body", *this).body(id, "body", false);
  }
  const auto names = notes().names.find(Role::body);
  if (names == notes().names.end()) return {};
  const auto found = names->second.find(id.serial);
  return found == names->second.end() ? std::string{} : found->second;
}

Index System::by_name(Role role, std::string_view name, std::string_view what) const {
  if (const auto names = notes().serials_by_name.find(role); names != notes().serials_by_name.end()) {
    if (const auto found = names->second.find(name); found != names->second.end()) return found->second;
  }
  throw ModelError(std::string(what) + " '" + std::string(name) +
                   "': there is none; allowed: the name of a " + std::string(what) + " of this system");
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
  return id != ground && bodies_.kind_of(id.serial).has_orientation();
}

bool System::contains(BodyId id) const { return id.token == token_ && bodies_.contains(id.serial); }
bool System::contains(ElementId id) const { return id.token == token_ && forces_.contains(id.serial); }
bool System::contains(JointId id) const { return id.token == token_ && joints_.contains(id.serial); }
bool System::contains(ShapeId id) const { return id.token == token_ && shapes_.contains(id.serial); }
bool System::contains(ObstacleId id) const {
  return id.token == token_ && ground_shapes_.contains(id.serial);
}
bool System::contains(MaterialId id) const {
  return id.token == token_ && id.serial < notes().surfaces.size();
}

BodyId System::body_of(ShapeId shape) const {
  if (shape.token == token_) {
    if (const auto place = shapes_.place(shape.serial); place.slot != none)
      return shapes_.entries()[place.entry].kind->body(place.slot);
    if (const auto found = notes().former_carriers.find(shape.serial); found != notes().former_carriers.end())
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
  if (const auto found = notes().names[role].find(id.serial); found != notes().names[role].end()) {
    notes().serials_by_name[role].erase(found->second);
  }
}

void System::remove(BodyId id) {
  if (id == ground) throw ModelError("ground: cannot be removed; allowed: a body of this system");
  std::vector<BodyId> ends;
  for (const auto& entry : forces_.entries()) {
    for (Index slot = 0; slot < entry.serials.size(); ++slot) {
      ends.clear();
      entry.kind->ends(slot, ends);
      if (std::find(ends.begin(), ends.end(), id) == ends.end()) continue;
      throw ModelError(name(id) + ": cannot be removed, " + name(ElementId{entry.serials[slot], token_}) +
                       " acts on it; allowed: a body without force elements");
    }
  }
  for (const auto& entry : joints_.entries()) {
    for (Index slot = 0; slot < entry.serials.size(); ++slot) {
      ends.clear();
      entry.kind->ends(slot, ends);
      if (std::find(ends.begin(), ends.end(), id) == ends.end()) continue;
      throw ModelError(name(id) + ": cannot be removed, " + name(JointId{entry.serials[slot], token_}) +
                       " binds it; allowed: a body without joints");
    }
  }
  for (const auto& entry : shapes_.entries()) {
    for (Index slot = 0; slot < entry.serials.size(); ++slot) {
      if (entry.kind->body(slot) != id) continue;
      throw ModelError(name(id) + ": cannot be removed, " + name(ShapeId{entry.serials[slot], token_}) +
                       " is fixed to it; allowed: a body without shapes");
    }
  }
  remove_from(Role::body, bodies_, id, "body");
  notes().kept.erase(id.serial);
  std::erase_if(notes().contact_decisions, [&](const auto& decision) {
    return decision.first.first == id.serial || decision.first.second == id.serial;
  });
}
void System::remove(ElementId id) { remove_from(Role::force, forces_, id, "element"); }
void System::remove(JointId id) {
  const auto refuse = [&](const std::string& by) {
    throw ModelError(name(id) + ": cannot be removed, " + by +
                     " acts on its coordinate; allowed: a joint without drivers, motors and stops");
  };
  for (const auto& entry : forces_.entries()) {
    for (Index slot = 0; slot < entry.serials.size(); ++slot) {
      if (id.valid() && entry.kind->on_joint(slot) == id)
        refuse(name(ElementId{entry.serials[slot], token_}));
    }
  }
  for (const auto& entry : joints_.entries()) {
    for (Index slot = 0; slot < entry.serials.size(); ++slot) {
      if (id.valid() && entry.kind->on_joint(slot) == id) refuse(name(JointId{entry.serials[slot], token_}));
    }
  }
  remove_from(Role::joint, joints_, id, "joint");
}
void System::remove(ShapeId id) {
  const BodyId carrier = contains(id) ? body_of(id) : BodyId{};
  remove_from(Role::shape, shapes_, id, "shape");
  notes().former_carriers.emplace(id.serial, carrier);
}
void System::remove(ObstacleId id) {
  remove_from(Role::obstacle, ground_shapes_, id, "obstacle");
  notes().surfaces.remove_own(id.serial);
}

void System::keep_place(BodyId body, bool keep) {
  PartCheck("place to keep", *this).body(body, "body", false);
  if (keep) {
    notes().kept.insert(body.serial);
  } else {
    notes().kept.erase(body.serial);
  }
}

bool System::keeps_place(BodyId body) const {
  PartCheck("place to keep", *this).body(body, "body", false);
  return notes().kept.contains(body.serial);
}

std::pair<Index, Index> System::two_bodies(BodyId a, BodyId b) const {
  const PartCheck check("contact of two bodies", *this);
  for (const BodyId body : {a, b}) check.body(body, "body", false);
  if (a == b) check.refuse("second body", name(b) + ", the first", "another body");
  return std::minmax(a.serial, b.serial);
}

void System::allow_contact(BodyId a, BodyId b, std::optional<bool> allowed) {
  const std::pair<Index, Index> pair = two_bodies(a, b);
  if (allowed) {
    notes().contact_decisions.insert_or_assign(pair, *allowed);
  } else {
    notes().contact_decisions.erase(pair);
  }
}

std::optional<bool> System::is_contact_allowed(BodyId a, BodyId b) const {
  const auto found = notes().contact_decisions.find(two_bodies(a, b));
  return found == notes().contact_decisions.end() ? std::nullopt : std::optional(found->second);
}

MaterialId System::material(std::string_view name) {
  if (name.empty()) throw ModelError("material: name is empty; allowed: a name");
  return {notes().surfaces.material(name), token_};
}

void System::between(MaterialId a, MaterialId b, const Surface& surface) {
  for (const MaterialId id : {a, b}) {
    if (!contains(id)) throw ModelError("surface: material is unknown; allowed: a material of this system");
  }
  PartCheck("surface between '" + notes().surfaces.name(a.serial) + "' and '" +
                notes().surfaces.name(b.serial) + "'",
            *this)
      .surface(surface);
  notes().surfaces.set(a.serial, b.serial, surface);
}

void System::set_default_law(const Surface& surface) {
  PartCheck("default law of contact", *this).surface(surface);
  notes().surfaces.set_default(surface);
}

std::optional<Surface> System::find_law(const ContactSide& a, const ContactSide& b) const {
  const Surface* const found = notes().surfaces.find(a, b);
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
  const auto place = ground_shapes_.place(obstacle.serial);
  const MaterialId b = ground_shapes_.entries()[place.entry].kind->material(place.slot);
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
  add_kinds(bodies_, add_filters);
  add_kinds(forces_, nothing_more);
  add_kinds(joints_, nothing_more);
  add_kinds(shapes_, add_filters);
  add_kinds(ground_shapes_, add_filters);
  notes().surfaces.fingerprint(print);
  if (!notes().contact_decisions.empty()) print.add("contacts of two bodies");
  for (const auto& [pair, allowed] : notes().contact_decisions) {
    for (const Index number : {pair.first, pair.second, Index{allowed}}) print.add(std::uint64_t{number});
  }
  return print.value();
}

}  // namespace carom

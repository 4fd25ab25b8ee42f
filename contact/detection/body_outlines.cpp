#include <carom/contact/detection/body_materials.h>
#include <carom/contact/detection/body_outlines.h>
#include <carom/contact/detection/body_seams.h>
#include <carom/core/described_sets.h>

#include <algorithm>

namespace carom {

namespace {

/// Outlines of all shapes, as these describe them. \param materials body_materials()
std::vector<DescribedOutline> outlines_of_shapes(const Assembly& assembly,
                                                 const std::vector<MaterialId>& materials) {
  const Layout& layout = *assembly.layout();
  const System& system = assembly.system();
  std::vector<Outline> outlines;
  std::vector<RoundedPoint> points;
  std::vector<DescribedOutline> described;
  for (const Index serial : system.shape_kinds().serials()) {
    const auto place = system.shape_kinds().place(serial);
    const ShapeKind& kind = *system.shape_kinds().entries()[place.entry].kind;
    outlines.clear();
    points.clear();
    const PartCheck check(system.name(ShapeId{serial, system.token()}), system);
    kind.rounded_points(place.slot, points);
    check_rounded_points(check, points);
    kind.outlines(place.slot, check, outlines);
    for (const Outline& outline : outlines) check_outline(check, outline);
    check_same_set(check, points, outlines);
    const Index material = number_of(kind.material(place.slot), materials);
    for (const Outline& outline : outlines) {
      BodyOutline of_body;
      of_body.body = layout.index(kind.body(place.slot));
      of_body.key = {FeatureKey::Owner::shape, serial, 0};
      of_body.filter = kind.filter(place.slot);
      of_body.material = material;
      of_body.radius = outline.radius;
      described.push_back({of_body, outline.vertices});
    }
  }
  return described;
}

}  // namespace

BodyOutlines::BodyOutlines(const Assembly& assembly) {
  const Layout& layout = *assembly.layout();
  const System& system = assembly.system();
  const std::vector<MaterialId> materials = body_materials(system);
  for (const auto& entry : system.body_kinds().entries()) {
    for (Index slot = 0; slot < entry.serials.size(); ++slot) {
      if (!entry.kind->has_contact_point(slot)) continue;
      const Index serial = entry.serials[slot];
      const Vec<2> centre = Vec<2>::Zero();
      BodyOutline of_body;
      of_body.body = layout.index(BodyId{serial, system.token()});
      of_body.filter = entry.kind->filter(slot);
      of_body.key = {FeatureKey::Owner::body, serial, 0};
      of_body.material = number_of(entry.kind->material(slot), materials);
      add(of_body, {&centre, 1});
    }
  }
  std::vector<DescribedOutline> described = outlines_of_shapes(assembly, materials);
  draw_seams(assembly, described);
  Index feature = 0;
  for (std::size_t i = 0; i < described.size(); ++i) {
    BodyOutline& of_body = described[i].outline;
    if (i == 0 || of_body.key.serial != described[i - 1].outline.key.serial) feature = 0;
    of_body.key.feature = feature;
    add(of_body, described[i].vertices);
    feature += static_cast<Index>(described[i].vertices.size()) + 1;
  }
  std::stable_sort(list_.begin(), list_.end(),
                   [](const BodyOutline& a, const BodyOutline& b) { return a.body < b.body; });
  in_order_of_keys_ = std::is_sorted(list_.begin(), list_.end(),
                                     [](const auto& one, const auto& other) { return one.key < other.key; });
  outline_of_.resize(vertices_.size());
  for (Index i = 0; i < list_.size(); ++i) {
    const FeatureKey& key = list_[i].key;
    std::vector<Index>& first = key.owner == FeatureKey::Owner::shape ? of_shape_ : of_body_;
    if (first.size() <= key.serial) first.resize(key.serial + 1, none);
    if (key.feature == 0) first[key.serial] = i;
    const Range vertices = list_[i].vertices;
    std::fill(outline_of_.begin() + vertices.begin, outline_of_.begin() + vertices.end, i);
  }
}

void BodyOutlines::add(BodyOutline outline, std::span<const Vec<2>> vertices) {
  outline.vertices.begin = static_cast<Index>(vertices_.size());
  for (const Vec<2>& vertex : vertices) {
    vertices_.push_back(vertex);
    outline.reach = std::max(outline.reach, vertex.norm() + outline.radius);
  }
  outline.vertices.end = static_cast<Index>(vertices_.size());
  list_.push_back(outline);
}

bool BodyOutlines::any_off_centre() const {
  return std::any_of(vertices_.begin(), vertices_.end(),
                     [](const Vec<2>& vertex) { return vertex[0] != 0.0 || vertex[1] != 0.0; });
}

Index BodyOutlines::find(const FeatureKey& key) const {
  const std::vector<Index>& first = key.owner == FeatureKey::Owner::shape ? of_shape_ : of_body_;
  if (key.serial >= first.size()) return none;
  // Outlines of one shape follow one another, in the order of their features.
  for (Index i = first[key.serial]; i < list_.size(); ++i) {
    const FeatureKey& of = list_[i].key;
    if (of.owner != key.owner || of.serial != key.serial) return none;
    if (list_[i].has(key)) return i;
  }
  return none;
}

void BodyOutlines::place(const BodyOutline& outline, const BodySlot& body, const StateView& state,
                         const Evaluation& evaluation, Vec<2>* out) const {
  const Vec<2> centre = Eigen::Map<const Vec<2>>(state.q + body.q);
  for (Index i = outline.vertices.begin; i < outline.vertices.end; ++i, ++out) {
    const Vec<2>& local = vertices_[i];
    const bool turns = body.rotation != none && (local[0] != 0.0 || local[1] != 0.0);
    *out =
        turns ? Vec<2>(centre + Space<2>::rotate(evaluation.rotation.data() + body.rotation, local)) : centre;
  }
}

}  // namespace carom

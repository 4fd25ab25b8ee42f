#include <carom/core/layout.h>

#include <carom/core/errors.h>

#include <algorithm>
#include <string>

namespace carom {

BodySlots::BodySlots(const std::vector<BodySlot>& slots, Index rotation_length)
    : size_(slots.size()), rotation_length_(rotation_length) {
  for (Index body = 0; body < slots.size(); ++body) {
    const BodySlot& slot = slots[body];
    if (!runs_.empty()) {
      const BodySlot next = runs_.back().at(runs_.back().count, rotation_length);
      if (slot.serial == next.serial && slot.q == next.q && slot.v == next.v && slot.q_size == next.q_size &&
          slot.v_size == next.v_size && slot.rotation == next.rotation && slot.kind == next.kind &&
          slot.slot == next.slot) {
        ++runs_.back().count;
        continue;
      }
    }
    by_serial_.push_back(static_cast<Index>(runs_.size()));
    runs_.push_back({body, 1, slot});
  }
  runs_.shrink_to_fit();
  by_serial_.shrink_to_fit();
  std::sort(by_serial_.begin(), by_serial_.end(),
            [this](Index a, Index b) { return runs_[a].first.serial < runs_[b].first.serial; });
}

const BodySlots::Run& BodySlots::run_of(Index body) const {
  return *(std::upper_bound(runs_.begin(), runs_.end(), body,
                            [](Index place, const Run& run) { return place < run.body; }) -
           1);
}

Index BodySlots::find(Index serial) const {
  const auto next = std::upper_bound(by_serial_.begin(), by_serial_.end(), serial,
                                     [this](Index s, Index run) { return s < runs_[run].first.serial; });
  if (next == by_serial_.begin()) return none;
  const Run& run = runs_[*(next - 1)];
  const Index i = serial - run.first.serial;
  return i < run.count ? run.body + i : none;
}

Layout::Layout(int dimension, Index token, const std::vector<BodySlot>& bodies)
    : dimension_(dimension), token_(token), bodies_(bodies, dimension == 2 ? 2 : 9) {
  const Index rotation_length = dimension == 2 ? 2 : 9;
  for (const BodySlot& body : bodies) {
    q_size_ = std::max(q_size_, body.q + body.q_size);
    v_size_ = std::max(v_size_, body.v + body.v_size);
    if (body.rotation != none) rotation_size_ = std::max(rotation_size_, body.rotation + rotation_length);
  }
}

bool Layout::has_places_of(const Layout& other) const {
  const auto is_same = [](const BodySlot& a, const BodySlot& b) {
    return a.serial == b.serial && a.q == b.q && a.v == b.v && a.q_size == b.q_size && a.v_size == b.v_size;
  };
  if (dimension_ != other.dimension_ || bodies_.size() != other.bodies_.size()) return false;
  for (Index body = 0; body < bodies_.size(); ++body) {
    if (!is_same(bodies_[body], other.bodies_[body])) return false;
  }
  return std::equal(internals_.begin(), internals_.end(), other.internals_.begin(), other.internals_.end(),
                    [](const InternalSlot& a, const InternalSlot& b) {
                      return a.serial == b.serial && a.first == b.first && a.size == b.size;
                    });
}

void Layout::place_joints(std::shared_ptr<const JointTable> joints) { joints_ = std::move(joints); }

void Layout::place_internals(std::vector<InternalSlot> internals) {
  internals_ = std::move(internals);
  std::sort(internals_.begin(), internals_.end(),
            [](const InternalSlot& a, const InternalSlot& b) { return a.serial < b.serial; });
  z_size_ = 0;
  for (const InternalSlot& element : internals_) z_size_ += element.size;
}

namespace {

auto find_serial(const std::vector<InternalSlot>& slots, Index serial) {
  return std::lower_bound(slots.begin(), slots.end(), serial,
                          [](const InternalSlot& slot, Index wanted) { return slot.serial < wanted; });
}

}  // namespace

bool Layout::contains(ElementId id) const {
  const auto found = find_serial(internals_, id.serial);
  return id.token == token_ && found != internals_.end() && found->serial == id.serial;
}

const InternalSlot& Layout::internal(ElementId id) const {
  if (contains(id)) return *find_serial(internals_, id.serial);
  throw ModelError("internal variables of element #" + std::to_string(id.serial) +
                   ": it has none in this model; allowed: an element of this model that has some");
}

Index Layout::index(BodyId id) const {
  if (id.token == token_) {
    if (const Index body = bodies_.find(id.serial); body != none) return body;
  }
  if (id == ground) throw ModelError("state of the ground: it has none; allowed: a body of this model");
  if (!id.valid())
    throw ModelError("state of a body: identity was never given; allowed: a body of this model");
  throw ModelError("state of a body: identity #" + std::to_string(id.serial) +
                   " is not in this model; allowed: a body of this model");
}

}  // namespace carom

#include <carom/core/layout.h>

#include <carom/core/errors.h>

#include <algorithm>
#include <string>
#include <utility>

namespace carom {

Layout::Layout(int dimension, Index token, std::vector<BodySlot> bodies, std::vector<InternalSlot> internals)
    : dimension_(dimension), token_(token), bodies_(std::move(bodies)), internals_(std::move(internals)) {
  std::sort(internals_.begin(), internals_.end(),
            [](const InternalSlot& a, const InternalSlot& b) { return a.serial < b.serial; });
  for (const InternalSlot& element : internals_) z_size_ += element.size;
  const Index rotation_length = dimension == 2 ? 2 : 9;
  for (Index i = 0; i < bodies_.size(); ++i) {
    const BodySlot& body = bodies_[i];
    q_size_ = std::max(q_size_, body.q + body.q_size);
    v_size_ = std::max(v_size_, body.v + body.v_size);
    if (body.rotation != none) rotation_size_ = std::max(rotation_size_, body.rotation + rotation_length);
    if (by_serial_.size() <= body.serial) by_serial_.resize(body.serial + 1, none);
    by_serial_[body.serial] = i;
  }
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

bool Layout::contains(BodyId id) const {
  return id.token == token_ && id.serial < by_serial_.size() && by_serial_[id.serial] != none;
}

Index Layout::index(BodyId id) const {
  if (contains(id)) return by_serial_[id.serial];
  if (id == ground) throw ModelError("state of the ground: it has none; allowed: a body of this model");
  if (!id.valid())
    throw ModelError("state of a body: identity was never given; allowed: a body of this model");
  throw ModelError("state of a body: identity #" + std::to_string(id.serial) +
                   " is not in this model; allowed: a body of this model");
}

}  // namespace carom

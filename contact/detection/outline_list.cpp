// Problem: outlines of bodies and on ground in one list.

#include <carom/contact/detection/outline_list.h>

namespace carom {

OutlineList::OutlineList(const Assembly& assembly, const FeatureLengths& lengths, bool between_bodies)
    : assembly_(&assembly), shapes_(assembly.system()), pieces_(assembly.system(), shapes_, lengths) {
  if (assembly.layout()->dimension() != 2) return;
  if (pieces_.size() != 0 || between_bodies) bodies_ = BodyOutlines(assembly);
}

PairSide OutlineList::side(Index outline, const StateView& state, const GroundPlaces& places) const {
  if (is_on_ground(outline)) {
    const Index ground = on_ground(outline);
    return pieces_.side(ground, shapes_.motion(pieces_.outlines()[ground].shape, places));
  }
  const BodyOutline& of = bodies_.list()[outline];
  return PairSide::of_body(slots()[of.body], of.body, of.radius, state);
}

}  // namespace carom

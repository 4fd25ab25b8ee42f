#include <carom/joints/drag.h>

namespace carom::generic {

template <int D>
PartType<ForceKind> Drag<D>::part_type() {
  return PartType<ForceKind>::of<ForceElementKind<Drag>, Drag>();
}

template PartType<ForceKind> Drag<2>::part_type();
template PartType<ForceKind> Drag<3>::part_type();

}  // namespace carom::generic

#include <carom/joints/maxwell.h>

namespace carom::generic {

template <int D>
PartType<ForceKind> MaxwellElement<D>::part_type() {
  return PartType<ForceKind>::of<ForceElementKind<MaxwellElement>, MaxwellElement>();
}

template PartType<ForceKind> MaxwellElement<2>::part_type();
template PartType<ForceKind> MaxwellElement<3>::part_type();

}  // namespace carom::generic

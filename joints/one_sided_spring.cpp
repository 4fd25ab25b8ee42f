#include <carom/joints/one_sided_spring.h>

namespace carom::generic {

template <int D, bool Pulls>
PartType<ForceKind> OneSidedSpring<D, Pulls>::part_type() {
  return PartType<ForceKind>::of<ForceElementKind<OneSidedSpring>, OneSidedSpring>();
}

template PartType<ForceKind> OneSidedSpring<2, true>::part_type();
template PartType<ForceKind> OneSidedSpring<2, false>::part_type();
template PartType<ForceKind> OneSidedSpring<3, true>::part_type();
template PartType<ForceKind> OneSidedSpring<3, false>::part_type();

}  // namespace carom::generic

#include <carom/joints/nonlinear_spring.h>

namespace carom::generic {

template <int D>
PartType<ForceKind> NonlinearSpring<D>::part_type() {
  return PartType<ForceKind>::of<ForceElementKind<NonlinearSpring>, NonlinearSpring>();
}

template PartType<ForceKind> NonlinearSpring<2>::part_type();
template PartType<ForceKind> NonlinearSpring<3>::part_type();

}  // namespace carom::generic

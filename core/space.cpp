#include <carom/core/space.h>

namespace carom {

std::array<Vec<3>, 2> Space<3>::tangent_frame(const Vec<3>& n) {
  int axis = 0;
  n.cwiseAbs().minCoeff(&axis);
  Vec<3> first = Vec<3>::Unit(axis) - n[axis] * n;
  first.normalize();
  return {first, Vec<3>(n[1] * first[2] - n[2] * first[1], n[2] * first[0] - n[0] * first[2],
                        n[0] * first[1] - n[1] * first[0])};
}

}  // namespace carom

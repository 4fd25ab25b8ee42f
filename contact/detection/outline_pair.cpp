#include <carom/contact/detection/outline_pair.h>

#include <algorithm>
#include <cmath>

namespace carom {

std::optional<MeetingCorners> corners_that_meet(OutlinePair& pair) {
  if (!pair.is_sharp() || pair.chain) return {};
  const Vec<2> place = pair.vertex_at_outline();
  const auto is_near = [&](const Vec<2>& corner) {
    return std::max(std::abs(place[0] - corner[0]), std::abs(place[1] - corner[1])) <= pair.lengths.sunk();
  };
  const auto near = std::find_if(pair.outline.vertices.begin(), pair.outline.vertices.end(), is_near);
  if (near == pair.outline.vertices.end()) return {};
  const auto own = std::find(pair.around.vertices.begin(), pair.around.vertices.end(), pair.vertex);
  if (own == pair.around.vertices.end()) return {};
  pair.corner = static_cast<Index>(near - pair.outline.vertices.begin());
  MeetingCorners out{SharpCorner::of(pair.around, static_cast<Index>(own - pair.around.vertices.begin())),
                     SharpCorner::of(pair.outline, pair.corner)};
  for (Vec<2>* point : {&out.of_vertex.before, &out.of_vertex.at, &out.of_vertex.behind})
    *point = pair.vertex_frame.outside(*point);
  for (Vec<2>* point : {&out.of_outline.before, &out.of_outline.at, &out.of_outline.behind})
    *point = pair.outline_frame.outside(*point);
  return out;
}

}  // namespace carom

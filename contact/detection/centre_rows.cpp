// Problem: which bodies are near ground, by their centres alone.

#include <carom/contact/detection/point_contacts.h>

#include <algorithm>
#include <cmath>

namespace carom {

bool PointContacts::may_touch(const CentreRow& row, const double* q) const {
  bool may = false;
  for (Index first = 0; first < row.count; first += PointRow::most) {
    const Index count = std::min(row.count - first, PointRow::most);
    const PointRow points{q + row.q + first * row.stride, row.stride, count};
    may = may || shapes_->points_within(row.shape, nullptr, points, row.reach) != 0;
  }
  return may;
}

std::vector<CentreRow> PointContacts::centre_rows(double margin) const {
  std::vector<CentreRow> rows;
  for (const CentreRun& run : features_.centres()) {
    const BodySlot first = assembly_->layout()->bodies()[run.bodies.begin];
    for (const TouchedShape& touched : touched_.by(material_of(run))) {
      rows.push_back({touched.shape, first.q, first.q_size, run.bodies.size(), run.reach(margin)});
    }
  }
  // Circles around all other points of a body, which places as far away as a hundred million radii round
  // less.
  constexpr double caution = 1.0 + 1e-6;
  for (const BodyFeature& point : features_.points()) {
    if (!features_.is_beside_centres(point)) continue;
    const BodySlot body = assembly_->layout()->bodies()[point.body];
    const double off = std::hypot(point.centre[0], point.centre[1], point.centre[2]);
    const double reach = caution * (off + point.radius + margin);
    for (const TouchedShape& touched : touched_.by(point.material)) {
      const auto same = [&](const CentreRow& row) { return row.shape == touched.shape && row.q == body.q; };
      const auto known = std::find_if(rows.begin(), rows.end(), same);
      if (known != rows.end()) {
        known->reach = std::max(known->reach, reach);
      } else {
        rows.push_back({touched.shape, body.q, body.q_size, 1, reach});
      }
    }
  }
  return rows;
}

bool PointContacts::centres_tell() const {
  const auto is_flat = [&](const TouchedShape& touched) { return shapes_->is_flat(touched.shape); };
  return std::all_of(features_.points().begin(), features_.points().end(), [&](const BodyFeature& point) {
    const std::span<const TouchedShape> touched = touched_.by(point.material);
    return !features_.is_beside_centres(point) || std::all_of(touched.begin(), touched.end(), is_flat);
  });
}

}  // namespace carom

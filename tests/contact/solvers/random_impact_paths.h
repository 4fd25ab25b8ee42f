#pragma once

/// \file
/// Random impacts of one contact, for the energetic law.

#include "tests/contact/random_problems.h"

#include <carom/contact/solvers/impact_path.h>

namespace carom::contact_test {

/// Rows of a contact of one body.
enum class PathRows { without_rolling, with_rolling };

/// A contact of one body that approaches.
inline ImpactPathInput random_impact_path(Random& random, double restitution,
                                          PathRows rows = PathRows::without_rolling) {
  ImpactPathInput in;
  const double mass = random.log_uniform(0.1, 10.0), inertia = random.log_uniform(0.1, 10.0);
  const double r_x = random.uniform(-2.0, 2.0), r_y = random.uniform(-2.0, 2.0);
  in.wnn = 1.0 / mass + r_x * r_x / inertia;
  in.wtt = 1.0 / mass + r_y * r_y / inertia;
  in.wnt = -r_x * r_y / inertia;
  in.friction = random.uniform(0.0, 1.5);
  if (rows == PathRows::with_rolling) {
    in.wnr = r_x / inertia;
    in.wtr = -r_y / inertia;
    in.wrr = 1.0 / inertia;
    in.rolling_resistance = random.uniform(0.0, 1.0);
  }
  in.restitution = restitution;
  in.normal = random.uniform(-3.0, -0.1);
  in.tangential = random.uniform(-3.0, 3.0);
  if (rows == PathRows::with_rolling) in.spin = random.uniform(-3.0, 3.0);
  return in;
}

}  // namespace carom::contact_test

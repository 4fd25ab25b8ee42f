#pragma once

// Free flight in uniform gravity.
//
// Source: any book of mechanics, e.g. Landau and Lifshitz, Mechanics, section 5: m x'' = m g, so
//     x(t) = x0 + v0 t + g t^2 / 2,    v(t) = v0 + g t.
// A body with spin keeps it: gravity has no torque about the centre of mass.

#include <carom/core/space.h>

#include <cmath>

namespace analytic {

template <int D>
struct Projectile {
  carom::Vec<D> start, velocity_at_start, gravity;

  carom::Vec<D> position(double t) const { return start + t * velocity_at_start + 0.5 * t * t * gravity; }
  carom::Vec<D> velocity(double t) const { return velocity_at_start + t * gravity; }

  /// First time > 0 at which the distance n.(x - p) from a plane through p falls to zero; NaN if it does not.
  double time_to_plane(const carom::Vec<D>& p, const carom::Vec<D>& n) const {
    const double distance = n.dot(start - p);
    const double speed = n.dot(velocity_at_start);
    const double half = 0.5 * n.dot(gravity);
    // half t^2 + speed t + distance = 0; the form without cancellation for a body that falls (half < 0).
    const double root = std::sqrt(speed * speed - 4.0 * half * distance);
    return speed > 0.0 ? (-speed - root) / (2.0 * half) : 2.0 * distance / (root - speed);
  }
};

}  // namespace analytic

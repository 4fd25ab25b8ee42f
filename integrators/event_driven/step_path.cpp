// Problem: places, velocities and accelerations within a step from those at its ends.

#include <carom/integrators/event_driven/step_path.h>

namespace carom {

CoordinateMotion motion_between(const CoordinateMotion& from, const CoordinateMotion& to, double length,
                                double tau) {
  const double v = length * from.rate, a = length * length * from.acceleration;
  const double d = to.place - from.place - v - 0.5 * a;
  const double e = length * to.rate - v - a;
  const double f = length * length * to.acceleration - a;
  const double c3 = 10.0 * d - 4.0 * e + 0.5 * f;
  const double c4 = -15.0 * d + 7.0 * e - f;
  const double c5 = 6.0 * d - 3.0 * e + 0.5 * f;
  return {from.place + tau * (v + tau * (0.5 * a + tau * (c3 + tau * (c4 + tau * c5)))),
          (v + tau * (a + tau * (3.0 * c3 + tau * (4.0 * c4 + tau * 5.0 * c5)))) / length,
          (a + tau * (6.0 * c3 + tau * (12.0 * c4 + tau * 20.0 * c5))) / (length * length)};
}

void follow_path(const PathEnd& from, const PathEnd& to, std::size_t count, double time, std::span<double> y,
                 double* acceleration) {
  const double length = to.time - from.time, tau = (time - from.time) / length;
  const auto motion_in = [count](const PathEnd& end, std::size_t i) {
    return CoordinateMotion{end.y[i], end.y[count + i], end.acceleration[i]};
  };
  for (std::size_t i = 0; i < count; ++i) {
    const CoordinateMotion at = motion_between(motion_in(from, i), motion_in(to, i), length, tau);
    y[i] = at.place;
    y[count + i] = at.rate;
    acceleration[i] = at.acceleration;
  }
  for (std::size_t i = 2 * count; i < y.size(); ++i) y[i] = from.y[i] + tau * (to.y[i] - from.y[i]);
}

}  // namespace carom

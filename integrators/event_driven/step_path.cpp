// Problem: places, velocities and accelerations within a step from those at its ends.

#include <carom/integrators/event_driven/step_path.h>

namespace carom {

void follow_path(const PathEnd& from, const PathEnd& to, std::size_t count, double time, std::span<double> y,
                 double* acceleration) {
  const double length = to.time - from.time, tau = (time - from.time) / length;
  for (std::size_t i = 0; i < count; ++i) {
    const double v = length * from.y[count + i], a = length * length * from.acceleration[i];
    const double d = to.y[i] - from.y[i] - v - 0.5 * a;
    const double e = length * to.y[count + i] - v - a;
    const double f = length * length * to.acceleration[i] - a;
    const double c3 = 10.0 * d - 4.0 * e + 0.5 * f;
    const double c4 = -15.0 * d + 7.0 * e - f;
    const double c5 = 6.0 * d - 3.0 * e + 0.5 * f;
    y[i] = from.y[i] + tau * (v + tau * (0.5 * a + tau * (c3 + tau * (c4 + tau * c5))));
    y[count + i] = (v + tau * (a + tau * (3.0 * c3 + tau * (4.0 * c4 + tau * 5.0 * c5)))) / length;
    acceleration[i] = (a + tau * (6.0 * c3 + tau * (12.0 * c4 + tau * 20.0 * c5))) / (length * length);
  }
  for (std::size_t i = 2 * count; i < y.size(); ++i) y[i] = from.y[i] + tau * (to.y[i] - from.y[i]);
}

}  // namespace carom

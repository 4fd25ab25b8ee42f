#include <carom/joints/mean_line.h>

namespace carom::planar {

namespace {

double half_turn(const ElementStep<2>& step, BodyId body) {
  if (body == ground) return 0.0;
  return 0.25 * step.step * (step.start.spin(body) + step.end.spin(body));
}

}  // namespace

MeanAngle::MeanAngle(const ElementStep<2>& step, BodyId from, BodyId to)
    : start(RelativeAngle(step.start, from, to).angle), end(RelativeAngle(step.end, from, to).angle) {
  const double a = half_turn(step, to);
  const double b = half_turn(step, from);
  rate = 2.0 * (a - b) / step.step;
  // growth = 2 (atan a - atan b) = 2 atan(u), u = (a - b)/(1 + a b) while neither turns by 90 degrees.
  const double base = 1.0 + a * b;
  const double u = (a - b) / base;
  constexpr double small = 1e-4;  // u^4/5 is below rounding
  if (base <= 0.0) {
    ratio = (std::atan(a) - std::atan(b)) / (a - b);
  } else if (std::abs(u) < small) {
    ratio = (1.0 - u * u / 3.0) / base;
  } else {
    ratio = std::atan(u) / (a - b);
  }
}

}  // namespace carom::planar

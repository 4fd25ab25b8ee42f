#include <carom/contact/detection/ground_builders.h>
#include <carom/core/errors.h>
#include <carom/core/part_check.h>

#include <cmath>
#include <string>

namespace carom::planar {

namespace {

void demand(bool allowed, const char* shape, const char* quantity, double value, const char* what) {
  if (std::isfinite(value) && allowed) return;
  throw ModelError(std::string(shape) + ": " + quantity + " is " + to_text(value) + " m; allowed: " + what);
}

void demand_finite(const char* shape, const char* quantity, const Vec<2>& point) {
  for (const double value : point) demand(true, shape, quantity, value, "finite numbers");
}

}  // namespace

Terrain stairs(const Vec<2>& start, int steps, double tread, double rise) {
  demand_finite("stairs", "start", start);
  if (steps < 1)
    throw ModelError("stairs: number of steps is " + std::to_string(steps) + "; allowed: at least 1");
  demand(tread > 0.0, "stairs", "tread", tread, "finite and > 0");
  demand(rise != 0.0, "stairs", "rise", rise, "finite and not 0");
  const double floor = 3.0 * tread;
  Terrain out;
  out.depth = std::abs(rise) + tread;
  out.vertices = {{start[0] - floor, start[1]}, start};
  for (int i = 0; i < steps; ++i) {
    const double x = start[0] + i * tread, y = start[1] + (i + 1) * rise;
    out.vertices.emplace_back(x, y);
    out.vertices.emplace_back(i + 1 < steps ? x + tread : x + floor, y);
  }
  return out;
}

std::array<Wall, 2> hopper(const Vec<2>& centre, double outlet, double width, double height, double radius) {
  demand_finite("hopper", "centre", centre);
  demand(outlet > 0.0, "hopper", "outlet", outlet, "finite and > 0");
  demand(width > outlet, "hopper", "width", width, "finite and wider than the outlet");
  demand(height > 0.0, "hopper", "height", height, "finite and > 0");
  demand(radius > 0.0, "hopper", "radius", radius, "finite and > 0");
  std::array<Wall, 2> walls;
  for (std::size_t i = 0; i < 2; ++i) {
    const double side = i == 0 ? -1.0 : 1.0;
    walls[i].from = centre + Vec<2>(side * (0.5 * width + radius), height);
    walls[i].to = centre + Vec<2>(side * (0.5 * outlet + radius), 0.0);
    walls[i].radius = radius;
  }
  return walls;
}

CircleInside drum(const Vec<2>& centre, double radius, double spin) {
  demand_finite("drum", "centre", centre);
  demand(radius > 0.0, "drum", "radius", radius, "finite and > 0");
  if (!std::isfinite(spin)) throw ModelError("drum: spin is " + to_text(spin) + " rad/s; allowed: finite");
  CircleInside out{.centre = centre, .radius = radius, .pivot = centre};
  if (spin == 0.0) return out;
  out.motion.angle = [spin](double time) { return spin * time; };
  out.motion.spin = [spin](double) { return spin; };
  out.motion.angular_acceleration = [](double) { return 0.0; };
  return out;
}

Terrain open_box(const Vec<2>& floor, double width, double height, double thickness) {
  demand_finite("open box", "floor", floor);
  demand(width > 0.0, "open box", "width", width, "finite and > 0");
  demand(height > 0.0, "open box", "height", height, "finite and > 0");
  demand(thickness > 0.0, "open box", "thickness", thickness, "finite and > 0");
  const double half = 0.5 * width;
  Terrain out;
  out.depth = thickness;
  out.vertices = {floor + Vec<2>(-half, height), floor + Vec<2>(-half, 0.0), floor + Vec<2>(half, 0.0),
                  floor + Vec<2>(half, height)};
  return out;
}

}  // namespace carom::planar

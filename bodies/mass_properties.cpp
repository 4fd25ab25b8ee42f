#include <carom/bodies/mass_properties.h>
#include <carom/core/errors.h>
#include <carom/core/part_check.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>

namespace carom::planar {

namespace {

[[noreturn]] void refuse(std::string_view function, std::string_view quantity, std::string_view value,
                         std::string_view allowed) {
  std::string message(function);
  message.append(": ").append(quantity).append(" is ").append(value).append("; allowed: ").append(allowed);
  throw ModelError(message);
}

void demand_positive(double value, std::string_view function, std::string_view quantity, const char* unit) {
  if (is_admissible(value) && value > 0.0) return;
  refuse(function, quantity, to_text(value) + unit, allowed_instead(value, "finite and > 0"));
}

void demand_finite(const Vec<2>& value, std::string_view function, std::string_view quantity) {
  if (is_admissible(value[0]) && is_admissible(value[1])) return;
  const double worse = is_admissible(value[0]) ? value[1] : value[0];
  refuse(function, quantity, "(" + to_text(value[0]) + ", " + to_text(value[1]) + ") m",
         allowed_instead(worse, "finite numbers"));
}

/// Demands mass properties that can be; without inertia they are a point mass.
void demand_possible(const MassProperties<2>& properties, std::string_view function,
                     const std::string& part) {
  demand_positive(properties.mass, function, part + "mass", " kg");
  if (!(is_admissible(properties.inertia) && properties.inertia >= 0.0)) {
    refuse(function, part + "moment of inertia", to_text(properties.inertia) + " kg m^2",
           allowed_instead(properties.inertia, "finite and >= 0"));
  }
  demand_finite(properties.centre, function, part + "centre");
}

/// m times the square of a radius of gyration, about the origin.
MassProperties<2> around_origin(std::string_view function, double mass, double gyration_squared) {
  demand_positive(mass, function, "mass", " kg");
  MassProperties<2> properties{.mass = mass, .inertia = mass * gyration_squared};
  demand_positive(properties.inertia, function, "moment of inertia", " kg m^2");
  return properties;
}

/// a x b to within two roundings: the fused operations keep what the difference of products would cancel.
double exact_cross(const Vec<2>& a, const Vec<2>& b) {
  const double product = a[1] * b[0];
  const double error = std::fma(-a[1], b[0], product);
  return std::fma(a[0], b[1], -product) + error;
}

/// True if the segments ab and cd cross in their interiors.
bool segments_cross(const Vec<2>& a, const Vec<2>& b, const Vec<2>& c, const Vec<2>& d) {
  const auto apart = [](const Vec<2>& p, const Vec<2>& q, const Vec<2>& r, const Vec<2>& s) {
    const double left = exact_cross(q - p, r - p);
    const double right = exact_cross(q - p, s - p);
    return (left > 0.0 && right < 0.0) || (left < 0.0 && right > 0.0);
  };
  return apart(a, b, c, d) && apart(c, d, a, b);
}

/// Demands an outline none of whose sides crosses another.
void demand_simple(const std::vector<Vec<2>>& points) {
  const std::size_t count = points.size();
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i + 2; j < count; ++j) {
      if (!segments_cross(points[i], points[i + 1 == count ? 0 : i + 1], points[j],
                          points[j + 1 == count ? 0 : j + 1])) {
        continue;
      }
      refuse("polygon", "outline",
             "crossing itself at sides " + std::to_string(i) + " and " + std::to_string(j),
             "a simple polygon");
    }
  }
}

}  // namespace

MassProperties<2> disc(double mass, double radius) {
  demand_positive(radius, "disc", "radius", " m");
  return around_origin("disc", mass, radius * radius / 2.0);
}

MassProperties<2> ring(double mass, double radius) {
  demand_positive(radius, "ring", "radius", " m");
  return around_origin("ring", mass, radius * radius);
}

MassProperties<2> solid_sphere(double mass, double radius) {
  demand_positive(radius, "solid_sphere", "radius", " m");
  return around_origin("solid_sphere", mass, 2.0 * radius * radius / 5.0);
}

MassProperties<2> thin_shell(double mass, double radius) {
  demand_positive(radius, "thin_shell", "radius", " m");
  return around_origin("thin_shell", mass, 2.0 * radius * radius / 3.0);
}

MassProperties<2> rod(double mass, double length) {
  demand_positive(length, "rod", "length", " m");
  return around_origin("rod", mass, length * length / 12.0);
}

MassProperties<2> box(double mass, double width, double height) {
  demand_positive(width, "box", "width", " m");
  demand_positive(height, "box", "height", " m");
  return around_origin("box", mass, (width * width + height * height) / 12.0);
}

MassProperties<2> polygon(double mass, const std::vector<Vec<2>>& vertices) {
  demand_positive(mass, "polygon", "mass", " kg");
  if (vertices.size() < 3)
    refuse("polygon", "number of vertices", std::to_string(vertices.size()), "at least 3");
  std::vector<Vec<2>> points;  // from the first vertex
  points.reserve(vertices.size());
  double extent = 0.0;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    demand_finite(vertices[i], "polygon", "vertex " + std::to_string(i));
    points.emplace_back(vertices[i] - vertices[0]);
    extent = std::max(extent, points.back().cwiseAbs().maxCoeff());
  }

  double doubled_area = 0.0;
  Vec<2> centre = Vec<2>::Zero();
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const double doubled = exact_cross(points[i], points[i + 1]);
    doubled_area += doubled;
    centre += doubled * (points[i] + points[i + 1]) / 3.0;
  }
  // Rounding of the coordinates alone moves the area by this much.
  const double rounding =
      std::numeric_limits<double>::epsilon() * static_cast<double>(points.size()) * extent * extent;
  if (!(std::isfinite(doubled_area) && std::abs(doubled_area) > rounding)) {
    refuse("polygon", "area", to_text(std::abs(doubled_area) / 2.0) + " m^2", "finite and above rounding");
  }
  demand_simple(points);
  centre /= doubled_area;

  double gyration_squared = 0.0;
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const Vec<2>& a = points[i];
    const Vec<2>& b = points[i + 1];
    const double own = (a.squaredNorm() + b.squaredNorm() + (b - a).squaredNorm()) / 36.0;
    const double away = ((a + b) / 3.0 - centre).squaredNorm();
    gyration_squared += exact_cross(a, b) / doubled_area * (own + away);
  }
  MassProperties<2> properties = around_origin("polygon", mass, gyration_squared);
  properties.centre = vertices[0] + centre;
  return properties;
}

MassProperties<2> point_mass(double mass) {
  demand_positive(mass, "point_mass", "mass", " kg");
  return {.mass = mass, .inertia = 0.0};
}

MassProperties<2> compose(std::span<const MassProperties<2>> parts) {
  if (parts.empty()) refuse("compose", "number of parts", "0", "at least 1");
  for (std::size_t i = 0; i < parts.size(); ++i) {
    demand_possible(parts[i], "compose", "part " + std::to_string(i) + " ");
  }
  MassProperties<2> whole{.mass = 0.0, .inertia = 0.0};
  Vec<2> moment = Vec<2>::Zero();  // about the centre of the first part
  for (const MassProperties<2>& part : parts) {
    whole.mass += part.mass;
    moment += part.mass * (part.centre - parts[0].centre);
  }
  const Vec<2> centre = moment / whole.mass;
  for (const MassProperties<2>& part : parts) {
    whole.inertia += part.inertia + part.mass * (part.centre - parts[0].centre - centre).squaredNorm();
  }
  whole.centre = parts[0].centre + centre;
  demand_possible(whole, "compose", "");
  return whole;
}

MassProperties<2> compose(std::initializer_list<MassProperties<2>> parts) {
  return compose(std::span<const MassProperties<2>>(parts.begin(), parts.size()));
}

MassProperties<2> shifted(const MassProperties<2>& properties, const Vec<2>& offset) {
  demand_possible(properties, "shifted", "");
  demand_finite(offset, "shifted", "offset");
  MassProperties<2> moved = properties;
  moved.centre += offset;
  demand_finite(moved.centre, "shifted", "centre");
  return moved;
}

MassProperties<2> centred(const MassProperties<2>& properties) {
  demand_possible(properties, "centred", "");
  MassProperties<2> moved = properties;
  moved.centre.setZero();
  return moved;
}

double inertia_about(const MassProperties<2>& properties, const Vec<2>& point) {
  demand_possible(properties, "inertia_about", "");
  demand_finite(point, "inertia_about", "point");
  return properties.inertia + properties.mass * (point - properties.centre).squaredNorm();
}

}  // namespace carom::planar

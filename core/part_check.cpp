#include <carom/core/part_check.h>

#include <carom/core/errors.h>
#include <carom/core/registry.h>
#include <carom/core/surface.h>
#include <carom/core/system.h>

#include <array>
#include <charconv>
#include <cmath>

// NaN says that a number is not given, infinity that there is no bound, and sums are exact to twice the
// digits: none of this is left where a compiler takes numbers for real ones.
#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ > 0) || \
    defined(__ASSOCIATIVE_MATH__)
#error carom needs the arithmetic of IEEE 754: compile it without -ffast-math, -Ofast and the options that they imply
#endif

namespace carom {

std::string to_text(double value) {
  std::array<char, 32> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), result.ptr};
}

namespace {

std::string with_unit(double value, std::string_view unit) {
  std::string text = to_text(value);
  if (!unit.empty()) text.append(" ").append(unit);
  return text;
}

/// Of a number that parts store: NaN stands for those that a description leaves out.
std::string stored(double value, std::string_view unit) {
  std::string text = with_unit(value, unit);
  if (std::isnan(value)) text += ", perhaps not given";
  return text;
}

template <class K, class Identity>
std::string with_removal(const System& system, const Registry<K>& parts, Identity id) {
  std::string text = system.name(id);
  const bool was_given = id.token == system.token() && parts.kind_ever(id.serial) != nullptr;
  if (was_given && !system.contains(id)) text += ", which was removed";
  return text;
}

}  // namespace

std::string allowed_instead(double value, std::string_view allowed) {
  if (!std::isfinite(value) || is_admissible(value)) return std::string(allowed);
  return "a number of a magnitude up to " + to_text(largest_magnitude);
}

std::string refused_name(const System& system, BodyId id) {
  return with_removal(system, system.body_kinds(), id);
}
std::string refused_name(const System& system, ElementId id) {
  return with_removal(system, system.force_kinds(), id);
}
std::string refused_name(const System& system, JointId id) {
  return with_removal(system, system.joint_kinds(), id);
}
std::string refused_name(const System& system, ShapeId id) {
  return with_removal(system, system.shape_kinds(), id);
}
std::string refused_name(const System& system, ObstacleId id) {
  return with_removal(system, system.ground_shape_kinds(), id);
}

void PartCheck::refuse(std::string_view quantity, std::string_view value, std::string_view allowed) const {
  std::string message = part_;
  message.append(": ").append(quantity).append(" is ").append(value).append("; allowed: ").append(allowed);
  throw ModelError(message);
}

void PartCheck::finite(double value, std::string_view quantity, std::string_view unit) const {
  if (is_admissible(value)) return;
  refuse(quantity, with_unit(value, unit), allowed_instead(value, "a finite number"));
}

void PartCheck::finite(std::span<const double> values, std::string_view quantity,
                       std::string_view unit) const {
  for (const double value : values) finite(value, quantity, unit);
}

void PartCheck::positive(double value, std::string_view quantity, std::string_view unit) const {
  if (is_admissible(value) && value > 0.0) return;
  refuse(quantity, stored(value, unit), allowed_instead(value, "finite and > 0"));
}

void PartCheck::non_negative(double value, std::string_view quantity, std::string_view unit) const {
  if (is_admissible(value) && value >= 0.0) return;
  refuse(quantity, stored(value, unit), allowed_instead(value, "finite and >= 0"));
}

void PartCheck::direction(std::span<const double> values, std::string_view quantity) const {
  for (const double value : values) {
    if (!std::isfinite(value)) refuse(quantity, stored(value, ""), "a finite number");
  }
}

void PartCheck::between(double value, double lower, double upper, std::string_view quantity) const {
  if (value >= lower && value <= upper) return;
  refuse(quantity, stored(value, ""), "in [" + to_text(lower) + ", " + to_text(upper) + "]");
}

void PartCheck::breaks(std::span<const double> times, std::string_view quantity) const {
  finite(times, quantity, "s");
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (times[i] > times[i - 1]) continue;
    refuse(quantity, to_text(times[i]) + " s after " + to_text(times[i - 1]) + " s", "ascending times");
  }
}

void PartCheck::surface(const Surface& surface) const {
  non_negative(surface.friction, "friction", "");
  between(surface.normal_restitution, 0.0, 1.0, "normal_restitution");
  between(surface.tangential_restitution, 0.0, 1.0, "tangential_restitution");
  if (surface.impact_law > ImpactLaw::energetic) {
    refuse("impact_law", std::to_string(static_cast<int>(surface.impact_law)),
           "newton, poisson or energetic");
  }
  if (surface.impact_law == ImpactLaw::energetic && surface.tangential_restitution != 0.0) {
    refuse("tangential_restitution", to_text(surface.tangential_restitution),
           "0 where impact_law is energetic");
  }
  non_negative(surface.rolling_resistance, "rolling_resistance", "m");
  between(surface.rolling_restitution, 0.0, 1.0, "rolling_restitution");
  if (surface.rolling_restitution > 0.0 && surface.rolling_resistance == 0.0) {
    refuse("rolling_restitution", to_text(surface.rolling_restitution), "0 where rolling_resistance is 0");
  }
  if (surface.impact_law == ImpactLaw::energetic && surface.rolling_restitution != 0.0) {
    refuse("rolling_restitution", to_text(surface.rolling_restitution), "0 where impact_law is energetic");
  }
  non_negative(surface.stribeck_speed, "stribeck_speed", "m/s");
  if (std::isnan(surface.static_friction)) {
    if (surface.stribeck_speed == 0.0) return;
    refuse("stribeck_speed", with_unit(surface.stribeck_speed, "m/s"),
           "0 where static_friction is not given");
  }
  finite(surface.static_friction, "static_friction", "");
  if (surface.static_friction >= surface.friction) return;
  refuse("static_friction", to_text(surface.static_friction),
         "not less than friction, " + to_text(surface.friction));
}

void PartCheck::body(BodyId id, std::string_view quantity, bool may_be_ground) const {
  if (id == ground) {
    if (!may_be_ground) refuse(quantity, "ground", "a body of this system");
    return;
  }
  if (!id.valid()) refuse(quantity, "not given", "a body of this system");
  if (id.token != system_->token()) refuse(quantity, "a body of another system", "a body of this system");
  if (system_->contains(id)) return;
  const bool was_removed = system_->body_kinds().kind_ever(id.serial) != nullptr;
  refuse(quantity,
         was_removed ? "a body that was removed, " + system_->name(id)
                     : "a body that was never given, #" + std::to_string(id.serial),
         "a body of this system");
}

void PartCheck::oriented_body(BodyId id, std::string_view quantity) const {
  body(id, quantity, false);
  if (!system_->has_orientation(id)) {
    refuse(quantity, system_->name(id), "a rigid body (a particle has no orientation)");
  }
}

void PartCheck::different_ends(BodyId from, BodyId to) const {
  if (from == to) {
    refuse("to", from == ground ? "ground, as from" : system_->name(to) + ", as from",
           "another body than from");
  }
}

void PartCheck::material(MaterialId id) const {
  if (!id.valid()) return;
  if (id.token != system_->token() || !system_->contains(id)) {
    refuse("material", "unknown", "a material of this system");
  }
}

void PartCheck::filter(const ContactFilter& filter) const {
  constexpr const char* allowed = "at least one group (to hide a part for a time: one that nothing else has)";
  if (filter.groups == 0) refuse("filter.groups", "0, which hides it from everything", allowed);
  if (filter.touches == 0) refuse("filter.touches", "0, which hides everything from it", allowed);
}

}  // namespace carom

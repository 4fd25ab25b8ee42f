// Problem: how far the normal impulse of one contact goes by the energetic law, and what friction does on the
// way. All is piecewise linear in it.

#include <carom/contact/solvers/impact_path.h>

#include <cmath>
#include <limits>

namespace carom {

namespace {

constexpr double endless = std::numeric_limits<double>::infinity();

/// A stretch of constant ratio k = dP_t/dp.
struct Stretch {
  double ratio = 0.0;
  double normal_rate = 0.0, tangential_rate = 0.0;  // of gamma over p
  double length = endless;                          // to gamma_t = 0
  bool sticks = false;
};

/// The stretch that begins at a tangential velocity.
Stretch stretch_from(const ImpactPathInput& at, double tangential) {
  Stretch out;
  const double needed = at.wtt > 0.0 ? -at.wnt / at.wtt : 0.0;
  if (tangential == 0.0) {
    out.sticks = std::abs(needed) <= at.friction;
    out.ratio = out.sticks ? needed : std::copysign(at.friction, needed);
  } else {
    out.ratio = -std::copysign(at.friction, tangential);
  }
  out.normal_rate = at.wnn + at.wnt * out.ratio;
  out.tangential_rate = out.sticks ? 0.0 : at.wnt + at.wtt * out.ratio;
  if (tangential * out.tangential_rate < 0.0) out.length = -tangential / out.tangential_rate;
  return out;
}

/// Impulse after which gamma_n = 0 at a rate; infinite if never.
double length_to_rest(double normal, double rate) { return rate > 0.0 ? -normal / rate : endless; }

/// Impulse after which the work of expansion from gamma_n is `left` more. The root of
/// rate p^2/2 + normal p = left that is not negative.
double length_of_work(double normal, double rate, double left) {
  const double root = normal * normal + 2.0 * rate * left;
  if (root < 0.0) return endless;
  const double sum = normal + std::sqrt(root);
  return sum > 0.0 ? 2.0 * left / sum : (left > 0.0 ? endless : 0.0);
}

}  // namespace

std::optional<ImpactPathEnd> follow_impact(const ImpactPathInput& contact) {
  ImpactPathEnd at{.normal = contact.normal, .tangential = contact.tangential};
  if (!(at.normal < 0.0)) return at;
  double compression = 0.0, expansion = 0.0;
  bool compresses = true;
  // At most two stretches of slip and one of stick, in either phase.
  constexpr int most_stretches = 6;
  for (int i = 0; i < most_stretches; ++i) {
    const Stretch along = stretch_from(contact, at.tangential);
    at.sticks = along.sticks;
    const double left = contact.restitution * contact.restitution * -compression - expansion;
    const double to_end = compresses ? length_to_rest(at.normal, along.normal_rate)
                                     : length_of_work(at.normal, along.normal_rate, left);
    const bool ends = to_end <= along.length;
    const double length = ends ? to_end : along.length;
    if (!(length < endless)) return std::nullopt;
    const double normal = ends && compresses ? 0.0 : at.normal + along.normal_rate * length;
    (compresses ? compression : expansion) += 0.5 * length * (at.normal + normal);
    at.normal_impulse += length;
    at.tangential_impulse += along.ratio * length;
    at.normal = normal;
    at.tangential = along.length <= length ? 0.0 : at.tangential + along.tangential_rate * length;
    if (!ends) continue;
    if (!compresses) return at;
    compresses = false;
    if (contact.restitution == 0.0) return at;
  }
  return std::nullopt;
}

}  // namespace carom

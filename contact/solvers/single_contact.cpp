// Problem: one contact, its impulses exactly and in nanoseconds.

#include <carom/contact/solvers/single_contact.h>

#include <carom/contact/solvers/planar_certificate.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace carom {

namespace {

// Solutions nearer than this part of their size are one: a mode boundary reached exactly from both sides.
constexpr double merge_distance = 1e-13;

// a b - c d with an error of at most five half roundings of the result: plainly where little cancels, by
// Kahan's algorithm (two roundings) where much does.
double difference_of_products(double a, double b, double c, double d) {
  const double ab = a * b, cd = c * d;
  const double plain = ab - cd;
  if (std::abs(plain) >= 0.5 * std::max(std::abs(ab), std::abs(cd))) return plain;
  const double error = std::fma(-c, d, cd);
  return std::fma(a, b, -cd) + error;
}

// The numbers that decide on the modes of a contact with friction.
struct Predicates {
  double p_plus, p_minus;   // W_nn -+ mu W_nt
  double s_plus, s_minus;   // see solve_planar_contact
  double p_scale, s_scale;  // what they are compared with
  double determinant;       // 0 where singular
};

// Inlined by force: passing these numbers through memory costs more than computing them.
[[gnu::always_inline]] inline Predicates evaluate(const PlanarContact& c) {
  Predicates v;
  const double coupling = c.friction * c.w_nt;
  const double lateral = c.friction * c.w_tt;
  v.p_plus = c.w_nn - coupling;
  v.p_minus = c.w_nn + coupling;
  v.s_plus = c.b_n * (c.w_nt - lateral) - c.b_t * v.p_plus;
  v.s_minus = c.b_t * v.p_minus - c.b_n * (c.w_nt + lateral);
  v.p_scale = c.w_nn + std::abs(coupling);
  v.s_scale = std::abs(c.b_t) * v.p_scale + std::abs(c.b_n) * (std::abs(c.w_nt) + lateral);
  const double determinant = difference_of_products(c.w_nn, c.w_tt, c.w_nt, c.w_nt);
  v.determinant = determinant > singular_determinant * c.w_nn * c.w_tt ? determinant : 0.0;
  return v;
}

double ratio(double value, double scale) { return scale > 0.0 ? value / scale : 0.0; }

PlanarImpulse slip(const PlanarContact& c, double p, ContactMode mode) {
  const double normal = -c.b_n / p;
  return {normal, mode == ContactMode::slip_positive ? -c.friction * normal : c.friction * normal, mode};
}

// Inlined by force, too: the impulse would be read in another way than it is written.
[[gnu::always_inline]] inline PlanarImpulse stick(const PlanarContact& c, double determinant) {
  const double normal = difference_of_products(c.w_nt, c.b_t, c.w_tt, c.b_n) / determinant;
  const double tangential = difference_of_products(c.w_nt, c.b_n, c.w_nn, c.b_t) / determinant;
  // The mode is decided by S+-; what rounding puts outside the cone is put back.
  const double feasible = std::max(normal, 0.0);
  const double limit = c.friction * feasible;
  return {feasible, std::clamp(tangential, -limit, limit), ContactMode::stick};
}

void add(PlanarSolutions& found, const PlanarImpulse& impulse) {
  for (int i = 0; i < found.count; ++i) {
    const PlanarImpulse& other = found.list[static_cast<std::size_t>(i)];
    const double size = std::max({std::abs(impulse.normal), std::abs(impulse.tangential),
                                  std::abs(other.normal), std::abs(other.tangential)});
    if (std::abs(impulse.normal - other.normal) <= merge_distance * size &&
        std::abs(impulse.tangential - other.tangential) <= merge_distance * size) {
      return;
    }
  }
  found.list[static_cast<std::size_t>(found.count++)] = impulse;
}

// Smallest normal impulse first, equal ones in the order found. Insertion: at most four, and no memory asked
// for.
void order(PlanarSolutions& found) {
  for (int i = 1; i < found.count; ++i) {
    for (int j = i; j > 0; --j) {
      PlanarImpulse& lower = found.list[static_cast<std::size_t>(j - 1)];
      PlanarImpulse& upper = found.list[static_cast<std::size_t>(j)];
      if (!(upper.normal < lower.normal)) break;
      std::swap(lower, upper);
    }
  }
}

// No coupling to, or no effect of, the tangential direction: P_n = max(0, -b_n / W_nn), P_t = 0.
PlanarSolutions solve_frictionless(const PlanarContact& c) {
  PlanarSolutions found;
  found.degenerate = !(std::abs(c.b_n) > degenerate_margin * std::abs(c.b_t)) || c.b_n == 0.0;
  if (c.b_n >= 0.0) {
    found.outcome = Outcome::solved;
    found.list[static_cast<std::size_t>(found.count++)] = {};
    return found;
  }
  if (!(c.w_nn > 0.0)) {
    found.outcome = std::isfinite(c.b_n) && c.w_nn == 0.0 ? Outcome::no_solution : Outcome::not_solved;
    return found;
  }
  const double normal = -c.b_n / c.w_nn;
  const double xi_t = c.b_t + c.w_nt * normal;
  ContactMode mode = ContactMode::stick;
  if (xi_t > 0.0) mode = ContactMode::slip_positive;
  if (xi_t < 0.0) mode = ContactMode::slip_negative;
  found.outcome = Outcome::solved;
  found.list[static_cast<std::size_t>(found.count++)] = {normal, 0.0, mode};
  return found;
}

// Sticking with singular W = u u^T: every impulse with W_nn P_n + W_nt P_t = -b_n sticks. Takes the one
// nearest to the origin inside the cone. Returns whether there is one with P_n > 0.
bool stick_singular(const PlanarContact& c, PlanarImpulse& impulse) {
  const double slope = std::clamp(c.w_nn > 0.0 ? c.w_nt / c.w_nn : 0.0, -c.friction, c.friction);
  // The slope turns to the other side where the impulse has to pull at the contact (b_n > 0, jammed).
  const double used = c.b_n <= 0.0 ? slope : (c.w_nt > 0.0 ? -c.friction : c.friction);
  const double p = c.w_nn + c.w_nt * used;
  const double normal = -c.b_n / p;
  impulse = {normal, used * normal, ContactMode::stick};
  return std::isfinite(normal) && normal > 0.0;
}

// All modes, with every special case. Called when the fast path below does not apply.
PlanarSolutions list_modes(const PlanarContact& c, const Predicates& v) {
  PlanarSolutions found;
  const double scale = std::max(std::abs(c.b_n), std::abs(c.b_t));
  const double open_margin = ratio(c.b_n, scale);
  const double s_plus = ratio(v.s_plus, v.s_scale), s_minus = ratio(v.s_minus, v.s_scale);
  const auto slip_margin = [&](double p, double s) {
    return p > 0.0 ? std::min({-open_margin, ratio(p, v.p_scale), -s})
                   : std::min({open_margin, ratio(-p, v.p_scale), s});
  };
  const double slip_plus_margin = slip_margin(v.p_plus, s_plus);
  const double slip_minus_margin = slip_margin(v.p_minus, s_minus);
  const double determinant_ratio = ratio(v.determinant, c.w_nn * c.w_tt);
  const double stick_margin = std::min({s_plus, s_minus, determinant_ratio});

  // For singular W the two predicates of stick differ from zero by rounding alone.
  const bool singular = v.determinant == 0.0;
  const double miss = difference_of_products(c.w_nn, c.b_t, c.w_nt, c.b_n);
  const double terms = std::abs(c.w_nn * c.b_t) + std::abs(c.w_nt * c.b_n);
  const bool in_range = singular && (c.w_nn > 0.0 ? std::abs(miss) <= range_margin * terms : c.b_n <= 0.0);

  if (c.b_n >= 0.0) add(found, {});
  if (in_range) {
    PlanarImpulse impulse;
    const bool sticks = stick_singular(c, impulse);
    if (sticks) add(found, impulse);
    // At b_n = 0 a jammed contact can be loaded by any multiple of one impulse; in an immovable normal
    // direction that load can stop the tangential motion.
    const bool jammed = c.b_n == 0.0 && v.p_plus * v.p_minus <= 0.0;
    const bool stops = c.w_nn == 0.0 && c.b_t != 0.0;
    found.degenerate = true;
    found.outcome = found.count == 0                        ? Outcome::no_solution
                    : found.count == 2 || (jammed && stops) ? Outcome::several_solutions
                    : sticks || jammed                      ? Outcome::forces_not_unique
                                                            : Outcome::solved;
    return found;
  }
  if (!singular && v.s_plus >= 0.0 && v.s_minus >= 0.0) add(found, stick(c, v.determinant));
  if (v.p_plus != 0.0 && slip_plus_margin >= 0.0) add(found, slip(c, v.p_plus, ContactMode::slip_positive));
  if (v.p_minus != 0.0 && slip_minus_margin >= 0.0) {
    add(found, slip(c, v.p_minus, ContactMode::slip_negative));
  }
  // W positive definite and b_n < 0: exactly, S+ and S- are not both negative (docs/method.md section 3);
  // where rounding says so, or says that a vanishing p opens a gap, the contact stands between slip and
  // stick.
  if (found.count == 0 && !singular) add(found, stick(c, v.determinant));

  for (const double margin : {open_margin, stick_margin, slip_plus_margin, slip_minus_margin}) {
    if (std::abs(margin) < degenerate_margin) found.degenerate = true;
  }
  found.outcome = found.count == 0   ? Outcome::no_solution
                  : found.count == 1 ? Outcome::solved
                                     : Outcome::several_solutions;
  // A proof about numbers that are none is no proof.
  if (found.count == 0 && !std::isfinite(terms + v.s_scale)) found.outcome = Outcome::not_solved;
  order(found);
  return found;
}

// The unique solution where mu |W_nt| < W_nn and W is regular, b_n not zero; false where one of these fails.
[[gnu::always_inline]] inline bool solve_regular(const PlanarContact& c, const Predicates& v,
                                                 PlanarImpulse& impulse, bool& degenerate) {
  if (!(v.p_plus > degenerate_margin * v.p_scale && v.p_minus > degenerate_margin * v.p_scale)) return false;
  const double normal_margin = std::abs(c.b_n);
  if (c.b_n > 0.0) {
    impulse = {};
    degenerate = normal_margin < degenerate_margin * std::abs(c.b_t);
    return true;
  }
  if (!(c.b_n < 0.0) || v.determinant == 0.0) return false;
  const double margin = degenerate_margin * v.s_scale;
  if (v.s_plus >= 0.0 && v.s_minus >= 0.0) {
    impulse = stick(c, v.determinant);
    degenerate =
        v.s_plus < margin || v.s_minus < margin || v.determinant < degenerate_margin * c.w_nn * c.w_tt;
    return true;
  }
  const bool positive = v.s_plus < v.s_minus;
  impulse = positive ? slip(c, v.p_plus, ContactMode::slip_positive)
                     : slip(c, v.p_minus, ContactMode::slip_negative);
  degenerate =
      (positive ? -v.s_plus : -v.s_minus) < margin || normal_margin < degenerate_margin * std::abs(c.b_t);
  return true;
}

template <bool ModeByRule>
[[gnu::always_inline]] inline void certify(const PlanarContact& c, CertifiedImpulse& answer) {
  const double p_n = answer.impulse.normal, p_t = answer.impulse.tangential;
  answer.xi_n = c.b_n + c.w_nn * p_n + c.w_nt * p_t;
  answer.xi_t = c.b_t + c.w_nt * p_n + c.w_tt * p_t;
  const PlanarAnswer numbers{c.w_nn + c.w_tt, c.b_n, c.b_t, c.friction, p_n, p_t, answer.xi_n, answer.xi_t};
  answer.residual = planar_residual(numbers);
  answer.mode = ModeByRule ? planar_mode(numbers) : answer.impulse.mode;
  answer.usable = true;
}

template <bool ModeByRule>
[[gnu::always_inline]] inline bool certified_regular(const PlanarContact& c, CertifiedImpulse& answer) {
  if (!(c.friction > 0.0 && c.w_tt > 0.0)) return false;
  if (!solve_regular(c, evaluate(c), answer.impulse, answer.degenerate)) return false;
  answer.outcome = Outcome::solved;
  certify<ModeByRule>(c, answer);
  return true;
}

// Problems that are not regular: every mode is tried.
[[gnu::noinline]] void certified_any(const PlanarContact& c, CertifiedImpulse& answer) {
  const PlanarSolutions found = solve_planar_contact(c);
  answer.outcome = found.outcome;
  answer.degenerate = found.degenerate;
  answer.impulse = found.list[0];
  certify<false>(c, answer);
  answer.usable = found.count > 0;
}

}  // namespace

CertifiedImpulse solve_certified_contact(const PlanarContact& contact) {
  CertifiedImpulse answer;
  if (!certified_regular<false>(contact, answer)) certified_any(contact, answer);
  return answer;
}

CertifiedImpulse solve_regular_contact(const PlanarContact& contact) {
  CertifiedImpulse answer;
  (void)certified_regular<true>(contact, answer);
  return answer;
}

CertifiedImpulse solve_regular_contact(const ContactProblem& problem) {
  const double* w = problem.matrix().data();
  const double* b = problem.vector().data();
  return solve_regular_contact(PlanarContact{w[0], w[1], w[3], b[0], b[1], problem.sets()[1].coefficient});
}

PlanarSolutions solve_planar_contact(const PlanarContact& contact) {
  // Without friction, or where nothing moves the contact tangentially, only the normal direction is left;
  // the tangential impulse is then arbitrary in its interval and taken as zero.
  if (!(contact.friction > 0.0)) return solve_frictionless(contact);
  if (!(contact.w_tt > 0.0) && contact.b_t == 0.0) {
    PlanarSolutions found = solve_frictionless(contact);
    if (found.outcome == Outcome::solved && found.list[0].normal > 0.0) {
      found.outcome = Outcome::forces_not_unique;
    }
    return found;
  }
  const Predicates v = evaluate(contact);
  PlanarSolutions found;
  if (solve_regular(contact, v, found.list[0], found.degenerate)) {
    found.count = 1;
    found.outcome = Outcome::solved;
    return found;
  }
  return list_modes(contact, v);
}

}  // namespace carom

// Problem: one contact, its impulses exactly and in nanoseconds.

#include <carom/contact/single_contact.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

// Solutions nearer than this part of their size are one: a mode boundary reached exactly from both sides.
constexpr double merge_distance = 1e-13;

// Coupling and anisotropy below this part of W count as rounding in the closed form of a sphere.
constexpr double decoupled_threshold = 8.0 * epsilon;

// a b - c d with an error of two roundings of the result (Kahan's algorithm).
double difference_of_products(double a, double b, double c, double d) {
  const double cd = c * d;
  const double error = std::fma(-c, d, cd);
  return std::fma(a, b, -cd) + error;
}

// The numbers that decide on the modes of a contact with friction.
struct Predicates {
  double p_plus, p_minus;    // W_nn -+ mu W_nt
  double s_plus, s_minus;    // see solve_planar_contact
  double p_scale, s_scale;   // what they are compared with
  double determinant;        // 0 where singular
};

Predicates evaluate(const PlanarContact& c) {
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

PlanarImpulse stick(const PlanarContact& c, double determinant) {
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

// Smallest normal impulse first. The list is short and nearly always has one entry.
void order(PlanarSolutions& found) {
  std::stable_sort(found.list.begin(), found.list.begin() + found.count,
                   [](const PlanarImpulse& a, const PlanarImpulse& b) { return a.normal < b.normal; });
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
    found.outcome = Outcome::no_solution;
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
  // W positive definite and b_n < 0: exactly, S+ and S- are not both negative (theory section 3); where
  // rounding says so, or says that a vanishing p opens a gap, the contact stands between slip and stick.
  if (found.count == 0 && !singular) add(found, stick(c, v.determinant));

  for (const double margin : {open_margin, stick_margin, slip_plus_margin, slip_minus_margin}) {
    if (std::abs(margin) < degenerate_margin) found.degenerate = true;
  }
  found.outcome = found.count == 0   ? Outcome::no_solution
                  : found.count == 1 ? Outcome::solved
                                     : Outcome::several_solutions;
  order(found);
  return found;
}

// The unique solution where mu |W_nt| < W_nn and W is regular, b_n not zero; false where one of these fails.
bool solve_regular(const PlanarContact& c, const Predicates& v, PlanarImpulse& impulse, bool& degenerate) {
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
    degenerate = v.s_plus < margin || v.s_minus < margin ||
                 v.determinant < degenerate_margin * c.w_nn * c.w_tt;
    return true;
  }
  const bool positive = v.s_plus < v.s_minus;
  impulse = positive ? slip(c, v.p_plus, ContactMode::slip_positive)
                     : slip(c, v.p_minus, ContactMode::slip_negative);
  degenerate = (positive ? -v.s_plus : -v.s_minus) < margin ||
               normal_margin < degenerate_margin * std::abs(c.b_t);
  return true;
}

}  // namespace

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

namespace {

constexpr SolverAnswer not_applicable{Outcome::not_solved, false, 0, "not applicable"};

SolverAnswer solve_planar(const ContactProblem& problem, std::span<double> impulse) {
  const auto b = problem.vector();
  const PlanarContact contact{problem.w(0, 0), problem.w(0, 1), problem.w(1, 1),
                              b[0],            b[1],            problem.sets()[1].coefficient};
  if (contact.friction > 0.0 && contact.w_tt > 0.0) {
    const Predicates v = evaluate(contact);
    PlanarImpulse found;
    bool degenerate = false;
    if (solve_regular(contact, v, found, degenerate)) {
      impulse[0] = found.normal;
      impulse[1] = found.tangential;
      return {Outcome::solved, degenerate, 1, {}};
    }
  }
  const PlanarSolutions found = solve_planar_contact(contact);
  impulse[0] = found.list[0].normal;
  impulse[1] = found.list[0].tangential;
  return {found.outcome, found.degenerate, 1,
          found.outcome == Outcome::no_solution ? "no mode is possible" : std::string_view{}};
}

SolverAnswer solve_lone_row(const ContactProblem& problem, std::span<double> impulse) {
  const RowSet& set = problem.sets()[0];
  const double w = problem.w(0, 0), b = problem.vector()[0];
  const double lower = set.kind == SetKind::half_line ? 0.0 : set.lower;
  const double upper = set.kind == SetKind::half_line ? std::numeric_limits<double>::infinity() : set.upper;
  const double wanted = w > 0.0 ? -b / w : (b > 0.0 ? lower : (b < 0.0 ? upper : 0.0));
  impulse[0] = std::clamp(wanted, lower, upper);
  if (std::isfinite(impulse[0])) return {Outcome::solved, b == 0.0, 1, {}};
  if (std::isnan(b) || std::isnan(w)) return {Outcome::not_solved, false, 1, "not a number"};
  impulse[0] = 0.0;
  return {Outcome::no_solution, false, 1, "an immovable row is driven against its bound"};
}

// A sphere or a particle in space (theory section 4, with the tangent a plane).
SolverAnswer solve_decoupled_disc(const ContactProblem& problem, std::span<double> impulse) {
  const auto b = problem.vector();
  const double w_nn = problem.w(0, 0), w_tt = 0.5 * (problem.w(1, 1) + problem.w(2, 2));
  const double coupling = std::max(std::abs(problem.w(0, 1)), std::abs(problem.w(0, 2)));
  const double anisotropy = std::max(std::abs(problem.w(1, 2)), std::abs(problem.w(1, 1) - problem.w(2, 2)));
  if (!(w_nn > 0.0 && w_tt > 0.0) || coupling > decoupled_threshold * std::min(w_nn, w_tt) ||
      anisotropy > decoupled_threshold * w_tt) {
    return not_applicable;
  }
  const double normal = std::max(-b[0] / w_nn, 0.0);
  const double wanted = std::hypot(b[1], b[2]) / w_tt;
  const double limit = problem.sets()[1].coefficient * normal;
  const double shrink = wanted > limit ? limit / wanted : 1.0;
  impulse[0] = normal;
  impulse[1] = -shrink * b[1] / w_tt;
  impulse[2] = -shrink * b[2] / w_tt;
  const double scale = std::max({std::abs(b[0]), std::abs(b[1]), std::abs(b[2])});
  const bool between = normal > 0.0 && limit > 0.0 && std::abs(wanted - limit) < degenerate_margin * (wanted + limit);
  return {Outcome::solved, between || !(std::abs(b[0]) > degenerate_margin * scale), 1, {}};
}

}  // namespace

SolverAnswer SingleContactSolver::solve(const ContactProblem& problem, std::span<double> impulse) {
  if (problem.groups().size() != 1) return not_applicable;
  switch (problem.rows()) {
    case 1: return solve_lone_row(problem, impulse);
    case 2:
      return problem.sets()[0].kind == SetKind::half_line ? solve_planar(problem, impulse) : not_applicable;
    case 3:
      return problem.sets()[0].kind == SetKind::half_line && problem.sets()[1].kind == SetKind::bounded_disc
                 ? solve_decoupled_disc(problem, impulse)
                 : not_applicable;
    default: return not_applicable;
  }
}

}  // namespace carom

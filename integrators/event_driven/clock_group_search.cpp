// Problem: the first event within a step: a gap that closes, a force that comes to its end, sliding that
// stops, a kink; first by polynomials, then by steps that end on it.

#include <carom/core/numerics/fall_search.h>
#include <carom/integrators/event_driven/clock_group.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double never = std::numeric_limits<double>::infinity();

// Forces this small against those around them are zero: answers of contact problems are certified to 1e-12.
constexpr double force_rounding = 1e-11;

// Where closed contacts follow from each other, forces just decided may lie this many times their rounding
// below zero.
constexpr double magnified_rounding = 16.0;

}  // namespace

/// Looks into the flow's last step.
class ClockGroup::Looker final : public StepLooker {
public:
  explicit Looker(ClockGroup& driver) : driver_(&driver) {}

  void look(double time, StepLook& out) override {
    driver_->sample(time);
    driver_->see(out);
  }

private:
  ClockGroup* driver_;
};

bool ClockGroup::sample_guards(double time, const double* y, Watch& out) {
  const bool solved = motion_.evaluate(time, y, true);
  const MotionWorkspace& work = work_->motion;
  const StateView state = work.trial.view();
  const double* const acceleration = work.acceleration.data();
  out.gaps.resize(motion_.pairs().size());
  out.gap_curvature_bound.resize(motion_.pairs().size());
  bool finite = solved;
  Constraint contact;
  for (std::size_t i = 0; i < out.gaps.size(); ++i) {
    if (is_active_[i] != 0) continue;
    motion_.contact(i, contact);
    const Constraint::Block& body = contact.blocks[0];
    const double spin = body.columns > 2 ? state.v[body.v + 2] : 0.0;
    // A point on an arm r that turns at w: its place has the sixth derivative w^6 r, its drift is w^2 r.
    out.gap_curvature_bound[i] = spin * spin * spin * spin * std::hypot(contact.drift[0], contact.drift[1]);
    out.gaps[i] = {contact.gap, contact.normal_velocity(state.v), contact.normal_acceleration(acceleration)};
    finite = finite && std::isfinite(out.gaps[i].second);
  }
  out.seen.time = time;
  if (motion_.guards().count() != 0) {
    const auto first = work.acceleration.begin() + assembly_->components()[motion_.component()].v.begin;
    out.path.time = time;
    out.path.y.assign(y, y + motion_.size());
    out.path.acceleration.assign(first, first + assembly_->components()[motion_.component()].v.size());
  }
  see(out.seen);
  for (const StepPolynomial::End& slip : out.seen.slips) finite = finite && std::isfinite(slip.first);
  out.noises.clear();
  // Where there are no loads all forces are rounding: of the mass times the tolerance of accelerations.
  const double no_force = 0.1 * motion_.absolute_tolerances().back();
  for (const ForceMargin& margin : work_->margins) {
    double size = 0.0;
    for (std::size_t i = margin.first; i < margin.last; ++i) {
      const ActiveContact& closed = motion_.active().list()[i];
      size += std::abs(closed.normal) + std::abs(closed.tangential);
    }
    out.noises.push_back(force_rounding * std::max(size, force_scale_) + no_force);
  }
  return finite;
}

/// Reads off the workspace, which holds an evaluation, what is watched beside gaps.
void ClockGroup::see(StepLook& out) {
  const MotionWorkspace& work = work_->motion;
  const auto& closed = motion_.active().list();
  out.slips.resize(closed.size());
  for (std::size_t i = 0; i < closed.size(); ++i) {
    const double sign = closed[i].slip_sign();
    out.slips[i] = {sign * closed[i].at.tangential_velocity(work.trial.v.data()),
                    sign * closed[i].at.tangential_acceleration(work.acceleration.data()), 0.0};
  }
  motion_.active().margins(work_->margins);
  out.margins.resize(work_->margins.size());
  for (std::size_t i = 0; i < out.margins.size(); ++i) out.margins[i] = work_->margins[i].margin;
  if (motion_.guards().count() != 0) motion_.read_guards(out.guards);
}

/// Brings the workspace to a time within the flow's last step.
void ClockGroup::sample(double time) {
  work_->y.resize(motion_.size());
  flow_->sample(time, work_->y);
  motion_.evaluate(time, work_->y.data(), true);
}

ClockGroup::Found ClockGroup::find_event() {
  passed_over_.assign(end_.gaps.size(), 0);
  forces_passed_.assign(end_.seen.margins.size(), 0);
  for (;;) {
    const Found rough = predict_event();
    if (!end_.seen.guards.empty() && leaps_over_loads(rough.time)) return {rough.time, Guard::leap, 0};
    if (rough.guard == Guard::nothing) return rough;
    const Found found = locate_event(rough);
    if (found.guard != Guard::restart) return first_of(rough, found);
    // A false alarm of a force at the very start: within such a step p = W_nn - s mu W_nt passes zero
    // together with the load, and the flow does not know the force in between.
    if (rough.guard == Guard::force && !(found.time > flow_->begin()) && !find_unbounded_force()) {
      forces_passed_[rough.which] = 1;
      continue;
    }
    if (rough.guard != Guard::gap) return found;
    // A false alarm of a gap that opens: in steps of low order there would be one after each restart.
    const StepPolynomial::End &start = start_.gaps[rough.which], &end = end_.gaps[rough.which];
    const bool opens =
        start.first >= 0.0 && end.first >= 0.0 && end.value >= level(rough.which) - options_.gap_tolerance;
    if (!opens) return found;
    passed_over_[rough.which] = 1;
  }
}

/// Gaps are foretold to rounding, other quantities to a part of a step: one that is located later than it was
/// foretold may lie behind the closing of a gap.
ClockGroup::Found ClockGroup::first_of(const Found& rough, const Found& found) {
  constexpr double as_foretold = 1e-9;  // of the step
  const double length = flow_->end() - flow_->begin();
  if (rough.guard == Guard::gap || found.time - rough.time <= as_foretold * length) return found;
  Found gap = found;
  predict_gaps(gap);
  if (gap.guard != Guard::gap) return found;
  const Found closing = locate_event(gap);
  return closing.guard == Guard::gap && closing.time < found.time ? closing : found;
}

/// True of a false alarm from which nothing is gained by going on anew.
bool ClockGroup::stands_still(const Found& found) const {
  constexpr double no_progress = 0.01;  // of the step
  const double begin = flow_->begin();
  return found.guard == Guard::restart && found.time - begin <= no_progress * (flow_->end() - begin);
}

/// The first event by the polynomials.
ClockGroup::Found ClockGroup::predict_event() {
  Found found{flow_->end(), Guard::nothing, 0};
  if (!motion_.pairs().empty()) predict_gaps(found);
  if (end_.seen.margins.empty() && end_.seen.guards.empty()) return found;
  Looker looker(*this);
  predict_forces(looker, found);
  if (!end_.seen.guards.empty()) predict_guards(looker, found);
  return found;
}

/// When a gap closes first. For a body that flies freely the error that turning makes is bounded beforehand.
void ClockGroup::predict_gaps(Found& found) {
  constexpr double fine = 1e-10;  // a gap this far off the polynomial still counts as found [m]
  constexpr int least_of_moving = 2;
  for (std::size_t i = 0; i < end_.gaps.size(); ++i) {
    if (is_active_[i] != 0 || passed_over_[i] != 0) continue;
    // Obstacles move unseen by the flow.
    const bool moving = detector_->moves(motion_.pairs()[i]);
    FallRule rule;
    rule.raise = gap_noise_ - level(i);
    rule.fine = fine;
    rule.clear_falls = false;  // of several gaps the first is wanted
    rule.measured = moving || !motion_.flies_freely();
    rule.least_depth = moving ? least_of_moving : 0;
    const double bend = std::max(start_.gap_curvature_bound[i], end_.gap_curvature_bound[i]);
    QuantityOf gap([&](double time) -> QuantityLook {
      sample(time);
      const MotionWorkspace& work = work_->motion;
      Constraint contact;
      motion_.contact(i, contact);
      return {time,
              {contact.gap, contact.normal_velocity(work.trial.v.data()),
               contact.normal_acceleration(work.acceleration.data())},
              bend};
    });
    const double until = found.guard == Guard::nothing ? never : found.time;
    const double time =
        FallSearch(gap, rule, until)
            .first({flow_->begin(), start_.gaps[i], bend}, {flow_->end(), end_.gaps[i], bend});
    if (time < until) found = {time, Guard::gap, i};
  }
}

/// When sliding stops, or a force comes to its end.
void ClockGroup::predict_forces(StepLooker& looker, Found& found) {
  constexpr int deepest = 6;  // forces without bound have no end of their own
  const auto search = [&](Guard guard, std::size_t which, const FallRule& rule, const auto& read) {
    QuantityOf quantity([&](double time) { return read(work_->looks.at(time, looker)); });
    const double until = found.guard == Guard::nothing ? never : found.time;
    const double time = FallSearch(quantity, rule, until).first(read(start_.seen), read(end_.seen));
    if (time < until) found = {time, guard, which};
  };
  const auto& closed = motion_.active().list();
  for (std::size_t i = 0; i < closed.size(); ++i) {
    if (closed[i].sticks() || closed[i].frictionless) continue;
    FallRule rule;
    rule.derivatives = 1;
    rule.fine = speed_noise();
    rule.raise = speed_noise() - slip_level(i);
    rule.deepest = deepest;
    search(Guard::slip, i, rule, [i](const StepLook& look) -> QuantityLook {
      return {look.time, look.slips[i], 0.0};
    });
  }
  for (std::size_t i = 0; i < end_.seen.margins.size(); ++i) {
    if (forces_passed_[i] != 0) continue;
    FallRule rule;
    rule.derivatives = 0;
    rule.fine = std::max(start_.noises[i], end_.noises[i]);
    rule.raise = rule.fine - force_level(i);
    rule.deepest = deepest;
    search(Guard::force, i, rule, [i](const StepLook& look) -> QuantityLook {
      return {look.time, {look.margins[i], 0.0, 0.0}, 0.0};
    });
  }
}

/// Where a gap that falls is an event: what separates from a little below zero (of two corners that hit at
/// almost the same time one is found late) does not fall through it once more.
double ClockGroup::level(std::size_t pair) const { return std::min(0.0, start_.gaps[pair].value); }

/// Likewise of sliding: what has just turned round may still creep the other way after a projection.
double ClockGroup::slip_level(std::size_t closed) const {
  return std::min(0.0, start_.seen.slips[closed].value);
}

/// And of forces, if by little.
double ClockGroup::force_level(std::size_t body) const {
  return std::clamp(start_.seen.margins[body], -magnified_rounding * start_.noises[body], 0.0);
}

/// The quantity of an event in the state of the workspace, and the size below which it counts as zero.
ClockGroup::Rest ClockGroup::rest_of(const Found& rough) {
  const MotionWorkspace& work = work_->motion;
  const double* const velocity = work.trial.v.data();
  if (rough.guard == Guard::gap) {
    Constraint contact;
    motion_.contact(rough.which, contact);
    return {contact.gap - level(rough.which), contact.normal_velocity(velocity), gap_noise_ / 16.0, true};
  }
  if (rough.guard == Guard::slip) {
    const ActiveContact& closed = motion_.active().list()[rough.which];
    return {closed.slip_sign() * closed.at.tangential_velocity(velocity) - slip_level(rough.which),
            closed.slip_sign() * closed.at.tangential_acceleration(work.acceleration.data()),
            speed_noise() / 16.0, true};
  }
  if (rough.guard == Guard::kink) {
    motion_.read_guards(guards_now_);
    const GuardMotion& guard = guards_now_[rough.which];
    return {rough.sign * guard.value, rough.sign * guard.first, gap_noise_ / 4.0,
            motion_.guards().has_motion(rough.which)};
  }
  motion_.active().margins(work_->margins);
  return {work_->margins[rough.which].margin - force_level(rough.which), 0.0,
          std::max(start_.noises[rough.which], end_.noises[rough.which]), false};
}

/// The event itself, by steps that end on it.
ClockGroup::Found ClockGroup::locate_event(const Found& rough) {
  constexpr int most_landings = 60;
  work_->y.resize(motion_.size());
  double low = flow_->begin(), high = flow_->end(), time = std::clamp(rough.time, low, high);
  const bool of_force = rough.guard == Guard::force, of_guard = rough.guard == Guard::kink;
  if (of_guard && guards_.passes_at_once({low, rough.which, rough.sign}, start_.seen.guards[rough.which],
                                         gap_noise_ / 4.0)) {
    time = high = low;
  }
  const double foretold = time;
  double f_low = 0.0, f_high = 0.0;
  bool below = false;  // something below zero was seen
  if (of_force) {
    f_low = start_.seen.margins[rough.which] - force_level(rough.which);
    f_high = end_.seen.margins[rough.which] - force_level(rough.which);
    below = f_high < 0.0;
  } else if (of_guard) {
    f_low = rough.sign * start_.seen.guards[rough.which].value;
    f_high = rough.sign * end_.seen.guards[rough.which].value;
    below = f_high < 0.0;
  }
  for (int i = 0; i < most_landings; ++i) {
    flow_->land(time, work_->y);
    motion_.evaluate(time, work_->y.data(), true);
    const Rest rest = rest_of(rough);
    // Between the ends of steps of low order a gap may seem to fall while its rate says that it opens.
    const bool opens = rough.guard == Guard::gap && rest.rate >= 0.0 && start_.gaps[rough.which].first >= 0.0;
    if ((std::abs(rest.value) <= rest.noise && !opens) || low == high) {
      landed_at_ = time;
      landed_.assign(work_->y.begin(), work_->y.end());
      return {time, rough.guard, rough.which, rough.sign};
    }
    if (rest.has_rate && rest.value > 0.0 && rest.rate >= 0.0) return {time, Guard::restart, 0};
    if (rest.value > 0.0 || opens) {
      low = time;
      f_low = rest.value;
    } else {
      high = time;
      f_high = rest.value;
      below = true;
    }
    if (high - low <= 2.0 * epsilon * std::max(1.0, std::abs(high))) break;
    double next =
        rest.has_rate ? time - rest.value / rest.rate : low + (high - low) * f_low / (f_low - f_high);
    if (!(next > low && next < high) || opens || i % 8 == 7) next = 0.5 * (low + high);
    time = next;
  }
  // From large to large of the other sign: no zero of the forces but a pole.
  const double large = without_bound * force_scale_;
  if (of_force && f_low > large && f_high < -large) return {low, Guard::painleve, rough.which};
  // Nothing there: go on from where it was foretold, for behind it others may have been.
  return below ? Found{high, rough.guard, rough.which, rough.sign} : Found{foretold, Guard::restart, 0};
}

}  // namespace carom

// Problem: the first event within a step: a gap that closes, a force that comes to its end, sliding that
// stops, a kink; first by polynomials, then by steps that end on it.

#include <carom/integrators/island_driver.h>

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

// Numbers of kinks this small against their size over the step are zero.
constexpr double kink_rounding = 1e-13;

}  // namespace

/// What has no derivatives at hand is known by more values.
void IslandDriver::sample_step() {
  if (start_.margins.empty() && start_.kinks.empty()) return;
  const double begin = flow_->begin(), length = flow_->end() - begin;
  between_.front().margins = start_.margins;
  between_.front().kinks = start_.kinks;
  between_.back().margins = end_.margins;
  between_.back().kinks = end_.kinks;
  work_->y.resize(motion_.size());
  for (std::size_t i = 1; i + 1 < samples; ++i) {
    const double time = begin + length * static_cast<double>(i) / static_cast<double>(samples - 1);
    flow_->sample(time, work_->y);
    motion_.evaluate(time, work_->y.data(), true);
    motion_.kinks(between_[i].kinks);
    motion_.closed().margins(work_->margins);
    between_[i].margins.clear();
    for (const ForceMargin& margin : work_->margins) between_[i].margins.push_back(margin.margin);
  }
}

bool IslandDriver::watch(double time, const double* y, Watch& out) {
  const bool solved = motion_.evaluate(time, y, true);
  const MotionWorkspace& work = work_->motion;
  const StateView state = work.trial.view();
  const double* const acceleration = work.acceleration.data();
  out.gaps.resize(motion_.pairs().size());
  out.bends.resize(motion_.pairs().size());
  bool finite = solved;
  Contact contact;
  for (std::size_t i = 0; i < out.gaps.size(); ++i) {
    if (closed_at_[i] != 0) continue;
    motion_.contact(i, contact);
    const double spin = contact.columns > 2 ? state.v[contact.v + 2] : 0.0;
    // A point on an arm r that turns at w: its place has the sixth derivative w^6 r, its drift is w^2 r.
    out.bends[i] = spin * spin * spin * spin * std::hypot(contact.drift[0], contact.drift[1]);
    out.gaps[i] = {contact.gap, contact.velocity(0, state.v), contact.acceleration(0, acceleration)};
    finite = finite && std::isfinite(out.gaps[i].second);
  }
  out.slips.clear();
  for (const ClosedContact& closed : motion_.closed().list()) {
    const double sign = closed.slip_sign();
    out.slips.push_back(
        {sign * closed.at.velocity(1, state.v), sign * closed.at.acceleration(1, acceleration), 0.0});
    finite = finite && std::isfinite(out.slips.back().first);
  }
  motion_.closed().margins(work_->margins);
  out.margins.clear();
  out.noises.clear();
  // Where there are no loads all forces are rounding: of the mass times the tolerance of accelerations.
  const double no_force = 0.1 * motion_.absolute_tolerances().back();
  for (const ForceMargin& margin : work_->margins) {
    double size = 0.0;
    for (std::size_t i = margin.first; i < margin.last; ++i) {
      const ClosedContact& closed = motion_.closed().list()[i];
      size += std::abs(closed.normal) + std::abs(closed.tangential);
    }
    out.margins.push_back(margin.margin);
    out.noises.push_back(force_rounding * std::max(size, force_scale_) + no_force);
  }
  motion_.kinks(out.kinks);
  return finite;
}

IslandDriver::Found IslandDriver::find_event() {
  passed_over_.assign(end_.gaps.size(), 0);
  forces_passed_.assign(end_.margins.size(), 0);
  for (;;) {
    const Found rough = foretell();
    if (rough.guard == Guard::nothing) return rough;
    const Found found = locate(rough);
    if (found.guard != Guard::restart) return found;
    // A false alarm of a force at the very start: within such a step p = W_nn - s mu W_nt passes zero
    // together with the load, and the flow does not know the force in between.
    if (rough.guard == Guard::force && !(found.time > flow_->begin()) && !find_jam()) {
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

/// True of a false alarm from which nothing is gained by going on anew.
bool IslandDriver::stands_still(const Found& found) const {
  constexpr double no_progress = 0.01;  // of the step
  const double begin = flow_->begin();
  return found.guard == Guard::restart && found.time - begin <= no_progress * (flow_->end() - begin);
}

/// The first event by the polynomials.
IslandDriver::Found IslandDriver::foretell() {
  const double begin = flow_->begin(), length = flow_->end() - begin;
  double first = never;
  Found found{flow_->end(), Guard::nothing, 0};
  const auto take = [&](double tau, Guard guard, std::size_t which) {
    if (!(tau < first)) return;
    first = tau;
    found = {begin + tau * length, guard, which};
  };
  const auto scaled = [length](StepPolynomial::End end) {
    end.first *= length;
    end.second *= length * length;
    return end;
  };
  for (std::size_t i = 0; i < end_.gaps.size(); ++i) {
    if (closed_at_[i] != 0 || passed_over_[i] != 0) continue;
    const double time = first_closing(i, {begin, start_.gaps[i]}, {flow_->end(), end_.gaps[i]}, 0);
    take((time - begin) / length, Guard::gap, i);
  }
  const auto& closed = motion_.closed().list();
  for (std::size_t i = 0; i < closed.size(); ++i) {
    if (closed[i].sticks() || closed[i].slippery) continue;
    const double noise = speed_noise();
    const auto slip =
        StepPolynomial::cubic(scaled(start_.slips[i]), scaled(end_.slips[i])).raised(noise - slip_level(i));
    take(slip.first_fall(), Guard::slip, i);
  }
  for (std::size_t i = 0; i < end_.margins.size(); ++i) {
    if (forces_passed_[i] != 0) continue;
    std::array<double, samples> values{};
    for (std::size_t k = 0; k < samples; ++k) values[k] = between_[k].margins[i];
    const double noise = std::max(start_.noises[i], end_.noises[i]);
    take(StepPolynomial::through(values).raised(noise - force_level(i)).first_fall(), Guard::force, i);
  }
  for (std::size_t i = 0; i < end_.kinks.size(); ++i) {
    std::array<double, samples> values{};
    double size = 0.0;
    for (std::size_t k = 0; k < samples; ++k) {
      values[k] = between_[k].kinks[i];
      size = std::max(size, std::abs(values[k]));
    }
    const double noise = kink_rounding * size;
    // One that has just been passed is at zero: the side it goes to counts.
    const double sign = std::copysign(1.0, std::abs(values[0]) > noise ? values[0] : values[1]);
    for (double& value : values) value *= sign;
    const double before = first;
    take(StepPolynomial::through(values).raised(noise).first_fall(), Guard::kink, i);
    if (first < before) found.sign = sign;
  }
  return found;
}

IslandDriver::GapLook IslandDriver::look_at_gap(std::size_t pair, double time) {
  work_->y.resize(motion_.size());
  flow_->sample(time, work_->y);
  motion_.evaluate(time, work_->y.data(), true);
  const MotionWorkspace& work = work_->motion;
  Contact contact;
  motion_.contact(pair, contact);
  return {time,
          {contact.gap, contact.velocity(0, work.trial.v.data()),
           contact.acceleration(0, work.acceleration.data())}};
}

/// Where a gap that falls is an event: what separates from a little below zero (of two corners that hit at
/// almost the same time one is found late) does not fall through it once more.
double IslandDriver::level(std::size_t pair) const { return std::min(0.0, start_.gaps[pair].value); }

/// Likewise of sliding: what has just turned round may still creep the other way after a projection.
double IslandDriver::slip_level(std::size_t closed) const {
  return std::min(0.0, start_.slips[closed].value);
}

/// And of forces, if by little.
double IslandDriver::force_level(std::size_t body) const {
  return std::clamp(start_.margins[body], -magnified_rounding * start_.noises[body], 0.0);
}

/// When a gap closes first. Between two looks it is taken for a polynomial of degree 5; where that might hide
/// a root, a third look is taken in the middle. For a body that flies freely what turning does to the
/// polynomial is bounded beforehand, else the third look tells how far it is off.
double IslandDriver::first_closing(std::size_t pair, const GapLook& from, const GapLook& to, int depth) {
  constexpr double fine = 1e-10;             // a gap this far off the polynomial still counts as found [m]
  constexpr double interpolation = 46080.0;  // 6! 2^6: error of the quintic over its sixth derivative
  constexpr int deepest = 14, least_of_moving = 2;
  const double length = to.time - from.time;
  const auto scaled = [length](StepPolynomial::End end) {
    end.first *= length;
    end.second *= length * length;
    return end;
  };
  const auto gap = StepPolynomial::quintic(scaled(from.gap), scaled(to.gap));
  // Obstacles move unseen by the flow.
  const bool moving = finder_->moves(motion_.pairs()[pair]);
  const bool measured = moving || !motion_.flies_freely();
  double error = std::pow(length, 6) * std::max(start_.bends[pair], end_.bends[pair]) / interpolation;
  const bool deep = !moving || depth >= least_of_moving;
  // Far away against all that it does.
  if (deep && gap.least() > std::max(error, gap.most() - gap.least())) return never;
  GapLook middle{};
  if (measured) {
    middle = look_at_gap(pair, from.time + 0.5 * length);
    error += 4.0 * std::abs(gap.value(0.5) - middle.gap.value);
  }
  if (deep && gap.least() > error) return never;
  if ((deep && error <= fine) || depth == deepest) {
    const double tau = gap.raised(gap_noise_ - level(pair)).first_fall();
    return tau < never ? from.time + tau * length : never;
  }
  if (!measured) middle = look_at_gap(pair, from.time + 0.5 * length);
  const double first = first_closing(pair, from, middle, depth + 1);
  return first < never ? first : first_closing(pair, middle, to, depth + 1);
}

/// The event itself, by steps that end on it.
IslandDriver::Found IslandDriver::locate(const Found& rough) {
  constexpr int most_landings = 60;
  work_->y.resize(motion_.size());
  double low = flow_->begin(), high = flow_->end(), time = std::clamp(rough.time, low, high);
  const double foretold = time;
  double f_low = 0.0, f_high = 0.0;
  bool below = false;  // something below zero was seen
  if (rough.guard == Guard::force) {
    f_low = start_.margins[rough.which] - force_level(rough.which);
    f_high = end_.margins[rough.which] - force_level(rough.which);
    below = f_high < 0.0;
  } else if (rough.guard == Guard::kink) {
    f_low = rough.sign * start_.kinks[rough.which];
    f_high = rough.sign * end_.kinks[rough.which];
    below = f_high < 0.0;
  }
  const bool by_values = rough.guard == Guard::force || rough.guard == Guard::kink;
  for (int i = 0; i < most_landings; ++i) {
    flow_->land(time, work_->y);
    double value = 0.0, rate = 0.0, noise = 0.0;
    motion_.evaluate(time, work_->y.data(), true);
    const StateView state = work_->motion.trial.view();
    if (rough.guard == Guard::gap) {
      Contact contact;
      motion_.contact(rough.which, contact);
      value = contact.gap - level(rough.which);
      rate = contact.velocity(0, state.v);
      noise = gap_noise_ / 16.0;
    } else if (rough.guard == Guard::slip) {
      const ClosedContact& closed = motion_.closed().list()[rough.which];
      value = closed.slip_sign() * closed.at.velocity(1, state.v) - slip_level(rough.which);
      rate = closed.slip_sign() * closed.at.acceleration(1, work_->motion.acceleration.data());
      noise = speed_noise() / 16.0;
    } else if (rough.guard == Guard::kink) {
      motion_.kinks(kinks_);
      value = rough.sign * kinks_[rough.which];
      noise = 0.25 * kink_rounding * std::max(std::abs(f_low), std::abs(f_high));
    } else {
      motion_.closed().margins(work_->margins);
      value = work_->margins[rough.which].margin - force_level(rough.which);
      noise = std::max(start_.noises[rough.which], end_.noises[rough.which]);
    }
    // Between the ends of steps of low order a gap may seem to fall while its rate says that it opens.
    const bool opens = rough.guard == Guard::gap && rate >= 0.0 && start_.gaps[rough.which].first >= 0.0;
    if (std::abs(value) <= noise && !opens) {
      landed_at_ = time;
      landed_.assign(work_->y.begin(), work_->y.end());
      return {time, rough.guard, rough.which, rough.sign};
    }
    if (!by_values && value > 0.0 && rate >= 0.0) return {time, Guard::restart, 0};
    if (value > 0.0 || opens) {
      low = time;
      f_low = value;
    } else {
      high = time;
      f_high = value;
      below = true;
    }
    if (high - low <= 2.0 * epsilon * std::max(1.0, std::abs(high))) break;
    double next = by_values ? low + (high - low) * f_low / (f_low - f_high) : time - value / rate;
    if (!(next > low && next < high) || opens || i % 8 == 7) next = 0.5 * (low + high);
    time = next;
  }
  // From large to large of the other sign: no zero of the forces but a pole.
  const double large = without_bound * force_scale_;
  if (rough.guard == Guard::force && f_low > large && f_high < -large) {
    return {low, Guard::jam, rough.which};
  }
  // Nothing there: go on from where it was foretold, for behind it others may have been.
  return below ? Found{high, rough.guard, rough.which, rough.sign} : Found{foretold, Guard::restart, 0};
}

}  // namespace carom

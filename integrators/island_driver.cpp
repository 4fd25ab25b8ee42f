// Problem: an island's smooth phases: make steps, find the first event in each, be looked at in between.

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

// Numbers of kinks this small against their size over the step are zero.
constexpr double kink_rounding = 1e-13;

}  // namespace

IslandDriver::IslandDriver(const Assembly& assembly, const ContactFinder& finder, const EventDriven& options,
                           Index island, DriverWorkspace& work)
    : assembly_(&assembly),
      finder_(&finder),
      options_(options),
      work_(&work),
      motion_(assembly, finder, island, options, work.motion),
      y_(motion_.size()),
      seen_(motion_.size()) {
  closed_at_.assign(motion_.pairs().size(), 0);
  if (assembly.layout()->dimension() == 3 && !motion_.pairs().empty()) {
    // Sliding in two directions has modes that are not written yet; taken as planar it would stick at once.
    const BodyId body = assembly.layout()->id(motion_.pairs().front().body);
    throw ModelError(
        "event-driven mode: " + assembly.system().name(body) +
        " may touch an obstacle in space; allowed: contact in the plane (time stepping does both)");
  }
}

void IslandDriver::start(const State& state, const ContactModes& present) {
  if (!flow_) flow_ = make_flow(options_.method, motion_, options_.relative_tolerance);
  time_ = looked_at_ = state.time;
  landed_at_ = never;
  motion_.gather(state, y_);
  seen_ = y_;
  delivered_ = {};
  pending_ = resting_ = in_phase_ = false;
  fresh_ = true;
  step_ = 0.0;
  last_impacts_.clear();
  breaking_.clear();
  lifting_.clear();
  counted_ = 0;
  window_start_ = time_;

  motion_.closed().list().clear();
  motion_.evaluate(time_, y_.data(), false);
  Contact contact;
  for (std::size_t i = 0; i < motion_.pairs().size(); ++i) {
    motion_.contact(i, contact);
    if (contact.gap < -options_.gap_tolerance) {
      throw ModelError("event-driven mode: gap of " + finder_->name(contact.key) + " is " +
                       to_text(contact.gap) + " m at the start; allowed: not below -gap_tolerance, " +
                       to_text(-options_.gap_tolerance) + " m");
    }
    const auto known = std::find_if(present.begin(), present.end(),
                                    [&](const auto& entry) { return entry.first == contact.key; });
    if (known == present.end() || known->second == ContactMode::open) continue;
    ClosedContact& closed = motion_.closed().list().emplace_back();
    closed.pair = motion_.pairs()[i];
    closed.mode = known->second;
    closed.at = contact;
  }
}

void IslandDriver::advance(double target, DriverNews& news) {
  const auto look = [&](std::span<const double> y) {
    for (Index line = 0; line < work_lines; ++line) {
      const double value = y[motion_.work_place(static_cast<WorkLine>(line))];
      constexpr std::array flows{EnergyFlow::dashpot, EnergyFlow::sliding, EnergyFlow::external};
      news.flows[flows[line]] += value - delivered_[line];
      delivered_[line] = value;
    }
    looked_at_ = target;
  };
  for (;;) {
    if (!in_phase_) begin_phase(news);
    if (resting_) time_ = target;
    if (time_ == target) {
      seen_ = y_;
      look(seen_);
      return;
    }
    if (!pending_) take_step();
    const double until = next_.guard == Guard::nothing ? flow_->end() : next_.time;
    if (target < until) {
      flow_->land(target, seen_);
      look(seen_);
      return;
    }
    if (next_.guard == Guard::nothing) {
      accept_step(news);
    } else {
      go_to_event(news);
    }
  }
}

void IslandDriver::write(State& state, ContactModes& modes) const {
  motion_.scatter(seen_, state);
  for (const ClosedContact& contact : motion_.closed().list())
    modes.emplace_back(contact.at.key, contact.mode);
}

double IslandDriver::longest_step() const {
  // Free flight would allow steps of any length; gaps would then be small differences of large numbers.
  constexpr double longest_flight = 1.0;
  return motion_.depends_on_time() ? options_.longest_step : longest_flight;
}

void IslandDriver::take_step() {
  const std::vector<double>& breaks = motion_.breaks();
  const auto due = std::upper_bound(breaks.begin(), breaks.end(), time_);
  const double until_break = due == breaks.end() ? never : *due - time_;
  try {
    flow_->advance(std::min(longest_step(), until_break));
  } catch (const SolverError& error) {
    fail(error.what(), {});
  }
  if (!watch(flow_->end(), flow_->state().data(), end_)) fail("the loads are not finite", {});
  sample_step();
  landed_at_ = never;
  next_ = find_event();
  const bool at_break = until_break < never && flow_->end() >= *due - 2.0 * epsilon * std::abs(*due);
  if (next_.guard == Guard::nothing && at_break) next_ = {*due, Guard::law, 0};
  pending_ = true;
}

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
  for (;;) {
    const Found rough = foretell();
    if (rough.guard == Guard::nothing) return rough;
    const Found found = locate(rough);
    if (rough.guard != Guard::gap || found.guard != Guard::restart) return found;
    // A false alarm of a gap that opens: in steps of low order there would be one after each restart.
    const StepPolynomial::End &start = start_.gaps[rough.which], &end = end_.gaps[rough.which];
    const bool opens =
        start.first >= 0.0 && end.first >= 0.0 && end.value >= level(rough.which) - options_.gap_tolerance;
    if (!opens) return found;
    passed_over_[rough.which] = 1;
  }
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
    std::array<double, samples> values{};
    for (std::size_t k = 0; k < samples; ++k) values[k] = between_[k].margins[i];
    const double noise = std::max(start_.noises[i], end_.noises[i]);
    take(StepPolynomial::through(values).raised(noise).first_fall(), Guard::force, i);
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
    f_low = start_.margins[rough.which];
    f_high = end_.margins[rough.which];
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
      value = work_->margins[rough.which].margin;
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
  // Nothing there: go on from where it was foretold, for behind it others may have been.
  return below ? Found{high, rough.guard, rough.which, rough.sign} : Found{foretold, Guard::restart, 0};
}

void IslandDriver::accept_step(DriverNews& news) {
  time_ = flow_->end();
  y_.assign(flow_->state().begin(), flow_->state().end());
  pending_ = false;
  std::swap(start_, end_);
  if (motion_.closed().list().empty()) return;
  motion_.evaluate(time_, y_.data(), true);
  if (settle(news)) flow_->correct(y_);
}

bool IslandDriver::settle(DriverNews& news) {
  bool changed = false;
  news.flows[EnergyFlow::projection] += motion_.project(y_, changed, news.shift);
  return changed;
}

void IslandDriver::go_to_event(DriverNews& news) {
  time_ = next_.time;
  if (landed_at_ == time_) {
    y_ = landed_;
  } else {
    flow_->land(std::min(time_, flow_->end()), y_);
  }
  pending_ = in_phase_ = false;
  step_ = flow_->next_step();
  motion_.evaluate(time_, y_.data(), true);
  count_event();
  // Events of several bodies at one instant are decided one after the other: what gave way goes on doing so.
  if (time_ != gave_way_at_) {
    breaking_.clear();
    lifting_.clear();
    gave_way_at_ = time_;
  }
  const auto& closed = motion_.closed().list();
  if (next_.guard == Guard::force) {
    motion_.closed().margins(work_->margins);
    const ForceMargin& at = work_->margins[next_.which];
    const double noise = 4.0 * std::max(start_.noises[next_.which], end_.noises[next_.which]);
    for (std::size_t i = at.first; i < at.last; ++i) {
      const ClosedContact& c = closed[i];
      if (c.normal <= at.margin + noise && c.normal <= noise) {
        lifting_.push_back(c.pair);
      } else if (c.sticks() && c.friction * c.normal - std::abs(c.tangential) <= at.margin + noise) {
        breaking_.push_back({c.pair, c.tangential});
      }
    }
  }
  if (next_.guard == Guard::law || next_.guard == Guard::kink) {
    const bool kink = next_.guard == Guard::kink;
    EventRecord& event = tell(kink ? EventKind::kink : EventKind::law_break, {}, news);
    if (kink) event.element = motion_.kink_element(next_.which);
  }
  stopped_ = next_.guard == Guard::slip ? closed[next_.which].pair : ContactPair{};
  settle(news);
  begin_phase(news);
}

bool IslandDriver::at_rest() {
  constexpr double no_speed = 1e-14, no_acceleration = 1e-12;
  if (motion_.depends_on_time() || !assembly_->islands()[motion_.island()].z.empty()) return false;
  const Range v = assembly_->islands()[motion_.island()].v;
  const MotionWorkspace& work = work_->motion;
  double fastest = 0.0;
  for (Index i = v.begin; i < v.end; ++i)
    fastest = std::max(fastest, std::abs(work.trial.v[i]) * work.lengths[i]);
  if (fastest > no_speed) return false;
  double free = 0.0, left = 0.0;
  motion_.evaluate(time_, y_.data(), false);
  for (Index i = v.begin; i < v.end; ++i)
    free = std::max(free, std::abs(work.acceleration[i]) * work.lengths[i]);
  motion_.evaluate(time_, y_.data(), true);
  for (Index i = v.begin; i < v.end; ++i)
    left = std::max(left, std::abs(work.acceleration[i]) * work.lengths[i]);
  return left <= no_acceleration * free;
}

}  // namespace carom

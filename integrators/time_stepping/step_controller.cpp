// Problem: choose the length of steps by the error of the smooth motion.

#include <carom/core/run_error.h>
#include <carom/integrators/time_stepping/added_reports.h>
#include <carom/integrators/time_stepping/step_controller.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace carom {

namespace {

// Of the length that the error allows, for the error of its estimate; and bounds of one change.
constexpr double caution = 0.9, most_growth = 2.0, most_shrinking = 0.2;

/// Whether the same contacts took part, without an impact.
bool same_contacts(const StepReport& a, const StepReport& b) {
  const auto same = [](const ContactRecord& x, const ContactRecord& y) {
    return x.key == y.key && !x.impact && !y.impact;
  };
  return std::equal(a.contacts.begin(), a.contacts.end(), b.contacts.begin(), b.contacts.end(), same);
}

/// Sorts keys, and leaves each once: how often a contact is hit depends on the step.
void sort_once(std::vector<ConstraintKey>& keys) {
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
}

/// Adds the contacts that were hit.
void add_impacts(const StepReport& report, std::vector<ConstraintKey>& keys) {
  for (const ContactRecord& contact : report.contacts) {
    if (contact.impact) keys.push_back(contact.key);
  }
}

/// Finds the contacts that are not among those hit, ascending, each once.
void find_others(const StepReport& report, const std::vector<ConstraintKey>& hit,
                 std::vector<ConstraintKey>& keys) {
  keys.clear();
  for (const ContactRecord& contact : report.contacts) {
    if (!std::binary_search(hit.begin(), hit.end(), contact.key)) keys.push_back(contact.key);
  }
  sort_once(keys);
}

}  // namespace

StepController::StepController(const Assembly& assembly, const TimeStepping& options)
    : assembly_(&assembly), options_(options) {
  if (!options.control) return;
  lengths_ = assembly.length_scales();
  slip_changes_.emplace(assembly);
}

void StepController::step(MakeStep make, State& state, Companion& companion, double limit,
                          StepReport& report) {
  const double wanted = companion.next_step > 0.0 ? companion.next_step : options_.step;
  const double room = limit - state.time;
  // Neither a sliver before the limit nor a step beyond it.
  double step = wanted >= room ? room : std::min(wanted, 0.5 * room);
  for (int rejected = 0;; ++rejected) {
    if (!(state.time + 0.5 * step > state.time)) fail_short(state.time, step);
    const Attempt attempt =
        this->attempt(make, state, companion, step, step == room ? limit : state.time + step);
    if (attempt.accepted) {
      std::swap(state, halves_.state);
      std::swap(companion, halves_.companion);
      // A step cut for the limit's sake says nothing against the length before.
      const bool cut = step < wanted && rejected == 0;
      const double next = cut ? std::max(attempt.next, wanted) : attempt.next;
      companion.next_step = std::clamp(next, options_.control->smallest, options_.control->largest);
      companion.statistics.rejected_steps += rejected;
      if (!attempt.compared) ++companion.statistics.steps_across_impacts;
      merge(report);
      report.step = step;
      report.control = {attempt.error, rejected, !attempt.compared, companion.next_step};
      return;
    }
    if (attempt.compared && step <= options_.control->smallest)
      fail_smallest(state.time, step, attempt.error);
    step = std::max(attempt.next, std::min(options_.control->smallest, step));
  }
}

/// Makes a step, judges it, and finds the length to go on with.
StepController::Attempt StepController::attempt(MakeStep make, const State& state, const Companion& companion,
                                                double step, double end) {
  Attempt made;
  Comparison comparison = Comparison::nothing;
  try {
    comparison = try_step(make, state, companion, step, end);
  } catch (const RunError&) {
    // A shorter step may succeed; at the smallest the error is the caller's.
    if (step <= options_.control->smallest) throw;
    made.next = most_shrinking * step;
    return made;
  }
  made.accepted = true;
  made.next = step;
  if (comparison == Comparison::error) judge(step, made);
  if (comparison == Comparison::least_error) judge_across_impacts(step, made);
  return made;
}

/// Judges a step without impacts.
void StepController::judge(double step, Attempt& made) const {
  const double tolerance = options_.control->tolerance;
  estimate(step, made);
  const double order = made.changed ? 2.0 : 3.0;  // of the error of one step
  const double factor =
      made.error > 0.0 ? caution * std::pow(tolerance / made.error, 1.0 / order) : most_growth;
  if (made.changed && made.error > tolerance && step <= options_.control->smallest) {
    // Sliding that ends at once, whatever the step: no shorter one would tell more.
    made.changed = false;
    made.error = 0.0;
    return;
  }
  made.compared = true;
  made.accepted = made.error <= tolerance;
  made.next = step * std::clamp(factor, most_shrinking, made.accepted ? most_growth : caution);
}

/// Judges a step with the same impacts as its halves: too long for the motion around them, it is tried
/// shorter. The error that is reported stays unknown.
void StepController::judge_across_impacts(double step, Attempt& made) const {
  constexpr double order = 2.0;  // of what an impact within a step leaves
  const double tolerance = options_.control->tolerance, least = difference(step);
  if (least <= tolerance || step <= options_.control->smallest) return;
  made.accepted = false;
  made.next = step * std::clamp(caution * std::pow(tolerance / least, 1.0 / order), most_shrinking, caution);
}

void StepController::fail_smallest(double time, double step, double error) const {
  SolverFailure failure;
  failure.time = time;
  failure.step = step;
  failure.residual = error;
  throw RunError("time stepping at t = " + to_text(time) + " s: error " + to_text(error) +
                     " m at the smallest step, " + to_text(step) +
                     " s; allowed: " + to_text(options_.control->tolerance) + " m",
                 std::move(failure));
}

void StepController::fail_short(double time, double step) {
  SolverFailure failure;
  failure.time = time;
  failure.step = step;
  throw RunError("time stepping at t = " + to_text(time) + " s: a step of " + to_text(step) +
                     " s is lost in the rounding of time; allowed: steps that move it (control.smallest)",
                 std::move(failure));
}

/// Makes the step at once and in halves. Returns what their difference tells.
StepController::Comparison StepController::try_step(MakeStep make, const State& state,
                                                    const Companion& companion, double step, double end) {
  whole_.state = state;
  whole_.companion = companion;
  halves_.state = state;
  halves_.companion = companion;
  make(halves_.state, halves_.companion, 0.5 * step, state.time + 0.5 * step, first_);
  const SlidStep first{state, companion.modes, halves_.state, halves_.companion.modes, first_};
  changed_speed_ = slip_changes_->largest_speed(first);
  if (slip_changes_->needs_states()) middle_ = halves_.state;
  modes_of_first_ = halves_.companion.modes;
  make(halves_.state, halves_.companion, 0.5 * step, end, second_);
  const SlidStep second{middle_, modes_of_first_, halves_.state, halves_.companion.modes, second_};
  changed_speed_ = std::max(changed_speed_, slip_changes_->largest_speed(second));
  make(whole_.state, whole_.companion, step, end, of_whole_);
  if (same_contacts(of_whole_, first_) && same_contacts(of_whole_, second_)) return Comparison::error;
  return same_impacts() ? Comparison::least_error : Comparison::nothing;
}

/// Whether the whole step and the halves have the same impacts, and the same contacts that last besides.
bool StepController::same_impacts() {
  keys_.hit.clear();
  keys_.of_halves.clear();
  add_impacts(of_whole_, keys_.hit);
  if (keys_.hit.empty()) return false;
  add_impacts(first_, keys_.of_halves);
  add_impacts(second_, keys_.of_halves);
  sort_once(keys_.hit);
  sort_once(keys_.of_halves);
  if (keys_.hit != keys_.of_halves) return false;
  // A contact that was hit may last afterwards or not.
  find_others(of_whole_, keys_.hit, keys_.of_whole);
  for (const StepReport* half : {&first_, &second_}) {
    find_others(*half, keys_.hit, keys_.of_halves);
    if (keys_.of_whole != keys_.of_halves) return false;
  }
  return true;
}

/// Whether the whole step had other modes than one of its halves.
bool StepController::modes_differ() const {
  return whole_.companion.modes != modes_of_first_ || whole_.companion.modes != halves_.companion.modes;
}

/// Error of the halves.
void StepController::estimate(double step, Attempt& made) const {
  constexpr double smooth = 1.0 / 3.0;  // of the halves in the difference: C h^3/4 of 3 C h^3/4
  made.changed = changed_speed_ > 0.0 || modes_differ();
  made.error = std::max((made.changed ? 1.0 : smooth) * difference(step), 0.5 * step * changed_speed_);
}

/// Difference of the whole step and the halves, the largest of all coordinates.
double StepController::difference(double step) const {
  double largest = 0.0;
  const auto take = [&](double difference, double length) {
    largest = std::max(largest, std::abs(difference) * length);
  };
  for (const BodySlot& body : assembly_->layout()->bodies()) {
    // Coordinates without a velocity of their own (unit quaternions) are judged as they are.
    for (Index i = 0; i < body.q_size; ++i) {
      const double length = i < body.v_size ? lengths_[body.v + i] : 1.0;
      take(whole_.state.q[body.q + i] - halves_.state.q[body.q + i], length);
    }
    for (Index i = 0; i < body.v_size; ++i) {
      take(step * (whole_.state.v[body.v + i] - halves_.state.v[body.v + i]), lengths_[body.v + i]);
    }
  }
  return largest;
}

void StepController::merge(StepReport& report) {
  first_.findings.swap(report.findings);
  std::swap(report, first_);
  add(second_, report);
}

}  // namespace carom

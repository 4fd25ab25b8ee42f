// Problem: an explicit Runge-Kutta method of order 5 that is started anew for the price of one evaluation,
// with the motion known everywhere within a step. Steps are those of ARKODE's ERKStep.

#include <carom/integrators/flow/dormand_prince.h>
#include <carom/integrators/flow/sundials_flow.h>
#include <carom/integrators/flow/sundials_loops.h>
#include <carom/integrators/flow/sundials_stepper.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace carom {

namespace {

class RungeKuttaFlow final : public SundialsFlow {
public:
  RungeKuttaFlow(FlowProblem& problem, double relative_tolerance)
      : SundialsFlow(problem, relative_tolerance),
        stepper_(link_, begin_vector_.get()),
        known_slope_(link_.size()),
        scratch_(slopes_kept * link_.size()) {}

private:
  int step(double longest, double& reached) override;
  void forget() override {
    restart_ = true;
    resumed_ = false;
  }
  void shift(std::span<const double>) override { forget(); }
  [[nodiscard]] bool starts_anew() const override { return restart_ && !resumed_; }
  [[nodiscard]] std::size_t history_size() const override { return link_.size() + 1; }
  void record_history(double* out) const override;
  void restore_history(const double* from) override;
  void interpolate(double time, double* y) override;
  void integrate_to(double time, double* y) override;

  [[nodiscard]] double guess_first_step(double longest);
  void make_polynomial();
  void evaluate_polynomial(double s, double* y) const;

  // Rates of a step that are needed at a time: the last ones are made when the second are of no more use.
  static constexpr std::size_t slopes_kept = dormand_prince::stages - 2;

  /// Array i of the memory that lasts for one call, i < slopes_kept.
  [[nodiscard]] double* scratch(std::size_t i) { return scratch_.data() + i * link_.size(); }

  Stepper stepper_;
  bool restart_ = true;
  bool resumed_ = false;  // the restart is to be none: the next step is the one after that of another flow,
  std::vector<double> known_slope_;  // with these rates at its beginning,
  double known_error_ = 0.0;         // after a step with this error
  bool polynomial_made_ = false;
  // y(s) = y_0 + s (slope + s (bend + s change)) + s^2 (1-s)^2 (even + (2 s - 1) odd),  s from 0 to 1: all
  // slopes, then all bends, ... Empty until asked for: where nothing may happen within a step nobody does.
  static constexpr std::size_t coefficients = 5;
  std::vector<double> polynomial_;
  std::vector<double> scratch_;
};

// E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, section II.4. ARKODE's own
// guess is that of a method of order 1 and costs eight steps more.
double RungeKuttaFlow::guess_first_step(double longest) {
  const double* const y = begin_state_.data();
  double* const first = scratch(0);
  double* const second = scratch(1);
  double* const place = scratch(2);
  if (!link_.evaluate(begin_, y, first)) return longest;  // the step will meet it again
  const double size = link_.in_tolerances(y, y), speed = link_.in_tolerances(first, y);
  // An explicit Euler step that changes y by a hundredth.
  const double small = std::min(longest, size > 1e-5 && speed > 1e-5 ? 0.01 * size / speed : 1e-6);
  for (std::size_t i = 0; i < link_.size(); ++i) place[i] = y[i] + small * first[i];
  if (!link_.evaluate(begin_ + small, place, second)) {
    link_.clear();
    return small;
  }
  for (std::size_t i = 0; i < link_.size(); ++i) second[i] -= first[i];
  const double bend = link_.in_tolerances(second, y) / small;
  const double largest = std::max(speed, bend);
  const double guess = largest > 1e-15 ? std::pow(0.01 / largest, 1.0 / 5.0) : std::max(1e-6, 1e-3 * small);
  return std::min({100.0 * small, guess, longest});
}

void RungeKuttaFlow::record_history(double* out) const {
  const std::size_t n = link_.size();
  if (resumed_) {
    std::copy_n(known_slope_.data(), n, out);
    out[n] = known_error_;
    return;
  }
  N_VSetArrayPointer(out, out_vector_.get());
  stepper_.slope(end_, out_vector_.get());
  out[n] = stepper_.error();
}

void RungeKuttaFlow::restore_history(const double* from) {
  std::copy_n(from, link_.size(), known_slope_.data());
  known_error_ = from[link_.size()];
  resumed_ = true;
}

int RungeKuttaFlow::step(double longest, double& reached) {
  polynomial_made_ = false;
  const bool guessed = next_ == 0.0;
  if (guessed) next_ = guess_first_step(longest);
  const double wanted = next_;
  const bool cut = wanted > longest && !starts_anew();
  if (restart_) {
    stepper_.start(begin_, begin_vector_.get(), guessed);
    if (resumed_) {
      stepper_.first_step(wanted, known_error_);
      link_.answer(begin_, known_slope_.data());
    } else {
      stepper_.first_step(std::min(wanted, longest));
    }
  }
  // A stop time that is not reached would cut the step after this one too, so it is set only where it will
  // be. So cut, a first step is not also to be limited.
  stepper_.longest_step(cut ? wanted : longest);
  stepper_.stop_at(cut ? begin_ + longest : no_stop_time);
  int flag = stepper_.step(horizon(longest), end_vector_.get(), reached);
  // ERKStep does not try a shorter step where a stage meets rates that are not finite. Each of ours ends
  // before the place where the last one did.
  while (flag < 0 && link_.errors().not_finite() && !link_.errors().thrown()) {
    const double shorter = 0.25 * (link_.errors().not_finite_at() - begin_);
    if (!(begin_ + 0.25 * shorter > begin_)) break;  // so begin() is the edge
    link_.clear();
    stepper_.start(begin_, begin_vector_.get(), guessed);
    stepper_.first_step(std::min(shorter, longest));
    stepper_.longest_step(longest);
    stepper_.stop_at(no_stop_time);
    flag = stepper_.step(horizon(longest), end_vector_.get(), reached);
  }
  if (flag < 0) return flag;
  // A step that was cut says nothing against the length it would have had. To grow back to it would take
  // several steps; to start anew with it takes one evaluation.
  restart_ = flag == ARK_TSTOP_RETURN;
  resumed_ = false;
  next_ = restart_ ? wanted : stepper_.next_step();
  return flag;
}

// Hermite's polynomial of degree 5 from the values and rates at both ends and the rates at 1/3 and 2/3. Those
// are evaluated on the polynomial of degree 4 that the ends and the rate at 1/3 give (as ARKODE does at each
// sample): its error is of order h^5, which f times h leaves as h^6, the order of the step itself.
void RungeKuttaFlow::make_polynomial() {
  const std::size_t n = link_.size();
  const double h = end_ - begin_;
  polynomial_.resize(coefficients * n);
  double* const slope = polynomial_.data();
  double *const bend = slope + n, *const change = bend + n, *const even = change + n, *const odd = even + n;
  double *const at_a = scratch(0), *const at_b = scratch(1), *const place = scratch(2);
  N_VSetArrayPointer(slope, out_vector_.get());
  stepper_.slope(begin_, out_vector_.get());
  N_VSetArrayPointer(at_b, out_vector_.get());
  stepper_.slope(end_, out_vector_.get());
  for (std::size_t i = 0; i < n; ++i) {
    const double rise = end_state_[i] - begin_state_[i];
    const double first = h * slope[i], last = h * at_b[i];
    slope[i] = first;
    bend[i] = 3.0 * rise - 2.0 * first - last;
    change[i] = first + last - 2.0 * rise;
    even[i] = odd[i] = 0.0;
  }
  const auto evaluate = [&](double s, double* rates) {
    evaluate_polynomial(s, place);
    link_.clear();
    if (!link_.evaluate(begin_ + s * h, place, rates)) link_.errors().fail(0, begin_, h);
  };
  const auto cubic_slope = [&](std::size_t i, double s) {
    return slope[i] + s * (2.0 * bend[i] + s * 3.0 * change[i]);
  };
  // The slopes of s^2 (1-s)^2 at a and b are 4/27 and -4/27; those of it times (2 s - 1) are 4/81 both.
  constexpr double a = 1.0 / 3.0, b = 2.0 / 3.0;
  evaluate(a, at_a);
  for (std::size_t i = 0; i < n; ++i) even[i] = 27.0 / 4.0 * (h * at_a[i] - cubic_slope(i, a));
  evaluate(a, at_a);
  evaluate(b, at_b);
  for (std::size_t i = 0; i < n; ++i) {
    const double lacking_a = h * at_a[i] - cubic_slope(i, a), lacking_b = h * at_b[i] - cubic_slope(i, b);
    even[i] = 27.0 / 8.0 * (lacking_a - lacking_b);
    odd[i] = 81.0 / 8.0 * (lacking_a + lacking_b);
  }
  polynomial_made_ = true;
}

void RungeKuttaFlow::evaluate_polynomial(double s, double* y) const {
  const double hump = s * s * (1.0 - s) * (1.0 - s), slant = hump * (2.0 * s - 1.0);
  const std::size_t n = link_.size();
  const double* const slope = polynomial_.data();
  const double *const bend = slope + n, *const change = bend + n, *const even = change + n,
                      *const odd = even + n;
  for (std::size_t i = 0; i < n; ++i) {
    y[i] = begin_state_[i] +
           (s * (slope[i] + s * (bend[i] + s * change[i])) + (hump * even[i] + slant * odd[i]));
  }
}

void RungeKuttaFlow::interpolate(double time, double* y) {
  if (!polynomial_made_) make_polynomial();
  evaluate_polynomial((time - begin_) / (end_ - begin_), y);
}

// One step, shorter than the one whose error was tolerated, made here: ARKODE's would need memory of its own,
// so as not to disturb the steps to come, and evaluates once more for an error that nobody asks for.
void RungeKuttaFlow::integrate_to(double time, double* y) {
  namespace pair = dormand_prince;
  constexpr std::size_t second = 1, sixth = 5, end = 6;
  static_assert(pair::a[end][second] == 0.0 && end + 1 == pair::stages);
  const std::size_t n = link_.size();
  const double h = time - begin_;
  const auto slopes = [&](std::size_t stage) { return scratch(stage == sixth ? second : stage); };
  const auto evaluate = [&](std::size_t stage, const double* place) {
    if (!link_.evaluate(begin_ + h * pair::c[stage], place, slopes(stage))) link_.errors().fail(0, begin_, h);
  };
  link_.clear();
  evaluate(0, begin_state_.data());
  for (std::size_t stage = 1;; ++stage) {
    std::array<double, pair::stages> factors{};
    for (std::size_t k = 0; k < stage; ++k) factors[k] = h * pair::a[stage][k];
    factors[stage] = 1.0;
    const auto arrays = [&](std::size_t k) { return k < stage ? slopes(k) : begin_state_.data(); };
    sundials_loops::combine(n, stage + 1, factors.data(), arrays, y);
    if (stage == end) return;
    evaluate(stage, y);
  }
}

}  // namespace

std::unique_ptr<Flow> make_runge_kutta_flow(FlowProblem& problem, double relative_tolerance) {
  return std::make_unique<RungeKuttaFlow>(problem, relative_tolerance);
}

}  // namespace carom

// Problem: let a library written in C evaluate our rates, in vectors of ours, and learn what went wrong.

#include <carom/integrators/flow/flow_checks.h>
#include <carom/integrators/flow/sundials_link.h>
#include <carom/integrators/flow/sundials_newton.h>

#include <carom/integrators/flow/sundials_loops.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace carom {

namespace {

namespace loops = sundials_loops;

std::size_t length(N_Vector v) { return static_cast<std::size_t>(NV_LENGTH_S(v)); }

// The operations the integrators call. Norms are the largest component in place of the mean square: otherwise
// the error of one body would be diluted by the many that rest.
void use_own_loops(N_Vector vector) {
  auto& ops = *vector->ops;
  ops.nvlinearsum = [](sunrealtype a, N_Vector x, sunrealtype b, N_Vector y, N_Vector z) {
    loops::linear_sum(length(x), a, NV_DATA_S(x), b, NV_DATA_S(y), NV_DATA_S(z));
  };
  ops.nvconst = [](sunrealtype c, N_Vector z) { loops::fill(length(z), c, NV_DATA_S(z)); };
  ops.nvprod = [](N_Vector x, N_Vector y, N_Vector z) {
    loops::multiply(length(x), NV_DATA_S(x), NV_DATA_S(y), NV_DATA_S(z));
  };
  ops.nvdiv = [](N_Vector x, N_Vector y, N_Vector z) {
    loops::divide(length(x), NV_DATA_S(x), NV_DATA_S(y), NV_DATA_S(z));
  };
  ops.nvscale = [](sunrealtype c, N_Vector x, N_Vector z) {
    loops::scale(length(x), c, NV_DATA_S(x), NV_DATA_S(z));
  };
  ops.nvabs = [](N_Vector x, N_Vector z) { loops::absolute(length(x), NV_DATA_S(x), NV_DATA_S(z)); };
  ops.nvinv = [](N_Vector x, N_Vector z) { loops::invert(length(x), NV_DATA_S(x), NV_DATA_S(z)); };
  ops.nvaddconst = [](N_Vector x, sunrealtype b, N_Vector z) {
    loops::add_constant(length(x), NV_DATA_S(x), b, NV_DATA_S(z));
  };
  ops.nvdotprod = [](N_Vector x, N_Vector y) { return loops::dot(length(x), NV_DATA_S(x), NV_DATA_S(y)); };
  ops.nvmaxnorm = [](N_Vector x) { return loops::maximum(length(x), NV_DATA_S(x)); };
  ops.nvmin = [](N_Vector x) { return loops::minimum(length(x), NV_DATA_S(x)); };
  ops.nvwrmsnorm = [](N_Vector x, N_Vector w) {
    return loops::weighted_maximum(length(x), NV_DATA_S(x), NV_DATA_S(w));
  };
  ops.nvlinearcombination = [](int count, sunrealtype* c, N_Vector* x, N_Vector z) {
    loops::combine(
        length(z), static_cast<std::size_t>(count), c, [x](std::size_t j) { return NV_DATA_S(x[j]); },
        NV_DATA_S(z));
    return 0;
  };
  ops.nvscaleaddmulti = [](int count, sunrealtype* c, N_Vector x, N_Vector* y, N_Vector* z) {
    for (int j = 0; j < count; ++j) {
      loops::linear_sum(length(x), c[j], NV_DATA_S(x), 1.0, NV_DATA_S(y[j]), NV_DATA_S(z[j]));
    }
    return 0;
  };
  ops.nvscalevectorarray = [](int count, sunrealtype* c, N_Vector* x, N_Vector* z) {
    for (int j = 0; j < count; ++j) loops::scale(length(x[j]), c[j], NV_DATA_S(x[j]), NV_DATA_S(z[j]));
    return 0;
  };
}

#if SUNDIALS_VERSION_MAJOR >= 7
SUNComm no_communicator() { return SUN_COMM_NULL; }
#else
void* no_communicator() { return nullptr; }
#endif

}  // namespace

SundialsLink::SundialsLink(FlowProblem& problem, double relative_tolerance)
    : problem_(&problem),
      size_(problem.size()),
      integrals_(problem.integrals()),
      relative_tolerance_(relative_tolerance) {
  check_flow_problem(problem, relative_tolerance);
  errors_.demand(SUNContext_Create(no_communicator(), &context_) == 0, "SUNContext_Create");
#if SUNDIALS_VERSION_MAJOR >= 7
  SUNContext_ClearErrHandlers(context_);
  SUNContext_PushErrHandler(
      context_,
      [](int, const char*, const char*, const char* message, SUNErrCode code, void* link, SUNContext) {
        static_cast<SundialsLink*>(link)->errors_.keep_message(code, message);
      },
      this);
#endif
}

SundialsLink::~SundialsLink() { SUNContext_Free(&context_); }

void SundialsLink::bind(FlowProblem& problem) {
  check_flow_bind(problem, size_, integrals_);
  check_flow_problem(problem, relative_tolerance_);
  problem_ = &problem;
  errors_ = {};
}

SundialsVector SundialsLink::vector(double* numbers) const {
  SundialsVector made(N_VMake_Serial(static_cast<sunindextype>(size_), numbers, context_));
  errors_.demand(made != nullptr, "N_VMake_Serial");
  use_own_loops(made.get());  // what SUNDIALS clones from it has them too
  return made;
}

double SundialsLink::in_tolerances(const double* x, const double* y) const {
  const double* const absolute = problem_->absolute_tolerances().data();
  double largest = 0.0;
  for (std::size_t i = 0; i < size_; ++i) {
    largest = std::max(largest, std::abs(x[i]) / (relative_tolerance_ * std::abs(y[i]) + absolute[i]));
  }
  return largest;
}

bool SundialsLink::evaluate(double time, const double* y, double* rates) {
  ++evaluations_;
  problem_->rates(time, y, rates);
  if (loops::all_finite(size_, rates)) return true;
  errors_.keep_not_finite(time);
  return false;
}

// Exceptions must not cross a library written in C: negative ends the step, positive asks for a shorter one.
int SundialsLink::rates(sunrealtype time, N_Vector y, N_Vector rates, void* link) noexcept {
  auto& self = *static_cast<SundialsLink*>(link);
  if (self.errors_.thrown()) return -1;  // CVODE tries shorter steps even so
  const double* const known = std::exchange(self.answer_, nullptr);
  if (known != nullptr && time == self.answer_at_) {
    std::copy_n(known, self.size_, NV_DATA_S(rates));
    return 0;
  }
  try {
    return self.evaluate(time, NV_DATA_S(y), NV_DATA_S(rates)) ? 0 : 1;
  } catch (...) {
    self.errors_.keep(std::current_exception());
    return -1;
  }
}

int SundialsLink::weights(N_Vector y, N_Vector weights, void* link) noexcept {
  const auto& self = *static_cast<SundialsLink*>(link);
  try {
    loops::tolerance_weights(self.size_, self.relative_tolerance_, NV_DATA_S(y),
                             self.problem_->absolute_tolerances().data(), NV_DATA_S(weights));
    loops::scale(self.size_, 1.0 / self.part_, NV_DATA_S(weights), NV_DATA_S(weights));
    return 0;
  } catch (...) {
    return -1;
  }
}

int SundialsLink::linear_system(sunrealtype time, N_Vector y, N_Vector rates, SUNMatrix matrix,
                                sunbooleantype keep, sunbooleantype* renewed, sunrealtype gamma, void* link,
                                N_Vector, N_Vector, N_Vector) noexcept {
  auto& self = *static_cast<SundialsLink*>(link);
  if (self.errors_.thrown()) return -1;
  try {
    NewtonMatrix& system = newton_matrix(matrix);
    *renewed = keep ? 0 : 1;
    if (!keep && !self.linearise(time, NV_DATA_S(y), NV_DATA_S(rates), system)) return 1;
    return system.factor(gamma) ? 0 : 1;  // 1: perhaps with another gamma
  } catch (...) {
    self.errors_.keep(std::current_exception());
    return -1;
  }
}

bool SundialsLink::linearise(double time, double* y, const double* rates, NewtonMatrix& matrix) {
  std::vector<RateDerivative>& entries = matrix.entries();
  entries.clear();
  if (problem_->has_jacobian()) {
    problem_->jacobian(time, y, entries);
  } else if (!difference_rates(time, y, rates, entries)) {
    return false;
  }
  if (matrix.take()) return true;
  errors_.keep_not_finite(time);
  return false;
}

bool SundialsLink::difference_rates(double time, double* y, const double* rates,
                                    std::vector<RateDerivative>& out) {
  const std::span<const double> absolute = problem_->absolute_tolerances();
  const double part = std::sqrt(std::numeric_limits<double>::epsilon());
  moved_rates_.resize(size_);
  for (std::size_t column = 0; column < size_; ++column) {
    const double at = y[column];
    // A number below the second counts as zero.
    y[column] = at + part * std::max(std::abs(at), absolute[column] / relative_tolerance_);
    const double step = y[column] - at;
    const bool finite = evaluate(time, y, moved_rates_.data());
    y[column] = at;
    if (!finite) return false;
    for (std::size_t row = 0; row < size_; ++row) {
      out.push_back({static_cast<Index>(row), static_cast<Index>(column), row == column ? 1.0 : 0.0,
                     (moved_rates_[row] - rates[row]) / step, 0.0});
    }
  }
  return true;
}

#if SUNDIALS_VERSION_MAJOR < 7
void SundialsLink::take_message(int code, const char*, const char*, char* message, void* link) noexcept {
  static_cast<SundialsLink*>(link)->errors_.keep_message(code, message);
}
#endif

}  // namespace carom

#pragma once

/// \file
/// FlowProblem as SUNDIALS sees it: a context, vectors with loops of our own, functions in C that call the
/// problem. Differences between the versions 6.4 and 7 live here and in sundials_link.cpp.

#include <carom/integrators/flow/flow.h>
#include <carom/integrators/flow/newton_matrix.h>
#include <carom/integrators/flow/sundials_errors.h>

#include <nvector/nvector_serial.h>
#include <sundials/sundials_config.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_types.h>

#include <cstdint>
#include <memory>
#include <type_traits>
#include <vector>

static_assert(std::is_same_v<sunrealtype, double>, "carom needs SUNDIALS in double precision");

// Since 7.1 the functions of ARKODE's methods have one name for all of them.
#if SUNDIALS_VERSION_MAJOR > 7 || (SUNDIALS_VERSION_MAJOR == 7 && SUNDIALS_VERSION_MINOR >= 1)
#define CAROM_ERK(name) ARKode##name
#else
#define CAROM_ERK(name) ERKStep##name
#endif

namespace carom {

/// Deletes what N_V*() made.
struct SundialsVectorDeleter {
  void operator()(N_Vector vector) const { N_VDestroy(vector); }
};
/// A vector over memory that somebody else owns.
using SundialsVector = std::unique_ptr<std::remove_pointer_t<N_Vector>, SundialsVectorDeleter>;

/// One problem as SUNDIALS sees it: the `user_data` of its callbacks. Stays where it is.
class SundialsLink {
public:
  /// Checks the problem's size and tolerances; ModelError.
  SundialsLink(FlowProblem& problem, double relative_tolerance);
  ~SundialsLink();
  SundialsLink(const SundialsLink&) = delete;
  SundialsLink& operator=(const SundialsLink&) = delete;

  /// Follows another problem from now on. Throws ModelError as check_flow_bind() and check_flow_problem().
  void bind(FlowProblem& problem);
  /// Number of unknowns.
  [[nodiscard]] std::size_t size() const { return size_; }
  /// The context of everything made for this problem.
  [[nodiscard]] SUNContext context() const { return context_; }
  /// The problem.
  [[nodiscard]] FlowProblem& problem() const { return *problem_; }
  /// Evaluations of f so far.
  [[nodiscard]] std::int64_t evaluations() const { return evaluations_; }
  /// Makes a vector over size() numbers.
  [[nodiscard]] SundialsVector vector(double* numbers) const;

  /// Holds the errors of steps to this part of the tolerances, > 0.
  void tighten(double part) { part_ = part; }
  /// Largest component of x, each measured by its tolerance at y.
  [[nodiscard]] double in_tolerances(const double* x, const double* y) const;
  /// Evaluates f outside SUNDIALS. False: not finite.
  [[nodiscard]] bool evaluate(double time, const double* y, double* rates);

  /// The next time that SUNDIALS asks for rates at this very time these are the answer, without an
  /// evaluation; once. \param rates must outlive that
  void answer(double time, const double* rates) {
    answer_at_ = time;
    answer_ = rates;
  }

  /// Forgets failures and known answers.
  void clear() {
    answer_ = nullptr;
    errors_.clear();
  }
  /// Failures of the evaluations and of SUNDIALS.
  [[nodiscard]] const SundialsErrors& errors() const { return errors_; }

  /// Callbacks of CVODE and ARKODE; `link` is a SundialsLink.
  static int rates(sunrealtype time, N_Vector y, N_Vector rates, void* link) noexcept;
  static int weights(N_Vector y, N_Vector weights, void* link) noexcept;
  /// Fills and factorises a matrix of make_newton_matrix().
  static int linear_system(sunrealtype time, N_Vector y, N_Vector rates, SUNMatrix matrix,
                           sunbooleantype keep, sunbooleantype* renewed, sunrealtype gamma, void* link,
                           N_Vector, N_Vector, N_Vector) noexcept;
#if SUNDIALS_VERSION_MAJOR < 7
  /// Takes messages in place of stderr; set for each integrator.
  static void take_message(int code, const char* module, const char* function, char* message,
                           void* link) noexcept;
#endif

private:
  bool linearise(double time, double* y, const double* rates, NewtonMatrix& matrix);
  bool difference_rates(double time, double* y, const double* rates, std::vector<RateDerivative>& out);

  FlowProblem* problem_;
  std::size_t size_, integrals_;
  double relative_tolerance_;
  double part_ = 1.0;
  SUNContext context_ = nullptr;
  std::int64_t evaluations_ = 0;
  std::vector<double> moved_rates_;
  double answer_at_ = 0.0;
  const double* answer_ = nullptr;
  SundialsErrors errors_;
};

}  // namespace carom

// Problem: methods that remember earlier steps, for long smooth motion (Adams-Moulton) and for stiff
// couplings (BDF). Steps are those of CVODE.

#include <carom/integrators/flow/sundials_flow.h>
#include <carom/integrators/flow/sundials_newton.h>

#include <cvode/cvode.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>
#include <memory>

namespace carom {

namespace {

// CVODE aims at errors of a sixth of what is allowed. Those of BDF of an odd order change the amplitude of
// what swings, by the same sign in every step, so that they add up in the energy: faster than a tenth of the
// tolerance a step, which the other methods stay below. This part costs a quarter more steps (order 5).
constexpr double bdf_part = 0.25;

class MultistepFlow final : public SundialsFlow {
public:
  MultistepFlow(FlowMethod method, FlowProblem& problem, double relative_tolerance);
  ~MultistepFlow() override;
  MultistepFlow(const MultistepFlow&) = delete;
  MultistepFlow& operator=(const MultistepFlow&) = delete;

private:
  int step(double longest, double& reached) override;
  void forget() override { restart_ = true; }
  [[nodiscard]] bool starts_anew() const override { return restart_; }
  void shift(std::span<const double> y) override;
  void interpolate(double time, double* y) override;
  void integrate_to(double time, double* y) override { interpolate(time, y); }

  void demand(int flag) const { link_.errors().demand(flag >= 0, "a call of CVODE"); }

  void* memory_;
  SUNNonlinearSolver fixed_point_ = nullptr;
  std::unique_ptr<NewtonMatrix> newton_;
  SUNMatrix matrix_ = nullptr;
  SUNLinearSolver linear_solver_ = nullptr;
  bool restart_ = true;
  double largest_next_ = 0.0;  // the next step as CVODE plans it is no longer
};

MultistepFlow::MultistepFlow(FlowMethod method, FlowProblem& problem, double relative_tolerance)
    : SundialsFlow(problem, relative_tolerance),
      memory_(CVodeCreate(method == FlowMethod::adams ? CV_ADAMS : CV_BDF, link_.context())) {
  link_.errors().demand(memory_ != nullptr, "CVodeCreate");
#if SUNDIALS_VERSION_MAJOR < 7
  demand(CVodeSetErrHandlerFn(memory_, SundialsLink::take_message, &link_));
#endif
  demand(CVodeInit(memory_, SundialsLink::rates, 0.0, begin_vector_.get()));
  demand(CVodeSetUserData(memory_, &link_));
  demand(CVodeWFtolerances(memory_, SundialsLink::weights));
  demand(CVodeSetMaxErrTestFails(memory_, error_test_failures));
  demand(CVodeSetMaxHnilWarns(memory_, -1));
  if (method == FlowMethod::adams) {
    fixed_point_ = SUNNonlinSol_FixedPoint(begin_vector_.get(), 0, link_.context());
    link_.errors().demand(fixed_point_ != nullptr, "SUNNonlinSol_FixedPoint");
    demand(CVodeSetNonlinearSolver(memory_, fixed_point_));
  } else {
    link_.tighten(bdf_part);
    newton_ = std::make_unique<NewtonMatrix>(link_.size(), problem.integrals());
    matrix_ = make_newton_matrix(*newton_, link_.context());
    linear_solver_ = make_newton_solver(*newton_, link_.context());
    link_.errors().demand(matrix_ != nullptr && linear_solver_ != nullptr, "making a linear solver");
    demand(CVodeSetLinearSolver(memory_, linear_solver_, matrix_));
    demand(CVodeSetLinSysFn(memory_, SundialsLink::linear_system));
  }
}

MultistepFlow::~MultistepFlow() {
  CVodeFree(&memory_);
  if (fixed_point_ != nullptr) SUNNonlinSolFree(fixed_point_);
  if (linear_solver_ != nullptr) SUNLinSolFree(linear_solver_);
  if (matrix_ != nullptr) SUNMatDestroy(matrix_);
}

int MultistepFlow::step(double longest, double& reached) {
  if (restart_) {
    demand(CVodeReInit(memory_, begin_, begin_vector_.get()));
    demand(CVodeSetInitStep(memory_, std::min(next_, longest)));
    largest_next_ = 0.0;
  }
  // The largest step holds for the first one and those after this one, so this one may need a stop time. One
  // that is not reached would cut the next step too; it is set only where it will be, as far as that is
  // known.
  demand(CVodeSetMaxStep(memory_, longest));
  demand(CVodeSetStopTime(memory_, largest_next_ > longest ? begin_ + longest : no_stop_time));
  const int flag = CVode(memory_, horizon(longest), end_vector_.get(), &reached, CV_ONE_STEP);
  if (flag < 0) return flag;
  restart_ = false;
  demand(CVodeGetCurrentStep(memory_, &next_));
  largest_next_ = flag == CV_TSTOP_RETURN ? longest : next_;  // there CVODE does not say
  return flag;
}

// The history of CVODE is a Taylor polynomial at the end of the step: y, then h y', h^2 y''/2 and so on. A
// small change moves its first row; the error of the others, h df/dy times the change, is left to the error
// test. So the order and the step are kept, where initialising anew would begin at order 1. CVODE gives
// access to that row as the prediction of the next step, which is not made yet.
void MultistepFlow::shift(std::span<const double> y) {
  double time = 0.0, gamma = 0.0, factor = 0.0;
  N_Vector first_row = nullptr, current = nullptr, rates = nullptr, second_row = nullptr;
  void* link = nullptr;
  demand(CVodeGetNonlinearSystemData(memory_, &time, &first_row, &current, &rates, &gamma, &factor,
                                     &second_row, &link));
  double* const row = N_VGetArrayPointer(first_row);
  for (std::size_t i = 0; i < y.size(); ++i) row[i] += y[i] - end_state_[i];
}

void MultistepFlow::interpolate(double time, double* y) {
  N_VSetArrayPointer(y, out_vector_.get());
  link_.clear();
  const int flag = CVodeGetDky(memory_, time, 0, out_vector_.get());
  if (flag < 0) link_.errors().fail(flag, begin_, end_ - begin_);
}

}  // namespace

std::unique_ptr<Flow> make_multistep_flow(FlowMethod method, FlowProblem& problem,
                                          double relative_tolerance) {
  return std::make_unique<MultistepFlow>(method, problem, relative_tolerance);
}

}  // namespace carom

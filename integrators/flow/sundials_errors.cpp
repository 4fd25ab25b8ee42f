#include <carom/integrators/flow/flow_checks.h>
#include <carom/integrators/flow/sundials_errors.h>

#include <arkode/arkode.h>
#include <cvode/cvode.h>

#include <cstring>
#include <string>

namespace carom {

namespace {

static_assert(CV_TOO_MUCH_ACC == ARK_TOO_MUCH_ACC && CV_ERR_FAILURE == ARK_ERR_FAILURE &&
              CV_CONV_FAILURE == ARK_CONV_FAILURE && CV_LSETUP_FAIL == ARK_LSETUP_FAIL &&
              CV_LSOLVE_FAIL == ARK_LSOLVE_FAIL && CV_TOO_CLOSE == ARK_TOO_CLOSE);

std::string reason(int flag) {
  switch (flag) {
    case CV_TOO_MUCH_ACC:
      return "the tolerances ask for more digits than numbers have";
    case CV_ERR_FAILURE:
      return "the error is above the tolerances however short the step";
    case CV_CONV_FAILURE:
      return "the corrector iteration does not converge however short the step";
    case CV_LSETUP_FAIL:
    case CV_LSOLVE_FAIL:
      return "the linear equations of a step cannot be solved";
    case CV_TOO_CLOSE:
      return "the length allowed for the step is too small to choose a step";
    default:
      return {};
  }
}

}  // namespace

void SundialsErrors::clear() {
  not_finite_ = false;
  exception_ = nullptr;
  message_[0] = '\0';
}

void SundialsErrors::keep_message(int code, const char* message) noexcept {
  if (code == CV_WARNING || message == nullptr) return;
  std::strncpy(message_.data(), message, message_.size() - 1);
}

void SundialsErrors::fail(int flag, double time, double step) const {
  if (exception_) std::rethrow_exception(exception_);
  if (not_finite_) fail_not_finite(time, step);
  std::string why = reason(flag);
  if (why.empty()) why = "SUNDIALS gives up (" + std::to_string(flag) + "): " + message_.data();
  fail_flow(why, time, step);
}

void SundialsErrors::fail_not_finite(double time, double step) const {
  fail_flow_not_finite(not_finite_at_, time, step);
}

void SundialsErrors::demand(bool success, const char* call) const {
  if (success) return;
  fail_flow(std::string(call) + " fails: " + message_.data(), 0.0, 0.0);
}

}  // namespace carom

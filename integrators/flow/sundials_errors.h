#pragma once

/// \file
/// Failures of a step by SUNDIALS: kept while C code runs, which exceptions must not cross, and thrown
/// afterwards.

#include <carom/core/export.h>

#include <array>
#include <exception>
#include <limits>
#include <utility>

namespace carom {

/// Failures since the last clear().
class CAROM_API SundialsErrors {
public:
  /// Forgets all but the time of the last rates that were not finite.
  void clear();
  /// Keeps an exception of the problem.
  void keep(std::exception_ptr exception) noexcept { exception_ = std::move(exception); }
  /// Keeps a message of SUNDIALS. \param code of the message; warnings are not kept
  void keep_message(int code, const char* message) noexcept;
  /// Keeps the time at which rates or their derivatives were not finite [s].
  void keep_not_finite(double time) noexcept {
    not_finite_ = true;
    not_finite_at_ = time;
  }

  /// True if rates or their derivatives were not finite.
  [[nodiscard]] bool not_finite() const { return not_finite_; }
  /// The time at which they last were not, also before clear(); minus infinity if they always were.
  [[nodiscard]] double not_finite_at() const { return not_finite_at_; }
  /// True if the problem threw.
  [[nodiscard]] bool thrown() const { return exception_ != nullptr; }

  /// Throws the exception of the problem, or else the SolverError that says why a step from `time` failed.
  /// \param flag returned by SUNDIALS; CVODE and ARKODE mean the same by it
  [[noreturn]] void fail(int flag, double time, double step) const;
  /// Throws the SolverError that rates are not finite where they last were not.
  [[noreturn]] void fail_not_finite(double time, double step) const;
  /// For calls that fail for want of memory or by a mistake of ours only.
  void demand(bool success, const char* call) const;

private:
  bool not_finite_ = false;
  double not_finite_at_ = -std::numeric_limits<double>::infinity();
  std::exception_ptr exception_{};
  std::array<char, 256> message_{};
};

}  // namespace carom

#pragma once

/// \file
/// The flow of a clock group, lent by a pool: between advances other groups have it where its last step is
/// all there is to know of the motion.

#include <carom/core/export.h>
#include <carom/integrators/flow/flow.h>
#include <carom/integrators/flow/flow_pool.h>

#include <span>

namespace carom {

/// The flow of one clock group.
class CAROM_API GroupFlow {
public:
  /// \param pool,problem must outlive it
  GroupFlow(FlowPool& pool, FlowProblem& problem) : pool_(&pool), problem_(&problem) {}

  /// Forgets the motion; the next use is start().
  void forget();
  /// Starts the flow at a state. \param one_step the method is helped by the length that the last step had
  void start(double time, std::span<const double> y, bool one_step);
  /// The flow, at the step where it was left.
  [[nodiscard]] Flow& borrow();
  /// True if the flow is borrowed now.
  [[nodiscard]] bool is_borrowed() const { return static_cast<bool>(loan_); }
  /// The flow, borrowed, to be advanced or corrected.
  [[nodiscard]] Flow& change();
  /// Keeps the length of the next step for the next start(). \param length [s], 0: none
  void keep_step(double length) { first_step_ = length; }
  /// Length of the next step, as keep_step() took it [s]; 0: none.
  [[nodiscard]] double kept_step() const { return first_step_; }
  /// Lets other groups have the flow. \param at_rest nothing of it is needed any more \param alone there are
  /// no others
  void leave(bool at_rest, bool alone);

private:
  FlowPool* pool_;
  FlowProblem* problem_;
  FlowPool::Loan loan_;  // null at rest, and where `left_` is all there is to know
  FlowStep left_;
  bool is_ballistic_ = false;
  bool is_recorded_ = false;  // `left_` is the step of the flow
  double first_step_ = 0.0;   // of the next phase [s]
};

}  // namespace carom

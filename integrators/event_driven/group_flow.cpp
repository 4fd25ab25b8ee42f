// Problem: few flows for many clock groups.

#include <carom/integrators/event_driven/group_flow.h>

namespace carom {

void GroupFlow::forget() {
  loan_.reset();
  first_step_ = 0.0;
}

void GroupFlow::start(double time, std::span<const double> y, bool one_step) {
  const bool is_ballistic = problem_->is_ballistic();
  if (is_ballistic != is_ballistic_) loan_.reset();
  is_ballistic_ = is_ballistic;
  if (!loan_) loan_ = pool_->borrow(*problem_);
  is_recorded_ = false;
  loan_->start(time, y, one_step ? first_step_ : 0.0);
}

Flow& GroupFlow::borrow() {
  if (!loan_) {
    loan_ = pool_->borrow(*problem_);
    loan_->resume(left_);
    is_recorded_ = true;
  }
  return *loan_;
}

Flow& GroupFlow::change() {
  is_recorded_ = false;
  return *loan_;
}

void GroupFlow::leave(bool at_rest, bool alone) {
  if (!loan_ || (!at_rest && (alone || !(is_recorded_ || loan_->leave(left_))))) return;
  loan_.reset();
  if (at_rest) left_ = {};
}

}  // namespace carom

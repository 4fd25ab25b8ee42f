// Problem: works up to an output state, of which the run itself knows nothing.

#include <carom/integrators/event_driven/group_output.h>

namespace carom {

void GroupOutput::start(std::span<const double> y) {
  y_.assign(y.begin(), y.end());
  booked_ = {};
  projected_ = 0.0;
}

void GroupOutput::book(double projected, EventBalance& balance) {
  balance.flows[EnergyFlow::projection] += projected - projected_;
  projected_ = projected;
  for (Index line = 0; line < unknowns_->work_count(); ++line) {
    const double value = y_[unknowns_->work_place(static_cast<WorkLine>(line))];
    constexpr std::array<EnergyFlow, work_lines> flows{EnergyFlow::dashpot, EnergyFlow::sliding,
                                                       EnergyFlow::external, EnergyFlow::joint_friction,
                                                       EnergyFlow::rolling};
    balance.flows[flows[line]] += value - booked_[line];
    booked_[line] = value;
  }
}

}  // namespace carom

#include <carom/integrators/run/stop_request.h>

namespace carom {

void StopRequest::check_interrupt() const {
  interrupted_ = true;  // also where it throws
  if (interrupt_()) throw Cancelled("cancelled: the function of interrupt_when asked for the end");
  interrupted_ = false;
}

void StopRequest::tell(double time) const {
  if (!reached_) return;
  interrupted_ = true;
  reached_(time);
  interrupted_ = false;
}

void StopRequest::stop() { throw Cancelled("cancelled: the function of stop_when asked for the end"); }

}  // namespace carom

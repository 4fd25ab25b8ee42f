#include <carom/integrators/run/stop_request.h>

namespace carom {

void StopRequest::stop() { throw Cancelled("cancelled: the function of stop_when asked for the end"); }

}  // namespace carom

#include <carom/integrators/progress_bar.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>

namespace carom {

namespace {
constexpr auto patience = std::chrono::seconds(1);
constexpr auto interval = std::chrono::milliseconds(200);
constexpr int width = 40;
}  // namespace

ProgressBar::ProgressBar(std::ostream& out, double from, double to, Clock::time_point now)
    : out_(out), from_(from), to_(to), start_(now), next_(now + patience) {}

ProgressBar::~ProgressBar() {
  if (drawn_) out_ << '\r' << std::string(width + 30, ' ') << '\r' << std::flush;
}

bool ProgressBar::terminal() { return isatty(STDERR_FILENO) == 1; }

void ProgressBar::update(double time, Clock::time_point now) {
  if (now < next_ || !(to_ > from_)) return;
  next_ = now + interval;
  drawn_ = true;
  const double done = std::clamp((time - from_) / (to_ - from_), 0.0, 1.0);
  const int filled = static_cast<int>(std::lround(done * width));
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  out_ << "\r[" << std::string(static_cast<std::size_t>(filled), '#')
       << std::string(static_cast<std::size_t>(width - filled), ' ') << "] " << std::lround(100.0 * done)
       << " %";
  if (done > 0.0) out_ << "  " << std::lround(elapsed * (1.0 - done) / done) << " s left ";
  out_ << std::flush;
}

}  // namespace carom

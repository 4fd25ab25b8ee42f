#include "watch.h"

#include <algorithm>
#include <ctime>
#include <utility>

namespace carom_python {

namespace {

constexpr auto look_interval = std::chrono::milliseconds(50);
constexpr auto show_interval = std::chrono::milliseconds(100);
constexpr std::uint32_t most_calls = 16;          // without a look at the clock
constexpr std::int64_t long_between = 4'000'000;  // looks at the clock: then each call has one [ns]

// Signals are of the whole program, and so is this.
std::atomic<bool> interrupted{false};

/// A clock that costs a few nanoseconds and is a few milliseconds late [ns].
std::int64_t coarse_time() {
#ifdef CLOCK_MONOTONIC_COARSE
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC_COARSE, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
#else
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
#endif
}

}  // namespace

void note_interrupt(const nb::python_error& error) {
  if (error.matches(PyExc_KeyboardInterrupt)) interrupted = true;
}

bool Watch::is_interrupted() { return interrupted.load(std::memory_order_relaxed); }

void Watch::begin(Show show) {
  interrupted = false;
  show_ = std::move(show);
  reached_ = 0.0;
  shown_ = {};
  count_ = 0;
  gate_ = 1;
}

void Watch::look_at_clock(double time) {
  count_ = 0;
  const std::int64_t coarse = coarse_time(), passed = coarse - coarse_;
  coarse_ = coarse;
  gate_ = passed >= long_between ? 1 : std::min(most_calls, 2 * gate_);
  if (passed == 0 && !is_interrupted()) return;  // within one tick of the clock
  const Clock::time_point now = Clock::now();
  if (now - looked_ < look_interval && !is_interrupted()) return;
  looked_ = now;
  const nb::gil_scoped_acquire lock;
  if (interrupted.exchange(false)) {
    PyErr_SetNone(PyExc_KeyboardInterrupt);
    throw nb::python_error();
  }
  if (PyErr_CheckSignals() != 0) throw nb::python_error();
  tell(std::max(time, reached_), now);
}

void Watch::tell(double time, Clock::time_point now) {
  if (!show_ || now - shown_ < show_interval) return;
  shown_ = now;
  call_python([&] { show_(time); });
}

void Watch::reach(double time) {
  reached_ = time;
  if (!show_) return;
  const nb::gil_scoped_acquire lock;
  tell(time, Clock::now());
}

void Watch::finish(double time) {
  const Show show = std::exchange(show_, {});
  if (show) show(time);
}

carom::StopFunction stop_or_signal(carom::StopFunction stop) {
  const auto watch = std::make_shared<Watch>();
  watch->begin({});
  return [stop = std::move(stop), watch] {
    if (stop && stop()) return true;
    watch->look(0.0);
    return false;
  };
}

}  // namespace carom_python

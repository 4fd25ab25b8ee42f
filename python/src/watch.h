#pragma once

// Lets Ctrl-C end work that C++ does, and tells how far the work is.

#include <nanobind/nanobind.h>

#include <carom/integrators/run/stop_request.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>

namespace carom_python {

namespace nb = nanobind;

/// Notes that a function of the user, which C++ called, was ended by Ctrl-C: whatever C++ does then, its work
/// shall end.
void note_interrupt(const nb::python_error& error);

/// Calls a function in Python, with the interpreter's lock taken; notes where Ctrl-C ended it.
template <class Call>
auto call_python(const Call& call) {
  try {
    return call();
  } catch (const nb::python_error& error) {
    note_interrupt(error);
    throw;
  }
}

/// Is asked in every sweep and evaluation of long work; several times a second it lets Python look at the
/// signals of the system.
class Watch {
public:
  /// Gets a time that a run has reached [s], with the interpreter's lock taken.
  using Show = std::function<void(double)>;

  /// New work begins. \param show called ten times a second; empty: nobody wants to know
  void begin(Show show);
  /// Looks. Throws what Python raises (KeyboardInterrupt). \param time that the work has reached [s]
  void look(double time) {
    if (!is_interrupted() && ++count_ < gate_) return;
    look_at_clock(time);
  }
  /// The work has reached a time that only it knows [s].
  void reach(double time);
  /// The work ended well, at a time [s].
  void finish(double time);

private:
  using Clock = std::chrono::steady_clock;
  [[nodiscard]] static bool is_interrupted();
  void look_at_clock(double time);
  void tell(double time, Clock::time_point now);

  std::uint32_t count_ = 0, gate_ = 1;  // calls since the last look at the clock, and from one to the next
  std::int64_t coarse_ = 0;             // the clock then [ns]
  Clock::time_point looked_{}, shown_{};
  double reached_ = 0.0;
  Show show_;
};

/// A StopFunction that asks one of the user, if there is one, and lets Ctrl-C end the work.
[[nodiscard]] carom::StopFunction stop_or_signal(carom::StopFunction stop);

}  // namespace carom_python

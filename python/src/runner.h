#pragma once

// The Simulation of Python: a carom::Simulation, the parts of its model, and the functions that it calls.

#include "model.h"
#include "watch.h"

#include <carom/integrators/simulation.h>

#include <atomic>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace carom_python {

/// A mode from its options. Raises TypeError.
[[nodiscard]] carom::Mode mode_of(nb::handle from);
/// Throws ModelError for functions in Python that several threads would call.
void check_threads(const Journal& journal, const carom::Mode& mode);

/// A running model.
class Runner {
public:
  Runner(const Model& model, const carom::Mode& mode);
  /// Simulation::copy().
  Runner(const Journal& journal, carom::Simulation simulation);
  Runner(const Runner&) = delete;
  Runner& operator=(const Runner&) = delete;
  ~Runner() = default;

  /// The simulation. Throws ModelError while another thread runs it.
  [[nodiscard]] carom::Simulation& get() {
    if (thread_.load(std::memory_order_relaxed) != std::thread::id()) check_thread();
    return *simulation_;
  }
  /// Runs `work` with the interpreter's lock released, unless something in Python is called in it. Ctrl-C
  /// ends it. \param show as Watch::begin()
  template <class Work>
  void run(const Work& work, Watch::Show show = {}) {
    get();
    const std::thread::id before = thread_.exchange(std::this_thread::get_id());
    const Restore restore{thread_, before};
    if (before != std::thread::id()) return work(*simulation_);  // which refuses
    const Watched watched{watch_};
    watch_.begin(std::move(show));
    if (calls_python()) {
      work(*simulation_);
    } else {
      const nb::gil_scoped_release release;
      work(*simulation_);
    }
    watch_.finish(simulation_->time());
  }
  /// Simulation::run_until(). \param show as Watch::begin()
  void run_until(double time, Watch::Show show);
  /// The model, as a copy of its own; the same object until the next edit.
  [[nodiscard]] nb::object system();
  void edit(nb::handle change);
  void switch_to(const carom::Mode& mode);
  /// Simulation::copy(), owned by whoever calls.
  [[nodiscard]] Runner* copy();
  /// Keeps a function of the user until it is dropped; returns its number.
  std::size_t keep(nb::handle function);
  void drop(std::size_t number) { (void)kept_.extract(number); }  // freed once it is out of the list
  /// That function, which may drop itself while it runs.
  [[nodiscard]] nb::object kept(std::size_t number) const { return kept_.at(number); }
  /// Forgets all functions, and that they are called (for the collector of garbage).
  void clear() { std::exchange(kept_, {}); }
  [[nodiscard]] const std::map<std::size_t, nb::object>& all_kept() const { return kept_; }
  [[nodiscard]] const Journal& journal() const { return journal_; }
  /// Asks `stop` from now on; a null one ends that.
  void stop_when(carom::StopFunction stop);
  /// First coordinate and velocity of every body, in the order in which bodies were added.
  [[nodiscard]] const std::vector<std::pair<carom::BodyId, carom::BodySlot>>& slots();
  void forget_model();

  std::optional<std::size_t> log_sink{};  ///< number of the function that gets the lines of the log

private:
  struct Restore {
    std::atomic<std::thread::id>& thread;
    std::thread::id before;
    ~Restore() { thread.store(before); }
  };
  struct Watched {
    Watch& watch;
    ~Watched() { watch.begin({}); }
  };
  void check_thread() const;
  void warn();
  void watch_simulation();
  [[nodiscard]] bool calls_python() const { return python_laws_ || !kept_.empty() || stop_; }

  Journal journal_;
  Watch watch_;
  std::unique_ptr<carom::Simulation> simulation_;
  std::map<std::size_t, nb::object> kept_;
  std::size_t next_ = 0;
  carom::StopFunction stop_;
  bool python_laws_ = false;
  nb::object system_;
  std::vector<std::pair<carom::BodyId, carom::BodySlot>> slots_;
  std::atomic<std::thread::id> thread_{};
};

}  // namespace carom_python

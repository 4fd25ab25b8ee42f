#include "runner.h"

#include <carom/core/errors.h>
#include <carom/core/layout.h>

#include <algorithm>

namespace carom_python {

using namespace carom;

Mode mode_of(nb::handle from) {
  if (nb::isinstance<TimeStepping>(from)) return nb::cast<TimeStepping>(from);
  if (nb::isinstance<EventDriven>(from)) return nb::cast<EventDriven>(from);
  refuse("mode", "TimeStepping(...) or EventDriven(...)", from);
}

void check_threads(const Journal& journal, const Mode& mode) {
  const auto* const stepping = std::get_if<TimeStepping>(&mode);
  if (stepping == nullptr || stepping->threads <= 1) return;
  const std::string part = find_python_part(journal);
  if (part.empty()) return;
  throw ModelError(part + " is in Python, which one thread at a time can run, and threads is " +
                   std::to_string(stepping->threads) +
                   "; allowed: threads = 1, or a compiled function (of ctypes, or numba.cfunc)");
}

Runner::Runner(const Model& model, const Mode& mode) : journal_(model) {
  check_threads(journal_, mode);
  simulation_ = std::make_unique<Simulation>(model.system, mode);
  python_laws_ = !find_python_part(journal_).empty();
  warn();
  watch_simulation();
}

Runner::Runner(const Journal& journal, Simulation simulation)
    : journal_(journal), simulation_(std::make_unique<Simulation>(std::move(simulation))) {
  python_laws_ = !find_python_part(journal_).empty();
  static_cast<void>(simulation_->log());
  watch_simulation();
}

Runner* Runner::copy() {
  Simulation made = get().copy();
  return new Runner(journal_, std::move(made));  // NOLINT(cppcoreguidelines-owning-memory): Python takes it
}

void Runner::watch_simulation() {
  simulation_->interrupt_when(
      [this] {
        watch_.look(simulation_->time());
        return false;
      },
      [this](double time) { watch_.reach(time); });
}

/// Findings about the model are warnings of Python; the first step writes nothing of them.
void Runner::warn() {
  static_cast<void>(simulation_->log());
  for (const ModelFinding& finding : simulation_->report().findings) {
    const std::string text = std::string(to_string(finding.kind)) + ": " + finding.text;
    if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) < 0) throw nb::python_error();
  }
}

void Runner::check_thread() const {
  if (thread_.load() != std::this_thread::get_id()) {
    throw ModelError("simulation: another thread is running it; one thread at a time may use it");
  }
}

void Runner::stop_when(StopFunction stop) {
  get().stop_when(stop);
  stop_ = std::move(stop);
}

void Runner::run_until(double time, Watch::Show show) {
  run([&](Simulation& simulation) { simulation.run_until(time); }, std::move(show));
}

std::size_t Runner::keep(nb::handle function) {
  kept_.emplace(next_, nb::borrow(function));
  return next_++;
}

void Runner::forget_model() {
  system_ = nb::object();
  slots_.clear();
}

nb::object Runner::system() {
  get();
  if (!system_.is_valid()) {
    Model copy;
    static_cast<Journal&>(copy) = journal_;
    copy.system = simulation_->system();
    system_ = nb::cast(std::move(copy));
  }
  return system_;
}

void Runner::edit(nb::handle change) {
  get();
  if (PyCallable_Check(change.ptr()) == 0) refuse("edit(): change", "a function of a System", change);
  nb::object lent = nb::cast(Model{});
  Model& model = *nb::inst_ptr<Model>(lent);
  static_cast<Journal&>(model) = journal_;
  Journal changed;
  const auto take_back = [&](System& system) {
    system = std::move(model.system);
    model.system = System();
    model.closed = true;
  };
  const std::vector<ModelFinding> before = simulation_->report().findings;
  simulation_->edit([&](System& system) {
    model.system = std::move(system);
    try {
      change(lent);
    } catch (...) {
      take_back(system);
      throw;
    }
    take_back(system);
    check_threads(model, simulation_->mode());
    changed = model;
  });
  journal_ = std::move(changed);
  python_laws_ = !find_python_part(journal_).empty();
  forget_model();
  const auto same = [](const ModelFinding& a, const ModelFinding& b) { return a.text == b.text; };
  if (!std::ranges::equal(before, simulation_->report().findings, same)) warn();
}

void Runner::switch_to(const Mode& mode) {
  check_threads(journal_, mode);
  get().switch_to(mode);
}

const std::vector<std::pair<BodyId, BodySlot>>& Runner::slots() {
  if (slots_.empty()) {
    const Layout& layout = *get().state().layout();
    for (Index i = 0; i < layout.bodies().size(); ++i) slots_.emplace_back(layout.id(i), layout.bodies()[i]);
    std::ranges::sort(slots_, {}, [](const auto& place) { return place.first.serial; });
  }
  return slots_;
}

}  // namespace carom_python

#include <carom/core/dynamics/joint_closure.h>
#include <carom/core/run_error.h>
#include <carom/core/whole_file.h>
#include <carom/integrators/checkpoint.h>
#include <carom/integrators/mode_switch.h>
#include <carom/integrators/progress_bar.h>
#include <carom/integrators/run_news.h>
#include <carom/integrators/simulation_impl.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <iostream>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

namespace carom {

/// One step, ending at `limit` or the next periodic event at the latest, then all who wait for it.
void Simulation::Impl::step(Simulation& simulation, double limit, Stops stops) {
  const double close = grid().closeness(state.time);
  if (limit - state.time <= close) {
    state.time = limit;
    return;
  }
  // Left over where an observer saved the state: actions come after observers.
  std::vector<std::exception_ptr> thrown;
  if (next_due(companion) <= state.time + close) {
    call_actions(simulation, thrown);
    rethrow(thrown);
  }
  show_findings();
  const std::int64_t told = log.enabled(LogLevel::error) ? events_counted() : 0;
  {
    const CallGuard::Scope scope(guard, CallGuard::Caller::law);
    stop.check();
    const double end = std::min(limit, next_due(companion));
    const Run run{mode, state, companion, report, events, unlisted};
    const bool is_unseen = stops == Stops::where_seen && model->machines.driver && !looked_at();
    try {
      is_unseen ? model->machines.advance_unseen(run, end) : model->machines.advance(run, end);
    } catch (const RunError& error) {
      throw SolverError(error);  // if a law runs this simulation, it is no error of the run that asks the law
    }
    if (is_unseen && report_seen) list_impacts();  // who has it goes on looking
  }
  try {
    write_to_log(told);
  } catch (...) {
    thrown.push_back(std::current_exception());
  }
  if (callbacks.has_observers()) callbacks.call_observers(simulation, guard, thrown);
  call_actions(simulation, thrown);
  if (!thrown.empty()) rethrow(thrown);
}

void Simulation::Impl::call_actions(Simulation& simulation, std::vector<std::exception_ptr>& thrown) {
  if (companion.rhythms.empty()) return;
  const double close = grid().closeness(state.time);
  callbacks.call_actions(simulation, companion.rhythms, guard, thrown,
                         [&](const Rhythm& rhythm) { return rhythm.due() <= state.time + close; });
}

/// Lets out the first exception of callbacks; the log is told the others.
void Simulation::Impl::rethrow(const std::vector<std::exception_ptr>& thrown) {
  if (thrown.empty()) return;
  const CallGuard::Scope scope(guard, CallGuard::Caller::log_sink);
  write_exceptions(log, state.time, std::span(thrown).subspan(1));
  std::rethrow_exception(thrown.front());
}

std::int64_t Simulation::Impl::events_counted() const {
  const EventCounts& counts = companion.statistics.events;
  return std::accumulate(counts.begin(), counts.end(), std::int64_t{0});
}

/// Findings once for every model on the standard error stream, unless the user has taken the log.
void Simulation::Impl::show_findings() {
  if (log_taken || findings_written || report.findings.empty()) return;
  findings_written = true;
  for (const std::string& line : finding_lines(report.findings)) std::cerr << "carom: " << line << "\n";
}

/// Findings once for every model, as soon as there is a sink.
void Simulation::Impl::write_to_log(std::int64_t told) {
  if (!log.enabled(LogLevel::error)) return;  // the highest level of a line
  const CallGuard::Scope scope(guard, CallGuard::Caller::log_sink);
  if (!findings_written && log.enabled(LogLevel::warning)) {
    findings_written = true;
    for (const std::string& line : finding_lines(report.findings)) log.write(LogLevel::warning, line);
  }
  const Detector& detector = model->machines.detector();
  write_step_news(log, report, detector);
  const auto* const options = std::get_if<EventDriven>(&mode);
  if (options == nullptr || !options->record_events) return;
  const std::span<const EventRecord> records = events.records();
  const auto fresh = std::min(records.size(), static_cast<std::size_t>(events_counted() - told));
  write_event_news(log, records.last(fresh), detector);
}

Simulation::Simulation(System system, Mode mode) : impl_(new Impl(std::move(system), std::move(mode))) {}
Simulation::Simulation(System system, const TimeStepping& mode) : Simulation(std::move(system), Mode(mode)) {}
Simulation::Simulation(System system, const EventDriven& mode) : Simulation(std::move(system), Mode(mode)) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

const StepReport& Simulation::step() {
  impl_->guard.demand("step", CallGuard::Need::outside);
  impl_->grid().demand_times("step", impl_->state.time, impl_->companion, impl_->state.time);
  impl_->step(*this, std::numeric_limits<double>::infinity(), Impl::Stops::on_grid);
  return report();
}

void Simulation::run_until(double time) {
  Impl& self = *impl_;
  const auto refuse = [&](const std::string& allowed) {
    throw ModelError("run_until: time is " + to_text(time) + " s; allowed: " + allowed);
  };
  if (!std::isfinite(time)) refuse("a finite time");
  if (time < self.state.time) refuse("not before the present, " + to_text(self.state.time) + " s");
  self.guard.demand("run_until", CallGuard::Need::outside);
  if (time > self.state.time) {
    self.grid().demand_times("run_until", std::max(time, std::abs(self.state.time)), self.companion,
                             self.state.time);
  }
  std::optional<ProgressBar> bar;
  if (self.progress && ProgressBar::terminal()) bar.emplace(std::cerr, self.state.time, time);
  while (self.state.time < time) {
    self.step(*this, time, Impl::Stops::where_seen);
    if (bar) bar->update(self.state.time);
  }
}

CallbackId Simulation::observe(Observer observer) {
  impl_->guard.demand("observe", CallGuard::Need::no_step);
  if (!observer) throw ModelError("observe: observer is empty; allowed: a function");
  return impl_->callbacks.add_observer(std::move(observer));
}

CallbackId Simulation::every(double interval, Action action) {
  Impl& self = *impl_;
  self.guard.demand("every", CallGuard::Need::no_step);
  self.grid().demand_interval(interval, self.state.time);
  if (!action) throw ModelError("every: action is empty; allowed: a function");
  self.companion.rhythms.push_back({self.state.time, interval, 0});
  return self.callbacks.add_action(std::move(action));
}

void Simulation::remove_callback(const CallbackId& callback) {
  impl_->guard.demand("remove_callback", CallGuard::Need::no_step);
  if (impl_->callbacks.remove(callback, impl_->companion.rhythms)) return;
  throw ModelError(
      "remove_callback: the function is not called by this simulation; allowed: one given to its observe() "
      "or every() and not yet removed");
}

void Simulation::stop_when(StopFunction stop) {
  impl_->guard.demand("stop_when", CallGuard::Need::no_step);
  impl_->stop.stop_when(std::move(stop));
}

void Simulation::interrupt_when(StopFunction stop, ReachedFunction reached) {
  impl_->guard.demand("interrupt_when", CallGuard::Need::no_step);
  impl_->stop.interrupt_when(std::move(stop), std::move(reached));
}

void Simulation::edit(const std::function<void(System&)>& change) {
  if (!change) throw ModelError("edit: change is empty; allowed: a function");
  Impl& self = *impl_;
  self.guard.demand("edit", CallGuard::Need::no_reader);
  System system = self.model->assembly.system();
  const Index token = system.token();
  {
    const CallGuard::Scope scope(self.guard, CallGuard::Caller::change);
    change(system);
  }
  if (system.token() != token) {
    throw ModelError(
        "edit: the system was replaced by another one; allowed: changes of the one that is given");
  }
  const CallGuard::Scope scope(self.guard, CallGuard::Caller::law);
  auto edited = std::make_unique<RunningModel>(std::move(system), self.mode, self.stop);
  State state = edited->continued(self.state);
  RunningModel::Prepared start = edited->prepare(state);
  const double projected = start.projected;
  std::vector<ModelFinding> findings = edited->findings(std::move(start));
  const StoredEnergies stored = edited->stored_energies(state);
  const auto same = [](const ModelFinding& a, const ModelFinding& b) { return a.text == b.text; };
  self.findings_written = self.findings_written && std::ranges::equal(findings, self.report.findings, same);
  self.report.projected = projected;
  self.report.findings = std::move(findings);
  self.model = std::move(edited);
  self.state = std::move(state);
  // Contacts that stuck go on sticking: velocities have not changed.
  auto modes = std::move(self.companion.modes);
  self.forget_history();
  self.companion.modes = std::move(modes);
  self.book_intervention(stored);
}

void Simulation::set_state(const State& state) {
  Impl& self = *impl_;
  self.guard.demand("set_state", CallGuard::Need::no_reader);
  const CallGuard::Scope scope(self.guard, CallGuard::Caller::law);
  check_state(self.model->assembly, state);
  const Layout &given = *state.layout(), &own = *self.state.layout();
  if (&given != &own && !given.has_places_of(own)) {
    throw ModelError(
        "state: model is another one; allowed: a state of this model as it is since its last edit");
  }
  State closed = self.state;
  closed.time = state.time;
  closed.q = state.q;
  closed.v = state.v;
  closed.z = state.z;
  const double projected = self.model->prepare(closed).projected;
  const StoredEnergies stored = self.model->stored_energies(closed);
  self.report.projected = projected;
  const bool moved_in_time = state.time != self.state.time;
  self.state = std::move(closed);
  if (moved_in_time) {
    skip_events(self.companion, self.state.time);
    restart_grid(self.companion, self.state.time);
  }
  self.forget_history();
  self.book_intervention(stored);
}

void Simulation::switch_to(Mode mode) {
  Impl& self = *impl_;
  self.guard.demand("switch_to", CallGuard::Need::no_reader);
  self.list_impacts();
  const CallGuard::Scope scope(self.guard, CallGuard::Caller::law);
  const Assembly& assembly = self.model->assembly;
  ModeMachines machines(assembly, mode, self.stop);
  if (machines.driver && self.model->machines.stepper) {
    prepare_for_events(assembly, *machines.driver, self.state, self.companion, self.report, self.events);
  }
  if (machines.driver && self.model->machines.driver) machines.driver->demand_start(self.state);
  if (machines.stepper && self.model->machines.driver) {
    // Closed contacts last: what stuck goes on sticking.
    auto modes = std::move(self.companion.modes);
    self.forget_history();
    self.companion.modes = std::move(modes);
    self.companion.history.step = 0.0;
  }
  self.mode = std::move(mode);
  self.model->machines = std::move(machines);
  self.companion.next_step = 0.0;
  self.companion.iterations.clear();
  restart_grid(self.companion, self.state.time);
}

const System& Simulation::system() const { return impl_->model->assembly.system(); }
const Assembly& Simulation::assembly() const { return impl_->model->assembly; }
const State& Simulation::state() const { return impl_->state; }
double Simulation::time() const { return impl_->state.time; }
const EnergyLedger& Simulation::energy() const { return impl_->companion.ledger; }
const StepReport& Simulation::report() const {
  impl_->report_seen = true;
  if (impl_->unlisted > 0) impl_->list_impacts();
  return impl_->report;
}
const Statistics& Simulation::statistics() const { return impl_->companion.statistics; }
const ChainStatistics& Simulation::contact_statistics() const { return impl_->companion.contact_statistics; }
const Companion& Simulation::companion() const { return impl_->companion; }
const Mode& Simulation::mode() const { return impl_->mode; }
const std::vector<EventRecord>& Simulation::events() const { return impl_->events.records(); }
void Simulation::clear_events() {
  impl_->guard.demand("clear_events", CallGuard::Need::no_step);
  impl_->list_impacts();
  impl_->events.clear();
}
std::string Simulation::name(const ConstraintKey& key) const {
  return impl_->model->machines.detector().name(key);
}
Log& Simulation::log() {
  impl_->log_taken = true;
  return impl_->log;
}
void Simulation::show_progress(bool on) { impl_->progress = on; }

void Simulation::save(const std::string& path) const {
  impl_->guard.demand("save", CallGuard::Need::no_step);
  save_checkpoint(path, system().fingerprint(), impl_->state, impl_->companion);
  // Steps ahead of the state are not in the file: whoever loads it starts anew, and so does this run.
  if (impl_->model->machines.driver) impl_->model->machines.driver->forget();
}

void Simulation::load(const std::string& path) { restore_from(read_file(path, "checkpoint"), path, "load"); }

std::string Simulation::checkpoint() const {
  impl_->guard.demand("checkpoint", CallGuard::Need::no_step);
  std::string made = write_checkpoint(system().fingerprint(), impl_->state, impl_->companion);
  if (impl_->model->machines.driver) impl_->model->machines.driver->forget();
  return made;
}

void Simulation::restore(std::string_view checkpoint) { restore_from(checkpoint, "in memory", "restore"); }

void Simulation::restore_from(std::string_view content, const std::string& origin, const char* call) {
  impl_->guard.demand(call, CallGuard::Need::no_reader);
  read_checkpoint(content, origin, system().fingerprint(), impl_->state, impl_->companion);
  if (impl_->model->machines.driver) impl_->model->machines.driver->forget();
  impl_->grid().match(impl_->companion, impl_->state.time);
}

Simulation Simulation::copy() const {
  impl_->guard.demand("copy", CallGuard::Need::no_step);
  Simulation made(system(), mode());
  Companion without_actions = impl_->companion;
  without_actions.rhythms.clear();
  made.restore(write_checkpoint(system().fingerprint(), impl_->state, without_actions));
  if (impl_->model->machines.driver) impl_->model->machines.driver->forget();
  return made;
}

}  // namespace carom

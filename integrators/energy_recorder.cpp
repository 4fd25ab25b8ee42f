#include <carom/contact/detection/contact_look.h>
#include <carom/core/dynamics/total_momentum.h>
#include <carom/core/errors.h>
#include <carom/core/largest_coordinate.h>
#include <carom/core/part_check.h>
#include <carom/integrators/energy_recorder.h>
#include <carom/integrators/simulation.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace carom {

namespace {

/// Deepest penetration of the present state, of bodies into ground or each other [m].
double deepest_penetration(const Simulation& simulation) {
  const Detector detector(simulation.assembly());
  ConstraintSet contacts;
  ContactLook(simulation.assembly(), detector).find(simulation.state().view(), 0.0, contacts);
  double deepest = 0.0;
  for (const Constraint& contact : contacts) deepest = std::max(deepest, -contact.gap);
  return deepest;
}

/// Gathers what happens between rows and makes the rows.
class RowMaker {
public:
  void take_step(const Simulation& simulation) {
    const StepReport& report = simulation.report();
    for (const ContactRecord& contact : report.contacts) {
      penetration_ = std::max(penetration_, -contact.gap);
      if (!contact.impact) continue;
      std::string text = simulation.name(contact.key);
      text.append(", ").append(to_string(contact.mode));
      trace_.add(TraceEvent{report.time, std::move(text)});
    }
  }

  void add_row(const Simulation& simulation) {
    const EnergyLedger& energy = simulation.energy();
    const TotalMomentum momentum = total_momentum(simulation.assembly(), simulation.state());
    momentum_scale_ = std::max(momentum_scale_, momentum.linear_scale);
    angular_scale_ = std::max(angular_scale_, momentum.angular_scale);
    length_scale_ = std::max(length_scale_, largest_coordinate(simulation.state()));

    TraceRow row;
    row.time = simulation.time();
    row.stored = energy.stored();
    row.total = energy.total();
    row.initial = energy.initial();
    for (std::size_t i = 0; i < energy_flow_count; ++i) {
      row.flows.values[i] = energy.flow(static_cast<EnergyFlow>(i));
    }
    row.residual = energy.residual();
    row.energy_scale = energy.scale();
    row.momentum = momentum.linear;
    row.momentum_scale = momentum_scale_;
    row.angular_momentum = momentum.angular;
    row.angular_momentum_scale = angular_scale_;
    // Reports tell of the states at which steps begin: the present one is missing.
    row.penetration = std::max(penetration_, deepest_penetration(simulation));
    row.length_scale = length_scale_;
    trace_.add(row);
    penetration_ = 0.0;
  }

  [[nodiscard]] const EnergyTrace& trace() const { return trace_; }

private:
  EnergyTrace trace_;
  double penetration_ = 0.0;  // deepest since the last row
  double momentum_scale_ = 0.0, angular_scale_ = 0.0, length_scale_ = 0.0;
};

void check(const EnergyRecorder::Options& options) {
  const auto refuse = [](const std::string& what, const std::string& allowed) {
    throw ModelError("energy recorder: " + what + "; allowed: " + allowed);
  };
  if (options.every_steps < 0) {
    refuse("every_steps is " + std::to_string(options.every_steps), "at least 1, or 0 for none");
  }
  if (!(std::isfinite(options.interval) && options.interval >= 0.0)) {
    refuse("interval is " + to_text(options.interval) + " s", "finite and > 0, or 0 for none");
  }
  if (options.every_steps > 0 && options.interval > 0.0) {
    refuse("every_steps is " + std::to_string(options.every_steps) + " and interval " +
               to_text(options.interval) + " s",
           "one of the two");
  }
}

}  // namespace

struct EnergyRecorder::Impl {
  RowMaker rows;
  bool by_interval = false;
  long steps = 0;
};

EnergyRecorder::EnergyRecorder(Simulation& simulation) : EnergyRecorder(simulation, Options{}) {}

EnergyRecorder::EnergyRecorder(Simulation& simulation, const Options& options)
    : impl_(std::make_shared<Impl>()) {
  check(options);
  impl_->rows.add_row(simulation);
  // Observers come before actions: an interval's row finds the events of the step that led to it.
  impl_->by_interval = options.interval > 0.0;
  const int every = impl_->by_interval ? 0 : std::max(options.every_steps, 1);
  if (impl_->by_interval) {
    action_ =
        simulation.every(options.interval, [impl = impl_](Simulation& run) { impl->rows.add_row(run); });
  }
  observer_ = simulation.observe([impl = impl_, every](const Simulation& run) {
    impl->rows.take_step(run);
    if (every > 0 && ++impl->steps % every == 0) impl->rows.add_row(run);
  });
}

void EnergyRecorder::detach(Simulation& simulation) {
  simulation.remove_callback(observer_);
  if (impl_->by_interval) simulation.remove_callback(action_);
}

const EnergyTrace& EnergyRecorder::trace() const { return impl_->rows.trace(); }

EnergyTrace record_at(Simulation& simulation, const std::vector<double>& times) {
  double before = simulation.time();
  for (const double time : times) {
    if (!(std::isfinite(time) && time > before)) {
      throw ModelError("record_at: time is " + to_text(time) + " s; allowed: finite and later than " +
                       to_text(before) + " s");
    }
    before = time;
  }
  RowMaker rows;
  // Ends with this function, however it is left.
  struct Watch {
    Watch(Simulation& run, RowMaker& maker)
        : simulation(&run), id(run.observe([&maker](const Simulation& now) { maker.take_step(now); })) {}
    ~Watch() { simulation->remove_callback(id); }
    Watch(const Watch&) = delete;
    Watch& operator=(const Watch&) = delete;
    Simulation* simulation;
    CallbackId id;
  } const watch(simulation, rows);
  rows.add_row(simulation);
  for (const double time : times) {
    simulation.run_until(time);
    rows.add_row(simulation);
  }
  return rows.trace();
}

}  // namespace carom

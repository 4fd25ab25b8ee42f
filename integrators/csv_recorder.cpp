#include <carom/core/csv.h>
#include <carom/core/errors.h>
#include <carom/core/part_check.h>
#include <carom/integrators/csv_recorder.h>
#include <carom/integrators/simulation.h>

#include <array>
#include <string_view>

namespace carom {

namespace {

constexpr std::array<std::string_view, 3> axes{"x", "y", "z"};

}  // namespace

struct CsvRecorder::Impl {
  Impl(const std::string& file_path, const Options& chosen) : options(chosen), file("recorder", file_path) {}

  void write_header(const Simulation& simulation);
  void write_row(const Simulation& simulation);

  Options options;
  CsvWriter file;
  std::vector<std::size_t> columns;  // by body
  long rows = 0;
  long steps = 0;
};

void CsvRecorder::Impl::write_header(const Simulation& simulation) {
  const Layout& layout = *simulation.state().layout();
  const auto dimension = static_cast<std::size_t>(layout.dimension());
  const auto add = [this](const std::string& name) { file.add(std::string_view(name)); };
  add("time [s]");
  for (const BodyId body : options.bodies) {
    std::string name = simulation.system().given_name(body);
    if (name.empty()) name = simulation.system().name(body);
    const bool oriented = layout.slot(body).rotation != none;
    const auto column = [&](const std::string& quantity) { add(name + "." + quantity); };
    for (std::size_t i = 0; i < dimension; ++i) column(std::string(axes[i]) + " [m]");
    if (oriented) column("angle [rad]");
    for (std::size_t i = 0; i < dimension; ++i) column("v" + std::string(axes[i]) + " [m/s]");
    if (oriented) column("spin [rad/s]");
    columns.push_back(layout.slot(body).q_size + layout.slot(body).v_size);
  }
  if (options.energies) {
    const auto column = [&](std::string_view name) { add(std::string(name) + " [J]"); };
    for (std::size_t i = 0; i < stored_energy_count; ++i) column(to_string(static_cast<StoredEnergy>(i)));
    column("total");
    for (std::size_t i = 0; i < energy_flow_count; ++i) column(to_string(static_cast<EnergyFlow>(i)));
    column("residual");
  }
  file.end_line();
}

void CsvRecorder::Impl::write_row(const Simulation& simulation) {
  const State& state = simulation.state();
  const Layout& layout = *state.layout();
  const auto add = [this](double number) { file.add(number); };
  add(state.time);
  for (std::size_t i = 0; i < options.bodies.size(); ++i) {
    const BodyId body = options.bodies[i];
    if (!layout.contains(body)) {
      file.skip(columns[i]);
      continue;
    }
    const BodySlot& slot = layout.slot(body);
    for (Index k = 0; k < slot.q_size; ++k) add(state.q[slot.q + k]);
    for (Index k = 0; k < slot.v_size; ++k) add(state.v[slot.v + k]);
  }
  if (options.energies) {
    const EnergyLedger& energy = simulation.energy();
    for (std::size_t i = 0; i < stored_energy_count; ++i) add(energy.stored(static_cast<StoredEnergy>(i)));
    add(energy.total());
    for (std::size_t i = 0; i < energy_flow_count; ++i) add(energy.flow(static_cast<EnergyFlow>(i)));
    add(energy.residual());
  }
  file.end_line();
  ++rows;
}

CsvRecorder::CsvRecorder(Simulation& simulation, const std::string& path)
    : CsvRecorder(simulation, path, Options{}) {}

CsvRecorder::CsvRecorder(Simulation& simulation, const std::string& path, const Options& options) {
  if (options.every_steps < 1) {
    throw ModelError("recorder: every_steps is " + std::to_string(options.every_steps) +
                     "; allowed: at least 1");
  }
  for (const BodyId body : options.bodies) (void)simulation.state().layout()->index(body);
  impl_ = std::make_shared<Impl>(path, options);
  if (impl_->options.bodies.empty()) impl_->options.bodies = simulation.system().bodies();
  impl_->write_header(simulation);
  impl_->write_row(simulation);
  observer_ = simulation.observe([impl = impl_](const Simulation& run) {
    if (++impl->steps % impl->options.every_steps == 0) impl->write_row(run);
  });
}

void CsvRecorder::flush() { impl_->file.flush(); }

void CsvRecorder::detach(Simulation& simulation) {
  simulation.remove_callback(observer_);
  flush();
}

long CsvRecorder::rows() const { return impl_->rows; }

}  // namespace carom

#include <carom/core/csv.h>
#include <carom/integrators/contact_recorder.h>
#include <carom/integrators/forces_of_step.h>
#include <carom/integrators/simulation.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace carom {

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

/// Name of the part that the body of a contact touches.
std::string other_part(const System& system, const ContactRecord& contact) {
  if (contact.obstacle.valid()) return system.name(contact.obstacle);
  return contact.other.valid() ? system.name(contact.other) : std::string();
}

}  // namespace

struct ContactRecorder::Impl {
  explicit Impl(const std::string& path) : file("contact recorder", path) {}

  void write_header();
  void write_rows(const Simulation& simulation);
  [[nodiscard]] std::array<double, 3> mean_force(const ContactRecord& contact, double step) const;
  void write_row(const Simulation& simulation, const ContactRecord& contact);
  /// Empty where there is no number.
  void add(double number) { std::isnan(number) ? file.skip() : file.add(number); }
  void add(std::string_view text) { file.add(text); }

  CsvWriter file;
  long rows = 0;
  std::vector<LastingContact> forces;  // of a step in several parts, by key
};

void ContactRecorder::Impl::write_header() {
  const auto vector = [this](std::string_view quantity) {
    for (const char* const along : {"normal", "tangential", "second tangential"})
      add(std::string(along).append(quantity));
  };
  for (const char* const name : {"time [s]", "contact", "part", "other part", "x [m]", "y [m]", "z [m]",
                                 "normal x", "normal y", "normal z", "gap [m]"}) {
    add(std::string_view(name));
  }
  vector(" velocity before [m/s]");
  vector(" velocity after [m/s]");
  vector(" impulse [N s]");
  add(std::string_view("rolling impulse moment [N m s]"));
  vector(" mean force [N]");
  for (const char* const name :
       {"mode", "kind", "work of contact [J]", "energy gain of impact [J]", "restitution factor"}) {
    add(std::string_view(name));
  }
  file.end_line();
}

void ContactRecorder::Impl::write_rows(const Simulation& simulation) {
  const StepReport& report = simulation.report();
  forces.clear();
  if (is_parted(report)) {
    forces = forces_of_step(report);
    std::sort(forces.begin(), forces.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
  }
  for (const ContactRecord& contact : report.contacts) write_row(simulation, contact);
}

/// That over the whole step, as Simulation::contact_forces() has it. None of an impact.
std::array<double, 3> ContactRecorder::Impl::mean_force(const ContactRecord& contact, double step) const {
  if (contact.impact || !(step > 0.0)) return {nothing, nothing, nothing};
  const auto found =
      std::lower_bound(forces.begin(), forces.end(), contact.key,
                       [](const auto& force, const ConstraintKey& key) { return force.key < key; });
  if (found != forces.end()) return found->force;
  std::array<double, 3> force = contact.impulse;
  for (double& number : force) number /= step;
  return force;
}

void ContactRecorder::Impl::write_row(const Simulation& simulation, const ContactRecord& contact) {
  const System& system = simulation.system();
  add(contact.time);
  add(simulation.name(contact.key));
  add(system.name(contact.body));
  add(other_part(system, contact));
  for (const auto* numbers : {&contact.point, &contact.normal}) {
    for (const double number : *numbers) add(number);
  }
  add(contact.gap);
  for (const auto* numbers : {&contact.velocity_before, &contact.velocity_after, &contact.impulse}) {
    for (const double number : *numbers) add(number);
  }
  add(contact.rolling_moment);
  for (const double number : mean_force(contact, simulation.report().step)) add(number);
  add(to_string(contact.mode));
  add(std::string_view(contact.impact ? "impact" : "lasting"));
  add(contact.contact_work);
  add(contact.energy_gain);
  add(contact.restitution_factor);
  file.end_line();
  ++rows;
}

ContactRecorder::ContactRecorder(Simulation& simulation, const std::string& path)
    : impl_(std::make_shared<Impl>(path)) {
  impl_->write_header();
  observer_ = simulation.observe([impl = impl_](const Simulation& run) { impl->write_rows(run); });
}

void ContactRecorder::flush() { impl_->file.flush(); }

void ContactRecorder::detach(Simulation& simulation) {
  simulation.remove_callback(observer_);
  flush();
}

long ContactRecorder::rows() const { return impl_->rows; }

}  // namespace carom

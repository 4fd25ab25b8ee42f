#include <carom/contact/impulse_map.h>
#include <carom/integrators/event_driven/impact_list.h>

#include <algorithm>

namespace carom {

namespace {

ContactRecord contact_of(const EventRecord& event) {
  ContactRecord entry;
  entry.key = event.contact;
  entry.body = event.body;
  entry.obstacle = event.obstacle;
  entry.other = event.other;
  static_cast<ImpactNote&>(entry) = event;
  entry.time = event.time;
  static_cast<ContactFrame&>(entry) = event;
  entry.gap = event.gap;
  entry.velocity_before = event.velocity_before;
  entry.velocity_after = event.velocity_after;
  entry.impulse = event.impulse;
  for (std::size_t row = 0; row < 3; ++row) {
    entry.work[row] = impulse_work(event.impulse[row], event.velocity_before[row], event.velocity_after[row]);
  }
  entry.mode = event.mode;
  entry.impact = true;
  entry.outcome = event.outcome;
  entry.residual = event.residual;
  entry.solver = event.solver;
  return entry;
}

}  // namespace

void list_impacts(const RecordedEvents& events, std::size_t latest, StepReport& report) {
  const std::size_t size = events.size();
  for (std::size_t i = size - std::min(latest, size); i < size; ++i) {
    const EventRecord event = events.record(i);
    if (is_impulsive(event.kind)) report.contacts.push_back(contact_of(event));
  }
}

}  // namespace carom

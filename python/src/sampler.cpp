#include "sampler.h"

#include <carom/core/errors.h>
#include <carom/core/layout.h>
#include <carom/core/registry.h>
#include <carom/integrators/contact_forces.h>

#include <nanobind/ndarray.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace carom_python {

using namespace carom;

namespace {

// Multiples of an interval and ends of steps differ by rounding: by this part of the interval at most.
constexpr double same_time = 1e-6;

template <class Row>
void append(std::vector<std::byte>& rows, const Row& row) {
  const auto* const bytes = reinterpret_cast<const std::byte*>(&row);
  rows.insert(rows.end(), bytes, bytes + sizeof(Row));
}

template <std::size_t D>
void copy(const std::array<double, 3>& from, std::array<double, D>& to) {
  std::copy_n(from.begin(), D, to.begin());
}

template <class T>
nb::object hand_over(std::vector<T>&& values) {
  auto* const kept = new std::vector<T>(std::move(values));
  const nb::capsule owner(kept, [](void* memory) noexcept { delete static_cast<std::vector<T>*>(memory); });
  using Number = std::conditional_t<std::is_same_v<T, std::byte>, std::uint8_t, T>;
  static Number nothing{};
  auto* const data = kept->empty() ? &nothing : reinterpret_cast<Number*>(kept->data());
  const std::array<std::size_t, 1> shape{kept->size()};
  return nb::cast(nb::ndarray<nb::numpy, Number>(data, 1, shape.data(), owner));
}

void put(double*& to, double value) { *to++ = value; }

void read_ledger(const EnergyLedger& ledger, double* to) {
  for (std::size_t i = 0; i < stored_energy_count; ++i) put(to, ledger.stored(static_cast<StoredEnergy>(i)));
  put(to, ledger.total());
  put(to, ledger.initial());
  for (std::size_t i = 0; i < energy_flow_count; ++i) put(to, ledger.flow(static_cast<EnergyFlow>(i)));
  put(to, ledger.residual());
}

}  // namespace

NameList::NameList(const std::vector<std::string>& known) {
  for (const std::string& text : known) by_text_.emplace(text, static_cast<std::int32_t>(by_text_.size()));
}

std::int32_t NameList::place(const std::string& text) {
  const auto [at, is_new] = by_text_.emplace(text, static_cast<std::int32_t>(by_text_.size()));
  if (is_new) fresh_.push_back(text);
  return at->second;
}

std::int32_t NameList::place(const Simulation& simulation, const ConstraintKey& key) {
  const auto found = by_key_.find(key);
  if (found != by_key_.end()) return found->second;
  return by_key_.emplace(key, place(simulation.name(key))).first->second;
}

std::size_t EventCursor::advance(const std::vector<EventRecord>& events) {
  const bool cleared =
      events.size() < read_ ||
      (read_ > 0 && (events[read_ - 1].instant != instant_ || events[read_ - 1].time != time_));
  const std::size_t first = cleared ? 0 : read_;
  read_ = events.size();
  if (!events.empty()) time_ = events.back().time, instant_ = events.back().instant;
  return first;
}

Sampler::Sampler(Runner& runner, SamplerOptions options)
    : options_(std::move(options)),
      names_(options_.names),
      instant_(options_.instant),
      last_(options_.last),
      called_(std::chrono::steady_clock::now()) {
  if (!(std::isfinite(options_.interval) && options_.interval >= 0.0)) {
    throw ModelError("recorder: interval is " + std::to_string(options_.interval) +
                     " s; allowed: finite and >= 0");
  }
  if (options_.frames == 0) throw ModelError("recorder: frames of a block are 0; allowed: > 0");
  const Simulation& simulation = runner.get();
  dimension_ = simulation.state().layout()->dimension() == 3 ? 3 : 2;
  layout_ = simulation.state().layout();
  for (const auto& place : runner.slots()) slots_.push_back(place.second);
  const auto& ground_shapes = simulation.system().ground_shape_kinds();
  for (const Index serial : ground_shapes.serials()) {
    const auto place = ground_shapes.place(serial);
    if (ground_shapes.entries()[place.entry].kind->moves(place.slot)) moved_.push_back(serial);
  }
  cursor_.advance(simulation.events());
  begin_block();
}

void Sampler::begin_block() {
  block_.frames = 0;
  const std::size_t widths[] = {1, 3 * slots_.size(), 3 * slots_.size(), 3 * moved_.size(), ledger_terms};
  for (std::size_t i = 0; i < block_.arrays.size(); ++i) {
    block_.arrays[i] = new_array(options_.frames * widths[i], 0, block_.next[i]);
  }
  block_.contact_ends.clear();
  block_.event_ends.clear();
}

void Sampler::check(const Simulation& simulation) const {
  if (simulation.state().layout() != layout_) {
    throw ModelError(
        "recorder: the model was edited; close the recorder before, and begin another one after");
  }
  if (simulation.time() < last_) {
    throw ModelError("recorder: time is " + std::to_string(simulation.time()) +
                     " s, before the last sample; allowed: not less than " + std::to_string(last_) + " s");
  }
}

void Sampler::observe(const Simulation& simulation) {
  check(simulation);
  if (dimension_ == 2) {
    read_events<2>(simulation);
  } else {
    read_events<3>(simulation);
  }
  const double interval = options_.interval;
  const double due = interval > 0.0 && last_ == last_
                         ? (std::floor(last_ / interval + same_time) + 1.0 - same_time) * interval
                         : -std::numeric_limits<double>::infinity();
  if (simulation.time() >= due) sample(simulation);
}

void Sampler::sample(const Simulation& simulation) {
  check(simulation);
  if (block_.frames == options_.frames) throw ModelError("recorder: its block is full and was not taken");
  if (options_.contacts && dimension_ == 2) read_contacts<2>(simulation);
  if (options_.contacts && dimension_ == 3) read_contacts<3>(simulation);
  read_states(simulation);
  last_ = simulation.time();
  ++block_.frames;
  const double passed = std::chrono::duration<double>(std::chrono::steady_clock::now() - called_).count();
  if (block_.frames == options_.frames || (options_.seconds > 0.0 && passed > options_.seconds)) call_full();
}

void Sampler::call_full() {
  const nb::gil_scoped_acquire lock;
  if (!options_.full.get().is_none()) options_.full.get()();
  called_ = std::chrono::steady_clock::now();
}

template <int D>
void Sampler::read_events(const Simulation& simulation) {
  const std::vector<EventRecord>& events = simulation.events();
  for (std::size_t i = cursor_.advance(events); i < events.size(); ++i) {
    const EventRecord& event = events[i];
    EventRow<D> row;
    row.time = event.time, row.instant = event.instant, row.gap = event.gap;
    copy(event.point, row.point), copy(event.normal, row.normal), copy(event.impulse, row.impulse);
    copy(event.velocity_before, row.velocity_before), copy(event.velocity_after, row.velocity_after);
    row.energy_before = event.energy_before, row.energy_after = event.energy_after;
    row.name =
        event.body.valid() ? names_.place(simulation, event.contact) : names_.place(simulation.name(event));
    row.kind = static_cast<std::uint8_t>(event.kind), row.mode = static_cast<std::uint8_t>(event.mode);
    append(block_.events, row);
  }
  if (!std::holds_alternative<TimeStepping>(simulation.mode())) return;
  bool any = false;
  for (const ContactRecord& contact : simulation.report().contacts) {
    if (!contact.impact) continue;
    any = true;
    EventRow<D> row;
    row.time = contact.time, row.instant = instant_, row.gap = contact.gap;
    copy(contact.point, row.point), copy(contact.normal, row.normal), copy(contact.impulse, row.impulse);
    copy(contact.velocity_before, row.velocity_before), copy(contact.velocity_after, row.velocity_after);
    row.energy_before = row.energy_after = std::numeric_limits<double>::quiet_NaN();
    row.name = names_.place(simulation, contact.key);
    row.kind = static_cast<std::uint8_t>(EventKind::impact),
    row.mode = static_cast<std::uint8_t>(contact.mode);
    append(block_.events, row);
  }
  if (any) ++instant_;
}

template <int D>
void Sampler::read_contacts(const Simulation& simulation) {
  for (const ContactRecord& contact : simulation.report().contacts) {
    if (contact.key.a.owner == FeatureKey::Owner::joint) continue;  // a limit, which is at no place
    ContactRow<D> row;
    copy(contact.point, row.point), copy(contact.normal, row.normal), copy(contact.impulse, row.impulse);
    row.gap = contact.gap, row.name = names_.place(simulation, contact.key);
    row.mode = static_cast<std::uint8_t>(contact.mode), row.impact = contact.impact ? 1 : 0;
    append(block_.contacts, row);
  }
  const double step = simulation.report().step;
  // The report of an event-driven step has impacts only. Before the first step nothing is known to last.
  if (std::holds_alternative<EventDriven>(simulation.mode()) && step > 0.0) read_lasting<D>(simulation, step);
}

template <int D>
void Sampler::read_lasting(const Simulation& simulation, double step) {
  for (const LastingContact& contact : simulation.contact_forces()) {
    ContactRow<D> row;
    copy(contact.point, row.point), copy(contact.normal, row.normal), copy(contact.force, row.impulse);
    for (double& impulse : row.impulse) impulse *= step;
    row.gap = contact.gap, row.name = names_.place(simulation, contact.key);
    row.mode = static_cast<std::uint8_t>(contact.mode);
    append(block_.contacts, row);
  }
}

void Sampler::read_states(const Simulation& simulation) {
  const State& state = simulation.state();
  auto& [times, positions, velocities, places, ledger] = block_.next;
  put(times, state.time);
  // Pointers of its own, which stay in registers.
  double *to_q = positions, *to_v = velocities;
  for (const BodySlot& slot : slots_) {
    const double *const q = &state.q[slot.q], *const v = &state.v[slot.v];
    const bool has_third = dimension_ == 3 || slot.rotation != none;
    to_q[0] = q[0], to_q[1] = q[1], to_q[2] = has_third ? q[2] : 0.0;
    to_v[0] = v[0], to_v[1] = v[1], to_v[2] = has_third ? v[2] : 0.0;
    to_q += 3, to_v += 3;
  }
  positions = to_q, velocities = to_v;
  const auto& shapes = simulation.system().ground_shape_kinds();
  for (const Index serial : moved_) {
    const auto at = shapes.place(serial);
    const GroundMotion motion = shapes.entries()[at.entry].kind->place(at.slot, state.time);
    put(places, motion.point[0]), put(places, motion.point[1]), put(places, motion.angle);
  }
  read_ledger(simulation.energy(), ledger);
  ledger += ledger_terms;
  const std::size_t contact = dimension_ == 2 ? sizeof(ContactRow<2>) : sizeof(ContactRow<3>);
  const std::size_t event = dimension_ == 2 ? sizeof(EventRow<2>) : sizeof(EventRow<3>);
  block_.contact_ends.push_back(static_cast<std::int64_t>(block_.contacts.size() / contact));
  block_.event_ends.push_back(static_cast<std::int64_t>(block_.events.size() / event));
}

nb::dict Sampler::take() {
  nb::dict taken;
  const char* const names[] = {"times", "positions", "velocities", "ground", "ledger"};
  for (std::size_t i = 0; i < block_.arrays.size(); ++i) taken[names[i]] = std::move(block_.arrays[i]);
  taken["frames"] = block_.frames;
  taken["contacts"] = hand_over(std::exchange(block_.contacts, {}));
  taken["events"] = hand_over(std::exchange(block_.events, {}));
  taken["contact_ends"] = hand_over(std::exchange(block_.contact_ends, {}));
  taken["event_ends"] = hand_over(std::exchange(block_.event_ends, {}));
  taken["names"] = Convert<std::vector<std::string>>::cast(names_.take_fresh());
  begin_block();
  return taken;
}

}  // namespace carom_python

#pragma once

// Samples of a run for carom.Recorder: rows of arrays, filled where they are kept, so that each number is
// copied once.

#include "functions.h"
#include "runner.h"

#include <carom/core/energy_term.h>
#include <carom/integrators/run/event_log.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace carom_python {

/// One contact of a sample. D: dimension of the model.
template <int D>
struct ContactRow {
  std::array<double, D> point{};   ///< where it touches [m]
  std::array<double, D> normal{};  ///< towards its body
  /// Normal first, of the step that ended at the sample; of a contact that lasts in the event-driven mode its
  /// force there times the length of the step [N s].
  std::array<double, D> impulse{};
  double gap = 0.0;         ///< [m]
  std::int32_t name = 0;    ///< place in the list of names
  std::uint8_t mode = 0;    ///< ContactMode
  std::uint8_t impact = 0;  ///< 1: closed faster than the capture speed
  std::uint16_t unused = 0;
};

/// One event; in time stepping an impact that a step's report has.
template <int D>
struct EventRow {
  double time = 0.0;                        ///< [s]
  std::int64_t instant = 0;                 ///< events of one instant have the same
  std::array<double, D> point{};            ///< of an impact [m]
  std::array<double, D> normal{};           ///< of an impact
  std::array<double, D> impulse{};          ///< normal first [N s]
  std::array<double, D> velocity_before{};  ///< of the contact, normal first [m/s]
  std::array<double, D> velocity_after{};   ///< likewise
  double gap = 0.0;                         ///< [m]
  double energy_before = 0.0;               ///< kinetic, of the bodies that answer; NaN in time stepping [J]
  double energy_after = 0.0;                ///< likewise
  std::int32_t name = 0;                    ///< place in the list of names
  std::uint8_t kind = 0;                    ///< EventKind
  std::uint8_t mode = 0;                    ///< ContactMode, after
  std::uint16_t unused = 0;
};

/// Choice of samples.
struct SamplerOptions {
  double interval = 0.0;           ///< >= 0; 0: every step [s]
  bool contacts = true;            ///< contacts too
  std::size_t frames = 1;          ///< of a block, after which `full` is called; > 0
  double seconds = 0.0;            ///< > 0: `full` is called after these too, of the clock on the wall
  Shared full;                     ///< a function without arguments, or none
  std::vector<std::string> names;  ///< known before
  /// Time of a sample that was taken before; NaN: none [s].
  double last = std::numeric_limits<double>::quiet_NaN();
  std::int64_t instant = 0;  ///< number of the first instant of impacts in time stepping
};

/// Names that rows refer to by their places.
class NameList {
public:
  explicit NameList(const std::vector<std::string>& known);
  /// Place of the name of a contact.
  std::int32_t place(const carom::Simulation& simulation, const carom::ConstraintKey& key);
  /// Place of a text.
  std::int32_t place(const std::string& text);
  /// Names that came since the last call.
  [[nodiscard]] std::vector<std::string> take_fresh() { return std::exchange(fresh_, {}); }

private:
  std::map<carom::ConstraintKey, std::int32_t> by_key_;
  std::map<std::string, std::int32_t> by_text_;
  std::vector<std::string> fresh_;
};

/// Place in the list of events up to which they were read. Its user may clear the list meanwhile.
class EventCursor {
public:
  /// Number of the first event that was not read yet; all are read then.
  std::size_t advance(const std::vector<carom::EventRecord>& events);

private:
  std::size_t read_ = 0;
  double time_ = 0.0;
  std::int64_t instant_ = 0;
};

/// Samples at the first end of a step at or after every multiple of an interval. It observes the run and
/// changes nothing in it.
class Sampler {
public:
  static constexpr std::size_t ledger_terms = carom::stored_energy_count + carom::energy_flow_count + 3;

  Sampler(Runner& runner, SamplerOptions options);

  /// Called after each step. Throws ModelError where the model was edited since the start, or time went back.
  void observe(const carom::Simulation& simulation);
  /// A sample now, whatever the interval. Throws as observe().
  void sample(const carom::Simulation& simulation);
  /// Samples since the last call: arrays by name, whose memory is handed over.
  [[nodiscard]] nb::dict take();
  /// Time of the last sample; NaN if there is none [s].
  [[nodiscard]] double last() const { return last_; }
  /// Serial numbers of the moved shapes on ground, in the order of the array `ground`.
  [[nodiscard]] const std::vector<carom::Index>& moved() const { return moved_; }
  [[nodiscard]] int dimension() const { return dimension_; }

private:
  /// Rows of one block: NumPy's own memory where their number is known before.
  struct Block {
    std::array<nb::object, 5> arrays{};  // times, positions, velocities, ground, ledger
    std::array<double*, 5> next{};       // where their next number belongs
    std::vector<std::byte> contacts, events;
    std::vector<std::int64_t> contact_ends, event_ends;  // since the start of the block, at each sample
    std::size_t frames = 0;
  };
  template <int D>
  void read_events(const carom::Simulation& simulation);
  template <int D>
  void read_contacts(const carom::Simulation& simulation);
  template <int D>
  void read_lasting(const carom::Simulation& simulation, double step);
  void read_states(const carom::Simulation& simulation);
  void check(const carom::Simulation& simulation) const;
  void begin_block();
  void call_full();

  SamplerOptions options_;
  int dimension_ = 2;
  std::vector<carom::BodySlot> slots_;
  std::shared_ptr<const carom::Layout> layout_;
  std::vector<carom::Index> moved_;
  NameList names_;
  EventCursor cursor_;
  std::int64_t instant_;  // of impacts of time stepping
  Block block_;
  double last_;
  std::chrono::steady_clock::time_point called_;
};

}  // namespace carom_python

#include <carom/core/errors.h>
#include <carom/core/fingerprint.h>
#include <carom/core/part_check.h>
#include <carom/core/whole_file.h>
#include <carom/integrators/checkpoint.h>
#include <carom/integrators/checkpoint_bytes.h>
#include <carom/integrators/checkpoint_keys.h>
#include <carom/integrators/checkpoint_statistics.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace carom {

namespace {

/// Behind it the version and a line break. Those before are read too.
constexpr std::string_view mark = "carom checkpoint ";

/// Takes the number in front of a line break off a text, and the break; 0 where there is none.
int take_version(std::string_view& text) {
  constexpr std::size_t most_digits = 4;
  int version = 0;
  for (std::size_t i = 0; i < std::min(most_digits + 1, text.size()); ++i) {
    if (text[i] == '\n') {
      text.remove_prefix(i + 1);
      return version;
    }
    if (text[i] < '0' || text[i] > '9') return 0;
    version = 10 * version + (text[i] - '0');
  }
  return 0;
}

void add(CheckpointWriter& out, const JointHistory& history) {
  out.add(history.step);
  out.add(std::uint64_t{history.known.size()});
  for (const int known : history.known) out.add(known);
  if (history.known.empty()) return;
  for (const StepCourse* const course : {&history.impulses, &history.velocities, &history.displacements}) {
    for (std::size_t ago = 0; ago < course->depth(); ++ago) out.add(course->numbers(ago));
  }
}

void add(CheckpointWriter& out, const ContactHistory& history) {
  out.add(history.step);
  out.add(std::uint64_t{history.starts.size()});
  for (std::size_t i = 0; i < history.starts.size(); ++i) {
    add(out, history.contacts.keys()[i]);
    for (const double impulse : history.starts[i].impulse) out.add(impulse);
    out.add(history.starts[i].kept);
  }
}

/// Changes of loads in the last steps; that of the last one may have to be computed first.
void add_changes(CheckpointWriter& out, const Companion& companion) {
  const LoadHistory& history = companion.history;
  LoadHistory last;
  const bool pending = history.known > 0 && history.pending;
  if (pending) {
    const std::size_t size = companion.loads.total.size();
    last.go_on(history.step, size);
    last.record_change({0, static_cast<Index>(size)}, history.before.data(), companion.loads.total.data());
  }
  for (int i = 0; i < history.known; ++i) {
    const LoadHistory& from = i == 0 && pending ? last : history;
    out.add(from.changes[static_cast<std::size_t>(i)]);
  }
}

std::uint64_t checksum(std::string_view bytes) {
  Fingerprint print;
  print.add(bytes);
  return print.value();
}

}  // namespace

std::string write_checkpoint(std::uint64_t fingerprint, const State& state, const Companion& companion) {
  CheckpointWriter out;
  out.add(fingerprint);
  out.add(state.time);
  out.add(state.q);
  out.add(state.v);
  out.add(state.z);
  for (const double number : companion.ledger.save()) out.add(number);
  for_statistics(companion.statistics, checkpoint_version, [&out](const auto& number) { out.add(number); });
  for_contact_statistics(companion.contact_statistics, checkpoint_version,
                         [&out](const auto& number) { out.add(number); });
  out.add(companion.rounding);
  out.add(companion.history.known);
  out.add(companion.history.step);
  add_changes(out, companion);
  out.add(std::uint64_t{companion.history.sweeps.size()});
  for (const int sweeps : companion.history.sweeps) out.add(sweeps);
  out.add(std::uint64_t{companion.iterations.entries().size()});
  for (const IterationMemory::Entry& entry : companion.iterations.entries()) {
    out.add(std::uint64_t{entry.component});
    out.add(std::uint64_t{static_cast<std::uint8_t>(entry.solved)});
    out.add(entry.steps);
  }
  out.add(std::uint64_t{companion.loads.valid && companion.loads.mean});
  if (companion.loads.valid && companion.loads.mean) out.add(companion.loads.total);
  out.add(companion.next_step);
  out.add(companion.grid_start);
  out.add(companion.grid_steps);
  out.add(std::uint64_t{companion.modes.size()});
  for (const auto& [key, mode] : companion.modes) {
    add(out, key);
    out.add(std::uint64_t{static_cast<std::uint8_t>(mode)});
  }
  out.add(std::uint64_t{companion.rhythms.size()});
  for (const Rhythm& rhythm : companion.rhythms) {
    out.add(rhythm.start);
    out.add(rhythm.interval);
    out.add(rhythm.fired);
  }
  add(out, companion.joints);
  add(out, companion.contacts);
  out.add(std::uint64_t{companion.closings.all_free});
  out.add(std::uint64_t{companion.closings.free.size()});
  for (const ConstraintKey& key : companion.closings.free) add(out, key);
  const std::string_view body(out.bytes().data(), out.bytes().size());
  CheckpointWriter end;
  end.add(checksum(body));

  std::string content(mark);
  content.append(std::to_string(checkpoint_version)).append("\n");
  content.append(body).append(end.bytes().data(), end.bytes().size());
  return content;
}

void save_checkpoint(const std::string& path, std::uint64_t fingerprint, const State& state,
                     const Companion& companion) {
  write_file(path, write_checkpoint(fingerprint, state, companion), "checkpoint");
}

namespace {

void read_history(CheckpointReader& in, std::size_t velocities, LoadHistory& history) {
  in.get(history.known);
  if (history.known < 0 || history.known > LoadHistory::most)
    in.damaged("its history of loads is of unknown length");
  in.get(history.step);
  for (int i = 0; i < LoadHistory::most; ++i) {
    std::vector<float>& changes = history.changes[static_cast<std::size_t>(i)];
    if (i < history.known) {
      in.get(changes);
      if (changes.size() != velocities) in.damaged("its sizes do not fit the model");
    } else if (history.known > 0) {
      changes.resize(velocities);
    }
  }
  history.sweeps.resize(in.count());
  for (int& sweeps : history.sweeps) in.get(sweeps);
}

void read_iterations(CheckpointReader& in, IterationMemory& iterations) {
  const std::size_t remembered = in.count();
  for (std::size_t i = 0; i < remembered; ++i) {
    std::uint64_t component = 0, solved = 0;
    IterationMemory::Entry entry;
    in.get(component);
    in.get(solved);
    in.get(entry.steps);
    entry.component = static_cast<Index>(component);
    entry.solved = static_cast<Iteration>(solved);
    if (component >= none || solved >= iteration_count || !iterations.append(entry)) {
      in.damaged("an iteration is unknown");
    }
  }
}

void read_mean_loads(CheckpointReader& in, std::size_t velocities, PresentLoads& loads) {
  std::uint64_t has_mean_loads = 0;
  in.get(has_mean_loads);
  if (has_mean_loads > 1) in.damaged("it is unknown whether it holds loads");
  if (has_mean_loads == 0) return;
  loads.valid = loads.mean = true;
  in.get(loads.total);
  if (loads.total.size() != velocities) in.damaged("its sizes do not fit the model");
  loads.dissipative.resize(loads.total.size());
  loads.external.resize(loads.total.size());
}

void read_modes(CheckpointReader& in, Companion& companion) {
  companion.modes.resize(in.count());
  for (auto& [key, mode] : companion.modes) {
    get(in, key);
    std::uint64_t number = 0;
    in.get(number);
    if (number > static_cast<std::uint64_t>(ContactMode::slip)) in.damaged("a contact has an unknown mode");
    mode = static_cast<ContactMode>(number);
  }
}

void read_closings(CheckpointReader& in, ClosingNotes& closings) {
  std::uint64_t all = 0;
  in.get(all);
  closings.all_free = all != 0;
  closings.free.resize(in.count());
  for (ConstraintKey& key : closings.free) get(in, key);
}

void read_rhythms(CheckpointReader& in, std::vector<Rhythm>& rhythms) {
  rhythms.resize(in.count());
  for (Rhythm& rhythm : rhythms) {
    in.get(rhythm.start);
    in.get(rhythm.interval);
    in.get(rhythm.fired);
  }
}

void read_joint_history(CheckpointReader& in, int version, std::size_t velocities, JointHistory& history) {
  constexpr std::size_t depth_before = 6;  // up to version 12, of all courses
  in.get(history.step);
  history.known.resize(in.count());
  for (int& known : history.known) {
    in.get(known);
    if (known < 0 || known > JointHistory::most) in.damaged("its history of joints is of unknown length");
  }
  if (history.known.empty()) return;
  for (StepCourse* const course : {&history.impulses, &history.velocities, &history.displacements}) {
    const std::size_t depth = course->depth(), saved = version >= 13 ? depth : depth_before;
    std::vector<double> forgotten;
    for (std::size_t ago = 0; ago < saved; ++ago) {
      std::vector<double>& numbers = ago < depth ? course->numbers(ago) : forgotten;
      in.get(numbers);
      const std::size_t size = course == &history.impulses ? course->numbers(0).size() : velocities;
      if (numbers.size() != size) in.damaged("its sizes do not fit the model");
    }
    for (std::size_t ago = saved; ago < depth; ++ago)
      course->numbers(ago).assign(course->numbers(0).size(), 0.0);
  }
}

void read_contacts(CheckpointReader& in, int version, ContactHistory& history) {
  double step = 0.0;
  in.get(step);
  history.start(step);
  for (std::size_t left = in.count(); left > 0; --left) {
    ConstraintKey key;
    SweepStart start;
    get(in, key);
    for (double& number : start.impulse) in.get(number);
    if (version >= 12) in.get(start.kept);
    if (start.kept < 0 || start.kept > SweepStart::most_kept) {
      in.damaged("the impulses of a contact were kept for an impossible number of steps");
    }
    history.add(key, start);
  }
  history.contacts.finish();
}

/// Demands the periodic events of the simulation.
void demand_rhythms(const std::string& path, const std::vector<Rhythm>& found,
                    const std::vector<Rhythm>& present) {
  if (found.size() != present.size()) {
    throw FileError("checkpoint '" + path + "': has " + std::to_string(found.size()) +
                    " periodic events, the simulation " + std::to_string(present.size()));
  }
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i].interval == present[i].interval) continue;
    throw FileError("checkpoint '" + path + "': periodic event " + std::to_string(i) +
                    " has an interval of " + to_text(found[i].interval) + " s, in the simulation " +
                    to_text(present[i].interval) + " s");
  }
}

/// A checkpoint without its mark and its checksum.
struct CheckpointContent {
  int version;
  std::string_view body;
};

/// Demands mark and checksum.
CheckpointContent checked_content(const std::string& path, std::string_view text) {
  int version = 0;
  if (text.starts_with(mark)) {
    text.remove_prefix(mark.size());
    version = take_version(text);
  }
  if (version < oldest_checkpoint || version > checkpoint_version) {
    throw FileError("checkpoint '" + path + "': is not a checkpoint of this version");
  }
  constexpr std::size_t checksum_size = 8;
  if (text.size() < checksum_size) throw FileError("checkpoint '" + path + "': is damaged: ends too early");
  const std::string_view body = text.substr(0, text.size() - checksum_size);
  CheckpointReader end(path, text.substr(body.size()));
  std::uint64_t expected = 0;
  end.get(expected);
  if (expected != checksum(body)) end.damaged("its checksum does not fit");
  return {version, body};
}

}  // namespace

void load_checkpoint(const std::string& path, std::uint64_t fingerprint, State& state, Companion& companion) {
  read_checkpoint(read_file(path, "checkpoint"), path, fingerprint, state, companion);
}

void read_checkpoint(std::string_view content, const std::string& origin, std::uint64_t fingerprint,
                     State& state, Companion& companion) {
  const auto [version, body] = checked_content(origin, content);
  CheckpointReader in(origin, body);
  std::uint64_t found = 0;
  in.get(found);
  if (found != fingerprint) throw FileError("checkpoint '" + origin + "': is of another model");
  State read = state;
  Companion other;
  in.get(read.time);
  in.get(read.q);
  in.get(read.v);
  in.get(read.z);
  if (read.q.size() != state.q.size() || read.v.size() != state.v.size() || read.z.size() != state.z.size()) {
    in.damaged("its sizes do not fit the model");
  }
  std::array<double, EnergyLedger::saved_size> ledger{};
  for (double& number : ledger) in.get(number);
  other.ledger.load(ledger);
  for_statistics(other.statistics, version, [&in](auto& number) { in.get(number); });
  for_contact_statistics(other.contact_statistics, version, [&in](auto& number) { in.get(number); });
  in.get(other.rounding);
  if (other.rounding.size() != companion.rounding.size()) in.damaged("its sizes do not fit the model");
  read_history(in, state.v.size(), other.history);
  read_iterations(in, other.iterations);
  read_mean_loads(in, state.v.size(), other.loads);
  in.get(other.next_step);
  in.get(other.grid_start);
  in.get(other.grid_steps);
  read_modes(in, other);
  read_rhythms(in, other.rhythms);
  if (version >= 7) {
    read_joint_history(in, version, state.v.size(), other.joints);
    read_contacts(in, version, other.contacts);
  }
  if (version >= 11 && version < 15) {
    std::int64_t unused = 0;  // steps that closings were allowed to take
    in.get(unused);
  }
  if (version >= 14) read_closings(in, other.closings);
  in.finish();
  demand_rhythms(origin, other.rhythms, companion.rhythms);
  state = std::move(read);
  companion = std::move(other);
}

}  // namespace carom

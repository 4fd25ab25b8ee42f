#include <carom/core/errors.h>
#include <carom/core/fingerprint.h>
#include <carom/core/part_check.h>
#include <carom/core/whole_file.h>
#include <carom/integrators/checkpoint.h>

#include <bit>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace carom {

namespace {

constexpr std::string_view mark = "carom checkpoint 6\n";

/// Numbers as bytes, lowest first, whatever the machine.
class Writer {
public:
  void add(std::uint64_t number) {
    for (unsigned shift = 0; shift < 64; shift += 8)
      bytes_.push_back(static_cast<char>((number >> shift) & 0xffU));
  }
  void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
  void add(std::int64_t number) { add(static_cast<std::uint64_t>(number)); }
  void add(int number) { add(std::int64_t{number}); }
  template <class Real>
  void add(const std::vector<Real>& numbers) {
    add(std::uint64_t{numbers.size()});
    for (const Real number : numbers) add(static_cast<double>(number));
  }
  [[nodiscard]] const std::vector<char>& bytes() const { return bytes_; }

private:
  std::vector<char> bytes_;
};

class Reader {
public:
  Reader(std::string path, std::string_view bytes) : path_(std::move(path)), bytes_(bytes) {}

  void get(std::uint64_t& number) {
    if (bytes_.size() < 8) damaged("ends too early");
    number = 0;
    for (unsigned i = 0; i < 8; ++i)
      number |= std::uint64_t{static_cast<unsigned char>(bytes_[i])} << (8 * i);
    bytes_.remove_prefix(8);
  }
  void get(double& number) {
    std::uint64_t bits = 0;
    get(bits);
    number = std::bit_cast<double>(bits);
  }
  void get(std::int64_t& number) {
    std::uint64_t bits = 0;
    get(bits);
    number = static_cast<std::int64_t>(bits);
  }
  void get(int& number) {
    std::int64_t wide = 0;
    get(wide);
    number = static_cast<int>(wide);
  }
  /// A count of things of at least 8 bytes each, which must fit into what is left.
  std::size_t count() {
    std::uint64_t number = 0;
    get(number);
    if (number > bytes_.size() / 8) damaged("a count does not fit");
    return static_cast<std::size_t>(number);
  }
  template <class Real>
  void get(std::vector<Real>& numbers) {
    numbers.resize(count());
    for (Real& kept : numbers) {
      double number = 0.0;
      get(number);
      kept = static_cast<Real>(number);
    }
  }
  void finish() const {
    if (!bytes_.empty()) damaged("goes on after its end");
  }
  [[noreturn]] void damaged(const std::string& how) const {
    throw FileError("checkpoint '" + path_ + "': is damaged: " + how);
  }

private:
  std::string path_;
  std::string_view bytes_;
};

/// The numbers of Statistics, in the order in which they are saved.
template <class S, class F>
void for_statistics(S& s, F&& f) {
  f(s.steps);
  f(s.sweeps);
  f(s.most_sweeps);
  f(s.largest_contraction);
  for (auto& count : s.steps_by_iteration) f(count);
  f(s.fallbacks);
  f(s.impacts);
  f(s.contact_steps);
  f(s.several_solutions);
  f(s.forces_not_unique);
  f(s.rejected_steps);
  f(s.steps_across_impacts);
  f(s.energy_gains);
  f(s.energy_gained);
  f(s.lasting_gains);
  f(s.lasting_gained);
  f(s.deepest_gap);
  f(s.worst_residual);
  for (auto& count : s.events) f(count);
  f(s.flow_steps);
  f(s.flow_evaluations);
  f(s.flow_restarts);
}

/// Likewise those of the contact solvers.
template <class S, class F>
void for_contact_statistics(S& s, F&& f) {
  f(s.problems);
  for (auto& count : s.accepted) f(count);
  for (auto& count : s.tried) f(count);
  f(s.fall_backs);
  f(s.tolerated);
  f(s.several_solutions);
  f(s.forces_not_unique);
  f(s.degenerate);
  f(s.no_solution);
  f(s.not_solved);
  f(s.worst_residual);
}

void add(Writer& out, const FeatureKey& key) {
  out.add(std::uint64_t{static_cast<std::uint8_t>(key.owner)});
  out.add(std::uint64_t{key.serial});
  out.add(std::uint64_t{key.feature});
}

void get(Reader& in, FeatureKey& key) {
  std::uint64_t owner = 0, serial = 0, feature = 0;
  in.get(owner);
  in.get(serial);
  in.get(feature);
  if (owner > 3) in.damaged("a contact has an unknown owner");
  key = {static_cast<FeatureKey::Owner>(owner), static_cast<Index>(serial), static_cast<Index>(feature)};
}

std::uint64_t checksum(std::string_view bytes) {
  Fingerprint print;
  print.add(bytes);
  return print.value();
}

}  // namespace

void save_checkpoint(const std::string& path, std::uint64_t fingerprint, const State& state,
                     const Companion& companion) {
  Writer out;
  out.add(fingerprint);
  out.add(state.time);
  out.add(state.q);
  out.add(state.v);
  out.add(state.z);
  for (const double number : companion.ledger.save()) out.add(number);
  for_statistics(companion.statistics, [&out](const auto& number) { out.add(number); });
  for_contact_statistics(companion.contact_statistics, [&out](const auto& number) { out.add(number); });
  out.add(companion.rounding);
  out.add(companion.history.known);
  out.add(companion.history.step);
  LoadHistory last;
  const bool pending = companion.history.known > 0 && companion.history.pending;
  if (pending) {
    last.go_on(companion.history.step, state.v.size());
    last.record_change({0, static_cast<Index>(state.v.size())}, companion.history.before.data(),
                       companion.loads.total.data());
  }
  for (int i = 0; i < companion.history.known; ++i) {
    const LoadHistory& from = i == 0 && pending ? last : companion.history;
    out.add(from.changes[static_cast<std::size_t>(i)]);
  }
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
    add(out, key.a);
    add(out, key.b);
    out.add(std::uint64_t{static_cast<std::uint8_t>(mode)});
  }
  out.add(std::uint64_t{companion.rhythms.size()});
  for (const Rhythm& rhythm : companion.rhythms) {
    out.add(rhythm.start);
    out.add(rhythm.interval);
    out.add(rhythm.fired);
  }
  const std::string_view body(out.bytes().data(), out.bytes().size());
  Writer end;
  end.add(checksum(body));

  std::string content(mark);
  content.append(body).append(end.bytes().data(), end.bytes().size());
  write_file(path, content, "checkpoint");
}

void load_checkpoint(const std::string& path, std::uint64_t fingerprint, State& state, Companion& companion) {
  const std::string content = read_file(path, "checkpoint");
  std::string_view text = content;
  if (!text.starts_with(mark))
    throw FileError("checkpoint '" + path + "': is not a checkpoint of this version");
  text.remove_prefix(mark.size());
  constexpr std::size_t checksum_size = 8;
  if (text.size() < checksum_size) throw FileError("checkpoint '" + path + "': is damaged: ends too early");
  const std::string_view body = text.substr(0, text.size() - checksum_size);
  Reader end(path, text.substr(body.size()));
  std::uint64_t expected = 0;
  end.get(expected);
  if (expected != checksum(body)) end.damaged("its checksum does not fit");

  Reader in(path, body);
  std::uint64_t found = 0;
  in.get(found);
  if (found != fingerprint) throw FileError("checkpoint '" + path + "': is of another model");
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
  for_statistics(other.statistics, [&in](auto& number) { in.get(number); });
  for_contact_statistics(other.contact_statistics, [&in](auto& number) { in.get(number); });
  in.get(other.rounding);
  if (other.rounding.size() != companion.rounding.size()) in.damaged("its sizes do not fit the model");
  LoadHistory& history = other.history;
  in.get(history.known);
  if (history.known < 0 || history.known > LoadHistory::most)
    in.damaged("its history of loads is of unknown length");
  in.get(history.step);
  for (int i = 0; i < LoadHistory::most; ++i) {
    std::vector<float>& changes = history.changes[static_cast<std::size_t>(i)];
    if (i < history.known) {
      in.get(changes);
      if (changes.size() != state.v.size()) in.damaged("its sizes do not fit the model");
    } else if (history.known > 0) {
      changes.resize(state.v.size());
    }
  }
  history.sweeps.resize(in.count());
  for (int& sweeps : history.sweeps) in.get(sweeps);
  const std::size_t remembered = in.count();
  for (std::size_t i = 0; i < remembered; ++i) {
    std::uint64_t component = 0, solved = 0;
    IterationMemory::Entry entry;
    in.get(component);
    in.get(solved);
    in.get(entry.steps);
    entry.component = static_cast<Index>(component);
    entry.solved = static_cast<Iteration>(solved);
    if (component >= none || solved >= iteration_count || !other.iterations.append(entry)) {
      in.damaged("an iteration is unknown");
    }
  }
  std::uint64_t has_mean_loads = 0;
  in.get(has_mean_loads);
  if (has_mean_loads > 1) in.damaged("it is unknown whether it holds loads");
  if (has_mean_loads == 1) {
    PresentLoads& loads = other.loads;
    loads.valid = loads.mean = true;
    in.get(loads.total);
    if (loads.total.size() != state.v.size()) in.damaged("its sizes do not fit the model");
    loads.dissipative.resize(loads.total.size());
    loads.external.resize(loads.total.size());
  }
  in.get(other.next_step);
  in.get(other.grid_start);
  in.get(other.grid_steps);
  other.modes.resize(in.count());
  for (auto& [key, mode] : other.modes) {
    get(in, key.a);
    get(in, key.b);
    std::uint64_t number = 0;
    in.get(number);
    if (number > static_cast<std::uint64_t>(ContactMode::slip)) in.damaged("a contact has an unknown mode");
    mode = static_cast<ContactMode>(number);
  }
  other.rhythms.resize(in.count());
  for (Rhythm& rhythm : other.rhythms) {
    in.get(rhythm.start);
    in.get(rhythm.interval);
    in.get(rhythm.fired);
  }
  in.finish();
  if (other.rhythms.size() != companion.rhythms.size()) {
    throw FileError("checkpoint '" + path + "': has " + std::to_string(other.rhythms.size()) +
                    " periodic events, the simulation " + std::to_string(companion.rhythms.size()));
  }
  for (std::size_t i = 0; i < other.rhythms.size(); ++i) {
    if (other.rhythms[i].interval == companion.rhythms[i].interval) continue;
    throw FileError("checkpoint '" + path + "': periodic event " + std::to_string(i) +
                    " has an interval of " + to_text(other.rhythms[i].interval) + " s, in the simulation " +
                    to_text(companion.rhythms[i].interval) + " s");
  }
  state = std::move(read);
  companion = std::move(other);
}

}  // namespace carom

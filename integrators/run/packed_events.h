#pragma once

/// \file
/// Records of events in about half of their memory. Most numbers of a record are those of an empty one: an
/// impact in the plane leaves out all that belongs to space, to other bodies and to other kinds of events.

#include <carom/core/export.h>
#include <carom/integrators/run/event_log.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace carom {

/// A list of packed records: those of a run that nobody has looked at yet. A record stays in place when the
/// list grows or is put in order.
class CAROM_API PackedEvents {
public:
  /// Number of records.
  [[nodiscard]] std::size_t size() const { return places_.size(); }
  /// True if there are none.
  [[nodiscard]] bool empty() const { return places_.empty(); }
  /// Bytes that a record takes.
  [[nodiscard]] std::size_t bytes(std::size_t i) const;
  /// Time of a record [s].
  [[nodiscard]] double time(std::size_t i) const;
  /// EventRecord::instant of a record.
  [[nodiscard]] std::int64_t instant(std::size_t i) const;
  void set_instant(std::size_t i, std::int64_t instant);
  /// A record.
  [[nodiscard]] EventRecord record(std::size_t i) const;

  /// Appends a record.
  void append(const EventRecord& event);
  /// Appends all of another list.
  void append(const PackedEvents& other);
  /// Memory of order().
  struct OrderMemory {
    std::vector<std::pair<double, std::size_t>> times;  ///< with places
    std::vector<std::uint64_t*> ordered;
  };
  /// Puts the records in the order of time; those of one time stay as they are.
  void order(OrderMemory& memory);
  /// Lets go of the first records.
  void drop_first(std::size_t count);
  /// Lets go of the last records.
  void drop_last(std::size_t count) { places_.resize(places_.size() - count); }
  /// Lets go of all. Memory stays.
  void clear();

private:
  struct Head;
  using Word = std::uint64_t;
  [[nodiscard]] Word* take(std::size_t words);
  void pack(const Word* packed, std::size_t words);

  struct Block {
    std::unique_ptr<Word[]> words;
    std::size_t size;
  };
  std::vector<Block> blocks_;
  std::size_t block_ = 0, used_ = 0;  // where the next record goes, if it has room
  std::vector<Word*> places_;         // of the records
  std::size_t dropped_ = 0;           // since records were copied together last
};

}  // namespace carom

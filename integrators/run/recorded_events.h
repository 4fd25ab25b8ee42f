#pragma once

/// \file
/// The records of events that a run has: packed until somebody looks at them.

#include <carom/core/export.h>
#include <carom/integrators/run/event_log.h>
#include <carom/integrators/run/packed_events.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace carom {

/// The log of a run.
class CAROM_API RecordedEvents {
public:
  /// The records, by time. From the first call on the list goes on with the run.
  [[nodiscard]] const std::vector<EventRecord>& records();
  /// Number of records.
  [[nodiscard]] std::size_t size() const { return packed_.empty() ? records_.size() : packed_.size(); }
  /// A record, by time, without a look at the list.
  [[nodiscard]] EventRecord record(std::size_t i) const {
    return packed_.empty() ? records_[i] : packed_.record(i);
  }
  /// Appends records of one instant each or of several, which are numbered from 0; here they go on from the
  /// last number. Keeps the latest. \param fresh empty then \param limit how many; 0: all
  void append(PackedEvents& fresh, std::size_t limit);
  /// Appends records of one instant.
  void append(std::vector<EventRecord> of_instant);
  /// Lets go of all.
  void clear();

private:
  [[nodiscard]] std::int64_t next_instant() const;

  PackedEvents packed_;  // none once somebody has looked
  std::vector<EventRecord> records_;
  bool seen_ = false;
};

}  // namespace carom

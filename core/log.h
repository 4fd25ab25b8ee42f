#pragma once

/// \file
/// Where log lines go. A log is a value held by whoever writes to it; there is no global one.

#include <carom/core/export.h>

#include <concepts>
#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>
#include <type_traits>
#include <utility>

namespace carom {

/// How much a line matters. `off` lets nothing pass; no line has it.
enum class LogLevel : std::uint8_t { trace, debug, info, warning, error, off };

/// Name of a level: "trace", "debug", "info", "warning", "error", "off".
[[nodiscard]] CAROM_API std::string_view to_string(LogLevel level);

/// Takes the lines. The text is good only during the call.
using LogSink = std::function<void(LogLevel, std::string_view)>;

/// Hands lines of at least one level to a sink. Quiet unless it is given one. Copies write to the same sink.
///
/// The sink is called in the thread that writes, by one thread at a time for a log and all its copies, and
/// may itself write to the log. What a sink throws arrives at the caller of write(), unchanged, and from
/// there like any exception at whoever called the library; the log goes on working. No destructor writes.
class CAROM_API Log {
public:
  /// A quiet log: costs one comparison per line.
  Log() = default;
  /// \param sink takes the lines; an empty one makes a quiet log
  /// \param level the lowest level that passes
  /// Throws ModelError for a value that is no level.
  explicit Log(LogSink sink, LogLevel level = LogLevel::info);
  Log(const Log&);
  /// A log that was moved from is quiet.
  Log(Log&& other) noexcept;
  Log& operator=(Log other) noexcept;
  ~Log();

  /// The lowest level that passes; `off` for a quiet log.
  [[nodiscard]] LogLevel level() const { return level_; }
  /// True if a line of this level would reach the sink. Ask before forming a costly text.
  [[nodiscard]] bool enabled(LogLevel level) const { return level >= level_ && level < LogLevel::off; }

  /// Writes a line, if its level is enabled. Throws what the sink throws.
  void write(LogLevel level, std::string_view text) const {
    if (enabled(level)) pass(level, text);
  }
  /// Writes the line that `text` makes, which is called only if the level is enabled.
  template <class F>
    requires std::invocable<F&> && std::convertible_to<std::invoke_result_t<F&>, std::string_view>
  void write(LogLevel level, F&& text) const {
    if (enabled(level)) pass(level, text());
  }

private:
  class Logger;

  void pass(LogLevel level, std::string_view text) const;

  LogLevel level_ = LogLevel::off;
  std::shared_ptr<Logger> logger_;
};

}  // namespace carom

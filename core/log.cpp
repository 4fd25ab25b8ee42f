#include <carom/core/enum_name.h>
#include <carom/core/errors.h>
#include <carom/core/log.h>

#include <spdlog/logger.h>
#include <spdlog/sinks/sink.h>

#include <array>
#include <cstddef>
#include <exception>
#include <mutex>
#include <string>
#include <utility>

namespace carom {

std::string_view to_string(LogLevel level) {
  constexpr std::array<std::string_view, 6> names{"trace", "debug", "info", "warning", "error", "off"};
  return enum_name(names, level);
}

namespace {

spdlog::level::level_enum to_spdlog(LogLevel level) {
  constexpr std::array levels{spdlog::level::trace, spdlog::level::debug, spdlog::level::info,
                              spdlog::level::warn,  spdlog::level::err,   spdlog::level::off};
  return levels[static_cast<std::size_t>(level)];
}

LogLevel from_spdlog(spdlog::level::level_enum level) {
  switch (level) {
    case spdlog::level::trace:
      return LogLevel::trace;
    case spdlog::level::debug:
      return LogLevel::debug;
    case spdlog::level::info:
      return LogLevel::info;
    case spdlog::level::warn:
      return LogLevel::warning;
    default:
      return LogLevel::error;
  }
}

/// Hands the bare text to the user's function and keeps what it throws: the logger above would print the
/// exception to stderr and go on.
class FunctionSink final : public spdlog::sinks::sink {
public:
  explicit FunctionSink(LogSink function) : function_(std::move(function)) {}

  void log(const spdlog::details::log_msg& message) override {
    try {
      function_(from_spdlog(message.level), {message.payload.data(), message.payload.size()});
    } catch (...) {
      thrown_ = std::current_exception();
    }
  }
  void flush() override {}
  // Lines go out as they were written: there is no pattern.
  void set_pattern(const std::string&) override {}
  void set_formatter(std::unique_ptr<spdlog::formatter>) override {}

  std::exception_ptr take_thrown() { return std::exchange(thrown_, nullptr); }

private:
  LogSink function_;
  std::exception_ptr thrown_;
};

}  // namespace

/// A logger of its own: made directly, so that spdlog's registry and default logger are never touched.
class Log::Logger {
public:
  explicit Logger(LogSink function)
      : sink_(std::make_shared<FunctionSink>(std::move(function))), logger_("carom", sink_) {
    logger_.set_level(spdlog::level::trace);
    logger_.set_error_handler([](const std::string& what) { throw Error("log: " + what); });
  }

  void write(LogLevel level, std::string_view text) {
    // Held over the call: an exception must come back to the thread that wrote the line. Recursive, since a
    // sink may write to the log.
    const std::scoped_lock lock(mutex_);
    logger_.log(to_spdlog(level), spdlog::string_view_t(text.data(), text.size()));
    if (const std::exception_ptr thrown = sink_->take_thrown()) std::rethrow_exception(thrown);
  }

private:
  std::recursive_mutex mutex_;
  std::shared_ptr<FunctionSink> sink_;
  spdlog::logger logger_;
};

Log::Log(const Log&) = default;
Log::Log(Log&& other) noexcept
    : level_(std::exchange(other.level_, LogLevel::off)), logger_(std::move(other.logger_)) {}
Log& Log::operator=(Log other) noexcept {
  std::swap(level_, other.level_);
  std::swap(logger_, other.logger_);
  return *this;
}
Log::~Log() = default;

Log::Log(LogSink sink, LogLevel level) {
  if (level > LogLevel::off) {
    throw ModelError("log: level is " + std::to_string(static_cast<int>(level)) +
                     "; allowed: one of LogLevel, trace (0) to off (5)");
  }
  if (!sink || level == LogLevel::off) return;
  level_ = level;
  logger_ = std::make_shared<Logger>(std::move(sink));
}

void Log::pass(LogLevel level, std::string_view text) const {
  const std::shared_ptr<Logger> alive = logger_;  // a sink may replace the log that calls it
  alive->write(level, text);
}

}  // namespace carom

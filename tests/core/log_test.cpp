#include <carom/core/log.h>

#include <gtest/gtest.h>

#include <array>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace {

using carom::Log;
using carom::LogLevel;
using Lines = std::vector<std::pair<LogLevel, std::string>>;

constexpr std::array all_levels{LogLevel::trace, LogLevel::debug, LogLevel::info, LogLevel::warning,
                                LogLevel::error};

carom::LogSink into(Lines& lines) {
  return [&lines](LogLevel level, std::string_view text) { lines.emplace_back(level, text); };
}

TEST(Log, IsQuietByDefaultAndFormsNoText) {
  const Log log;
  EXPECT_EQ(log.level(), LogLevel::off);
  for (const LogLevel level : all_levels) {
    EXPECT_FALSE(log.enabled(level));
    log.write(level, "unheard");
    log.write(level, [] {
      ADD_FAILURE() << "a text was formed";
      return "unheard";
    });
  }
}

TEST(Log, ReachesNeitherStandardOutputNorError) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  Lines lines;
  const Log log(into(lines), LogLevel::trace);
  for (const LogLevel level : all_levels) log.write(level, "line");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(lines.size(), 5U);
}

TEST(Log, PassesLinesFromItsLevelUpwards) {
  for (const LogLevel lowest : all_levels) {
    Lines lines;
    const Log log(into(lines), lowest);
    Lines expected;
    for (const LogLevel level : all_levels) {
      const std::string text = "at " + std::string(to_string(level));
      log.write(level, text);
      EXPECT_EQ(log.enabled(level), level >= lowest);
      if (level >= lowest) expected.emplace_back(level, text);
    }
    EXPECT_EQ(lines, expected);
  }
}

TEST(Log, HandsOverTheTextAsItIs) {
  Lines lines;
  const Log log(into(lines));
  const std::string text = "braces {} {0} %v, a quote \", two\nlines, bytes \x01\xff";
  log.write(LogLevel::info, text);
  log.write(LogLevel::info, "");
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].second, text);
  EXPECT_EQ(lines[1].second, "");
}

TEST(Log, FormsATextOnlyForALevelThatPasses) {
  Lines lines;
  const Log log(into(lines), LogLevel::warning);
  int formed = 0;
  const auto text = [&formed] { return std::to_string(++formed); };
  log.write(LogLevel::info, text);
  log.write(LogLevel::error, text);
  EXPECT_EQ(lines, (Lines{{LogLevel::error, "1"}}));
}

TEST(Log, NothingHasLevelOff) {
  Lines lines;
  const Log log(into(lines), LogLevel::trace);
  EXPECT_FALSE(log.enabled(LogLevel::off));
  log.write(LogLevel::off, "unheard");
  const Log silenced(into(lines), LogLevel::off);
  silenced.write(LogLevel::error, "unheard");
  EXPECT_TRUE(lines.empty());
}

TEST(Log, AnEmptySinkIsQuiet) {
  const Log log(carom::LogSink{}, LogLevel::trace);
  EXPECT_FALSE(log.enabled(LogLevel::error));
  log.write(LogLevel::error, "unheard");
}

TEST(Log, CopiesWriteToOneSinkAndOutliveTheOriginal) {
  Lines lines;
  Log copy;
  {
    const Log log(into(lines));
    copy = log;
    log.write(LogLevel::info, "original");
  }
  copy.write(LogLevel::info, "copy");
  EXPECT_EQ(lines, (Lines{{LogLevel::info, "original"}, {LogLevel::info, "copy"}}));
}

TEST(Log, AMovedFromLogIsQuiet) {
  Lines lines;
  Log log(into(lines));
  const Log moved = std::move(log);
  log.write(LogLevel::error, "unheard");  // NOLINT(bugprone-use-after-move): that it is safe is the point
  moved.write(LogLevel::error, "heard");
  EXPECT_EQ(lines, (Lines{{LogLevel::error, "heard"}}));
}

TEST(Log, LogsOfOneNameAreIndependent) {
  Lines first, second;
  const Log one(into(first)), other(into(second));
  one.write(LogLevel::info, "one");
  other.write(LogLevel::info, "other");
  EXPECT_EQ(first, (Lines{{LogLevel::info, "one"}}));
  EXPECT_EQ(second, (Lines{{LogLevel::info, "other"}}));
}

struct SinkFailed {};  // derived from nothing

TEST(Log, WhatASinkThrowsArrivesUnchangedAndTheLogGoesOn) {
  testing::internal::CaptureStderr();
  int calls = 0;
  const Log log([&calls](LogLevel, std::string_view) {
    ++calls;
    if (calls == 1) throw std::runtime_error("disk full");
    if (calls == 2) throw SinkFailed{};
  });
  try {
    log.write(LogLevel::info, "first");
    ADD_FAILURE() << "the exception was swallowed";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "disk full");
  }
  EXPECT_THROW(log.write(LogLevel::info, "second"), SinkFailed);
  EXPECT_NO_THROW(log.write(LogLevel::info, "third"));
  EXPECT_EQ(calls, 3);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Log, ASinkMayWriteToItsLog) {
  Lines lines;
  Log log;
  log = Log([&](LogLevel level, std::string_view text) {
    if (lines.empty()) {
      lines.emplace_back(level, text);
      log.write(LogLevel::warning, "from the sink");
    } else {
      lines.emplace_back(level, text);
      throw SinkFailed{};
    }
  });
  EXPECT_THROW(log.write(LogLevel::info, "outer"), SinkFailed);
  EXPECT_EQ(lines, (Lines{{LogLevel::info, "outer"}, {LogLevel::warning, "from the sink"}}));
}

TEST(Log, ThreadsCallTheSinkOneByOneAndGetTheirOwnExceptions) {
  constexpr int count = 2000;
  int inside = 0, odd = 0, even = 0;  // not atomic: the log is to protect them
  const Log log([&](LogLevel level, std::string_view) {
    if (++inside != 1) ADD_FAILURE() << "two threads in the sink";
    level == LogLevel::error ? ++odd : ++even;
    --inside;
    if (level == LogLevel::error) throw SinkFailed{};
  });
  int caught = 0, astray = 0;
  std::thread thrower([&, copy = log] {
    for (int i = 0; i < count; ++i) {
      try {
        copy.write(LogLevel::error, "line");
      } catch (const SinkFailed&) {
        ++caught;
      }
    }
  });
  for (int i = 0; i < count; ++i) {
    try {
      log.write(LogLevel::info, "line");
    } catch (const SinkFailed&) {
      ++astray;
    }
  }
  thrower.join();
  EXPECT_EQ(odd, count);
  EXPECT_EQ(even, count);
  EXPECT_EQ(caught, count);
  EXPECT_EQ(astray, 0);
}

TEST(Log, LevelsHaveNames) {
  EXPECT_EQ(to_string(LogLevel::trace), "trace");
  EXPECT_EQ(to_string(LogLevel::debug), "debug");
  EXPECT_EQ(to_string(LogLevel::info), "info");
  EXPECT_EQ(to_string(LogLevel::warning), "warning");
  EXPECT_EQ(to_string(LogLevel::error), "error");
  EXPECT_EQ(to_string(LogLevel::off), "off");
}

}  // namespace

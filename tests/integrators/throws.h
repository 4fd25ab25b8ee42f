#pragma once

// EXPECT_THROWS(type, statement, text, ...): the statement throws this type, its message holds every text.

#include <gtest/gtest.h>

#include <exception>
#include <initializer_list>
#include <string_view>

namespace carom_test {

template <class E, class F>
testing::AssertionResult throws(F&& statement, std::initializer_list<std::string_view> texts) {
  try {
    statement();
  } catch (const E& error) {
    const std::string_view message = error.what();
    for (const std::string_view text : texts) {
      if (message.find(text) == std::string_view::npos) {
        return testing::AssertionFailure() << "the message \"" << message << "\" lacks \"" << text << "\"";
      }
    }
    return testing::AssertionSuccess();
  } catch (const std::exception& error) {
    return testing::AssertionFailure() << "another type was thrown: " << error.what();
  }
  return testing::AssertionFailure() << "nothing was thrown";
}

}  // namespace carom_test

#define EXPECT_THROWS(type, statement, ...)                                                       \
  EXPECT_TRUE((::carom_test::throws<type>([&] { static_cast<void>(statement); }, {__VA_ARGS__}))) \
      << #statement

#pragma once

// EXPECT_MODEL_ERROR(statement, text, ...): the statement throws a ModelError whose message holds every text;
// the texts name the part, the value and what is allowed.

#include <carom/core/errors.h>

#include <gtest/gtest.h>

#include <initializer_list>
#include <string_view>

namespace carom_test {

template <class F>
testing::AssertionResult throws_model_error(F&& statement, std::initializer_list<std::string_view> texts) {
  try {
    statement();
  } catch (const carom::ModelError& error) {
    const std::string_view message = error.what();
    for (const std::string_view text : texts) {
      if (message.find(text) == std::string_view::npos) {
        return testing::AssertionFailure() << "the message \"" << message << "\" lacks \"" << text << "\"";
      }
    }
    return testing::AssertionSuccess();
  }
  return testing::AssertionFailure() << "nothing was thrown";
}

}  // namespace carom_test

#define EXPECT_MODEL_ERROR(statement, ...)                                                            \
  EXPECT_TRUE(::carom_test::throws_model_error([&] { static_cast<void>(statement); }, {__VA_ARGS__})) \
      << #statement

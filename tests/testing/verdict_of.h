#pragma once

// Verdict of a matcher on a value, as a user sees it.

#include <gmock/gmock.h>

#include <initializer_list>
#include <string>

namespace carom_test {

struct Said {
  bool matches = false;
  std::string why;
};

template <class T, class M>
Said said(const T& value, const M& matcher) {
  testing::StringMatchResultListener listener;
  const bool matches = testing::ExplainMatchResult(matcher, value, &listener);
  return {matches, listener.str()};
}

}  // namespace carom_test

/// The matcher refuses the value, and its explanation holds every one of the texts.
#define EXPECT_REFUSES(matcher, value, ...)                                            \
  do {                                                                                 \
    const carom_test::Said said_ = carom_test::said(value, matcher);                   \
    EXPECT_FALSE(said_.matches);                                                       \
    for (const std::string& text_ : std::initializer_list<std::string>{__VA_ARGS__}) { \
      EXPECT_NE(said_.why.find(text_), std::string::npos) << text_ << said_.why;       \
    }                                                                                  \
  } while (false)

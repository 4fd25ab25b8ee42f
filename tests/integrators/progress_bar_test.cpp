// The progress bar, with times given by hand.

#include <carom/integrators/progress_bar.h>

#include <gtest/gtest.h>

#include <sstream>
#include <string>

namespace {

using carom::ProgressBar;
using std::chrono::milliseconds;

class ProgressBarTest : public testing::Test {
protected:
  ProgressBar::Clock::time_point start_{};
  std::ostringstream out_;
};

TEST_F(ProgressBarTest, IsQuietDuringShortRuns) {
  {
    ProgressBar bar(out_, 0.0, 10.0, start_);
    bar.update(5.0, start_ + milliseconds(500));
    bar.update(9.0, start_ + milliseconds(999));
  }
  EXPECT_EQ(out_.str(), "");
}

TEST_F(ProgressBarTest, DrawsShareAndTimeLeft) {
  ProgressBar bar(out_, 2.0, 12.0, start_);
  bar.update(4.5, start_ + milliseconds(4000));
  EXPECT_EQ(out_.str(), "\r[" + std::string(10, '#') + std::string(30, ' ') + "] 25 %  12 s left ");
}

TEST_F(ProgressBarTest, DrawsAFewTimesASecondOnly) {
  ProgressBar bar(out_, 0.0, 10.0, start_);
  for (int i = 0; i < 1000; ++i) bar.update(0.01 * i, start_ + milliseconds(1000 + i));  // one second
  std::size_t drawn = 0;
  for (const char letter : out_.str()) drawn += letter == '\r' ? 1 : 0;
  EXPECT_EQ(drawn, 5u);
}

TEST_F(ProgressBarTest, WipesItself) {
  {
    ProgressBar bar(out_, 0.0, 10.0, start_);
    bar.update(5.0, start_ + milliseconds(2000));
  }
  const std::string text = out_.str();
  EXPECT_EQ(text.back(), '\r');
  const std::string wiped = text.substr(text.rfind('\r', text.size() - 2));
  EXPECT_GE(wiped.size(), text.find("left") + 2);
  EXPECT_EQ(wiped.find_first_not_of("\r "), std::string::npos);
}

TEST_F(ProgressBarTest, SurvivesAnEmptySpan) {
  ProgressBar bar(out_, 1.0, 1.0, start_);
  bar.update(1.0, start_ + milliseconds(5000));
  EXPECT_EQ(out_.str(), "");
}

}  // namespace

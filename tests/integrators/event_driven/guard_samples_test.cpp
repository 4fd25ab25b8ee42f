// Samples of guards are kept for the times of one step.

#include <carom/integrators/event_driven/guard_samples.h>

#include <gtest/gtest.h>

namespace {

using namespace carom;

class Counted final : public GuardSampler {
public:
  int made = 0;
  void sample(double time, GuardSample& out) override {
    ++made;
    out.margins.assign(1, 10.0 * time);
  }
};

TEST(GuardSamples, EachTimeIsSampledOnce) {
  GuardSamples samples;
  Counted sampler;
  for (const double time : {0.5, 0.25, 0.5, 0.75, 0.25}) {
    const GuardSample& at = samples.at(time, sampler);
    EXPECT_EQ(at.time, time);
    EXPECT_EQ(at.margins[0], 10.0 * time);
  }
  EXPECT_EQ(sampler.made, 3);
  samples.forget();
  EXPECT_EQ(samples.at(0.5, sampler).margins[0], 5.0);
  EXPECT_EQ(sampler.made, 4);
}

TEST(GuardSamples, TheOldestMakeRoom) {
  GuardSamples samples;
  Counted sampler;
  for (int i = 0; i < 100; ++i) (void)samples.at(i, sampler);
  EXPECT_EQ(sampler.made, 100);
  EXPECT_EQ(samples.at(99.0, sampler).margins[0], 990.0);
  EXPECT_EQ(sampler.made, 100);
  EXPECT_EQ(samples.at(0.0, sampler).margins[0], 0.0);
  EXPECT_EQ(sampler.made, 101);
  // The first that was made room for took the place of the oldest: 64 are kept.
  EXPECT_EQ(samples.at(37.0, sampler).margins[0], 370.0);
  EXPECT_EQ(sampler.made, 101);
  EXPECT_EQ(samples.at(36.0, sampler).margins[0], 360.0);
  EXPECT_EQ(sampler.made, 102);
}

}  // namespace

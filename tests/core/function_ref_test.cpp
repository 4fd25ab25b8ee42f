#include <carom/core/function_ref.h>

#include <gtest/gtest.h>

namespace {

using carom::FunctionRef;

TEST(FunctionRef, CallsWhatItRefersTo) {
  int calls = 0;
  auto count = [&calls](int by) { return calls += by; };
  const FunctionRef<int(int)> reference(count);
  EXPECT_TRUE(static_cast<bool>(reference));
  EXPECT_EQ(reference(2), 2);
  EXPECT_EQ(FunctionRef<int(int)>(reference)(3), 5);  // a copy refers to the same
  EXPECT_EQ(calls, 5);
}

TEST(FunctionRef, TakesFunctionsThatAreConst) {
  const auto twice = [](double x) { return 2.0 * x; };
  EXPECT_EQ(FunctionRef<double(double)>(twice)(1.5), 3.0);
}

TEST(FunctionRef, RefersToNothingUnlessTold) { EXPECT_FALSE(static_cast<bool>(FunctionRef<void()>())); }

}  // namespace

#include <carom/core/fingerprint.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>

namespace {

using carom::Fingerprint;

template <class... Values>
std::uint64_t print_of(const Values&... values) {
  Fingerprint print;
  (print.add(values), ...);
  return print.value();
}

TEST(Fingerprint, IsFnv1a) {
  // Published values of the 64-bit FNV-1a hash; a text is ended by a zero byte, which only multiplies.
  constexpr std::uint64_t prime = 0x100000001b3ULL;
  EXPECT_EQ(Fingerprint().value(), 0xcbf29ce484222325ULL);
  EXPECT_EQ(print_of(std::string_view("a")), 0xaf63dc4c8601ec8cULL * prime);
  EXPECT_EQ(print_of(std::string_view("foobar")), 0x85944171f73967e8ULL * prime);
}

TEST(Fingerprint, SeesEveryBitOfANumber) {
  EXPECT_NE(print_of(1.0), print_of(std::nextafter(1.0, 2.0)));
  EXPECT_NE(print_of(0.0), print_of(-0.0));
  EXPECT_NE(print_of(std::uint64_t{1}), print_of(std::uint64_t{1} << 63));
}

TEST(Fingerprint, SeesOrderAndLimits) {
  EXPECT_NE(print_of(1.0, 2.0), print_of(2.0, 1.0));
  EXPECT_NE(print_of(std::string_view("ab"), std::string_view("c")),
            print_of(std::string_view("a"), std::string_view("bc")));
}

TEST(Fingerprint, ManyNumbersAreTheSameAsOneByOne) {
  const std::array<double, 2> both{1.5, -2.5};
  EXPECT_EQ(print_of(std::span<const double>(both)), print_of(1.5, -2.5));
}

}  // namespace

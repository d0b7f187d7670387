#include "hv_core/time.h"

#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace hv {
namespace {

TEST(Time, SecondsKeepNanosecondsOfTheirPrecision) {
  EXPECT_EQ(Time::FromSeconds(1.5).nanoseconds(), 1500000000);
  EXPECT_EQ(Time::FromSeconds(-0.25).nanoseconds(), -250000000);
  EXPECT_EQ(Time::FromSeconds(1e-9).nanoseconds(), 1);
  EXPECT_NEAR(static_cast<double>(Time::FromSeconds(1646310000.125).nanoseconds()),
              1646310000125000000.0, 300.0);
}

TEST(Time, DifferencesOfEpochStampsAreExact) {
  const Time a = Time::FromNanoseconds(1646310000123456789);
  const Time b = Time::FromNanoseconds(1646310000123456788);
  EXPECT_DOUBLE_EQ(a - b, 1e-9);
  EXPECT_EQ((b + 1e-9), a);
  EXPECT_EQ((a - 1e-9), b);
  EXPECT_LT(b, a);
  EXPECT_GE(a, b);
}

TEST(Time, TextHasNineDigits) {
  EXPECT_EQ(ToString(Time::FromNanoseconds(1646310000000000001)), "1646310000.000000001");
  EXPECT_EQ(ToString(Time::FromNanoseconds(-500000000)), "-0.500000000");
  EXPECT_EQ(ToString(Time::FromNanoseconds(0)), "0.000000000");
}

TEST(Time, ParsesDecimalsExactly) {
  EXPECT_EQ(ParseTime("1646310000.123456789")->nanoseconds(), 1646310000123456789);
  EXPECT_EQ(ParseTime("12")->nanoseconds(), 12000000000);
  EXPECT_EQ(ParseTime("-0.5")->nanoseconds(), -500000000);
  EXPECT_EQ(ParseTime("+.25")->nanoseconds(), 250000000);
  EXPECT_EQ(ParseTime("7.")->nanoseconds(), 7000000000);
  EXPECT_EQ(ParseTime("1.2345678901234")->nanoseconds(), 1234567890);
  EXPECT_EQ(ParseTime("1.5e3")->nanoseconds(), 1500000000000);
}

TEST(Time, RefusesWhatIsNotANumber) {
  for (const char* text : {"", "-", ".", "abc", "1.2.3", "1 2", "0x10", "nan", "inf", "1e300",
                           "--1", "99999999999999999999", "9300000000", "1e", "1.5s", "1e10"}) {
    EXPECT_FALSE(ParseTime(text).has_value()) << text;
  }
}

TEST(Time, RoundTripOfRandomStamps) {
  std::mt19937_64 random(1);
  std::uniform_int_distribution<std::int64_t> any(-9000000000000000000, 9000000000000000000);
  for (int i = 0; i < 2000; ++i) {
    const Time time = Time::FromNanoseconds(any(random));
    const std::optional<Time> back = ParseTime(ToString(time));
    ASSERT_TRUE(back.has_value());
    ASSERT_EQ(*back, time);
  }
}

TEST(Time, ParsingRandomTextNeverMisbehaves) {
  std::mt19937 random(2);
  const std::string alphabet = "0123456789.+-eE xX\tnaif";
  std::uniform_int_distribution<std::size_t> letter(0, alphabet.size() - 1);
  std::uniform_int_distribution<int> length(0, 30);
  for (int i = 0; i < 20000; ++i) {
    std::string text;
    for (int n = length(random); n > 0; --n) text += alphabet[letter(random)];
    const std::optional<Time> time = ParseTime(text);
    if (time) {
      ASSERT_LE(std::abs(time->seconds()), 9.21e9) << text;
    }
  }
}

}  // namespace
}  // namespace hv

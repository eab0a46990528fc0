// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Numbers in texts; that the locale changes nothing is shown by python/test/test_locale.py.
#include <franka_core/numbers.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

namespace franka_core {
namespace {

TEST(Numbers, TheWholeTextIsRead) {
  EXPECT_EQ(0.5, readNumber("0.5"));
  EXPECT_EQ(-1e-05, readNumber(" -1e-05\n"));
  EXPECT_EQ(3.0, readNumber("+3."));
  for (const char* text : {"", " ", "0,5", "1 2", "1.5x", "+-1", "+", "nan", "inf", "1e999", "x"}) {
    EXPECT_FALSE(readNumber(text)) << "'" << text << "'";
  }
}

TEST(Numbers, OnlyIntegersWithinTheRangeAreWholeNumbers) {
  constexpr std::int64_t kMin = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  constexpr double kBeyond = 0x1p63;
  const struct {
    double value;
    std::int64_t least, most;
    std::optional<std::int64_t> whole;
  } cells[] = {
      {0.0, 0, 7, 0},
      {-0.0, 0, 7, 0},
      {7.0, 0, 7, 7},
      {-3.0, -3, 7, -3},
      {8.0, 0, 7, {}},
      {-1.0, 0, 7, {}},
      {1.5, 0, 7, {}},
      {1e20, 0, 7, {}},
      {-1e20, 0, 7, {}},
      {1e300, kMin, kMax, {}},
      {kInf, kMin, kMax, {}},
      {-kInf, kMin, kMax, {}},
      {std::numeric_limits<double>::quiet_NaN(), kMin, kMax, {}},
      {kBeyond, kMin, kMax, {}},
      {-kBeyond, kMin, kMax, kMin},
      {std::nextafter(kBeyond, 0.0), kMin, kMax, kMax - 1023},
  };
  for (const auto& cell : cells) {
    EXPECT_EQ(cell.whole, wholeNumber(cell.value, cell.least, cell.most)) << cell.value;
  }
}

TEST(Numbers, TextsHaveTheRequestedDigits) {
  EXPECT_EQ("0.3333", numberText(1.0 / 3.0, 4));
  EXPECT_EQ("-20", numberText(-20.0));
  EXPECT_EQ("1e+20", numberText(1e20));
  EXPECT_EQ("0.250", fixedText(0.25, 3));
  EXPECT_EQ("-3", fixedText(-2.75, 0));
  const double largest = std::numeric_limits<double>::max();
  EXPECT_EQ(largest, readNumber(numberText(largest, 17)));
  EXPECT_EQ(largest, readNumber(fixedText(-largest, 30).substr(1)));
}

}  // namespace
}  // namespace franka_core

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/numbers.h>
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "serve/robot_report.h"

namespace franka_sim::fci {
namespace {

template <typename Value>
std::string written(const Value& value) {
  return JsonWriter().value(value).text();
}

TEST(JsonWriter, WritesNestedObjectsAndLists) {
  JsonWriter json;
  json.beginObject().member("name", "panda").member("q", std::array<double, 2>{0.5, -1.0});
  json.key("hand").beginObject().member("homed", true).member("count", 3).endObject();
  json.key("list").beginArray().value(false).beginArray().endArray().value("x").endArray();
  json.endObject();
  EXPECT_EQ(
      R"({"name":"panda","q":[0.5,-1],"hand":{"homed":true,"count":3},"list":[false,[],"x"]})",
      json.text());
}

TEST(JsonWriter, WritesListsAndMapsOfValues) {
  EXPECT_EQ("[[1,2],[3]]", written(std::vector<std::vector<int>>{{1, 2}, {3}}));
  EXPECT_EQ("[true,false]", written(std::vector<bool>{true, false}));
  EXPECT_EQ(R"({"a":"b","c":""})",
            written(std::map<std::string, std::string>{{"a", "b"}, {"c", ""}}));
  const bool closed[3] = {true, false, true};
  EXPECT_EQ("[true,false,true]", written(closed));
}

TEST(JsonWriter, WritesNumbersThatReadBackTheSame) {
  for (const double number : {0.1, 1.0 / 3.0, -2.5e-300, 6.02214076e23, 1e300,
                              std::numeric_limits<double>::denorm_min()}) {
    EXPECT_EQ(number, franka_core::readNumber(written(number)));
  }
  EXPECT_EQ("0.1", written(0.1));
  EXPECT_EQ("0.1", written(0.1f));
  EXPECT_EQ("18446744073709551615", written(std::numeric_limits<std::uint64_t>::max()));
}

TEST(JsonWriter, WritesNullForNumbersThatAreNotFinite) {
  EXPECT_EQ("[null,null]", written(std::array<double, 2>{std::nan(""), -INFINITY}));
}

TEST(JsonWriter, EscapesQuotesAndControlCharacters) {
  EXPECT_EQ(R"("a\"b\\c\u000ad\u0000")", written(std::string("a\"b\\c\nd\0", 8)));
}

TEST(JsonWriter, KeepsUtf8AndReplacesOtherBytes) {
  EXPECT_EQ("\"\xC3\xA9 \xE2\x82\xAC \xF0\x9F\x98\x80\"",
            written("\xC3\xA9 \xE2\x82\xAC \xF0\x9F\x98\x80"));
  const std::string replaced = "\xEF\xBF\xBD";
  EXPECT_EQ("\"" + replaced + "x\"", written("\x80x"));
  EXPECT_EQ("\"" + replaced + "\"", written("\xC3"));
  EXPECT_EQ("\"" + replaced + replaced + "\"", written("\xC0\x80")) << "overlong";
  EXPECT_EQ("\"" + replaced + replaced + replaced + "\"", written("\xED\xA0\x80")) << "surrogate";
}

}  // namespace
}  // namespace franka_sim::fci

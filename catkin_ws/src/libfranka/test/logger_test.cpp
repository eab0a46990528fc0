// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/log.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <franka/logging/logger.hpp>
#include <locale>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace {

namespace logging = franka::logging;
using Lines = std::vector<std::string>;

class Sink : public franka::LoggingSinkInterface {
 public:
  explicit Sink(std::string name) : name_(std::move(name)) {}
  std::string getName() const override { return name_; }
  void logInfo(const std::string& message) override { lines.push_back("info " + message); }
  void logWarn(const std::string& message) override { lines.push_back("warn " + message); }
  void logError(const std::string& message) override { lines.push_back("error " + message); }
  Lines lines;

 private:
  std::string name_;
};

class Logger : public ::testing::Test {
 protected:
  ~Logger() override { logging::removeAllLoggers(); }
};

TEST_F(Logger, SendsEachMessageToEverySink) {
  const auto one = std::make_shared<Sink>("one");
  const auto two = std::make_shared<Sink>("two");
  logging::logInfo("before");
  logging::addLogger(one);
  logging::addLogger(two);
  logging::logInfo("a");
  logging::logWarn("b");
  logging::logError("c");
  logging::removeLogger("one");
  logging::removeLogger("nobody");
  logging::logInfo("d");
  logging::removeAllLoggers();
  logging::logInfo("after");
  EXPECT_EQ((Lines{"info a", "warn b", "error c"}), one->lines);
  EXPECT_EQ((Lines{"info a", "warn b", "error c", "info d"}), two->lines);
}

TEST_F(Logger, KeepsTheFirstSinkOfAName) {
  const auto first = std::make_shared<Sink>("same");
  const auto second = std::make_shared<Sink>("same");
  logging::addLogger(first);
  logging::addLogger(second);
  logging::logInfo("a");
  EXPECT_EQ(1u, first->lines.size());
  EXPECT_TRUE(second->lines.empty());
  EXPECT_THROW(logging::addLogger(nullptr), std::invalid_argument);
}

TEST_F(Logger, FillsPlaceholdersWithValues) {
  const auto sink = std::make_shared<Sink>("sink");
  logging::addLogger(sink);
  logging::logInfo("{} of {} rad", 1, 0.5);
  logging::logWarn("{:.3f} {{}} {}", "a");
  logging::logError("end {", std::string("unused"));
  logging::logError("{} as it is");
  EXPECT_EQ((Lines{"info 1 of 0.5 rad", "warn a {} {}", "error end {", "error {} as it is"}),
            sink->lines);
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) {
    parts.push_back(part);
  }
  return parts;
}

TEST(Log, HasAColumnForEachValue) {
  franka::Record record;
  record.state.time = franka::Duration(12345678);
  record.state.control_command_success_rate = 0.5;
  record.state.tau_ext_hat_filtered[6] = 6.5;
  record.command.cartesian_pose.O_T_EE[15] = 1.0;
  record.command.torques.tau_J = {1, 2, 3, 4, 5, 6, 7.25};
  const std::vector<std::string> lines = split(franka::logToCSV({record, record}), '\n');
  ASSERT_EQ(3u, lines.size());
  const std::vector<std::string> names = split(lines[0], ',');
  const std::vector<std::string> values = split(lines[1], ',');
  ASSERT_EQ(2u + 6 * 7 + 7 + 7 + 16 + 6 + 7, names.size());
  ASSERT_EQ(names.size(), values.size());
  EXPECT_EQ(0u, lines[0].find("time,success_rate,state.q[0],state.q[1],"));
  const auto value = [&](const std::string& name) {
    return values[std::find(names.begin(), names.end(), name) - names.begin()];
  };
  EXPECT_EQ("12345678", value("time"));
  EXPECT_EQ("0.5", value("success_rate"));
  EXPECT_EQ("6.5", value("state.tau_ext_hat_filtered[6]"));
  EXPECT_EQ("1", value("cmd.O_T_EE_d[15]"));
  EXPECT_EQ("7.25", value("cmd.tau_J_d[6]"));
}

/// As in a German locale, which need not be installed.
class DecimalComma : public std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(Log, HasDecimalPointsInEveryLocale) {
  franka::Record record;
  record.state.time = franka::Duration(12345678);
  record.state.control_command_success_rate = 0.5;
  const std::string expected = franka::logToCSV({record});
  const std::locale before =
      std::locale::global(std::locale(std::locale::classic(), new DecimalComma));
  const std::string found = franka::logToCSV({record});
  std::locale::global(before);
  EXPECT_NE(std::string::npos, expected.find("12345678,0.5,"));
  EXPECT_EQ(expected, found);
}

}  // namespace

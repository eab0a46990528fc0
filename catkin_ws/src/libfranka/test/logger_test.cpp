// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <franka/logging/cout_logging_sink.hpp>
#include <franka/logging/logger.hpp>
#include <iostream>
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

/// Captures the output of a stream.
class Captured {
 public:
  explicit Captured(std::ostream& stream) : stream_(stream), before_(stream.rdbuf(text_.rdbuf())) {}
  ~Captured() { stream_.rdbuf(before_); }
  std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
  std::ostream& stream_;
  std::streambuf* before_;
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

TEST_F(Logger, CoutLoggingSinkWritesLines) {
  const Captured output(std::cout);
  logging::addLogger(std::make_shared<franka::CoutLoggingSink>());
  logging::logInfo("a");
  logging::logWarn("b");
  logging::logError("c");
  EXPECT_EQ("INFO: a\nWARNING: b\nERROR: c\n", output.text());
  logging::removeLogger("CoutLoggingSink");
  logging::logInfo("d");
  EXPECT_EQ("INFO: a\nWARNING: b\nERROR: c\n", output.text());
}

}  // namespace

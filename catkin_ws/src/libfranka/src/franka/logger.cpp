// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/logging/cout_logging_sink.hpp>
#include <franka/logging/logger.hpp>
#include <iostream>
#include <map>
#include <mutex>
#include <stdexcept>

#include "franka/warning.h"

namespace franka {

std::string CoutLoggingSink::getName() const { return "CoutLoggingSink"; }

void CoutLoggingSink::logInfo(const std::string& message) {
  std::cout << "INFO: " << message << std::endl;
}

void CoutLoggingSink::logWarn(const std::string& message) {
  std::cout << "WARNING: " << message << std::endl;
}

void CoutLoggingSink::logError(const std::string& message) {
  std::cout << "ERROR: " << message << std::endl;
}

namespace logging {

namespace {

// The interface has free functions: the sinks belong to the process.
struct Sinks {
  std::mutex mutex;
  std::map<std::string, std::shared_ptr<LoggingSinkInterface>> by_name;
};

Sinks& sinks() {
  static Sinks sinks;
  return sinks;
}

/// @returns whether there was a sink.
bool sendToAll(void (LoggingSinkInterface::*log)(const std::string&), const std::string& message) {
  const std::lock_guard<std::mutex> lock(sinks().mutex);
  for (const auto& [name, sink] : sinks().by_name) {
    ((*sink).*log)(message);
  }
  return !sinks().by_name.empty();
}

}  // namespace

void addLogger(const std::shared_ptr<LoggingSinkInterface>& logger) {
  if (!logger) {
    throw std::invalid_argument("libfranka: There is no sink to add for log messages.");
  }
  const std::lock_guard<std::mutex> lock(sinks().mutex);
  sinks().by_name.emplace(logger->getName(), logger);
}

void removeLogger(const std::string& logger_name) {
  const std::lock_guard<std::mutex> lock(sinks().mutex);
  sinks().by_name.erase(logger_name);
}

void removeAllLoggers() {
  const std::lock_guard<std::mutex> lock(sinks().mutex);
  sinks().by_name.clear();
}

void logInfo(const std::string& message) { sendToAll(&LoggingSinkInterface::logInfo, message); }
void logWarn(const std::string& message) { sendToAll(&LoggingSinkInterface::logWarn, message); }
void logError(const std::string& message) { sendToAll(&LoggingSinkInterface::logError, message); }

std::string fill(const std::string& text, const std::vector<std::string>& values) {
  std::string filled;
  auto value = values.begin();
  for (std::size_t i = 0; i < text.size(); i++) {
    const bool is_brace = text[i] == '{' || text[i] == '}';
    const std::size_t end = text.find('}', i);
    if (is_brace && i + 1 < text.size() && text[i + 1] == text[i]) {
      filled += text[i++];
    } else if (text[i] == '{' && end != std::string::npos && value != values.end()) {
      filled += *value++;
      i = end;
    } else {
      filled += text[i];
    }
  }
  return filled;
}

void warn(const std::string& message) {
  if (!sendToAll(&LoggingSinkInterface::logWarn, message)) {
    std::cerr << message << std::endl;
  }
}

}  // namespace logging

}  // namespace franka

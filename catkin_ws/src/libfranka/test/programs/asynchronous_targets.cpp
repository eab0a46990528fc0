// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Moves an FR3 to asynchronous targets, and logs the results.
#include <franka/exception.h>
#include <franka/robot.h>

#include <franka/async_control/async_position_control_handler.hpp>
#include <franka/async_control/target_status.hpp>
#include <franka/logging/cout_logging_sink.hpp>
#include <franka/logging/logger.hpp>
#include <franka/logging/logging_sink_interface.hpp>
#include <iostream>
#include <memory>
#include <string>

namespace {

/// Counts warnings and errors.
class ProblemCounter : public franka::LoggingSinkInterface {
 public:
  std::string getName() const override { return "ProblemCounter"; }
  void logInfo(const std::string& /*message*/) override {}
  void logWarn(const std::string& /*message*/) override { count++; }
  void logError(const std::string& /*message*/) override { count++; }
  int count{0};
};

bool reach(franka::AsyncPositionControlHandler& handler,
           const franka::AsyncPositionControlHandler::JointPositionTarget& target) {
  for (int i = 0; i < 1000; i++) {
    const auto result = handler.setJointPositionTarget(target);
    if (!result.was_successful) {
      franka::logging::logError(result.error_message.value_or("no reason"));
      return false;
    }
    const auto feedback = handler.getTargetFeedback();
    switch (feedback.status) {
      case franka::TargetStatus::kTargetReached:
        franka::logging::logInfo("reached " + result.motion_uuid);
        return true;
      case franka::TargetStatus::kAborted:
        franka::logging::logError("aborted: {}", feedback.error_message.value_or("no reason"));
        return false;
      case franka::TargetStatus::kIdle:
      case franka::TargetStatus::kExecuting:
        break;
    }
  }
  franka::logging::logWarn("The target was not reached.");
  return false;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "Usage: " << argv[0] << " <robot-hostname>" << std::endl;
    return 2;
  }
  auto problems = std::make_shared<ProblemCounter>();
  franka::logging::addLogger(problems);
  franka::logging::addLogger(std::make_shared<franka::CoutLoggingSink>());
  bool all_reached = true;
  try {
    auto robot = std::make_shared<franka::Robot>(argv[1], franka::RealtimeConfig::kIgnore);
    const franka::AsyncPositionControlHandler::Configuration configuration{
        std::vector<double>(7, 0.5), 0.01};
    auto configured = franka::AsyncPositionControlHandler::configure(robot, configuration);
    if (configured.handler == nullptr) {
      franka::logging::logError(*configured.error_message);
      return 1;
    }
    franka::AsyncPositionControlHandler& handler = *configured.handler;
    all_reached = reach(handler, {{0.1, -0.7, 0.0, -2.3, 0.0, 1.5, 0.7}}) &&
                  reach(handler, {{0.0, -0.8, 0.0, -2.3, 0.0, 1.5, 0.8}});
    handler.stopControl();
  } catch (const franka::Exception& error) {
    franka::logging::logError(error.what());
  }
  franka::logging::removeLogger("CoutLoggingSink");
  franka::logging::removeAllLoggers();
  return all_reached && problems->count == 0 ? 0 : 1;
}

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <franka/async_control/async_position_control_handler.hpp>
#include <memory>
#include <thread>
#include <vector>

#include "common.h"

namespace {
constexpr char kDescription[] =
    "Gives an FR3 targets now and then; the robot plans its own motion to each (protocol 10).";
}  // namespace

int main(int argc, char** argv) {
  return example::run(argc, argv, kDescription, [](const std::string& address) {
    using Handler = franka::AsyncPositionControlHandler;
    auto robot = std::make_shared<franka::Robot>(example::ready(address));
    const Handler::ConfigurationResult made =
        Handler::configure(robot, {std::vector<double>(7, 0.8), 0.01});
    if (!made.handler) {
      throw franka::CommandException(*made.error_message);
    }
    for (const double angle : {0.3, -0.3, 0.0}) {
      std::vector<double> target(example::kReadyPose.begin(), example::kReadyPose.end());
      target[0] = angle;
      const Handler::CommandResult sent = made.handler->setJointPositionTarget({target});
      if (!sent.was_successful) {
        throw franka::CommandException(*sent.error_message);
      }
      const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(20);
      Handler::TargetFeedback feedback;
      do {
        feedback = made.handler->getTargetFeedback();
      } while (feedback.status == franka::TargetStatus::kExecuting &&
               std::chrono::steady_clock::now() < until);
      std::printf("target %.1f %s\n", angle,
                  feedback.status == franka::TargetStatus::kTargetReached ? "reached" : "missed");
    }
    made.handler->stopControl();
  });
}

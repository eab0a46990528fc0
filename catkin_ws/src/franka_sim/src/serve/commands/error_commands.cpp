// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "serve/commands/command_groups.h"
#include "serve/operator_switches.h"

namespace franka_sim {

namespace {

using namespace fci;  // NOLINT: the words of the table

constexpr double kMaxClock = 1e6;  // [s] until the self-test is overdue

/// Names of all errors: first those that are recovered at the arm, then those to acknowledge.
std::vector<std::string> errorNames() {
  std::vector<std::string> names(kDemandedRecoveryNames.begin(), kDemandedRecoveryNames.end());
  names.insert(names.end(), kRecoverableErrorNames.begin(), kRecoverableErrorNames.end());
  return names;
}

std::optional<DemandedRecovery> demanded(std::uint64_t error) {
  return error < kDemandedRecoveryNames.size()
             ? std::optional<DemandedRecovery>(static_cast<DemandedRecovery>(error))
             : std::nullopt;
}

RecoverableError recoverable(std::uint64_t error) {
  return static_cast<RecoverableError>(error - kDemandedRecoveryNames.size());
}

void inject(SafetyController& safety, std::uint64_t error, std::optional<std::uint64_t> joint,
            bool active) {
  const std::optional<DemandedRecovery> recovery = demanded(error);
  if (recovery.has_value() != joint.has_value()) {
    throw std::invalid_argument(errorNames()[error] + (recovery ? " is an error of a joint: name "
                                                                  "it, 1 to 7."
                                                                : " is not an error of a joint."));
  }
  if (recovery) {
    safety.inject(*recovery, *joint - 1, active);
  } else {
    safety.inject(recoverable(error), active);
  }
}

Reply recover(ControlUnit& unit) {
  const std::optional<Status> answer =
      unit.request(franka_core::fci::AutomaticErrorRecoveryRequest{});
  if (answer == Status::kManualErrorRecoveryRequiredRejected) {
    throw std::runtime_error(
        "JointRecoveryRequired: A joint is beyond its limits, or a stop is pressed; guide the arm "
        "back, or release the stop.");
  }
  if (answer && answer != Status::kSuccess) {
    throw std::runtime_error(
        "MotionActive: Errors cannot be cleared in the mode in which the robot is.");
  }
  return Reply([&unit]() -> std::optional<std::string> {
    const franka_core::RobotMode mode = unit.state().robot_mode;
    if (mode == franka_core::RobotMode::kAutomaticErrorRecovery) {
      return std::nullopt;
    }
    if (mode == franka_core::RobotMode::kReflex) {
      throw std::runtime_error("The recovery has failed: the arm does not come to rest.");
    }
    return "";
  });
}

}  // namespace

void addErrorCommands(fci::CommandTable& table, const OperatorContext& context) {
  SimRobot& robot = context.robot;
  SafetyController& safety = robot.whole().safety();
  table.add(line("self_test"),
            "starts the self-test, which closes the brakes and switches the FCI off. At its end "
            "both are as before; with Desk's rules brakes stay closed and the FCI off. Meanwhile "
            "nothing opens the brakes, moves the arm or switches the FCI on",
            kControl, [&] { requireAllowed(safety.startSelfTest()); });
  table.add(line("self_test due", number("SECONDS", "s", 0.0, kMaxClock)),
            "sets the time until the self-test is overdue", kNotOnPage,
            [&](double seconds) { safety.setSelfTestDue(seconds); });
  table.add(line("acknowledge", choice(errorNames(), "ERROR")),
            "an error of the safety controller, such as `td2Timeout`", kControl,
            [&](std::uint64_t error) {
              const std::optional<DemandedRecovery> recovery = demanded(error);
              requireAllowed(recovery ? safety.acknowledge(*recovery)
                                      : safety.acknowledge(recoverable(error)));
            });
  table.add(
      line("inject", choice(errorNames(), "ERROR"), optional(integer("JOINT", 1, 7)), onOff()),
      "lets the safety controller have an error; JOINT for jointLimitViolation and "
      "jointPositionErrorDemand",
      kInput, [&](std::uint64_t error, std::optional<std::uint64_t> joint, bool active) {
        inject(safety, error, joint, active);
      });
  table.add(line("recover"), "automatic error recovery; the answer comes at its end", kControl,
            [&] { return recover(robot.unit()); });
}

}  // namespace franka_sim

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/robot/safety/refusal.h>

#include <array>

namespace franka_sim {

namespace {

struct RefusalText {
  std::string_view name, sentence;
};
constexpr std::array<RefusalText, 10> kRefusals{{
    {"", ""},
    {"NotReady", "The robot is switched off; switch it on."},
    {"BrakesClosed", "The brakes are closed; unlock the joints first."},
    {"EmergencyStopPressed", "A stop is pressed; release it."},
    {"SelfTestRunning", "The self-test runs; wait for its end."},
    {"RecoverableErrorActive", "An error of the safety controller is active; acknowledge it."},
    {"JointRecoveryRequired",
     "A joint needs manual recovery: press the enabling device X4, then acknowledge."},
    {"WrongOperatingMode", "The operating mode, or the activation device, does not allow this."},
    {"MotionActive", "A motion runs, or the FCI is active; end it first."},
    {"NoAckRequired", "There is nothing to acknowledge."},
}};

}  // namespace

std::string_view nameOf(Refusal refusal) noexcept {
  return kRefusals[static_cast<std::size_t>(refusal)].name;
}

std::string_view sentenceOf(Refusal refusal) noexcept {
  return kRefusals[static_cast<std::size_t>(refusal)].sentence;
}

}  // namespace franka_sim

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

namespace franka_sim {

/// Why the safety controller refuses a request.
enum class Refusal : std::size_t {
  kNone,
  kNotReady,
  kBrakesClosed,
  kEmergencyStopPressed,
  kSelfTestRunning,
  kRecoverableErrorActive,
  kJointRecoveryRequired,
  kWrongOperatingMode,
  kMotionActive,
  kNoAckRequired,
};

/// The word for a refusal in Desk's interface, such as "BrakesClosed", and a sentence about it.
std::string_view nameOf(Refusal refusal) noexcept;
std::string_view sentenceOf(Refusal refusal) noexcept;

}  // namespace franka_sim

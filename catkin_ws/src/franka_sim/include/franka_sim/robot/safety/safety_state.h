// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

/// @file
/// The state that a robot's safety controller reports to the operator, and its names. The names are
/// those of Desk's interface.

namespace franka_sim {

/// Stops and enabling devices at the robot's connectors. Pressed means that they act.
enum class SafetyInput : std::size_t {
  kX31,            ///< the emergency stop of an FR3
  kX32,            ///< another stop of an FR3
  kX33,            ///< another stop of an FR3
  kX4,             ///< Panda: the activation device, pressed stops; FR3: the enabling device
  kGuidingButton,  ///< the button at the arm's wrist that frees the arm
};
constexpr std::size_t kSafetyInputCount = 5;
constexpr std::array<std::string_view, kSafetyInputCount> kSafetyInputNames{"x31", "x32", "x33",
                                                                            "x4", "guiding"};

/// The buttons of the Pilot.
constexpr std::size_t kButtonCount = 7;
constexpr std::array<std::string_view, kButtonCount> kButtonNames{"circle", "cross", "check", "up",
                                                                  "down",   "left",  "right"};

/// Errors that lock the robot until they are acknowledged.
enum class RecoverableError : std::size_t {
  kEnvironmentDataTimeout,
  kFsoeConnectionError,
  kGenericJointError,
  kGuidingEnablingDevice,
  kJointPositionError,
  kSafeInputErrorX31,
  kSafeInputErrorX32,
  kSafeInputErrorX33,
  kSafeInputErrorX4,
  kTd2Timeout,  ///< the self-test is overdue
};
constexpr std::size_t kRecoverableErrorCount = 10;
constexpr std::array<std::string_view, kRecoverableErrorCount> kRecoverableErrorNames{
    "environmentDataTimeout", "fsoeConnectionError", "genericJointError", "guidingEnablingDevice",
    "jointPositionError",     "safeInputErrorX31",   "safeInputErrorX32", "safeInputErrorX33",
    "safeInputErrorX4",       "td2Timeout"};

/// Recoveries that the operator carries out at the arm, for each joint.
enum class DemandedRecovery : std::size_t { kJointLimitViolation, kJointPositionError };
constexpr std::array<std::string_view, 2> kDemandedRecoveryNames{"jointLimitViolation",
                                                                 "jointPositionErrorDemand"};

enum class OperatingMode { kExecution, kProgramming };
enum class GuidingMode : std::size_t { kFree, kTranslation, kRotation, kUser };
constexpr std::array<std::string_view, 4> kGuidingModeNames{"free", "translation", "rotation",
                                                            "user"};

/// The light at the arm's base.
enum class LightColor : std::size_t { kYellow, kWhite, kBlue, kGreen, kPink, kRed };
constexpr std::array<std::string_view, 6> kLightColorNames{"yellow", "white", "blue",
                                                           "green",  "pink",  "red"};
struct Light {
  LightColor color{LightColor::kBlue};
  bool blinking{false};
};

struct SafetyState {
  bool power{true};
  std::array<bool, 7> brakes_closed{};  ///< joint by joint
  bool brakes_moving{false};            ///< they are being opened or closed
  OperatingMode mode{OperatingMode::kExecution};
  std::array<bool, kSafetyInputCount> inputs{};  ///< pressed at their connectors
  bool user_stop{false};                         ///< the operator's own stop is pressed
  bool conflicting_inputs{false};                ///< guiding was requested where it is not allowed
  std::array<bool, kButtonCount> buttons{};
  bool arrows_guide_desk{true};  ///< Pilot mode: the arrow keys are for Desk, not for the tool
  GuidingMode guiding_mode{GuidingMode::kFree};
  std::array<bool, 7> guiding_axes{{true, true, true, true, true, true, true}};  ///< K, elbow
  std::array<bool, kRecoverableErrorCount> recoverable{};
  std::array<std::array<bool, 7>, 2> demanded{};  ///< by DemandedRecovery and joint
  bool self_test{false};
  double self_test_left{0.0};   ///< [s]
  double self_test_due{86400};  ///< [s] until td2Timeout
  bool end_effector_power{true};
};

}  // namespace franka_sim

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/robot_state.h>

#include <array>
#include <cstdint>
#include <variant>

/// @file
/// Requests of a client and replies of the robot, the same for every protocol version. Transforms
/// are 4x4, inertias 3x3, both column-major; [m] [rad] [N] [Nm] [kg] [s].

namespace franka_core::fci {

/// The commands of all versions; their numbers on the wire depend on the version.
enum class Command : std::uint8_t {
  kConnect,
  kMove,
  kStopMove,
  kGetCartesianLimit,  ///< up to version 5
  kSetCollisionBehavior,
  kSetJointImpedance,
  kSetCartesianImpedance,
  kSetGuidingMode,
  kSetEEToK,
  kSetNEToEE,  ///< version 3 calls it SetFToEE: there NE is the flange
  kSetLoad,
  kSetFilters,  ///< up to version 5
  kAutomaticErrorRecovery,
  kLoadModelLibrary,  ///< up to version 9
  kGetRobotModel,     ///< from version 8 on
};
constexpr std::size_t kCommandCount = 15;

/// The statuses of all replies; their numbers depend on the command and the version.
enum class Status : std::uint8_t {
  kSuccess,
  kMotionStarted,  ///< first of the two replies to Move
  kPreempted,      ///< by StopMove
  kPreemptedDueToActivatedSafetyFunctions,
  kRejectedDueToActivatedSafetyFunctions,
  kCommandNotPossibleRejected,  ///< not in the current mode
  kStartAtSingularPoseRejected,
  kInvalidArgumentRejected,
  kReflexAborted,
  kEmergencyAborted,  ///< user stop
  kInputErrorAborted,
  kAborted,
  kManualErrorRecoveryRequiredRejected,
  kIncompatibleLibraryVersion,  ///< Connect only
  kError,                       ///< LoadModelLibrary only
};
constexpr std::size_t kStatusCount = 15;

struct ConnectRequest {
  std::uint16_t version{0};
  std::uint16_t udp_port{0};  ///< the client's port for states
};

/// Allowed distance of the arm from its desired pose.
struct Deviation {
  double translation{10.0};         ///< [m]; the defaults of the genuine client
  double rotation{3.12};            ///< [rad]
  double elbow{6.283185307179586};  ///< [rad]
};

struct MoveRequest {
  ControllerMode controller_mode{ControllerMode::kJointImpedance};                 ///< not kOther
  MotionGeneratorMode motion_generator_mode{MotionGeneratorMode::kJointPosition};  ///< not kIdle
  Deviation max_path_deviation;
  Deviation max_goal_deviation;
  bool use_async_motion_generator{false};    ///< version 10
  std::array<double, 7> maximum_velocity{};  ///< [rad/s], for the asynchronous generator
};

struct StopMoveRequest {};
struct GetCartesianLimitRequest {
  std::int32_t id{0};
};
struct SetCollisionBehaviorRequest {
  std::array<double, 7> lower_torques_acceleration{}, upper_torques_acceleration{};
  std::array<double, 7> lower_torques_nominal{}, upper_torques_nominal{};
  std::array<double, 6> lower_forces_acceleration{}, upper_forces_acceleration{};
  std::array<double, 6> lower_forces_nominal{}, upper_forces_nominal{};
};
struct SetJointImpedanceRequest {
  std::array<double, 7> K_theta{};  ///< [Nm/rad]
};
struct SetCartesianImpedanceRequest {
  std::array<double, 6> K_x{};  ///< [N/m], [Nm/rad]
};
struct SetGuidingModeRequest {
  std::array<bool, 6> guiding_mode{};  ///< x, y, z, R, P, Y free
  bool nullspace{false};               ///< elbow free
};
struct SetEEToKRequest {
  std::array<double, 16> EE_T_K{};
};
struct SetNEToEERequest {
  std::array<double, 16> NE_T_EE{};
};
struct SetLoadRequest {
  double mass{0.0};
  std::array<double, 3> F_x_Cload{};
  std::array<double, 9> inertia{};  ///< about the center of mass, axes of F
};
struct SetFiltersRequest {
  double joint_position{1000.0}, joint_velocity{1000.0};          ///< cutoffs [Hz]; 1000 is off
  double cartesian_position{1000.0}, cartesian_velocity{1000.0};  ///< [Hz]
  double controller{1000.0};                                      ///< [Hz]
};
struct AutomaticErrorRecoveryRequest {};
enum class Architecture : std::uint8_t { kX64, kX86, kArm, kArm64 };
enum class OperatingSystem : std::uint8_t { kLinux, kWindows };
struct LoadModelLibraryRequest {
  Architecture architecture{Architecture::kX64};
  OperatingSystem system{OperatingSystem::kLinux};
};
struct GetRobotModelRequest {};

/// In the order of Command, so that index() is the command.
using Request =
    std::variant<ConnectRequest, MoveRequest, StopMoveRequest, GetCartesianLimitRequest,
                 SetCollisionBehaviorRequest, SetJointImpedanceRequest,
                 SetCartesianImpedanceRequest, SetGuidingModeRequest, SetEEToKRequest,
                 SetNEToEERequest, SetLoadRequest, SetFiltersRequest, AutomaticErrorRecoveryRequest,
                 LoadModelLibraryRequest, GetRobotModelRequest>;
static_assert(std::variant_size_v<Request> == kCommandCount);

constexpr Command commandOf(const Request& request) noexcept {
  return static_cast<Command>(request.index());
}

/// A cuboid that the arm must not enter, as returned by GetCartesianLimit.
struct CartesianLimit {
  std::array<double, 3> object_world_size{};  ///< edges [m]
  std::array<double, 16> object_frame{};      ///< its pose in O
  bool active{false};
};

/// Content of a reply. Fields that the command's reply does not have keep their defaults.
struct Reply {
  Status status{Status::kSuccess};
  std::uint16_t server_version{0};  ///< Connect
  CartesianLimit cartesian_limit;   ///< GetCartesianLimit
};

}  // namespace franka_core::fci

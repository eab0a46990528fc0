// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>
#include <franka_core/fci/commands.h>
#include <franka_core/robot_state.h>
#include <franka_sim/robot/safety/collision_thresholds.h>

#include <array>
#include <cstdint>
#include <variant>

/// @file
/// The requests of a control unit: those of the FCI, and those of the operator or the server. Their
/// answers: ControlUnit::request.

namespace franka_sim {

using Status = franka_core::fci::Status;  ///< of the answer to a request

/// The external activation device: pressed stops any motion and closes the brakes; released leads
/// to Idle, or to Reflex if there were errors.
struct UserStop {
  bool pressed;  ///< otherwise released
};
/// The user starts or ends guiding of the arm with its guiding buttons.
struct Guiding {
  bool active;  ///< otherwise not
};
/// Closed brakes: mode Other.
struct Brakes {
  bool closed;  ///< otherwise open
};
/// Inactive: no motion can be requested, and a running one is aborted.
struct FciActivation {
  bool active;  ///< otherwise not
};
/// A motion that the operator commands by Desk: a Move that needs no FCI.
struct OperatorMove {
  franka_core::fci::MoveRequest move;  ///< its request
};
/// A motion that goes on after a stop, with another controller: a Cartesian one also at a singular
/// pose.
struct ContinuedMove {
  franka_core::fci::MoveRequest move;  ///< its request
};
/// The end effector as it is set in Desk. Refused in Move, and if no arm can hold it.
struct SetEndEffector {
  franka_core::Payload payload;   ///< m_ee, F_x_Cee, I_ee
  std::array<double, 16> F_T_NE;  ///< 4x4, column-major
};
/// Sets one of the virtual walls.
struct SetVirtualWall {
  std::int32_t id;                        ///< number of the wall, 0 to 7
  franka_core::fci::CartesianLimit wall;  ///< its box
};
/// The version, 3 to 10, whose limits apply from the next motion on.
struct SetProtocolVersion {
  unsigned version;  ///< of the protocol
};
/// The running motion gets no more commands. A motion of the asynchronous generator, in which a
/// client may be silent for any time, then ends as others do: after 20 lost commands in a row.
struct ClientLost {};

/// Any request of a control unit.
using UnitRequest = std::variant<
    franka_core::fci::MoveRequest, franka_core::fci::StopMoveRequest,
    franka_core::fci::AutomaticErrorRecoveryRequest, franka_core::fci::SetCollisionBehaviorRequest,
    franka_core::fci::SetJointImpedanceRequest, franka_core::fci::SetCartesianImpedanceRequest,
    franka_core::fci::SetGuidingModeRequest, franka_core::fci::SetEEToKRequest,
    franka_core::fci::SetNEToEERequest, franka_core::fci::SetLoadRequest,
    franka_core::fci::SetFiltersRequest, UserStop, Guiding, Brakes, FciActivation, OperatorMove,
    ContinuedMove, SetEndEffector, SetVirtualWall, SetProtocolVersion, ClientLost>;

/// The requests that are answered later than they are made.
enum class PendingAnswer {
  kMotion,    ///< the result of a motion
  kStop,      ///< the arm rests after StopMove
  kRecovery,  ///< the result of an error recovery
};

/// The request of a client for this load.
inline franka_core::fci::SetLoadRequest loadRequest(const franka_core::Payload& load) noexcept {
  return {load.mass, load.com, load.inertia};
}

/// The request of a client for these thresholds.
inline franka_core::fci::SetCollisionBehaviorRequest collisionRequest(
    const CollisionThresholds& acceleration, const CollisionThresholds& nominal) noexcept {
  return {acceleration.lower_torque, acceleration.upper_torque, nominal.lower_torque,
          nominal.upper_torque,      acceleration.lower_force,  acceleration.upper_force,
          nominal.lower_force,       nominal.upper_force};
}

/// A Move request for torques of an external controller without a motion generator.
inline franka_core::fci::MoveRequest torqueControl() noexcept {
  franka_core::fci::MoveRequest request;
  request.controller_mode = franka_core::ControllerMode::kExternalController;
  request.motion_generator_mode = franka_core::MotionGeneratorMode::kNone;
  return request;
}

}  // namespace franka_sim

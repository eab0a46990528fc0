// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/simulation/simulated_robot.h>

#include <Eigen/Geometry>
#include <array>
#include <cstddef>

/// @file
/// What the action of a learned policy does to an arm and a hand. All values of an action lie in
/// [-1, 1]. The robot's own control runs at 1 kHz below the policy; an action moves the target of
/// its springs, or sets torques. A target never leads the arm by more than a limit, so that an arm
/// at an obstacle presses gently. docs/gym.md describes them for users. Called by one thread.

namespace franka_sim {

/// What the numbers of an action are.
enum class PolicyControl {
  kTorque,          ///< 7 torques beside gravity
  kJointDelta,      ///< 7 steps of the joints' targets
  kCartesianDelta,  ///< steps of the end effector's target: x, y, z and a rotation vector
};

/// Of an action kCartesianDelta of length 1. Chosen here: the joints stay below their limits.
constexpr double kPolicySpeed = 0.25;     ///< [m/s]
constexpr double kPolicyTurnSpeed = 0.8;  ///< [rad/s]

/// Numbers of an action of one arm, without its hand.
constexpr std::size_t sizeOfAction(PolicyControl control) noexcept {
  return control == PolicyControl::kCartesianDelta ? 6 : 7;
}

/// Lowest and highest x, y, z of targets in the world [m].
struct PolicyWorkspace {
  Eigen::Vector3d lowest, highest;  ///< each with x, y and z [m]
};

/// Applies the actions of one arm. While the robot cannot be commanded, as during its recovery,
/// actions have no effect.
class ArmPolicy {
 public:
  /// @param robot outlives it. @param base pose of the robot in the world
  ArmPolicy(PolicyControl control, SimulatedRobot& robot, const Eigen::Isometry3d& base,
            const PolicyWorkspace& workspace);

  /// Call after a reset: the present orientation is the one about which targets may turn.
  void restart() noexcept;
  /// @param action sizeOfAction() numbers @param seconds for how long it is applied
  /// @throws RequestRefused if the robot cannot start a motion
  void apply(const double* action, double seconds);

 private:
  using Vector7 = Eigen::Matrix<double, 7, 1>;

  Eigen::Isometry3d worldPose() const noexcept;
  void begin();
  void applyTorque(const Vector7& action);
  void applyJointDelta(const Vector7& action, double seconds);
  void applyCartesianDelta(const double* action, double seconds);
  double shareOfSpeed(const Eigen::Vector3d& velocity,
                      const Eigen::Vector3d& turning) const noexcept;

  PolicyControl control_;
  SimulatedRobot* robot_;
  Eigen::Isometry3d base_, to_base_;
  PolicyWorkspace workspace_;
  Vector7 lowest_, highest_;  ///< of the joints [rad]
  bool running_{false};
  Eigen::Matrix3d start_;
  Eigen::Isometry3d target_;  ///< of the end effector, in the world
  Vector7 q_target_;          ///< [rad]
};

/// Applies an action's last number: below 0 the hand closes and holds what is between the fingers
/// with 20 N, else it opens fully. A command is given only when this changes.
class HandPolicy {
 public:
  /// @param hand outlives it
  explicit HandPolicy(GripperUnit& hand) noexcept : hand_(&hand) {}

  /// Call after a reset: the hand is open.
  void restart() noexcept { closed_ = false; }
  /// @param action in [-1, 1]
  void apply(double action) noexcept;

 private:
  GripperUnit* hand_;
  bool closed_{false};
};

}  // namespace franka_sim

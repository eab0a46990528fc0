// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/simulation/simulated_robot.h>
#include <franka_sim/simulation/simulation.h>

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

/// @file
/// What the action of a learned policy does to an arm and a hand. All values of an action lie in
/// [-1, 1]. The robot's own control runs at 1 kHz below the policy; an action moves the target of
/// its springs, or sets torques. A target never leads the arm by more than a limit, so that an arm
/// at an obstacle presses gently. docs/gym.md describes them for users. Called by one thread.

namespace franka_sim {

/// What the numbers of an action are.
enum class PolicyControl {
  kTorque,          ///< 7 torques in addition to gravity
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

/// Episodes in which a learned policy acts on the robots of a simulation: what a step of the policy
/// does, and what it observes. pyfranka.gym makes tasks of it. Called by one thread.
class PolicyEpisode {
 public:
  /// Fixed for all episodes.
  struct Setting {
    PolicyControl control{PolicyControl::kCartesianDelta};  ///< kind of the actions
    bool hands{false};                                      ///< whether the policy drives the hands
    std::string body;           ///< the object that is observed; empty: none
    PolicyWorkspace workspace;  ///< of the targets
  };

  /// @param simulation outlives the episode
  /// @throws std::runtime_error without such a body or hand
  PolicyEpisode(Simulation& simulation, const Setting& setting);

  /// Numbers of an action: of each arm, and of its hand.
  std::size_t actionSize() const noexcept;
  /// Numbers of an observation. For each robot: q, dq, position of the end effector in the world
  /// and its x and y axis, and with hands the width between the fingers. Of the body: position,
  /// quaternion w, x, y, z with w not negative, mean velocity of the last step, and whether each
  /// robot, and anything else, touches it (0 or 1).
  std::size_t observationSize() const noexcept;

  /// Call after the simulation was reset: begins an episode.
  void restart();
  /// Applies an action; then the simulation is stepped. @param action actionSize() numbers in [-1,
  /// 1]
  /// @param seconds for how long @throws RequestRefused if a robot cannot start a motion
  void apply(const double* action, double seconds);
  /// Starts the recovery of robots that a reflex has stopped. @param seconds since the last call
  void recover(double seconds);
  /// @param seconds since the last observation; 0 at the beginning of an episode
  /// @param observation observationSize() numbers
  void observe(double seconds, double* observation);

  /// Of this episode.
  std::uint64_t reflexes() const noexcept { return reflexes_; }
  /// Whether a reflex had stopped a robot at the last recover().
  bool stopped() const noexcept;
  /// Whether recovery fails, as for a joint beyond its limits, which people guide back by hand.
  bool stuck() const noexcept;

 private:
  struct Robot {
    SimulatedRobot* robot;
    Eigen::Isometry3d base;
    ArmPolicy arm;
    bool stopped;
  };

  void observeBody(double seconds, double* to);

  Simulation* simulation_;
  Setting setting_;
  std::vector<Robot> robots_;
  std::vector<HandPolicy> hands_;
  std::array<double, 3> before_{};  ///< the body's position at the last observation
  std::uint64_t reflexes_{0};
  double waited_{0.0};  ///< [s] in a reflex
};

}  // namespace franka_sim

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/robot/plant.h>
#include <mujoco/mujoco.h>

#include <limits>
#include <string>
#include <vector>

namespace franka_sim::physics {

/// The friction of arms' joints (JointFriction), as torques in each physics step.
///
/// MuJoCo's own dry friction does not depend on velocity, cannot act behind a torque sensor, and
/// creeps. At rest the motor side is Prandtl's elastoplastic element: a spring in series with a
/// slider, so that a joint neither creeps under a torque below Coulomb friction nor chatters.
/// Called by the stepping thread. Real-time safe. Exceptions: `add` and `carry`.
class JointFrictions {
 public:
  struct Joint {
    std::string name;
    int dof{-1};
    JointFriction law;
    double at_rest{0};  ///< the sigmoid's torque at rest, which the law subtracts [Nm]
    double stiffness{0}, damping{0};  ///< of the spring [Nm/rad], [Nm s/rad]
    double held{0};                   ///< torque of the spring [Nm]
    double motor_side{0};             ///< torque of the last step at the motor side [Nm]
  };

  /// Adds the friction of a joint of the model.
  void add(const mjModel& model, const std::string& joint, const JointFriction& law);
  /// Takes over the springs of joints with the same name.
  void carry(const JointFrictions& others);
  /// All springs become slack.
  void reset() noexcept;
  /// Call in each physics step, between its first half and its second: adds to qfrc_passive.
  void apply(const mjModel& model, mjData* data) noexcept;

  /// The longest physics step in which no friction changes a joint's velocity by more than that
  /// velocity [s]: half of what makes an Euler step unstable.
  double longestStep() const noexcept { return longest_step_; }

  const std::vector<Joint>& joints() const noexcept { return joints_; }

 private:
  std::vector<Joint> joints_;
  double longest_step_{std::numeric_limits<double>::infinity()};
};

}  // namespace franka_sim::physics

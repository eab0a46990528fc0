// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/robot/plant.h>
#include <mujoco/mujoco.h>

#include <string>
#include <vector>

namespace franka_sim::physics {

/// The friction of arms' joints (JointFriction), as torques in each physics step.
///
/// MuJoCo's own dry friction has no law of the velocity, knows no friction beyond a torque sensor,
/// and creeps. At rest the motor side is Prandtl's elastoplastic element: a spring in series with a
/// slider, so that a joint neither creeps under a torque below Coulomb friction nor chatters. Owned
/// by the stepping thread; only `add` and `carry` allocate.
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

  const std::vector<Joint>& joints() const noexcept { return joints_; }

 private:
  std::vector<Joint> joints_;
};

}  // namespace franka_sim::physics

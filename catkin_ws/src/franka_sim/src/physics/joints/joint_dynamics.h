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

/// Reading of a torque sensor between gear and link, the mean over a tick (decision 2):
/// motor torque - friction + brake - B (dq_k - dq_{k-1}) / T, per degree of freedom [Nm] or [N].
/// The friction of JointFriction at the link side acts behind the sensor and is not subtracted.
///
/// Owned by the stepping thread; allocates only in `prepare`.
class MotorSide {
 public:
  /// Allocates for a model. @param brake_dofs for every equality the degree of freedom that it
  /// brakes, or -1 for other equalities.
  void prepare(const mjModel& model, std::vector<int> brake_dofs);
  /// Call before the first substep of a tick.
  void startTick(const mjModel& model, const mjData& data) noexcept;
  /// Call after each substep, while the constraint forces of that substep are still in the data.
  void addSubstep(const mjModel& model, const mjData& data,
                  const JointFrictions& frictions) noexcept;
  /// Call after the last substep. @param period of the tick [s].
  void finishTick(const mjModel& model, const mjData& data, int substeps, double period) noexcept;
  /// Before any motion the sensor shows the motor's torque.
  void reset(const mjData& data) noexcept;

  double torque(int dof) const noexcept { return torque_[dof]; }
  /// Physics steps of the last tick.
  int substeps() const noexcept { return substeps_; }
  void setTorque(int dof, double torque) noexcept { torque_[dof] = torque; }
  const std::vector<double>& torques() const noexcept { return torque_; }

 private:
  std::vector<double> torque_, sum_, velocity_;
  std::vector<int> brake_dofs_;
  int substeps_{1};
};

}  // namespace franka_sim::physics

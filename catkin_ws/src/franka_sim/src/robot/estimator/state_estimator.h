// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/robot_state.h>
#include <franka_sim/robot/fixed_pointer.h>
#include <franka_sim/robot/plant.h>

#include <array>

#include "robot/configuration.h"
#include "robot/estimator/contact_monitor.h"
#include "robot/estimator/estimate.h"
#include "robot/estimator/external_torque.h"
#include "robot/estimator/external_wrench.h"
#include "robot/estimator/low_pass.h"
#include "robot/estimator/sensor_noise.h"

namespace franka_sim {

/// From measurement to state: poses, torques, external torques and wrenches, contacts,
/// accelerations. Writes the measured fields of the robot's state.
///
/// Called by one thread. Real-time safe. Exception: the constructor.
class StateEstimator {
 public:
  /// @param configuration, state outlive the estimator.
  StateEstimator(const Configuration& configuration, franka_core::RobotState& state) noexcept;

  /// One tick. The first sample after the start or a restart has no motor torques of a previous
  /// tick: tau_J is then gravity, as the sensor of a resting arm measures, and the external torque
  /// is 0. A sample that is not finite is replaced by the last finite pose at rest.
  /// @param thresholds of this tick
  void update(const ArmMeasurement& measurement, const CollisionThresholds& thresholds) noexcept;

  const Estimate& estimate() const noexcept { return estimate_; }
  /// Whether there was a measurement since the start or a restart.
  bool started() const noexcept { return started_; }

  /// Clears latched collisions.
  void clearContacts() noexcept;
  /// The arm was moved to another pose: clears velocities, filters and collisions.
  void restart() noexcept;

 private:
  void updateTorques(const ArmMeasurement& measurement) noexcept;
  void updateContacts(const CollisionThresholds& thresholds) noexcept;
  void updateAccelerometers(const std::array<double, 7>& dq_before) noexcept;

  FixedPointer<const Configuration> configuration_;
  FixedPointer<franka_core::RobotState> state_;
  Estimate estimate_;
  bool started_{false};
  bool continuous_{false};  // the last sample was finite and of the same motion
  SensorNoise noise_;
  ExternalTorque external_torque_;
  ExternalWrench external_wrench_;
  LowPass<7> tau_ext_filter_, dtau_J_filter_;
  /// Of the torques that become the wrench, all at the joints' mean bandwidth: the wrench of
  /// torques with different delays would be later than each of them.
  LowPass<7> wrench_filter_;
  ContactMonitor<7> joint_contacts_;
  ContactMonitor<6> cartesian_contacts_;
};

}  // namespace franka_sim

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

namespace franka_example_controllers {

using Vector7d = Eigen::Matrix<double, 7, 1>;  ///< a value per joint

/// Gains and limits of teleoperation; [Nm/rad] [Nm s/rad] [rad/s] [rad/s^2] [N].
struct TeleopParameters {
  Vector7d leader_d_gains_lower, leader_d_gains_upper;            ///< damping
  Vector7d leader_dq_max_lower, leader_dq_max_upper;              ///< speeds
  Vector7d follower_p_gains, follower_d_gains, drift_comp_gains;  ///< stiffness, damping, drift
  Vector7d follower_dq_max_lower, follower_dq_max_upper;          ///< speeds
  Vector7d follower_ddq_max_lower, follower_ddq_max_upper;        ///< accelerations
  double leader_damping_scaling{1.0};                             ///< of the damping
  double follower_stiffness_scaling{1.0};                         ///< of the stiffness
  double force_feedback_idle{0.5};             ///< share of the follower's external torque fed back
  double force_feedback_guiding{0.95};         ///< the same while the leader is guided
  double leader_contact_force_threshold{4.0};  ///< [N]
  double follower_contact_force_threshold{5.0};  ///< [N]
};

/// Input of the law for one arm in a cycle.
struct TeleopArm {
  Vector7d q, dq;             ///< joint positions [rad] and velocities [rad/s]
  Vector7d tau_ext;           ///< estimated external torque [Nm]
  Eigen::Vector3d force_ext;  ///< estimated external force [N]
  bool has_error{false};      ///< whether the robot has an error
};

/// Smooth transition from `pos_x_value` (far below the shift) to `neg_x_value` (far above): 0.5
/// (pos + neg - (pos - neg) tanh(increase (x - shift))).
double rampParameter(double x, double neg_x_value, double pos_x_value, double shift_along_x,
                     double increase) noexcept;

/// Law by which one arm follows another, with feedback of its contacts.
///
/// It first aligns: the follower moves slowly to the leader, which is held in place. Once all
/// joints agree within 0.01 rad it tracks: the leader moves freely, is damped at high speed, and
/// feels the follower's contacts. Called by one thread at 1 kHz. No function throws.
/// Real-time safe.
class TeleopFollow {
 public:
  /// Starts at the arms' present positions.
  void start(const TeleopArm& leader, const TeleopArm& follower) noexcept;

  /// One cycle. @param dt [s]
  void update(const TeleopParameters& parameters, const TeleopArm& leader,
              const TeleopArm& follower, double dt) noexcept;

  /// Torques of this cycle without gravity [Nm].
  const Vector7d& leaderTorque() const noexcept { return tau_leader_; }
  /// Torques of the follower in this cycle [Nm].
  const Vector7d& followerTorque() const noexcept { return tau_follower_; }

  const Vector7d& target() const noexcept { return q_target_; }           ///< of the follower [rad]
  const Vector7d& targetVelocity() const noexcept { return dq_target_; }  ///< [rad/s]
  double leaderContact() const noexcept { return leader_contact_; }  ///< 0 not touched, 1 guided
  double followerContact() const noexcept { return follower_contact_; }  ///< 0 none, 1 in contact

 private:
  void advanceTarget(const TeleopParameters& parameters, const TeleopArm& leader,
                     double dt) noexcept;
  void align(const TeleopParameters& parameters, const TeleopArm& leader,
             const TeleopArm& follower) noexcept;
  void track(const TeleopParameters& parameters, const TeleopArm& leader,
             const TeleopArm& follower) noexcept;

  bool tracking_{false};
  Vector7d q_leader_start_{Vector7d::Zero()};
  Vector7d q_target_{Vector7d::Zero()}, dq_target_{Vector7d::Zero()};
  Vector7d tau_leader_{Vector7d::Zero()}, tau_follower_{Vector7d::Zero()};
  double leader_contact_{0.0}, follower_contact_{0.0};
};

}  // namespace franka_example_controllers

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_example_controllers/teleop_follow.h>

#include <cmath>

namespace franka_example_controllers {

namespace {

// The original's constants.
constexpr double kAligned = 0.01;           // [rad]
constexpr double kAlignVelocity = 0.1;      // [rad/s]
constexpr double kAlignAcceleration = 0.5;  // [rad/s^2]
constexpr double kVelocityShift = 0.25;     // [rad] deviation at the middle of the transition
constexpr double kVelocityIncrease = 20.0;  // [1/rad]
constexpr double kContactIncrease = 0.3;    // [1/N]
constexpr double kErrorDecay = 0.95;        // of the torques per cycle, while an arm has an error

const Vector7d& alignStiffness() {
  static const Vector7d gains = (Vector7d() << 45.0, 45.0, 45.0, 45.0, 18.0, 11.0, 5.0).finished();
  return gains;
}
const Vector7d& alignDamping() {
  static const Vector7d gains = (Vector7d() << 4.5, 4.5, 4.5, 4.5, 1.5, 1.5, 1.0).finished();
  return gains;
}

/// 0 without force, approaching 1 above the threshold.
double contact(const Eigen::Vector3d& force, double threshold) noexcept {
  return rampParameter(force.norm(), 1.0, 0.0, threshold, kContactIncrease);
}

}  // namespace

double rampParameter(double x, double neg_x_value, double pos_x_value, double shift_along_x,
                     double increase) noexcept {
  return 0.5 * (pos_x_value + neg_x_value -
                (pos_x_value - neg_x_value) * std::tanh(increase * (x - shift_along_x)));
}

void TeleopFollow::start(const TeleopArm& leader, const TeleopArm& follower) noexcept {
  tracking_ = false;
  q_leader_start_ = leader.q;
  q_target_ = follower.q;
  dq_target_.setZero();
  tau_leader_.setZero();
  tau_follower_.setZero();
}

void TeleopFollow::update(const TeleopParameters& parameters, const TeleopArm& leader,
                          const TeleopArm& follower, double dt) noexcept {
  leader_contact_ = contact(leader.force_ext, parameters.leader_contact_force_threshold);
  follower_contact_ = contact(follower.force_ext, parameters.follower_contact_force_threshold);
  if (leader.has_error || follower.has_error) {
    // An arm is not driven while its partner stands still.
    tau_leader_ *= kErrorDecay;
    tau_follower_ *= kErrorDecay;
    q_target_ = follower.q;
    dq_target_.setZero();
    return;
  }
  if (!tracking_ && ((leader.q - follower.q).cwiseAbs().array() < kAligned).all()) {
    tracking_ = true;
  }
  advanceTarget(parameters, leader, dt);
  if (tracking_) {
    track(parameters, leader, follower);
  } else {
    align(parameters, leader, follower);
  }
}

void TeleopFollow::advanceTarget(const TeleopParameters& parameters, const TeleopArm& leader,
                                 double dt) noexcept {
  for (Eigen::Index i = 0; i < 7; ++i) {
    const double deviation = leader.q[i] - q_target_[i];
    double dq_max = kAlignVelocity;
    double ddq_max = kAlignAcceleration;
    if (tracking_) {
      // The larger the deviation, the slower it is reduced.
      dq_max =
          rampParameter(std::abs(deviation), parameters.follower_dq_max_lower[i],
                        parameters.follower_dq_max_upper[i], kVelocityShift, kVelocityIncrease);
      ddq_max =
          rampParameter(std::abs(deviation), parameters.follower_ddq_max_lower[i],
                        parameters.follower_ddq_max_upper[i], kVelocityShift, kVelocityIncrease);
    }
    const double desired = parameters.drift_comp_gains[i] * deviation + leader.dq[i];
    const double step = std::min(std::max(desired - dq_target_[i], -ddq_max * dt), ddq_max * dt);
    dq_target_[i] = std::min(std::max(dq_target_[i] + step, -dq_max), dq_max);
    q_target_[i] += dq_target_[i] * dt;
  }
}

void TeleopFollow::align(const TeleopParameters& parameters, const TeleopArm& leader,
                         const TeleopArm& follower) noexcept {
  tau_follower_ = alignStiffness().cwiseProduct(q_target_ - follower.q) +
                  alignDamping().cwiseProduct(dq_target_ - follower.dq);
  tau_leader_ = parameters.follower_p_gains.cwiseProduct(q_leader_start_ - leader.q) -
                alignDamping().cwiseProduct(leader.dq);
}

void TeleopFollow::track(const TeleopParameters& parameters, const TeleopArm& leader,
                         const TeleopArm& follower) noexcept {
  const double feedback =
      follower_contact_ *
      (parameters.force_feedback_idle +
       leader_contact_ * (parameters.force_feedback_guiding - parameters.force_feedback_idle));
  for (Eigen::Index i = 0; i < 7; ++i) {
    const double slow = parameters.leader_dq_max_lower[i];
    const double fast = parameters.leader_dq_max_upper[i];
    const double share =
        std::min(std::max((std::abs(leader.dq[i]) - slow) / (fast - slow), 0.0), 1.0);
    const double damping =
        parameters.leader_d_gains_lower[i] +
        share * (parameters.leader_d_gains_upper[i] - parameters.leader_d_gains_lower[i]);
    tau_leader_[i] = -feedback * follower.tau_ext[i] -
                     parameters.leader_damping_scaling * damping * leader.dq[i];
  }
  const double scaling = parameters.follower_stiffness_scaling;
  tau_follower_ =
      scaling * parameters.follower_p_gains.cwiseProduct(q_target_ - follower.q) +
      std::sqrt(scaling) * parameters.follower_d_gains.cwiseProduct(dq_target_ - follower.dq);
}

}  // namespace franka_example_controllers

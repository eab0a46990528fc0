// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_example_controllers/cartesian_impedance.h>
#include <franka_example_controllers/pseudo_inversion.h>

#include <cmath>

namespace franka_example_controllers {

namespace {

/// Share of the difference to a target that is covered in one update of 1 ms; the original's
/// constant.
constexpr double kComplianceFilter = 0.005;

using Pose = Eigen::Map<const Eigen::Matrix4d>;
using Joints = Eigen::Map<const CartesianImpedance::Vector7>;
using Wrench = Eigen::Matrix<double, 6, 1>;

template <typename Value>
Value filtered(const Value& current, const Value& target) noexcept {
  return kComplianceFilter * target + (1.0 - kComplianceFilter) * current;
}

double criticalDamping(double stiffness) noexcept { return 2.0 * std::sqrt(stiffness); }

}  // namespace

void CartesianImpedance::start(const std::array<double, 16>& O_T_EE, const std::array<double, 7>& q,
                               double nullspace_stiffness) noexcept {
  const Pose pose(O_T_EE.data());
  position_d_ = position_target_ = pose.topRightCorner<3, 1>();
  orientation_d_ = orientation_target_ =
      Eigen::Quaterniond(pose.topLeftCorner<3, 3>()).normalized();
  q_nullspace_ = Joints(q.data());
  gains_ = Gains{};
  nullspace_stiffness_ = nullspace_stiffness;
}

void CartesianImpedance::setEquilibrium(const Eigen::Vector3d& position,
                                        const Eigen::Quaterniond& orientation) noexcept {
  position_target_ = position;
  orientation_target_ = orientation;
}

CartesianImpedance::Vector7 CartesianImpedance::update(const Arm& arm) noexcept {
  const Eigen::Map<const Eigen::Matrix<double, 6, 7>> J(arm.zero_jacobian.data());
  const Joints q(arm.q.data());
  const Joints dq(arm.dq.data());

  const Wrench error = poseError(arm.O_T_EE);
  const Wrench twist = J * dq;
  Wrench wrench;
  wrench << -gains_.stiffness[0] * error.head<3>() - gains_.damping[0] * twist.head<3>(),
      -gains_.stiffness[1] * error.tail<3>() - gains_.damping[1] * twist.tail<3>();

  const Vector7 tau_elbow =
      nullspace_stiffness_ * (q_nullspace_ - q) - criticalDamping(nullspace_stiffness_) * dq;
  const Eigen::Matrix<double, 7, 6> Jt = J.transpose();
  const Wrench elbow_wrench = dampedSolution(Jt, tau_elbow, kNullSpaceDamping);

  const Vector7 tau = Jt * (wrench - elbow_wrench) + tau_elbow + Joints(arm.coriolis.data());
  approachTargets();
  return saturateTorqueRate(tau, Joints(arm.tau_J_d.data()));
}

Eigen::Matrix<double, 6, 1> CartesianImpedance::poseError(
    const std::array<double, 16>& O_T_EE) const noexcept {
  const Pose pose(O_T_EE.data());
  const Eigen::Matrix3d rotation = pose.topLeftCorner<3, 3>();
  Eigen::Quaterniond orientation(rotation);
  if (orientation_d_.coeffs().dot(orientation.coeffs()) < 0.0) {
    orientation.coeffs() = -orientation.coeffs();  // the same rotation, by the shortest arc
  }
  const Eigen::Quaterniond left_to_turn = orientation.conjugate() * orientation_d_;
  Eigen::Vector3d turn = left_to_turn.vec();
  if (rotation_error_ == RotationError::kAxisAngle) {
    const Eigen::AngleAxisd angle_axis(left_to_turn);
    turn = angle_axis.axis() * angle_axis.angle();
  }
  Wrench error;
  error << pose.topRightCorner<3, 1>() - position_d_, -(rotation * turn);
  return error;
}

void CartesianImpedance::approachTargets() noexcept {
  const std::array<double, 2> stiffness{
      {compliance_target_.translational_stiffness, compliance_target_.rotational_stiffness}};
  for (std::size_t i = 0; i < stiffness.size(); ++i) {
    gains_.stiffness[i] = filtered(gains_.stiffness[i], stiffness[i]);
    gains_.damping[i] = filtered(gains_.damping[i], criticalDamping(stiffness[i]));
  }
  nullspace_stiffness_ = filtered(nullspace_stiffness_, compliance_target_.nullspace_stiffness);
  position_d_ = filtered(position_d_, position_target_);
  orientation_d_ = orientation_d_.slerp(kComplianceFilter, orientation_target_).normalized();
}

}  // namespace franka_example_controllers

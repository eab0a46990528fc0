// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_control/state_conversions.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstring>
#include <utility>
#include <vector>

#include "random_state.h"

namespace franka_control {
namespace {

template <std::size_t N>
bool same(const std::array<double, N>& state, const boost::array<double, N>& message) {
  return std::memcmp(state.data(), message.data(), sizeof(state)) == 0;
}

void expectSameErrors(const franka::Errors& errors, const franka_msgs::Errors& message) {
#define FRANKA_CONTROL_SAME(name) EXPECT_EQ(errors.name, message.name != 0) << #name
  FRANKA_CONTROL_SAME(joint_position_limits_violation);
  FRANKA_CONTROL_SAME(cartesian_position_limits_violation);
  FRANKA_CONTROL_SAME(self_collision_avoidance_violation);
  FRANKA_CONTROL_SAME(joint_velocity_violation);
  FRANKA_CONTROL_SAME(cartesian_velocity_violation);
  FRANKA_CONTROL_SAME(force_control_safety_violation);
  FRANKA_CONTROL_SAME(joint_reflex);
  FRANKA_CONTROL_SAME(cartesian_reflex);
  FRANKA_CONTROL_SAME(max_goal_pose_deviation_violation);
  FRANKA_CONTROL_SAME(max_path_pose_deviation_violation);
  FRANKA_CONTROL_SAME(cartesian_velocity_profile_safety_violation);
  FRANKA_CONTROL_SAME(joint_position_motion_generator_start_pose_invalid);
  FRANKA_CONTROL_SAME(joint_motion_generator_position_limits_violation);
  FRANKA_CONTROL_SAME(joint_motion_generator_velocity_limits_violation);
  FRANKA_CONTROL_SAME(joint_motion_generator_velocity_discontinuity);
  FRANKA_CONTROL_SAME(joint_motion_generator_acceleration_discontinuity);
  FRANKA_CONTROL_SAME(cartesian_position_motion_generator_start_pose_invalid);
  FRANKA_CONTROL_SAME(cartesian_motion_generator_elbow_limit_violation);
  FRANKA_CONTROL_SAME(cartesian_motion_generator_velocity_limits_violation);
  FRANKA_CONTROL_SAME(cartesian_motion_generator_velocity_discontinuity);
  FRANKA_CONTROL_SAME(cartesian_motion_generator_acceleration_discontinuity);
  FRANKA_CONTROL_SAME(cartesian_motion_generator_elbow_sign_inconsistent);
  FRANKA_CONTROL_SAME(cartesian_motion_generator_start_elbow_invalid);
  FRANKA_CONTROL_SAME(cartesian_motion_generator_joint_position_limits_violation);
  FRANKA_CONTROL_SAME(cartesian_motion_generator_joint_velocity_limits_violation);
  FRANKA_CONTROL_SAME(cartesian_motion_generator_joint_velocity_discontinuity);
  FRANKA_CONTROL_SAME(cartesian_motion_generator_joint_acceleration_discontinuity);
  FRANKA_CONTROL_SAME(cartesian_position_motion_generator_invalid_frame);
  FRANKA_CONTROL_SAME(force_controller_desired_force_tolerance_violation);
  FRANKA_CONTROL_SAME(controller_torque_discontinuity);
  FRANKA_CONTROL_SAME(start_elbow_sign_inconsistent);
  FRANKA_CONTROL_SAME(communication_constraints_violation);
  FRANKA_CONTROL_SAME(power_limit_violation);
  FRANKA_CONTROL_SAME(joint_p2p_insufficient_torque_for_planning);
  FRANKA_CONTROL_SAME(tau_j_range_violation);
  FRANKA_CONTROL_SAME(instability_detected);
  FRANKA_CONTROL_SAME(joint_move_in_wrong_direction);
  FRANKA_CONTROL_SAME(cartesian_spline_motion_generator_violation);
  FRANKA_CONTROL_SAME(joint_via_motion_generator_planning_joint_limit_violation);
  FRANKA_CONTROL_SAME(base_acceleration_initialization_timeout);
  FRANKA_CONTROL_SAME(base_acceleration_invalid_reading);
#undef FRANKA_CONTROL_SAME
}

TEST(ToMessage, CarriesEveryField) {
  RandomStates states;
  for (int n = 0; n < 100; ++n) {
    const franka::RobotState state = states.next();
    franka_msgs::FrankaState message;
    toMessage(state, message);
#define FRANKA_CONTROL_SAME(name) EXPECT_TRUE(same(state.name, message.name)) << #name
    FRANKA_CONTROL_SAME(cartesian_collision);
    FRANKA_CONTROL_SAME(cartesian_contact);
    FRANKA_CONTROL_SAME(q);
    FRANKA_CONTROL_SAME(q_d);
    FRANKA_CONTROL_SAME(dq);
    FRANKA_CONTROL_SAME(dq_d);
    FRANKA_CONTROL_SAME(ddq_d);
    FRANKA_CONTROL_SAME(theta);
    FRANKA_CONTROL_SAME(dtheta);
    FRANKA_CONTROL_SAME(tau_J);
    FRANKA_CONTROL_SAME(dtau_J);
    FRANKA_CONTROL_SAME(tau_J_d);
    FRANKA_CONTROL_SAME(K_F_ext_hat_K);
    FRANKA_CONTROL_SAME(elbow);
    FRANKA_CONTROL_SAME(elbow_d);
    FRANKA_CONTROL_SAME(elbow_c);
    FRANKA_CONTROL_SAME(delbow_c);
    FRANKA_CONTROL_SAME(ddelbow_c);
    FRANKA_CONTROL_SAME(joint_collision);
    FRANKA_CONTROL_SAME(joint_contact);
    FRANKA_CONTROL_SAME(O_F_ext_hat_K);
    FRANKA_CONTROL_SAME(O_dP_EE_d);
    FRANKA_CONTROL_SAME(O_ddP_O);
    FRANKA_CONTROL_SAME(O_dP_EE_c);
    FRANKA_CONTROL_SAME(O_ddP_EE_c);
    FRANKA_CONTROL_SAME(tau_ext_hat_filtered);
    FRANKA_CONTROL_SAME(F_x_Cee);
    FRANKA_CONTROL_SAME(I_ee);
    FRANKA_CONTROL_SAME(F_x_Cload);
    FRANKA_CONTROL_SAME(I_load);
    FRANKA_CONTROL_SAME(F_x_Ctotal);
    FRANKA_CONTROL_SAME(I_total);
    FRANKA_CONTROL_SAME(O_T_EE);
    FRANKA_CONTROL_SAME(O_T_EE_d);
    FRANKA_CONTROL_SAME(O_T_EE_c);
    FRANKA_CONTROL_SAME(F_T_EE);
    FRANKA_CONTROL_SAME(F_T_NE);
    FRANKA_CONTROL_SAME(NE_T_EE);
    FRANKA_CONTROL_SAME(EE_T_K);
#undef FRANKA_CONTROL_SAME
    EXPECT_EQ(state.m_ee, message.m_ee);
    EXPECT_EQ(state.m_load, message.m_load);
    EXPECT_EQ(state.m_total, message.m_total);
    EXPECT_EQ(state.control_command_success_rate, message.control_command_success_rate);
    EXPECT_DOUBLE_EQ(static_cast<double>(state.time.toMSec()) / 1000.0, message.time);
    expectSameErrors(state.current_errors, message.current_errors);
    expectSameErrors(state.last_motion_errors, message.last_motion_errors);
  }
}

TEST(ToMessage, MapsEachRobotModeToItsNumber) {
  const std::vector<std::pair<franka::RobotMode, int>> modes{
      {franka::RobotMode::kOther, 0},
      {franka::RobotMode::kIdle, 1},
      {franka::RobotMode::kMove, 2},
      {franka::RobotMode::kGuiding, 3},
      {franka::RobotMode::kReflex, 4},
      {franka::RobotMode::kUserStopped, 5},
      {franka::RobotMode::kAutomaticErrorRecovery, 6}};
  for (const auto& [mode, number] : modes) {
    franka::RobotState state;
    state.robot_mode = mode;
    franka_msgs::FrankaState message;
    toMessage(state, message);
    EXPECT_EQ(number, message.robot_mode);
  }
}

TEST(ToTransform, TurnsAMatrixIntoAUnitQuaternion) {
  const Eigen::Quaterniond turn = Eigen::Quaterniond(0.1, -0.7, 0.3, 0.5).normalized();
  std::array<double, 16> transform{};
  Eigen::Map<Eigen::Matrix4d> matrix(transform.data());
  matrix.setIdentity();
  matrix.topLeftCorner<3, 3>() = turn.toRotationMatrix();
  matrix.topRightCorner<3, 1>() << 0.25, -0.5, 0.75;

  const geometry_msgs::Transform message = toTransform(transform);
  EXPECT_EQ(0.25, message.translation.x);
  EXPECT_EQ(-0.5, message.translation.y);
  EXPECT_EQ(0.75, message.translation.z);
  const Eigen::Quaterniond result(message.rotation.w, message.rotation.x, message.rotation.y,
                                  message.rotation.z);
  EXPECT_NEAR(0.0, turn.angularDistance(result), 1e-7);
}

TEST(ToTransform, NormalizesRotationsTypedWithFourDigits) {
  const geometry_msgs::Transform message =
      toTransform({{0.7071, -0.7071, 0, 0, 0.7071, 0.7071, 0, 0, 0, 0, 1, 0, 0, 0, 0.1034, 1}});
  const auto& q = message.rotation;
  EXPECT_NEAR(1.0, q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, 1e-15);
  EXPECT_NEAR(-0.3826834, q.z, 1e-5);
}

}  // namespace
}  // namespace franka_control

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_control/state_conversions.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/array.hpp>
#include <cstddef>

namespace franka_control {

namespace {

template <std::size_t N>
void copy(const std::array<double, N>& from, boost::array<double, N>& to) noexcept {
  std::copy(from.begin(), from.end(), to.begin());
}

std::uint8_t toMessage(franka::RobotMode mode) noexcept {
  using Message = franka_msgs::FrankaState;
  switch (mode) {
    case franka::RobotMode::kIdle:
      return Message::ROBOT_MODE_IDLE;
    case franka::RobotMode::kMove:
      return Message::ROBOT_MODE_MOVE;
    case franka::RobotMode::kGuiding:
      return Message::ROBOT_MODE_GUIDING;
    case franka::RobotMode::kReflex:
      return Message::ROBOT_MODE_REFLEX;
    case franka::RobotMode::kUserStopped:
      return Message::ROBOT_MODE_USER_STOPPED;
    case franka::RobotMode::kAutomaticErrorRecovery:
      return Message::ROBOT_MODE_AUTOMATIC_ERROR_RECOVERY;
    case franka::RobotMode::kOther:
      break;
  }
  return Message::ROBOT_MODE_OTHER;
}

void toMessage(const franka::Errors& errors, franka_msgs::Errors& message) noexcept {
#define FRANKA_CONTROL_COPY(name) message.name = static_cast<std::uint8_t>(errors.name)
  FRANKA_CONTROL_COPY(joint_position_limits_violation);
  FRANKA_CONTROL_COPY(cartesian_position_limits_violation);
  FRANKA_CONTROL_COPY(self_collision_avoidance_violation);
  FRANKA_CONTROL_COPY(joint_velocity_violation);
  FRANKA_CONTROL_COPY(cartesian_velocity_violation);
  FRANKA_CONTROL_COPY(force_control_safety_violation);
  FRANKA_CONTROL_COPY(joint_reflex);
  FRANKA_CONTROL_COPY(cartesian_reflex);
  FRANKA_CONTROL_COPY(max_goal_pose_deviation_violation);
  FRANKA_CONTROL_COPY(max_path_pose_deviation_violation);
  FRANKA_CONTROL_COPY(cartesian_velocity_profile_safety_violation);
  FRANKA_CONTROL_COPY(joint_position_motion_generator_start_pose_invalid);
  FRANKA_CONTROL_COPY(joint_motion_generator_position_limits_violation);
  FRANKA_CONTROL_COPY(joint_motion_generator_velocity_limits_violation);
  FRANKA_CONTROL_COPY(joint_motion_generator_velocity_discontinuity);
  FRANKA_CONTROL_COPY(joint_motion_generator_acceleration_discontinuity);
  FRANKA_CONTROL_COPY(cartesian_position_motion_generator_start_pose_invalid);
  FRANKA_CONTROL_COPY(cartesian_motion_generator_elbow_limit_violation);
  FRANKA_CONTROL_COPY(cartesian_motion_generator_velocity_limits_violation);
  FRANKA_CONTROL_COPY(cartesian_motion_generator_velocity_discontinuity);
  FRANKA_CONTROL_COPY(cartesian_motion_generator_acceleration_discontinuity);
  FRANKA_CONTROL_COPY(cartesian_motion_generator_elbow_sign_inconsistent);
  FRANKA_CONTROL_COPY(cartesian_motion_generator_start_elbow_invalid);
  FRANKA_CONTROL_COPY(cartesian_motion_generator_joint_position_limits_violation);
  FRANKA_CONTROL_COPY(cartesian_motion_generator_joint_velocity_limits_violation);
  FRANKA_CONTROL_COPY(cartesian_motion_generator_joint_velocity_discontinuity);
  FRANKA_CONTROL_COPY(cartesian_motion_generator_joint_acceleration_discontinuity);
  FRANKA_CONTROL_COPY(cartesian_position_motion_generator_invalid_frame);
  FRANKA_CONTROL_COPY(force_controller_desired_force_tolerance_violation);
  FRANKA_CONTROL_COPY(controller_torque_discontinuity);
  FRANKA_CONTROL_COPY(start_elbow_sign_inconsistent);
  FRANKA_CONTROL_COPY(communication_constraints_violation);
  FRANKA_CONTROL_COPY(power_limit_violation);
  FRANKA_CONTROL_COPY(joint_p2p_insufficient_torque_for_planning);
  FRANKA_CONTROL_COPY(tau_j_range_violation);
  FRANKA_CONTROL_COPY(instability_detected);
  FRANKA_CONTROL_COPY(joint_move_in_wrong_direction);
  FRANKA_CONTROL_COPY(cartesian_spline_motion_generator_violation);
  FRANKA_CONTROL_COPY(joint_via_motion_generator_planning_joint_limit_violation);
#ifdef ENABLE_BASE_ACCELERATION
  FRANKA_CONTROL_COPY(base_acceleration_initialization_timeout);
  FRANKA_CONTROL_COPY(base_acceleration_invalid_reading);
#endif
#undef FRANKA_CONTROL_COPY
}

}  // namespace

void toMessage(const franka::RobotState& state, franka_msgs::FrankaState& message) noexcept {
  copy(state.cartesian_collision, message.cartesian_collision);
  copy(state.cartesian_contact, message.cartesian_contact);
  copy(state.q, message.q);
  copy(state.q_d, message.q_d);
  copy(state.dq, message.dq);
  copy(state.dq_d, message.dq_d);
  copy(state.ddq_d, message.ddq_d);
  copy(state.theta, message.theta);
  copy(state.dtheta, message.dtheta);
  copy(state.tau_J, message.tau_J);
  copy(state.dtau_J, message.dtau_J);
  copy(state.tau_J_d, message.tau_J_d);
  copy(state.K_F_ext_hat_K, message.K_F_ext_hat_K);
  copy(state.elbow, message.elbow);
  copy(state.elbow_d, message.elbow_d);
  copy(state.elbow_c, message.elbow_c);
  copy(state.delbow_c, message.delbow_c);
  copy(state.ddelbow_c, message.ddelbow_c);
  copy(state.joint_collision, message.joint_collision);
  copy(state.joint_contact, message.joint_contact);
  copy(state.O_F_ext_hat_K, message.O_F_ext_hat_K);
  copy(state.O_dP_EE_d, message.O_dP_EE_d);
#ifdef ENABLE_BASE_ACCELERATION
  copy(state.O_ddP_O, message.O_ddP_O);
#else
  message.O_ddP_O = {{0.0, 0.0, -9.81}};
#endif
  copy(state.O_dP_EE_c, message.O_dP_EE_c);
  copy(state.O_ddP_EE_c, message.O_ddP_EE_c);
  copy(state.tau_ext_hat_filtered, message.tau_ext_hat_filtered);
  message.m_ee = state.m_ee;
  copy(state.F_x_Cee, message.F_x_Cee);
  copy(state.I_ee, message.I_ee);
  message.m_load = state.m_load;
  copy(state.F_x_Cload, message.F_x_Cload);
  copy(state.I_load, message.I_load);
  message.m_total = state.m_total;
  copy(state.F_x_Ctotal, message.F_x_Ctotal);
  copy(state.I_total, message.I_total);
  copy(state.O_T_EE, message.O_T_EE);
  copy(state.O_T_EE_d, message.O_T_EE_d);
  copy(state.O_T_EE_c, message.O_T_EE_c);
  copy(state.F_T_EE, message.F_T_EE);
  copy(state.F_T_NE, message.F_T_NE);
  copy(state.NE_T_EE, message.NE_T_EE);
  copy(state.EE_T_K, message.EE_T_K);
  message.time = state.time.toSec();
  message.control_command_success_rate = state.control_command_success_rate;
  message.robot_mode = toMessage(state.robot_mode);
  toMessage(state.current_errors, message.current_errors);
  toMessage(state.last_motion_errors, message.last_motion_errors);
}

geometry_msgs::Transform toTransform(const std::array<double, 16>& transform) noexcept {
  const Eigen::Map<const Eigen::Matrix4d> matrix(transform.data());
  const Eigen::Quaterniond rotation = Eigen::Quaterniond(matrix.topLeftCorner<3, 3>()).normalized();
  geometry_msgs::Transform message;
  message.translation.x = transform[12];
  message.translation.y = transform[13];
  message.translation.z = transform[14];
  message.rotation.x = rotation.x();
  message.rotation.y = rotation.y();
  message.rotation.z = rotation.z();
  message.rotation.w = rotation.w();
  return message;
}

}  // namespace franka_control

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace franka_core {

constexpr std::size_t kErrorCount = 41;  ///< (protocol 4.3)

/// Numbers as in the datagrams and in franka::RobotMode.
enum class RobotMode : std::uint8_t {
  kOther,
  kIdle,
  kMove,
  kGuiding,
  kReflex,
  kUserStopped,
  kAutomaticErrorRecovery
};

/// Numbers of the UDP state (one more than those of the Move request).
enum class MotionGeneratorMode : std::uint8_t {
  kIdle,
  kJointPosition,
  kJointVelocity,
  kCartesianPosition,
  kCartesianVelocity,
  kNone
};

/// What computes the torques; kOther: none of a client.
enum class ControllerMode : std::uint8_t {
  kJointImpedance,
  kCartesianImpedance,
  kExternalController,
  kOther
};

/// The state of a control unit, once a millisecond: the fields of every protocol version, in
/// double. Frames, units and layouts are those of franka::RobotState (transforms 4x4 column-major,
/// inertias 3x3 column-major, [m] [rad] [s] [N] [Nm] [kg]).
struct RobotState {
  std::uint64_t message_id{0};  ///< [ms] since the unit started; the client's clock

  /// @name As the fields of franka::RobotState with these names
  /// @{
  std::array<double, 16> O_T_EE{}, O_T_EE_d{}, F_T_EE{}, EE_T_K{}, F_T_NE{}, NE_T_EE{};
  double m_ee{0.0};
  std::array<double, 9> I_ee{};
  std::array<double, 3> F_x_Cee{};
  double m_load{0.0};
  std::array<double, 9> I_load{};
  std::array<double, 3> F_x_Cload{};
  double m_total{0.0};  // not transmitted: end effector and load together
  std::array<double, 9> I_total{};
  std::array<double, 3> F_x_Ctotal{};
  std::array<double, 2> elbow{}, elbow_d{};
  std::array<double, 7> tau_J{}, tau_J_d{}, dtau_J{};
  std::array<double, 7> q{}, q_d{}, dq{}, dq_d{}, ddq_d{};
  std::array<double, 7> joint_contact{};
  std::array<double, 6> cartesian_contact{};
  std::array<double, 7> joint_collision{};
  std::array<double, 6> cartesian_collision{};
  std::array<double, 7> tau_ext_hat_filtered{};
  std::array<double, 6> O_F_ext_hat_K{}, K_F_ext_hat_K{};
  std::array<double, 6> O_dP_EE_d{};
  std::array<double, 3> O_ddP_O{};
  std::array<double, 2> elbow_c{}, delbow_c{}, ddelbow_c{};
  std::array<double, 16> O_T_EE_c{};
  std::array<double, 6> O_dP_EE_c{}, O_ddP_EE_c{};
  std::array<double, 7> theta{}, dtheta{};
  // Protocol 10 only: readings of the sensors at the upper and lower side of six joints [m/s^2].
  std::array<std::array<double, 3>, 6> accelerometer_top{}, accelerometer_bottom{};
  MotionGeneratorMode motion_generator_mode{MotionGeneratorMode::kIdle};
  ControllerMode controller_mode{ControllerMode::kOther};
  std::array<bool, kErrorCount> errors{}, reflex_reason{};
  RobotMode robot_mode{RobotMode::kUserStopped};
  double control_command_success_rate{0.0};
  /// @}
};

/// The command for one millisecond, as transmitted.
struct RobotCommand {
  std::uint64_t message_id{0};  ///< of the state that it answers

  /// @name As in the protocol: 5.7 says what c means
  /// @{
  std::array<double, 7> q_c{}, dq_c{};
  std::array<double, 16> O_T_EE_c{};
  std::array<double, 6> O_dP_EE_c{};
  std::array<double, 2> elbow_c{};
  bool valid_elbow{false};
  bool motion_generation_finished{false};
  std::array<double, 7> tau_J_d{};
  bool torque_command_finished{false};
  /// @}
};

}  // namespace franka_core

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/command_types.h>
#include <franka/control_types.h>
#include <franka/duration.h>
#include <franka/extensions.h>
#include <franka/lowpass_filter.h>
#include <franka/robot_state.h>
#include <research_interface/robot/service_types.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#if __cplusplus >= 201703L
#include <optional>
#endif

/// @file
/// The connection to a robot.

namespace franka {

class ActiveControlBase;
class Model;

/// A connection to one robot: its state once a millisecond, its settings, and its motions.
///
/// **Robots.** One library for the Panda (FER, protocol 3 to 5) and the FR3 (6 to 10): it offers
/// the newest protocol, then the robot's (serverVersion). Limits are those of the connected robot.
///
/// **Frames.** O base, F flange, NE nominal end effector, EE end effector, K stiffness frame. A
/// pose A_T_B (4x4 column-major) is that of B in A. Units: m, rad, s, kg, N, Nm.
///
/// **Threads.** control, read, readOnce and a motion started with start...Control exclude each
/// other: while one runs on this object, the others throw InvalidOperationException. Settings, stop
/// and automaticErrorRecovery may be called at any time from any thread. Callbacks run on the
/// thread that called control or read.
///
/// **Real time.** The loop inside control allocates nothing, takes no lock and writes no log. A
/// thread that calls control or start...Control gets the highest priority of SCHED_FIFO and, with
/// RealtimeConfig::kEnforce, memory is locked as far as allowed. A robot on a loopback address
/// counts as simulated: on a kernel without real-time support, kEnforce is only a warning then (see
/// franka_core/realtime_rule.h).
///
/// **Time.** No call waits for ever. Unless franka/extensions.h sets other bounds: connecting takes
/// at most 5 s; a motion or read throws a NetworkException if no state arrives for 1 s; a command
/// if its reply does not arrive within 10 s or, where it may take long (automaticErrorRecovery,
/// stop, the end of a motion, the download of a model), within 60 s or if no state arrives for 5 s.
///
/// Every member function may throw NetworkException if the connection is lost, and
/// ProtocolException if the robot's messages violate the protocol.
class Robot {
 public:
  /// Connects.
  /// @param franka_address IP address or host name, optionally `:port`.
  /// @param realtime_config whether control needs a realtime kernel and priority.
  /// @param log_size how many states and commands ControlException::log keeps.
  /// @throws NetworkException if the robot cannot be reached or sends no state.
  /// @throws IncompatibleVersionException if the robot's protocol is not one of 3 to 10.
  explicit Robot(const std::string& franka_address,
                 RealtimeConfig realtime_config = RealtimeConfig::kEnforce, size_t log_size = 50);
  Robot(Robot&& other) noexcept;
  Robot& operator=(Robot&& other) noexcept;
  /// Closes the connection; the robot stops a motion that still runs.
  ~Robot() noexcept;

  /// Version of the protocol that robot and library agreed on, 3 to 10.
  using ServerVersion = uint16_t;
  /// The version in use.
  ServerVersion serverVersion() const noexcept;

  /// @name Motions
  /// Each call blocks until the motion ends. Callbacks get the newest state and the time since the
  /// state before (0 at first, 1 ms without losses), and return the command for it; the one marked
  /// by MotionFinished ends the motion. Commands are low-pass filtered (`cutoff_frequency` [Hz];
  /// kMaxCutoffFrequency switches it off), then kept within the limits of the robot (`limit_rate`).
  /// With two callbacks the motion's comes first (see setControlOptions).
  /// @throws ControlException if the motion is aborted; it holds the log.
  /// @throws CommandException if the robot does not start the motion.
  /// @throws InvalidOperationException if another motion or read runs.
  /// @throws RealtimeException if realtime priority is enforced and not available.
  /// @throws std::invalid_argument if a commanded value is not finite, a matrix no transformation,
  /// or an elbow's sign neither +1 nor -1.
  /// An exception of a callback stops the robot and propagates to the caller.
  /// @{
  void control(std::function<Torques(const RobotState&, franka::Duration)> control_callback,
               bool limit_rate = true, double cutoff_frequency = kDefaultCutoffFrequency);
  void control(
      std::function<Torques(const RobotState&, franka::Duration)> control_callback,
      std::function<JointPositions(const RobotState&, franka::Duration)> motion_generator_callback,
      bool limit_rate = true, double cutoff_frequency = kDefaultCutoffFrequency);
  void control(
      std::function<Torques(const RobotState&, franka::Duration)> control_callback,
      std::function<JointVelocities(const RobotState&, franka::Duration)> motion_generator_callback,
      bool limit_rate = true, double cutoff_frequency = kDefaultCutoffFrequency);
  void control(
      std::function<Torques(const RobotState&, franka::Duration)> control_callback,
      std::function<CartesianPose(const RobotState&, franka::Duration)> motion_generator_callback,
      bool limit_rate = true, double cutoff_frequency = kDefaultCutoffFrequency);
  void control(std::function<Torques(const RobotState&, franka::Duration)> control_callback,
               std::function<CartesianVelocities(const RobotState&, franka::Duration)>
                   motion_generator_callback,
               bool limit_rate = true, double cutoff_frequency = kDefaultCutoffFrequency);
  void control(
      std::function<JointPositions(const RobotState&, franka::Duration)> motion_generator_callback,
      ControllerMode controller_mode = ControllerMode::kJointImpedance, bool limit_rate = true,
      double cutoff_frequency = kDefaultCutoffFrequency);
  void control(
      std::function<JointVelocities(const RobotState&, franka::Duration)> motion_generator_callback,
      ControllerMode controller_mode = ControllerMode::kJointImpedance, bool limit_rate = true,
      double cutoff_frequency = kDefaultCutoffFrequency);
  void control(
      std::function<CartesianPose(const RobotState&, franka::Duration)> motion_generator_callback,
      ControllerMode controller_mode = ControllerMode::kJointImpedance, bool limit_rate = true,
      double cutoff_frequency = kDefaultCutoffFrequency);
  void control(std::function<CartesianVelocities(const RobotState&, franka::Duration)>
                   motion_generator_callback,
               ControllerMode controller_mode = ControllerMode::kJointImpedance,
               bool limit_rate = true, double cutoff_frequency = kDefaultCutoffFrequency);
  /// @}

  /// @name Motions that the program drives itself
  /// See ActiveControlBase. The motion has begun when the call returns.
  /// @param control_type the controller; with kExternalController each command needs torques.
  /// @throws as control.
  /// @{
  std::unique_ptr<ActiveControlBase> startTorqueControl();
  std::unique_ptr<ActiveControlBase> startJointPositionControl(
      const research_interface::robot::Move::ControllerMode& control_type);
  std::unique_ptr<ActiveControlBase> startJointVelocityControl(
      const research_interface::robot::Move::ControllerMode& control_type);
  std::unique_ptr<ActiveControlBase> startCartesianPoseControl(
      const research_interface::robot::Move::ControllerMode& control_type);
  std::unique_ptr<ActiveControlBase> startCartesianVelocityControl(
      const research_interface::robot::Move::ControllerMode& control_type);
  /// @}
#if __cplusplus >= 201703L
  /// The robot plans its own motion to each commanded joint position (protocol 10). Commands need
  /// not come every millisecond.
  /// @param control_type the controller @param maximum_velocities of the seven joints [rad/s]
  /// @throws CommandException if the robot's system has no such motion.
  /// @throws std::invalid_argument without seven limits, or for one that is not positive.
  std::unique_ptr<ActiveControlBase> startAsyncJointPositionControl(
      const research_interface::robot::Move::ControllerMode& control_type,
      const std::optional<std::vector<double>>& maximum_velocities);
#endif

  /// Calls back with every new state until the callback returns false. For monitoring a robot that
  /// something else moves; not from within a control callback. The first state is that of readOnce.
  /// @throws InvalidOperationException if a motion or another read runs.
  void read(std::function<bool(const RobotState&)> read_callback);
  /// Waits for a state that arrives after the call. If none arrives within 50 ms, where a running
  /// robot sends fifty, it returns the newest state that arrived before and was not read yet.
  /// @throws InvalidOperationException if a motion or another read runs.
  RobotState readOnce();

  /// @name Settings
  /// For a robot at rest, not for a control loop: each waits for the robot's answer.
  /// @throws CommandException if the robot refuses, or has no such command (protocol versions are
  /// named where it matters).
  /// @{

  /// Reads a virtual wall (protocol 3 to 5).
  /// @param id number of the wall.
  VirtualWallCuboid getVirtualWall(int32_t id);

  /// Sets the external torques and forces above which the robot reports a contact (lower) or stops
  /// (upper), while it accelerates or decelerates and otherwise (nominal).
  /// @param lower_torque_thresholds_acceleration, upper_torque_thresholds_acceleration,
  /// lower_torque_thresholds_nominal, upper_torque_thresholds_nominal for each joint [Nm].
  /// @param lower_force_thresholds_acceleration, upper_force_thresholds_acceleration,
  /// lower_force_thresholds_nominal, upper_force_thresholds_nominal for (x, y, z, R, P, Y) [N, Nm].
  void setCollisionBehavior(const std::array<double, 7>& lower_torque_thresholds_acceleration,
                            const std::array<double, 7>& upper_torque_thresholds_acceleration,
                            const std::array<double, 7>& lower_torque_thresholds_nominal,
                            const std::array<double, 7>& upper_torque_thresholds_nominal,
                            const std::array<double, 6>& lower_force_thresholds_acceleration,
                            const std::array<double, 6>& upper_force_thresholds_acceleration,
                            const std::array<double, 6>& lower_force_thresholds_nominal,
                            const std::array<double, 6>& upper_force_thresholds_nominal);
  /// The same thresholds in all phases.
  void setCollisionBehavior(const std::array<double, 7>& lower_torque_thresholds,
                            const std::array<double, 7>& upper_torque_thresholds,
                            const std::array<double, 6>& lower_force_thresholds,
                            const std::array<double, 6>& upper_force_thresholds);

  /// @param K_theta stiffness of the joint impedance controller, 0 to 14250 [Nm/rad].
  void setJointImpedance(const std::array<double, 7>& K_theta);
  /// @param K_x stiffness of the Cartesian impedance controller along and about the axes of K:
  /// 10 to 3000 [N/m], 1 to 300 [Nm/rad].
  void setCartesianImpedance(const std::array<double, 6>& K_x);
  /// @param guiding_mode whether the hand may move (x, y, z, R, P, Y). @param elbow and the elbow.
  void setGuidingMode(const std::array<bool, 6>& guiding_mode, bool elbow);
  /// @param EE_T_K pose of K in EE, 4x4 column-major; corrected or refused by typed_transform.h.
  void setK(const std::array<double, 16>& EE_T_K);
  /// @param NE_T_EE pose of EE in the nominal end effector frame, 4x4 column-major; likewise.
  void setEE(const std::array<double, 16>& NE_T_EE);
  /// Sets the mass that the robot carries besides the end effector.
  /// @param load_mass [kg]. @param F_x_Cload center of mass in F [m].
  /// @param load_inertia about the center of mass, axes of F, 3x3 column-major [kg m^2].
  void setLoad(double load_mass, const std::array<double, 3>& F_x_Cload,
               const std::array<double, 9>& load_inertia);
  /// Sets the robot's own filters of commands (protocol 3 to 5), each 1 to 1000 [Hz], where 1000
  /// switches it off. Deprecated: the filters of control do the same in the client.
  void setFilters(double joint_position_filter_frequency, double joint_velocity_filter_frequency,
                  double cartesian_position_filter_frequency,
                  double cartesian_velocity_filter_frequency, double controller_filter_frequency);
  /// @}

  /// Clears the errors after a reflex, as far as possible without the user. Returns when the robot
  /// has recovered.
  /// @throws CommandException if it cannot recover, or was interrupted.
  void automaticErrorRecovery();

  /// Stops the running motion; its control throws ControlException. May be called from another
  /// thread or from a callback's thread after control has ended.
  /// @throws CommandException if the robot refuses.
  void stop();

  /// Loads the model of this arm: from its description (protocol 8 to 10), else from its model
  /// library (3 to 9).
  /// @throws ModelException if it cannot be loaded, CommandException if the robot refuses.
  Model loadModel();

  /// Whether the robot is a mobile base (see franka/mobile_model.h): one of protocol 10 with such a
  /// description. Real-time safe.
  bool isMobileRobot() const noexcept;

  /// The robot's description (URDF), unchanged (protocol 8 to 10).
  /// @throws CommandException if the robot's system has none.
  std::string getRobotModel();

  /// Highest velocity that the rate limiter allows for each joint at q [rad/s]: constant for the
  /// Panda, dependent on the position for the FR3 (from its description for protocol 10).
  /// Real-time safe.
  /// @param joint_positions q [rad].
  std::array<double, 7> getUpperJointVelocityLimits(
      const std::array<double, 7>& joint_positions) const noexcept;
  /// Lowest velocity, as getUpperJointVelocityLimits.
  std::array<double, 7> getLowerJointVelocityLimits(
      const std::array<double, 7>& joint_positions) const noexcept;

  /// Selects the behavior of another version of the library for all motions started later.
  /// Extension of this library.
  void setControlOptions(const ControlOptions& options);

  Robot(const Robot&) = delete;
  Robot& operator=(const Robot&) = delete;

  /// Hidden parts.
  class Impl;

 private:
  std::shared_ptr<Impl> impl_;
};

}  // namespace franka

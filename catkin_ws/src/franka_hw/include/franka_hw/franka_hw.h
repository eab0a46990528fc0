// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/control_types.h>
#include <franka/duration.h>
#include <franka/robot.h>
#include <franka/robot_state.h>
#include <franka_hw/control_mode.h>
#include <franka_hw/franka_cartesian_command_interface.h>
#include <franka_hw/franka_model_interface.h>
#include <franka_hw/franka_state_interface.h>
#include <franka_hw/model_base.h>
#include <franka_hw/response_times.h>
#include <franka_hw/robot_clock.h>
#if __has_include(<hardware_interface/command_effect_interface.h>)  // not of the original
#include <hardware_interface/command_effect_interface.h>
#endif
#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/joint_state_interface.h>
#include <hardware_interface/robot_hw.h>
#include <joint_limits_interface/joint_limits.h>
#include <joint_limits_interface/joint_limits_interface.h>
#include <joint_limits_interface/joint_limits_rosparam.h>
#include <joint_limits_interface/joint_limits_urdf.h>
#include <ros/node_handle.h>
#include <ros/time.h>
#include <urdf/model.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <exception>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

namespace franka_hw {

class ArmConnection;
class CommandPermission;
class JointLimitMonitor;
class RobotMutex;

/// A Franka arm as hardware of ros_control, connected over the Franka Control Interface.
///
/// Offers joint states, the three joint command interfaces, the state, the model and both Cartesian
/// command interfaces, and soft limits for the joints whose URDF has them. The interfaces that may
/// be claimed together: resource_helpers.h.
///
/// Threads: one thread alternates between control(), while a controller commands the arm, and
/// update() with readOnce() otherwise; it calls the controller manager in both. That thread calls
/// all virtual functions of the control cycle (read, write, update, enforceLimits,
/// checkJointLimits, reset, the callbacks). Real-time safe. Other threads call prepareSwitch,
/// connect, disconnect and the services. A thread that communicates with the robot holds
/// robotMutex(); control() holds it during a motion.
class FrankaHW : public hardware_interface::RobotHW {
 public:
  /// Thresholds of contact and collision, [Nm] and [N, Nm].
  struct CollisionConfig {
    std::array<double, 7> lower_torque_thresholds_acceleration;  ///< [Nm]
    std::array<double, 7> upper_torque_thresholds_acceleration;  ///< [Nm]
    std::array<double, 7> lower_torque_thresholds_nominal;       ///< [Nm]
    std::array<double, 7> upper_torque_thresholds_nominal;       ///< [Nm]
    std::array<double, 6> lower_force_thresholds_acceleration;   ///< [N, Nm]
    std::array<double, 6> upper_force_thresholds_acceleration;   ///< [N, Nm]
    std::array<double, 6> lower_force_thresholds_nominal;        ///< [N, Nm]
    std::array<double, 6> upper_force_thresholds_nominal;        ///< [N, Nm]
  };

  FrankaHW();
  ~FrankaHW() override;

  /// Reads the parameters, connects to the robot and registers the interfaces. Call it once only.
  /// If the robot cannot be reached, tries again for `connect_timeout` seconds (parameter, default
  /// 0).
  /// @param root_nh namespace of robot_description @param robot_hw_nh namespace of the parameters
  /// @returns false, after logging what is missing or wrong
  bool init(ros::NodeHandle& root_nh, ros::NodeHandle& robot_hw_nh) override;

  /// Reads the parameters. @returns false, after logging what is missing or wrong
  virtual bool initParameters(ros::NodeHandle& root_nh, ros::NodeHandle& robot_hw_nh);
  /// Registers the interfaces.
  virtual void initROSInterfaces(ros::NodeHandle& robot_hw_nh);
  /// Sets up the parameters that are read again at every switch of controllers: rate_limiting,
  /// cutoff_frequency and internal_controller.
  virtual void setupParameterCallbacks(ros::NodeHandle& robot_hw_nh);

  /// Connects to the robot and sets its collision behavior; does nothing when connected.
  /// @throws franka::Exception if the robot cannot be reached or refuses
  virtual void connect();
  /// Ends the connection. @returns false, after logging the reason, while a controller commands the
  /// robot
  virtual bool disconnect();
  /// Whether there is a connection.
  virtual bool connected();
  /// The connection (franka_hw/arm_connection.h): its state, its errors and its services. Its
  /// disconnect() ends it even if controllers are active, but not within a motion.
  ArmConnection& armConnection() noexcept { return *connection_; }
  const ArmConnection& armConnection() const noexcept { return *connection_; }

  /// Moves the robot until the controllers that command it are stopped; returns at once if there
  /// are none, or if armConnection() has an error. Holds robotMutex() during this time.
  /// @param ros_callback called once per millisecond of the robot's time, with that time on the
  /// clock of ROS and the time since the last call, which is zero for the first call; if it returns
  /// false, the motion ends.
  /// @throws franka::Exception if the motion ends otherwise
  virtual void control(
      const std::function<bool(const ros::Time&, const ros::Duration&)>& ros_callback);

  /// Takes over a robot state that was read outside of control().
  virtual void update(const franka::RobotState& robot_state);

  /// Whether a controller commands the robot.
  virtual bool controllerActive() const noexcept;

  /// Whether the motion that was prepared last continues with controllers that commanded the motion
  /// before it. These controllers have to be restarted; controllers that the switch has just
  /// started need not.
  virtual bool motionGoesOn() const noexcept;

  bool checkForConflict(const std::list<hardware_interface::ControllerInfo>& info) const override;
  void doSwitch(const std::list<hardware_interface::ControllerInfo>& start_list,
                const std::list<hardware_interface::ControllerInfo>& stop_list) override;
  /// Sets the control mode after the switch. A switch that acceptsSwitch() refuses changes nothing.
  /// A motion that has to change is ended here: waits for its end, and refuses the switch after two
  /// seconds. A call with the lists exchanged, before doSwitch(), cancels the preparation: the
  /// motion continues, and its controllers are restarted.
  bool prepareSwitch(const std::list<hardware_interface::ControllerInfo>& start_list,
                     const std::list<hardware_interface::ControllerInfo>& stop_list) override;
  /// Whether the robot can carry out a switch; changes nothing. Controllers are refused, after
  /// logging the reason, if they claim what the robot lacks or modes that exclude each other, if
  /// they cannot move the robot (no real-time priority, which realtime_config enforces) or must not
  /// (the robot is not the one in its parameters). Not real-time safe.
  virtual bool acceptsSwitch(const std::list<hardware_interface::ControllerInfo>& start_list,
                             const std::list<hardware_interface::ControllerInfo>& stop_list) const;

  /// The controllers' last positions [rad].
  virtual std::array<double, 7> getJointPositionCommand() const noexcept;
  /// The controllers' last velocities [rad/s].
  virtual std::array<double, 7> getJointVelocityCommand() const noexcept;
  /// The controllers' last torques [Nm].
  virtual std::array<double, 7> getJointEffortCommand() const noexcept;

  /// Limits the controllers' joint commands to the soft limits. @param period since the last cycle;
  /// does nothing if it is zero
  virtual void enforceLimits(const ros::Duration& period);
  /// Sets the start of the position limits to the present positions.
  virtual void reset();
  /// Records the joints that are near an end of their range; a timer prints them, at most every
  /// 5 s.
  virtual void checkJointLimits();

  void read(const ros::Time& time, const ros::Duration& period) override;
  void write(const ros::Time& time, const ros::Duration& period) override;

  /// @throws std::logic_error if there is no connection
  virtual franka::Robot& robot() const;
  /// armConnection().mutex(), held by the thread that communicates with the robot.
  virtual std::mutex& robotMutex();
  /// The mode in the last state.
  virtual franka::RobotMode robotMode() const;
  /// The time of measurement of the last state, on the clock of ROS. It is the time for the
  /// controllers and never goes back.
  const ros::Time& stateTime() const noexcept { return clock_.time(); }
  /// How fast the controllers answer the robot. Only one thread may take reports.
  ResponseTimes& responseTimes() noexcept { return response_times_; }

  /// Whether controllers need real-time priority to move this robot: by realtime_config, except for
  /// simulated robots (franka_core::realtimeRule). Valid after init().
  bool enforcesRealtime() const noexcept {
    return realtime_config_ == franka::RealtimeConfig::kEnforce;
  }

  /// Whether a value of the command is NaN.
  static bool commandHasNaN(const franka::Torques& command);
  static bool commandHasNaN(const franka::JointPositions& command);
  static bool commandHasNaN(const franka::JointVelocities& command);
  static bool commandHasNaN(const franka::CartesianPose& command);
  static bool commandHasNaN(const franka::CartesianVelocities& command);

  /// The parameter of that name, a list of numbers. If it is missing or has another length: the
  /// defaults, after an info line.
  static std::vector<double> getCollisionThresholds(const std::string& name,
                                                    const ros::NodeHandle& robot_hw_nh,
                                                    const std::vector<double>& defaults);

 protected:
  using Callback = std::function<bool(const franka::RobotState&, franka::Duration)>;

  /// Whether a value of the array is NaN.
  template <size_t size>
  static bool arrayHasNaN(const std::array<double, size>& array) {
    return std::any_of(array.begin(), array.end(), [](double e) { return std::isnan(e); });
  }

  /// Leaves the control loop to end a motion while the robot moves; the robot then brakes by
  /// itself.
  struct MotionInterrupted : public std::exception {
    const char* what() const noexcept override { return "the motion was interrupted by a switch"; }
  };

  /// One millisecond of a motion. @param command filled by write()
  /// @throws std::invalid_argument if a controller commands NaN
  /// @throws MotionInterrupted if the motion has to end while the robot moves
  template <typename T>
  T controlCallback(const T& command, Callback ros_callback, const franka::RobotState& robot_state,
                    franka::Duration time_step) {
    response_times_.stateArrived(robot_state.time, ResponseTimes::Clock::now());
    robot_state_libfranka_ = robot_state;
    const ros::Duration period(time_step.toSec());
    read(clock_.time(), period);
    if (!controller_active_ || (ros_callback && !ros_callback(robot_state, time_step))) {
      return finished(command, robot_state);
    }
    write(clock_.time(), period);
    if (commandHasNaN(command)) {
      throw std::invalid_argument(
          "A controller of " + arm_id_ +
          " commands a value that is not a number (NaN). The motion was ended "
          "before it reached the robot.");
    }
    response_times_.commandReady(response_times_.lastArrival(), ResponseTimes::Clock::now());
    return command;
  }

  /// The last command of a motion.
  template <typename T>
  static T finished(const T& command, const franka::RobotState& robot_state) {
    if (isMoving(robot_state)) {
      throw MotionInterrupted();
    }
    return franka::MotionFinished(command);
  }
  /// Whether the robot would refuse the end of a motion, because it moves or its desired motion
  /// does.
  static bool isMoving(const franka::RobotState& robot_state) noexcept;

  /// Registers soft limits for every joint whose URDF has a limit and a safety controller.
  template <typename T>
  void setupLimitInterface(joint_limits_interface::JointLimitsInterface<T>& limit_interface,
                           hardware_interface::JointCommandInterface& command_interface) {
    for (size_t i = 0; i < joint_names_.size(); i++) {
      joint_limits_interface::SoftJointLimits soft_limits;
      joint_limits_interface::JointLimits joint_limits;
      if (!readLimits(i, joint_limits, soft_limits)) {
        continue;
      }
      limit_interface.registerHandle(
          T(command_interface.getHandle(joint_names_[i]), joint_limits, soft_limits));
    }
    // getHandle() has claimed the joints, but only to read their limits.
    command_interface.clearClaims();
  }

  virtual void setupJointStateInterface(franka::RobotState& robot_state);

  /// @param use_q_d whether the handles show desired positions and velocities
  template <typename T>
  void setupJointCommandInterface(std::array<double, 7>& command, franka::RobotState& state,
                                  bool use_q_d, T& interface) {
    for (size_t i = 0; i < joint_names_.size(); i++) {
      const hardware_interface::JointStateHandle joint(
          joint_names_[i], use_q_d ? &state.q_d[i] : &state.q[i],
          use_q_d ? &state.dq_d[i] : &state.dq[i], &state.tau_J[i]);
      interface.registerHandle(hardware_interface::JointHandle(joint, &command[i]));
    }
    registerInterface(&interface);
  }

  virtual void setupFrankaStateInterface(franka::RobotState& robot_state);
  virtual void setupFrankaCartesianPoseInterface(franka::CartesianPose& pose_cartesian_command);
  virtual void setupFrankaCartesianVelocityInterface(
      franka::CartesianVelocities& velocity_cartesian_command);
  virtual void setupFrankaModelInterface(franka::RobotState& robot_state);

  /// Whether the robot can run this mode.
  virtual bool supports(ControlMode mode) const;

  /// Selects what control() runs. @returns false for modes that this robot cannot run
  virtual bool setRunFunction(const ControlMode& requested_control_mode, bool limit_rate,
                              double cutoff_frequency, franka::ControllerMode internal_controller);

  /// Connects, loads the model and reads the first state.
  virtual void initRobot();

  /// @name Functions that armConnection() calls
  /// @{
  /// Connects, sets the collision behavior, and warns about controllers that would be refused.
  virtual std::unique_ptr<franka::Robot> openRobot();
  /// Whether a loss of the robot now requires a recovery: while a controller commands it.
  virtual bool lossIsError() const { return controllerActive(); }
  /// Called before a recovery ends an error. The robot is then Idle.
  virtual void errorEnds() {}
  /// @}

  /// Whether these lists cancel the preparation under way.
  bool takesBack(const std::list<hardware_interface::ControllerInfo>& start_list,
                 const std::list<hardware_interface::ControllerInfo>& stop_list) const;

  /// Ends the motion under way and waits for its end. @returns false if it does not end in time
  bool endMotion();

  /// Marks that control() runs. Held while a run function may be called, because a switch replaces
  /// the run function. Create it before a call of controllerActive().
  class InControl {
   public:
    explicit InControl(FrankaHW& robot) : robot_(robot) { robot_.in_control_ = true; }
    ~InControl() { robot_.in_control_ = false; }
    InControl(const InControl&) = delete;
    InControl& operator=(const InControl&) = delete;

   private:
    FrankaHW& robot_;
  };

  CollisionConfig collision_config_{};

  hardware_interface::JointStateInterface joint_state_interface_{};
  FrankaStateInterface franka_state_interface_{};
  hardware_interface::PositionJointInterface position_joint_interface_{};
  hardware_interface::VelocityJointInterface velocity_joint_interface_{};
  hardware_interface::EffortJointInterface effort_joint_interface_{};
  FrankaPoseCartesianInterface franka_pose_cartesian_interface_{};
  FrankaVelocityCartesianInterface franka_velocity_cartesian_interface_{};
  FrankaModelInterface franka_model_interface_{};
#if __has_include(<hardware_interface/command_effect_interface.h>)
  hardware_interface::CommandEffectInterface command_effect_interface_{};
#endif

  joint_limits_interface::PositionJointSoftLimitsInterface position_joint_limit_interface_{};
  joint_limits_interface::VelocityJointSoftLimitsInterface velocity_joint_limit_interface_{};
  joint_limits_interface::EffortJointSoftLimitsInterface effort_joint_limit_interface_{};

  // The state from libfranka and the commands to libfranka.
  franka::RobotState robot_state_libfranka_{};
  franka::JointPositions position_joint_command_libfranka_;
  franka::JointVelocities velocity_joint_command_libfranka_;
  franka::Torques effort_joint_command_libfranka_;
  franka::CartesianPose pose_cartesian_command_libfranka_;
  franka::CartesianVelocities velocity_cartesian_command_libfranka_;

  // The state and the commands to which the handles refer.
  franka::RobotState robot_state_ros_{};
  franka::JointPositions position_joint_command_ros_;
  franka::JointVelocities velocity_joint_command_ros_;
  franka::Torques effort_joint_command_ros_;
  franka::CartesianPose pose_cartesian_command_ros_;
  franka::CartesianVelocities velocity_cartesian_command_ros_;

  // For classes whose control loop and controllers run in two threads; not used in this class.
  std::mutex libfranka_state_mutex_;
  std::mutex ros_state_mutex_;
  std::mutex libfranka_cmd_mutex_;
  std::mutex ros_cmd_mutex_;

  class ConnectionOwner;  // calls the functions of this class for armConnection()
  std::unique_ptr<ConnectionOwner> connection_owner_;
  std::unique_ptr<ArmConnection> connection_;
  RobotMutex& robot_mutex_;
  const std::unique_ptr<franka::Robot>& robot_;
  std::unique_ptr<franka_hw::ModelBase> model_{};

  std::array<std::string, 7> joint_names_;
  std::string arm_id_;
  std::string robot_ip_;
  urdf::Model urdf_model_;
  double joint_limit_warning_threshold_{0.1};

  franka::RealtimeConfig realtime_config_{franka::RealtimeConfig::kEnforce};

  std::atomic_bool initialized_{false};
  std::atomic_bool controller_active_{false};
  ControlMode current_control_mode_ = ControlMode::None;

  std::function<franka::ControllerMode()> get_internal_controller_;
  std::function<bool()> get_limit_rate_;
  std::function<double()> get_cutoff_frequency_;
  std::function<void(franka::Robot&, Callback)> run_function_;

  RobotClock clock_;  ///< the time for the controllers
  ResponseTimes response_times_;

 private:
  /// The settings of a motion; a change requires a new motion.
  struct RunSettings {
    ControlMode mode{ControlMode::None};
    bool limit_rate{true};
    double cutoff_frequency{0.0};
    franka::ControllerMode internal_controller{franka::ControllerMode::kJointImpedance};
    bool operator==(const RunSettings& other) const;
  };

  bool readLimits(size_t joint, joint_limits_interface::JointLimits& limits,
                  joint_limits_interface::SoftJointLimits& soft_limits) const;
  void connectInTime();
  void takePreparationBack();
  /// Continues a motion that was ended for a switch.
  void resumePrevious(bool was_active);

  /// The last preparation, and the settings before it.
  struct Preparation {
    std::vector<std::string> start, stop;  // controllers
    bool was_active{false};
    RunSettings settings_before;
  };

  RunSettings run_settings_;
  Preparation preparation_;  // used by the thread that calls prepareSwitch
  std::atomic_bool preparation_pending_{false};
  std::atomic_bool motion_goes_on_{false};
  std::atomic_bool in_control_{false};
  double connect_timeout_{0.0};  // [s] for a robot that is still starting
  std::atomic<franka::RobotMode> robot_mode_{franka::RobotMode::kOther};
  std::unique_ptr<const std::array<double, 16>> described_F_T_NE_;  // by robot_description
  std::string reported_mismatch_;  // of F_T_NE; written by openRobot() only

  std::unique_ptr<CommandPermission> command_permission_;
  std::unique_ptr<JointLimitMonitor> joint_limit_monitor_;  // after init()
};

}  // namespace franka_hw

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <control_toolbox/pid.h>
#include <franka_sim/robot/plant.h>
#include <franka_sim_mujoco/robot_hw_sim.h>
#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/joint_effort_limit_interface.h>
#include <hardware_interface/joint_state_interface.h>
#include <joint_limits_interface/joint_limits_interface.h>

#include <list>
#include <memory>
#include <optional>
#include <set>
#include <string>

namespace franka_sim_mujoco {

/// Joints of other devices than Franka arms and hands (a lift, a mobile base, another gripper),
/// driven like gazebo_ros_control's default hardware: the interfaces that a joint's transmission
/// declares; commands kept within the URDF's limits; and, while a controller commands
///   efforts:     the effort acts [Nm|N];
///   positions:   the joint moves to the position and holds it, or a PID does;
///   velocities:  the joint moves at the velocity, or a PID does.
/// A PID is used if the parameters `<namespace>/gazebo_ros_control/pid_gains/<joint>/{p,i,d,...}`
/// are set. With and without a PID the effort is limited to the URDF's (none, or 0: it is not
/// limited), and for commanded positions without a PID to that of a controller, too
/// (JointEffortLimitInterface). Without a controller, joints with position or velocity commands
/// hold their position, and joints with only effort commands move freely.
///
/// Set up by any thread; read, write and doSwitch are called by the stepping thread and do not
/// throw. Real-time safe. Exceptions: the constructor, `add` and `registerHandles`; PIDs also
/// publish their state if configured.
class DeviceJoints {
 public:
  /// @param node of the robot's namespace, where gains are looked up
  DeviceJoints(const ros::NodeHandle& node, RobotHandle robot);

  /// Adds the joint of a SimpleTransmission; a mimic joint only has a state.
  /// @throws std::invalid_argument with a sentence: unknown joint, or bad gains
  void add(const transmission_interface::TransmissionInfo& transmission, const urdf::Model& model);
  bool empty() const noexcept { return joints_.empty(); }
  std::set<std::string> names() const;

  /// Call after the last `add`: registers the handles. @throws std::runtime_error with a sentence
  /// if a joint does not move
  void registerHandles(hardware_interface::JointStateInterface& states,
                       hardware_interface::EffortJointInterface& efforts,
                       hardware_interface::PositionJointInterface& positions,
                       hardware_interface::VelocityJointInterface& velocities,
                       hardware_interface::JointEffortLimitInterface& effort_limits);

  void read() noexcept;
  void write(const ros::Duration& period);
  void doSwitch(const std::list<hardware_interface::ControllerInfo>& start_list,
                const std::list<hardware_interface::ControllerInfo>& stop_list) noexcept;
  /// Call if joints may have been teleported: resets the commands.
  void worldWasReset() noexcept;

 private:
  enum class Method { kNone, kEffort, kPosition, kVelocity };

  struct Joint {
    std::string name;
    urdf::JointConstSharedPtr described;
    franka_sim::JointDrive* drive{nullptr};
    franka_sim::JointMeasurement measured;
    struct Commands {
      double effort{0}, position{0}, velocity{0};
    };
    Commands commands;  ///< written by the controllers, once a period
    Commands applied;   ///< those of this tick, within the limits
    bool takes_effort{false}, takes_position{false}, takes_velocity{false};
    std::optional<control_toolbox::Pid> pid;
    Method method{Method::kNone};
    double followed{0};    ///< position that a commanded velocity has reached
    double max_effort{0};  ///< a controller's, for positions; 0: none
  };

  void readInterfaces(const transmission_interface::JointInfo& info, Joint* joint) const;
  void readGains(Joint* joint) const;
  void registerLimits(Joint& joint, const hardware_interface::JointStateHandle& state,
                      Method method);
  void choose(Joint* joint, Method method) noexcept;
  void write(Joint* joint, const ros::Duration& period);
  static double positionError(const Joint& joint) noexcept;
  /// The URDF's, and a controller's maximum effort (0: none).
  static franka_sim::DriveLimits limitsOf(const Joint& joint, double max_effort = 0.0) noexcept;
  static double limited(const Joint& joint, double effort) noexcept;

  ros::NodeHandle node_;
  RobotHandle robot_;
  std::list<Joint> joints_;  ///< with stable addresses
  joint_limits_interface::EffortJointSaturationInterface effort_limits_;
  joint_limits_interface::PositionJointSaturationInterface position_limits_;
  joint_limits_interface::VelocityJointSaturationInterface velocity_limits_;
};

}  // namespace franka_sim_mujoco

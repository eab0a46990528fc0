// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_hw/franka_cartesian_command_interface.h>
#include <franka_hw/franka_model_interface.h>
#include <franka_hw/franka_state_interface.h>
#include <franka_hw/model_kdl.h>
#include <franka_sim_mujoco/arm_services.h>
#include <franka_sim_mujoco/device_joints.h>
#include <franka_sim_mujoco/robot_hw_sim.h>
#include <franka_sim_mujoco/sim_arm.h>
#include <hardware_interface/command_effect_interface.h>
#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/joint_state_interface.h>
#include <joint_limits_interface/joint_limits_interface.h>
#include <realtime_tools/realtime_publisher.h>
#include <ros/wall_timer.h>
#include <std_msgs/Bool.h>

#include <array>
#include <cstddef>
#include <list>
#include <memory>
#include <string>
#include <vector>

namespace franka_sim_mujoco {

/// A simulated Panda or FR3 as ros_control hardware, with the eight interfaces of franka_hw: joint
/// states, joint positions, velocities and efforts, franka state, franka model, Cartesian pose and
/// Cartesian velocity. The transmissions of the URDF declare the interfaces of the joints; a robot
/// with the franka state interface also has the Cartesian interfaces. All commands and states pass
/// through the arm's ControlUnit. The hand's fingers, if there are any, are two more effort joints.
/// Other joints of the URDF, of a lift or a mobile base, are controlled separately from the arm
/// (DeviceJoints).
///
/// Position and velocity handles show desired values (q_d, dq_d), effort and state handles measured
/// ones. Claims may be combined as on the robot (resource_helpers.h).
///
/// Threads and real-time safety: RobotHWSim. Parameters, services and topics: docs of the package.
class FrankaHWSim : public RobotHWSim {
 public:
  FrankaHWSim();
  ~FrankaHWSim() override;

  bool initSim(const std::string& robot_namespace, ros::NodeHandle model_nh, RobotHandle robot,
               const urdf::Model* urdf_model,
               std::vector<transmission_interface::TransmissionInfo> transmissions) override;
  std::string failure() const override { return failure_; }
  std::string condition() const override;
  void readSim(ros::Time time, ros::Duration period) override;
  void writeSim(ros::Time time, ros::Duration period) override;
  void eStopActive(bool active) override;
  void worldWasReset() override;

  /// The claim rules of franka_hw; refusals are logged.
  bool checkForConflict(
      const std::list<hardware_interface::ControllerInfo>& controllers) const override;
  /// Refuses controllers whose claims this hardware does not support, and Cartesian motions where
  /// none can start; the reason is logged.
  bool prepareSwitch(const std::list<hardware_interface::ControllerInfo>& start_list,
                     const std::list<hardware_interface::ControllerInfo>& stop_list) override;
  void doSwitch(const std::list<hardware_interface::ControllerInfo>& start_list,
                const std::list<hardware_interface::ControllerInfo>& stop_list) override;
  /// Of the last switch, if it concerned the arm: ongoing while the arm comes to rest for the next
  /// motion; an error if it cannot start.
  SwitchState switchResult() const override;
  SwitchState switchResult(const hardware_interface::ControllerInfo& controller) const override;

 private:
  static constexpr std::size_t kArmJoints = 7;
  static constexpr std::size_t kJoints = 9;  ///< the arm's and two fingers

  struct Joint {
    std::string name;
    double position{0}, velocity{0}, effort{0}, command{0};
    bool has_state{false}, has_effort{false}, has_position{false}, has_velocity{false};
  };

  void start(const ros::NodeHandle& node, const RobotHandle& robot, const urdf::Model& model,
             const std::vector<transmission_interface::TransmissionInfo>& transmissions);
  void nameJoints(const urdf::Model& model, bool has_hand);
  void addTransmission(const transmission_interface::TransmissionInfo& transmission,
                       const urdf::Model& model);
  void addJoint(const transmission_interface::TransmissionInfo& transmission,
                const urdf::Model& model);
  void addState(const transmission_interface::TransmissionInfo& transmission,
                const urdf::Model& model);
  void addModel(const transmission_interface::TransmissionInfo& transmission,
                const urdf::Model& model);
  void checkComplete() const;
  void registerAll();
  void registerArmJoint(std::size_t joint);
  void registerCartesian();
  void registerLimits(const urdf::Model& model);
  void holdJointLimits(const ros::Duration& period);
  /// As franka_hw::ArmConnection::reasonWithoutEffect. Thread-safe.
  std::string reasonWithoutEffect() const;
  bool refusesAtSingularPose(franka_hw::ControlMode starts, franka_hw::ControlMode stops) const;
  Joint* findJoint(const std::string& name);
  void publishInitialized(bool initialized);
  void report();

  std::string failure_;
  std::string arm_id_;
  BetweenTicks between_ticks_;
  double singularity_threshold_{-1.0};
  std::array<Joint, kJoints> joints_;
  franka_sim::HandPlant* hand_{nullptr};
  std::unique_ptr<SimArm> arm_;
  std::unique_ptr<DeviceJoints> devices_;  ///< all other joints with transmissions
  std::unique_ptr<franka_hw::ModelKDL> model_;
  hardware_interface::JointStateInterface joint_states_;
  hardware_interface::EffortJointInterface efforts_;
  hardware_interface::PositionJointInterface positions_;
  hardware_interface::VelocityJointInterface velocities_;
  hardware_interface::JointEffortLimitInterface effort_limits_;  ///< of devices
  hardware_interface::CommandEffectInterface command_effects_;   ///< of the arm
  joint_limits_interface::PositionJointSoftLimitsInterface position_limits_;
  joint_limits_interface::VelocityJointSoftLimitsInterface velocity_limits_;
  franka_hw::FrankaStateInterface franka_states_;
  franka_hw::FrankaModelInterface franka_models_;
  franka_hw::FrankaPoseCartesianInterface poses_;
  franka_hw::FrankaVelocityCartesianInterface twists_;
  std::unique_ptr<ArmServices> services_;
  std::unique_ptr<realtime_tools::RealtimePublisher<std_msgs::Bool>> initialized_;
  bool initialized_published_{false};
  bool switch_concerns_arm_{false};  ///< the last one
  ros::WallTimer reporter_;
  std::uint64_t reported_commands_{0}, reported_aborts_{0};
};

}  // namespace franka_sim_mujoco

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_manager/controller_manager.h>
#include <franka_hw/thrown_report.h>
#include <franka_sim/physics/world.h>
#include <franka_sim_mujoco/robot_hw_sim.h>
#include <ros/node_handle.h>
#include <urdf/model.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <pluginlib/class_loader.hpp>
#include <set>
#include <string>
#include <vector>

#include "served_robot.h"

namespace franka_sim_mujoco {

class JointStatePublisher;
class TransformPublisher;

/// Request to add a robot to the world.
struct SpawnOrder {
  std::string name;
  std::string urdf;
  std::string robot_namespace;
  franka_sim::Pose pose;
  std::map<std::string, double> initial_positions;
};

/// A spawn request, read and checked: everything that needs neither the world nor the stepping
/// thread.
struct RobotPlan {
  franka_sim::RobotDescription description;
  std::string robot_namespace;
  /// Not empty. In a robot without arms the first has the arm_id that was looked for, and no type.
  std::vector<SimulatedArm> arms;
  std::string hardware_type;  ///< plugin of type RobotHWSim; empty for a robot without hardware
  std::string fci_ip;         ///< address if it is served by a ServedRobot instead; else empty
  std::uint16_t control_port{1340};  ///< of its control interface if it is served; 0: none
  /// Whether Desk guards it, so that its control interface serves this process' user only:
  /// parameter `desk`.
  bool has_desk{false};
  /// Whether it starts with Desk's rules, brakes closed and FCI off: parameter `fci_start` is
  /// `locked`.
  bool locked{false};
  int control_ticks{1};  ///< controlPeriod in ticks of 1 ms
  /// Names of the controllers that its launch file starts: parameter `awaited_controllers` in its
  /// namespace, separated by blanks.
  std::vector<std::string> awaited_controllers;
  /// Rate of its `joint_states` [Hz of simulated time]: parameter `joint_state_rate`; empty: not
  /// published, a separate node may do so.
  std::optional<double> joint_state_rate;
  /// Whether it publishes the transforms of its links: parameter `publish_transforms`.
  bool publish_transforms{false};
  urdf::Model urdf;
  std::vector<transmission_interface::TransmissionInfo> transmissions;
};

/// Reads the URDF, its <gazebo> plugin element and transmissions, the arms' physics parameters.
/// Thread-safe. @throws std::runtime_error with a sentence
RobotPlan planRobot(const SpawnOrder& order);

using HardwareLoader = pluginlib::ClassLoader<RobotHWSim>;

/// Durations of the parts of a tick, summed during a benchmark [ns].
struct TickTimes {
  std::int64_t read{0}, update{0}, write{0};
};

/// A robot in the world with its hardware plugin and controller manager, or served over the FCI, or
/// without both. Created and destroyed by the threads of requests, because it talks to the ROS
/// master; in between used by the stepping thread.
class RobotInstance {
 public:
  /// Starts the hardware.
  /// @param between_ticks the robot is in the world within that work
  /// @throws std::runtime_error with a sentence
  RobotInstance(const RobotPlan& plan, franka_sim::World& world, HardwareLoader& loader,
                BetweenTicks between_ticks, const OperatorAccess& access);
  ~RobotInstance();
  RobotInstance(const RobotInstance&) = delete;
  RobotInstance& operator=(const RobotInstance&) = delete;

  const std::string& name() const noexcept { return name_; }
  /// Whether one of these joints belongs to the robot.
  bool hasAnyOf(const std::vector<std::string>& joints) const;

  /// Null unless it is served.
  ServedRobot* served() noexcept { return served_.get(); }
  /// Its Franka arms, for programs that draw the world.
  const std::vector<franka_sim::SceneRobot>& inScene() const noexcept { return in_scene_; }

  /// One line for the user that describes its mode and errors; empty if it has neither.
  std::string condition() const;

  /// Whether controllers that its launch file starts do not run yet: for kMaxStartTicks ticks at
  /// most, then with a warning.
  bool isStarting() const noexcept { return start_ticks_left_ > 0; }
  static constexpr int kMaxStartTicks = 30000;  ///< [ticks], the spawner's own timeout

  /// Read, controllers, write; does nothing for a served robot. 1 kHz loop. @param times durations
  /// are added to it, unless null
  void tick(const ros::Time& time, TickTimes* times);

  /// Publishes the joint states of a world that stands still.
  void publishNow(const ros::Time& time);
  /// Waits, for a second at most, until the transforms of published joint states have been sent.
  void waitForTransforms(const ros::Time& time);

  /// @throws std::runtime_error with a sentence while a client of the FCI moves the robot: its
  /// motion would jump.
  void requireRest() const;
  /// The world has stopped: aborts motions of a served robot's clients.
  void halt();
  /// The world was reset or restored; controllers are restarted in the next tick.
  void worldWasReset();
  /// The same for the arms that have one of these joints, and the controllers that claim something
  /// of them.
  void jointsWereSet(const std::vector<std::string>& joints);

 private:
  void start(const RobotPlan& plan, franka_sim::World& world, HardwareLoader& loader,
             BetweenTicks between_ticks, const OperatorAccess& access);
  void serve(const RobotPlan& plan, const RobotHandle& robot, const OperatorAccess& access);
  void startHardware(const RobotPlan& plan, const RobotHandle& robot, HardwareLoader& loader);
  void loadHardware(const std::string& type, std::size_t arms, HardwareLoader& loader);
  void limitTransformLag(const ros::Time& time);
  void reviewStart();
  void updateControllers(const ros::Time& time, const ros::Duration& period);

  std::string name_;
  std::vector<franka_sim::SceneRobot> in_scene_;
  std::set<std::string> joints_;
  int control_ticks_;
  int ticks_to_control_{0};
  controller_manager::ControllerManager::ControllerFilter restarts_;  ///< in the next update
  int start_ticks_left_{0};
  std::vector<std::string> awaited_controllers_;
  franka_hw::ThrownReport thrown_report_;
  std::unique_ptr<ServedRobot> served_;
  std::shared_ptr<RobotHWSim> hardware_;  ///< destroyed after the manager that uses it
  std::unique_ptr<controller_manager::ControllerManager> manager_;
  std::unique_ptr<JointStatePublisher> joint_states_;
  std::unique_ptr<TransformPublisher> transforms_;
  ros::Duration max_transform_lag_;  ///< behind the joint states
  ros::Time first_joint_states_;     ///< zero: none yet
};

}  // namespace franka_sim_mujoco

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_interface/multi_interface_controller.h>
#include <franka_hw/control_mode.h>
#include <franka_hw/franka_cartesian_command_interface.h>
#include <franka_hw/franka_model_interface.h>
#include <franka_hw/franka_state_interface.h>
#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/robot_hw.h>
#include <ros/node_handle.h>
#include <ros/time.h>

#include <memory>

namespace franka_example_controllers {

class ArmCommander;
class ScriptRunner;
class SelfStop;

/// Runs a Python class as a controller: `starting(state, model)`, then in every cycle
/// `update(state, model, period) -> command`, and optionally `stopping()`. docs/write_your_own.md
/// describes arguments and results of scripts.
///
/// Parameters in the controller's namespace: `script` (path of a file) or `module` (importable
/// name), `class`, `arm_id`, `joint_names` (seven), `command` (a list of joint_position,
/// joint_velocity, cartesian_pose, cartesian_velocity, effort, in combinations that franka_hw
/// allows); `max_update_time` and `max_starting_time` [s] that the loop waits for the script,
/// `load_timeout` [s], `fallback_controllers` to start if the script fails. The class's constructor
/// gets all of them as a dict if it has an argument.
///
/// A script that raises, returns no finite command of the right shape, or is late is not called
/// again. The controller brings the arm to rest by itself (motions along a smooth curve, torques as
/// damping), reports the traceback, and has itself stopped by its controller manager. Other
/// controllers continue. After a restart, it begins with the script's `starting`.
///
/// The script runs in its own thread, with the loop's priority; the loop waits for it, but
/// allocates nothing and never takes Python's lock. In simulated time both wait without sleep
/// (decision 53). Python itself allocates and locks: the script's time is part of the cycle.
class PythonController
    : public controller_interface::MultiInterfaceController<
          franka_hw::FrankaModelInterface, franka_hw::FrankaStateInterface,
          hardware_interface::EffortJointInterface, hardware_interface::PositionJointInterface,
          hardware_interface::VelocityJointInterface, franka_hw::FrankaPoseCartesianInterface,
          franka_hw::FrankaVelocityCartesianInterface> {
 public:
  PythonController();
  ~PythonController() override;

  /// @returns false, after one sentence in the log, if a parameter is missing or wrong, the robot
  /// lacks a handle, or the script cannot be loaded
  bool init(hardware_interface::RobotHW* robot_hw, ros::NodeHandle& root_nh,
            ros::NodeHandle& controller_nh) override;
  void starting(const ros::Time& time) override;
  void update(const ros::Time& time, const ros::Duration& period) override;
  void stopping(const ros::Time& time) override;

 private:
  bool loadScript(ros::NodeHandle& controller_nh, const franka_hw::FrankaModelHandle& model);
  bool readTimes(ros::NodeHandle& controller_nh);
  void fail();

  double max_update_time_{0.0};    // [s]
  double max_starting_time_{0.0};  // [s]
  double load_timeout_{30.0};      // [s]
  franka_hw::ControlMode mode_{franka_hw::ControlMode::None};

  std::unique_ptr<franka_hw::FrankaStateHandle> state_handle_;
  std::unique_ptr<ArmCommander> commander_;
  std::unique_ptr<ScriptRunner> runner_;
  std::unique_ptr<SelfStop> self_stop_;  // destroyed first, because it reports the runner's result

  enum class Phase { kRunning, kComingToRest, kResting };
  Phase phase_{Phase::kResting};
};

}  // namespace franka_example_controllers

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Several arms under one controller manager. Each arm has its own thread for its robot.
#include <controller_manager/controller_manager.h>
#include <franka/control_tools.h>
#include <franka_hw/franka_combined_hw.h>
#include <franka_hw/robot_clock.h>
#include <franka_hw/thrown_report.h>
#include <franka_hw/usage.h>
#include <ros/console.h>
#include <ros/init.h>
#include <ros/rate.h>
#include <ros/spinner.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "commanding_controllers.h"
#include "end_in_time.h"
#include "flag.h"
#include "loop_health.h"
#include "robot_health.h"

namespace {

constexpr char kUsage[] =
    "usage: rosrun franka_control franka_combined_control_node [NAME:=VALUE]...\n\n"
    "Drives several arms under one controller manager, with torques.\n"
    "Parameters in its own namespace: robot_hardware, robot_description and a namespace for each\n"
    "arm; docs/franka_control.md lists them. franka_combined_control.launch sets them all:\n"
    "  roslaunch franka_control franka_combined_control.launch \\\n"
    "    robot_ips:=\"{panda_1/robot_ip: ADDRESS, panda_2/robot_ip: ADDRESS}\" (or sim:=true)";

/// The status of one arm on /diagnostics.
class ArmHealth {
 public:
  ArmHealth(const ros::NodeHandle& nh, franka_hw::FrankaCombinableHW& arm)
      : state_(arm.get<franka_hw::FrankaStateInterface>()
                   ->getHandle(arm.getArmID() + "_robot")
                   .getRobotState()),
        health_(nh, arm.getArmID(), arm.getArmID(), arm.armConnection(), arm.responseTimes()) {}

  /// Called once per cycle, after read().
  void update() { health_.state(state_); }

 private:
  const franka::RobotState& state_;
  franka_control::RobotHealth health_;
};

/// Whether this thread needs real-time priority: unless realtime_config is ignore, and if the
/// thread of at least one arm may need it.
bool enforcesRealtime(const ros::NodeHandle& nh, const franka_hw::FrankaCombinedHW& robots) {
  const std::vector<franka_hw::FrankaCombinableHW*>& arms = robots.arms();
  return nh.param<std::string>("realtime_config", "enforce") != "ignore" &&
         (arms.empty() || std::any_of(arms.begin(), arms.end(),
                                      [](const auto* arm) { return arm->enforcesRealtime(); }));
}

/// Sets real-time priority for this thread. @returns false, after logging the reason, if it is
/// enforced but not available
bool raisePriority(bool enforce) {
  std::string error;
  if (franka::setCurrentThreadToHighestSchedulerPriority(&error)) {
    return true;
  }
  if (!enforce) {
    ROS_WARN_STREAM("franka_combined_control_node: going on without real-time priority. " << error);
    return true;
  }
  ROS_ERROR_STREAM("franka_combined_control_node: no real-time priority. "
                   << error
                   << " Give the user the right to it (ulimit -r), or start with "
                      "realtime_config:=ignore.");
  return false;
}

/// The milliseconds of this computer's clock since a moment in the past. Several robots have no
/// common clock.
franka::Duration ownMilliseconds() {
  const auto since = std::chrono::steady_clock::now().time_since_epoch();
  return franka::Duration(std::chrono::duration_cast<std::chrono::milliseconds>(since).count());
}

/// One cycle of the controllers. An exception stops all arms, as an error of the arms does.
void updateControllers(controller_manager::ControllerManager& controllers,
                       franka_hw::FrankaCombinedHW& robots, franka_hw::ThrownReport& thrown,
                       const ros::Time& time, const ros::Duration& period) {
  const auto stop = [&](const char* what) {
    thrown.report("franka_combined_control_node", what,
                  "No arm is moved until the controller has been stopped "
                  "(controller_manager/switch_controller) and error_recovery called.");
    robots.triggerError();
  };
  try {
    controllers.update(time, period, robots.controllerNeedsReset());
  } catch (const std::exception& error) {
    stop(error.what());
  } catch (...) {
    stop("a value that is not a std::exception.");
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (franka_hw::printsUsage(argc, argv, kUsage)) {
    return 0;
  }
  ros::init(argc, argv, "franka_combined_control_node");
  franka_control::EndInTime end_in_time("franka_combined_control_node");
  ros::AsyncSpinner spinner(4);
  spinner.start();

  ros::NodeHandle nh("~");
  bool restarts_controllers = true;
  franka_hw::FrankaCombinedHW robots;
  if (!end_in_time.readTimeout(nh) ||
      !franka_control::readFlag("restart_controllers_after_recovery", nh, restarts_controllers) ||
      !robots.init(nh, nh)) {
    ROS_ERROR("franka_combined_control_node: the robots could not be set up (see above).");
    return 1;
  }
  if (!raisePriority(enforcesRealtime(nh, robots))) {
    return 1;
  }
  controller_manager::ControllerManager controllers(&robots, nh);
  if (!restarts_controllers) {
    robots.beforeRecovery([nh] { franka_control::stopCommandingControllers(nh); });
  }
  std::vector<std::unique_ptr<ArmHealth>> arms;
  for (franka_hw::FrankaCombinableHW* const arm : robots.arms()) {
    arms.push_back(std::make_unique<ArmHealth>(nh, *arm));
  }
  franka_control::LoopHealth loop_health(nh, "all arms");

  const ros::Duration period(0.001);
  franka_hw::RobotClock clock;
  franka_hw::ThrownReport thrown;
  ros::Rate rate(period);
  while (ros::ok()) {
    rate.sleep();
    const ros::Time now = clock.update(ownMilliseconds(), ros::Time::now());
    robots.read(now, period);
    for (const auto& arm : arms) {
      arm->update();
    }
    loop_health.cycleBegins();
    updateControllers(controllers, robots, thrown, now, period);
    loop_health.cycleEnds();
    robots.write(now, period);
  }
  return 0;
}

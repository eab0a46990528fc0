// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_example_controllers/pi.h>
#include <franka_example_controllers/robot_handles.h>

#include <cmath>
#include <iomanip>

namespace franka_example_controllers {

namespace {

constexpr std::array<double, 7> kStartPose{
    {0.0, -kPi / 4.0, 0.0, -3.0 * kPi / 4.0, 0.0, kPi / 2.0, kPi / 4.0}};  // [rad]
constexpr double kTolerance = 0.1;                                         // [rad]

}  // namespace

bool isAtStartPose(const char* controller, const std::array<double, 7>& q) {
  for (std::size_t i = 0; i < q.size(); ++i) {
    if (std::abs(q[i] - kStartPose[i]) > kTolerance) {
      ROS_ERROR_STREAM(
          std::fixed << std::setprecision(3) << controller << ": joint " << i + 1 << " stands at "
                     << q[i] << " rad, and this motion begins at " << kStartPose[i]
                     << ". Run `roslaunch franka_example_controllers move_to_start.launch "
                        "robot_ip:=<robot-ip> load_gripper:=<has-attached-gripper>` first.");
      return false;
    }
  }
  return true;
}

}  // namespace franka_example_controllers

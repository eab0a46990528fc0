// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// A FrankaHW and its environment: a robot on a socket, parameters in a namespace of their own,
// controllers that follow the tests' instructions, and the loop that runs them.

#include <controller_interface/controller_base.h>
#include <controller_manager/controller_loader_interface.h>
#include <controller_manager/controller_manager.h>
#include <franka_hw/franka_hw.h>
#include <ros/ros.h>
#include <ros_test/eventually.h>
#include <ros_test/log_catcher.h>

#include <array>
#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "fake_robot.h"

namespace franka_hw_test {

using franka_core::fci::Command;
using ros_test::eventually;
using ros_test::LogCatcher;

/// The name under which Loop loads the controller with these claims.
std::string nameOf(std::string claims);

/// The URDF of a robot ("fr3" or "panda") whose joints and links have this arm_id.
std::string urdfOf(const std::string& arm_id, const std::string& robot = "fr3");

/// A robot that follows its commands at once, and the parameters to find it.
class FakeArm {
 public:
  /// @param nh where `robot_description` is written; the other parameters are written below
  /// `arm_id`
  explicit FakeArm(const std::string& arm_id = "fr3", const ros::NodeHandle& nh = freshNamespace());

  static ros::NodeHandle freshNamespace();
  /// The names of the joints.
  static std::vector<std::string> joints(const std::string& arm_id);

  const std::string arm_id;
  ros::NodeHandle nh;        ///< of the description and the controllers
  ros::NodeHandle robot_nh;  ///< of the robot
  franka_test::FakeRobot robot{10};
};

/// A controller that claims the interfaces in its parameter `claims` (a list of JP, JV, JT, CP, CV
/// and looks, on the first `joints` joints). It holds still unless the test sets a command or a
/// fault.
class TestController : public controller_interface::ControllerBase {
 public:
  enum class Fault { kNone, kThrow, kNan, kSleep };

  void starting(const ros::Time& time) override;
  void update(const ros::Time& time, const ros::Duration& period) override;
  void stopping(const ros::Time& /*time*/) override { ++stops; }

  std::atomic<int> starts{0}, updates{0}, stops{0};
  std::atomic<int> updates_since_start{0};
  std::atomic<double> torque{0.0};  ///< commanded to every joint [Nm]
  std::atomic<double> speed{0.0};   ///< of joints [rad/s] or along z [m/s]
  std::atomic<Fault> fault{Fault::kNone};

 protected:
  bool initRequest(hardware_interface::RobotHW* robot_hw, ros::NodeHandle& root_nh,
                   ros::NodeHandle& controller_nh, ClaimedResources& claimed_resources) override;

 private:
  template <typename Interface>
  void claim(hardware_interface::RobotHW* robot_hw, const std::vector<std::string>& names,
             std::vector<typename Interface::ResourceHandleType>& handles,
             ClaimedResources& claimed);

  std::vector<hardware_interface::JointHandle> torques_, positions_, velocities_;
  std::vector<franka_hw::FrankaCartesianPoseHandle> poses_;
  std::vector<franka_hw::FrankaCartesianVelocityHandle> twists_;
  std::array<double, 7> q_{};
  std::array<double, 16> pose_{};
};

/// A controller manager and the loop that runs it with a FrankaHW, as franka_control_node does.
class Loop {
 public:
  /// The robot must be initialized. Errors of motions are stored and end only the motion.
  /// @param considerate whether the loop yields between two states, so that others can lock the
  /// robot
  Loop(franka_hw::FrankaHW& robot, const FakeArm& arm, bool considerate = true);
  ~Loop();

  /// The controller with these claims ("JT", "JT+CP", ...), loaded at the first call; "JT:2" is
  /// another controller with the same claims.
  TestController& controller(const std::string& claims);
  bool switchTo(const std::vector<std::string>& start, const std::vector<std::string>& stop);
  controller_manager::ControllerManager& manager() { return manager_; }
  /// The information about a loaded controller for the robot.
  hardware_interface::ControllerInfo info(const std::string& claims) const;

  /// Creates TestController, the type test/Test.
  static controller_manager::ControllerLoaderInterfaceSharedPtr makeLoader();
  /// Writes the parameters of a controller with these claims. @returns its name
  static std::string describe(const ros::NodeHandle& nh, const std::string& arm_id,
                              const std::string& claims);

  /// The texts of the errors that ended motions, and their number.
  std::vector<std::string> errors() const;
  void forgetErrors();

 private:
  class Loader;
  void run();
  void cycle();

  franka_hw::FrankaHW& robot_;
  ros::NodeHandle nh_;
  std::string arm_id_;
  const bool considerate_;
  std::shared_ptr<Loader> loader_;
  controller_manager::ControllerManager manager_;
  std::map<std::string, TestController*> controllers_;
  mutable std::mutex mutex_;
  std::vector<std::string> errors_;
  std::atomic_bool has_error_{false};
  std::atomic_bool ending_{false};
  std::thread thread_;
};

}  // namespace franka_hw_test

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_interface/controller_base.h>
#include <controller_manager/internal/runs_through.h>
#include <hardware_interface/controller_info.h>
#include <hardware_interface/robot_hw.h>
#include <ros/time.h>

#include <atomic>
#include <list>
#include <string>
#include <vector>

namespace controller_manager {
namespace internal {

/// One switch: filled completely outside the loop, then carried out by the loop over one or more
/// cycles. The phase defines its owner.
struct SwitchRequest {
  enum class Phase {
    kPosted,     ///< waits for the loop; may be withdrawn
    kTaken,      ///< belongs to the loop
    kWithdrawn,  ///< the loop must not start it
    kDone        ///< the loop will never access it again
  };

  enum class Outcome { kPending, kStarted, kRobotError, kTimeout, kCanceled, kThrew };

  struct Start {
    controller_interface::ControllerBaseSharedPtr controller;
    hardware_interface::ControllerInfo info;
    Outcome outcome{Outcome::kPending};
    const char* thrower{nullptr};  ///< the callback that threw, if one did
    ExceptionText thrown{};        ///< what it threw
  };

  struct Stop {
    controller_interface::ControllerBaseSharedPtr controller;
    std::string name;
  };

  std::vector<Start> starts;  ///< a restarted controller is in both
  std::vector<Stop> stops;
  std::list<hardware_interface::ControllerInfo> start_list;  ///< for the robot, without restarts
  std::list<hardware_interface::ControllerInfo> stop_list;
  bool start_asap{false};
  bool guarded{false};  ///< a throwing controller is aborted, and the switch continues
  double timeout{0.0};  ///< [s] on the loop's clock, from its first cycle on; 0: none

  bool broken{false};         ///< an exception ended the switch
  ExceptionText broken_by{};  ///< that exception

  std::atomic<Phase> phase{Phase::kPosted};
  std::atomic<bool> canceled{false};  ///< its caller no longer waits: abort

  /// Whether this switch starts or stops a controller.
  bool involves(const std::string& name) const;

  /// One cycle of the switch, in the loop: stops controllers in the first call, then starts those
  /// for which the robot is ready. Real-time safe. The robot's doSwitch and switchResult and the
  /// controllers' callbacks must neither allocate nor lock.
  /// @returns true when the switch is complete.
  /// Throws exceptions of the robot, and of controllers unless guarded. Nothing remains to be done
  /// then: controllers not yet started or stopped have been aborted, without another callback.
  bool advance(hardware_interface::RobotHW& robot, const ros::Time& time);

 private:
  bool proceed(hardware_interface::RobotHW& robot, const ros::Time& time);
  bool begin(hardware_interface::RobotHW& robot, const ros::Time& time);
  bool startTogether(hardware_interface::RobotHW& robot, const ros::Time& time);
  bool startEach(hardware_interface::RobotHW& robot, const ros::Time& time);
  void start(Start& start, const ros::Time& time) const;
  void wait(Start& start, const ros::Time& time) const;
  void giveUp(Start& start, Outcome reason, const ros::Time& time) const;
  void stop(const Stop& stop, const ros::Time& time) const;
  void abandon();
  /// Makes a request of the controller. @returns false if it threw; it is then aborted.
  template <class Call>
  bool runs(Start& start, const char* callback, Call call) const;
  /// Why the start is aborted in this cycle; kPending if it is not.
  Outcome reasonToGiveUp(hardware_interface::RobotHW::SwitchState state,
                         const ros::Time& time) const;

  ros::Time begin_;
  bool begun_{false};  ///< the robot has switched, and controllers to stop are stopped
};

}  // namespace internal
}  // namespace controller_manager

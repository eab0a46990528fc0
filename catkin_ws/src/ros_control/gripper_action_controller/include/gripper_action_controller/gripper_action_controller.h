// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <actionlib/server/action_server.h>
#include <control_msgs/GripperCommandAction.h>
#include <controller_interface/controller.h>
#include <gripper_action_controller/hardware_interface_adapter.h>
#include <hardware_interface/joint_effort_limit_interface.h>
#include <joint_trajectory_controller/internal/command_exchange.h>
#include <joint_trajectory_controller/internal/realtime_goal.h>
#include <realtime_tools/latest_value.h>
#include <realtime_tools/own_callbacks.h>
#include <realtime_tools/realtime_server_goal_handle.h>
#include <ros/node_handle.h>

#include <atomic>
#include <boost/shared_ptr.hpp>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

namespace gripper_action_controller {

/// Moves a gripper of one joint to positions given as goals of the action `gripper_cmd`.
///
/// A goal is reached within `goal_tolerance` of its position, and aborted as stalled if the joint
/// is slower than `stall_velocity_threshold` for `stall_timeout`. Parameters (namespace of the
/// controller): `joint` (required), `action_monitor_rate` 20 [Hz], `goal_tolerance` 0.01 [m or
/// rad], `max_effort` 0 [N or Nm], `stall_velocity_threshold` 0.001 [m/s or rad/s], `stall_timeout`
/// 1 [s].
///
/// `max_effort`, of a goal or of the parameters, limits the effort. Position commands have no place
/// for it: hardware with a JointEffortLimitInterface heeds it, where 0 means without a limit; other
/// hardware does not.
///
/// The control loop calls update(), starting(), stopping(), waiting() and aborting(): they neither
/// allocate nor lock. All others run in callbacks under one mutex that the loop never takes.
/// @tparam HardwareInterface one with a HardwareInterfaceAdapter
template <class HardwareInterface>
class GripperActionController : public controller_interface::Controller<HardwareInterface> {
 public:
  /// Target of a goal or of starting().
  struct Commands {
    double position_{0.0};    ///< [m] or [rad]
    double max_effort_{0.0};  ///< [N] or [Nm]
  };

  GripperActionController() = default;
  ~GripperActionController() override;

  /// @returns false, after logging the reason, if a parameter or the joint is missing or wrong.
  bool init(HardwareInterface* hw, ros::NodeHandle& root_nh,
            ros::NodeHandle& controller_nh) override;
  /// Holds the present position.
  void starting(const ros::Time& time) override;
  /// Stops; a running goal is canceled shortly afterwards.
  void stopping(const ros::Time& time) override;
  void waiting(const ros::Time& time) override { stopping(time); }
  void aborting(const ros::Time& time) override { stopping(time); }
  void update(const ros::Time& time, const ros::Duration& period) override;

 protected:
  typedef actionlib::ActionServer<control_msgs::GripperCommandAction> ActionServer;
  typedef ActionServer::GoalHandle GoalHandle;
  typedef realtime_tools::RealtimeServerGoalHandle<control_msgs::GripperCommandAction>
      RealtimeGoalHandle;
  typedef joint_trajectory_controller::internal::RealtimeGoal<RealtimeGoalHandle> RealtimeGoal;
  typedef HardwareInterfaceAdapter<HardwareInterface> HwIfaceAdapter;
  typedef typename HardwareInterface::ResourceHandleType JointHandle;

  virtual void goalCB(GoalHandle gh);
  virtual void cancelCB(GoalHandle gh);
  /// Cancels the running goal, if any.
  virtual void preemptActiveGoal();

  std::string name_;  ///< last part of the controller's namespace
  JointHandle joint_;
  std::string joint_name_;
  HwIfaceAdapter hw_iface_adapter_;

 private:
  /// A command of the callbacks for the loop; without a goal: hold.
  struct Order {
    Commands commands;
    boost::shared_ptr<RealtimeGoal> goal;
    std::uint64_t session{0};
    Order* next{nullptr};
  };

  /// State of the loop for the callbacks, after each update.
  struct Snapshot {
    double position{0.0};
    double effort{0.0};
    bool stalled{false};
  };

  bool initRequest(hardware_interface::RobotHW* robot_hw, ros::NodeHandle& root_nh,
                   ros::NodeHandle& controller_nh,
                   controller_interface::ControllerBase::ClaimedResources& claims) override;
  bool readParameters(ros::NodeHandle& controller_nh);

  // In the control loop.
  /// Without effect if the hardware takes no limit.
  void limitEffort(double max_effort);
  void takeOrder();
  void hold();
  void checkGoal(double error_position);
  void settle(RealtimeGoal& goal, bool reached);
  void publishSnapshot(bool stalled);

  // In callbacks.
  void endGoal(const std::string& reason);
  void sendResult(const std::string& reason);
  void publishFeedback();
  void monitor(const ros::WallTimerEvent& event);

  double action_monitor_rate_{20.0};
  double goal_tolerance_{0.01};
  double default_max_effort_{0.0};
  double stall_velocity_threshold_{0.001};
  double stall_timeout_{1.0};

  // Of the control loop.
  Order* order_{nullptr};  ///< the present one; owned
  Commands commands_;
  double computed_effort_{0.0};
  hardware_interface::JointEffortLimitHandle effort_limit_;
  bool has_effort_limit_{false};
  double still_for_{0.0};  ///< time of standstill [s]

  // Shared.
  joint_trajectory_controller::internal::CommandExchange<Order> exchange_;
  realtime_tools::LatestValue<Snapshot> snapshot_;
  std::atomic<bool> running_{false};
  std::atomic<std::uint64_t> session_{0};  ///< changes with every start and stop

  // Of callbacks, under mutex_.
  std::recursive_mutex mutex_;
  boost::shared_ptr<RealtimeGoal> active_goal_;
  std::uint64_t active_goal_session_{0};
  realtime_tools::OwnCallbacks callbacks_;
  std::shared_ptr<ActionServer> action_server_;
  ros::WallTimer monitor_timer_;
};

}  // namespace gripper_action_controller

#include <gripper_action_controller/gripper_action_controller_impl.h>

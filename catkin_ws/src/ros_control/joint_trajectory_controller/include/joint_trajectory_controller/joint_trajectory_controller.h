// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <actionlib/server/action_server.h>
#include <control_msgs/FollowJointTrajectoryAction.h>
#include <control_msgs/JointTrajectoryControllerState.h>
#include <control_msgs/QueryTrajectoryState.h>
#include <controller_interface/controller.h>
#include <hardware_interface/command_effect_interface.h>
#include <hardware_interface/internal/demangle_symbol.h>
#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/robot_hw.h>
#include <joint_trajectory_controller/hardware_interface_adapter.h>
#include <joint_trajectory_controller/hold_trajectory_builder.h>
#include <joint_trajectory_controller/init_joint_trajectory.h>
#include <joint_trajectory_controller/internal/command_exchange.h>
#include <joint_trajectory_controller/internal/realtime_goal.h>
#include <joint_trajectory_controller/joint_trajectory_segment.h>
#include <joint_trajectory_controller/stop_trajectory_builder.h>
#include <realtime_tools/latest_value.h>
#include <realtime_tools/own_callbacks.h>
#include <realtime_tools/realtime_box.h>
#include <realtime_tools/realtime_buffer.h>
#include <realtime_tools/realtime_publisher.h>
#include <ros/node_handle.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace joint_trajectory_controller {

/// Capacity for the reason of a goal's end, written by the control loop [characters].
constexpr std::size_t kReasonCapacity = 512;

/// Moves joints along trajectories from messages or from goals of an action.
///
/// Topics: `command` (in), `state` (out); action `follow_joint_trajectory`; service `query_state`;
/// all in the controller's namespace. [rad] or [m], and their derivatives.
///
/// The control loop calls update(), starting(), stopping(), waiting() and aborting().
/// Real-time safe. All others run in callbacks under one mutex that the loop never takes; commands
/// are passed to the loop through a CommandExchange and the loop's state comes back as a Snapshot.
/// When the loop overrides a command (it starts, or holds after a violated tolerance) it increments
/// an *epoch*; a command computed for an earlier epoch is not followed but computed again, so that
/// motions always start at the robot's position. A trajectory that the loop gets some ticks after
/// the one that it was computed for is joined without a jump: see join().
///
/// @tparam SegmentImpl such as trajectory_interface::QuinticSplineSegment<double>
/// @tparam HardwareInterface one with a HardwareInterfaceAdapter
template <class SegmentImpl, class HardwareInterface>
class JointTrajectoryController : public controller_interface::Controller<HardwareInterface> {
 public:
  JointTrajectoryController();
  ~JointTrajectoryController() override;

  /// Reads the parameters, gets the joints and opens topics, action and service.
  /// @returns false, after logging the reason, if a parameter or a joint is missing or wrong.
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
  /// As the base class; also gets the handles that tell whether commands have an effect.
  bool initRequest(
      hardware_interface::RobotHW* robot_hw, ros::NodeHandle& root_nh,
      ros::NodeHandle& controller_nh,
      controller_interface::ControllerBase::ClaimedResources& claimed_resources) override;

  struct TimeData {
    ros::Time time;        ///< of the last update, in ROS time
    ros::Duration period;  ///< of the last update
    ros::Time uptime;      ///< since starting(), the time base of trajectories
  };

  typedef actionlib::ActionServer<control_msgs::FollowJointTrajectoryAction> ActionServer;
  typedef std::shared_ptr<ActionServer> ActionServerPtr;
  typedef ActionServer::GoalHandle GoalHandle;
  typedef JointTrajectorySegment<SegmentImpl> Segment;
  typedef std::vector<Segment> TrajectoryPerJoint;
  typedef std::vector<TrajectoryPerJoint> Trajectory;
  typedef std::shared_ptr<Trajectory> TrajectoryPtr;
  typedef typename Segment::RealtimeGoalHandle RealtimeGoalHandle;
  typedef typename Segment::RealtimeGoalHandlePtr RealtimeGoalHandlePtr;
  typedef trajectory_msgs::JointTrajectory::ConstPtr JointTrajectoryConstPtr;
  typedef realtime_tools::RealtimePublisher<control_msgs::JointTrajectoryControllerState>
      StatePublisher;
  typedef std::unique_ptr<StatePublisher> StatePublisherPtr;
  typedef typename Segment::Scalar Scalar;
  typedef typename Segment::State State;
  typedef typename HardwareInterface::ResourceHandleType JointHandle;
  typedef HardwareInterfaceAdapter<HardwareInterface, typename Segment::State> HwIfaceAdapter;

  /// Passes a new trajectory to the control loop, spliced to the current one; a message without
  /// points means hold.
  /// @param gh its goal, or null. Its preallocated result gets the end of the goal.
  /// @param[out] error_string why it was refused; may be null
  /// @returns whether it was accepted. Thread-safe. Not real-time safe.
  virtual bool updateTrajectoryCommand(const JointTrajectoryConstPtr& msg, RealtimeGoalHandlePtr gh,
                                       std::string* error_string = nullptr);
  virtual void trajectoryCommandCB(const JointTrajectoryConstPtr& msg);
  virtual void goalCB(GoalHandle gh);
  virtual void cancelCB(GoalHandle gh);
  /// Cancels the running goal, if any, because another command replaces it.
  virtual void preemptActiveGoal();
  virtual bool queryStateService(control_msgs::QueryTrajectoryState::Request& req,
                                 control_msgs::QueryTrajectoryState::Response& resp);

  std::string name_;  ///< last part of the controller's namespace
  std::vector<JointHandle> joints_;
  std::vector<bool> angle_wraparound_;  ///< which joints are continuous
  std::vector<std::string> joint_names_;
  SegmentTolerances<Scalar> default_tolerances_;
  HwIfaceAdapter hw_iface_adapter_;
  bool allow_partial_joints_goal_{false};

  // Of the control loop.
  State current_state_;  ///< measured
  State desired_state_;
  State state_error_;  ///< desired minus measured
  TimeData time_data_;

  ros::NodeHandle controller_nh_;
  realtime_tools::OwnCallbacks callbacks_;
  ros::Subscriber trajectory_command_sub_;
  ActionServerPtr action_server_;
  ros::ServiceServer query_state_service_;
  StatePublisherPtr state_publisher_;
  ros::WallTimer monitor_timer_;
  ros::Duration state_publisher_period_;  ///< 0: no state is published

 private:
  typedef internal::RealtimeGoal<RealtimeGoalHandle> RealtimeGoal;
  typedef std::shared_ptr<RealtimeGoal> RealtimeGoalPtr;

  /// A command of the callbacks for the loop.
  struct Command {
    TrajectoryPtr trajectory;  ///< null: hold
    RealtimeGoalPtr goal;
    JointTrajectoryConstPtr message;
    double start{0.0};         ///< of the message, in uptime [s]
    std::uint64_t epoch{0};    ///< for which the trajectory was computed
    std::uint64_t session{0};  ///< session in which it was given
    std::uint64_t number{0};   ///< counts commands
    bool outdated{false};      ///< the loop refused it because of its epoch
    Command* next{nullptr};
  };

  /// State of the loop for the callbacks, after each update.
  struct Snapshot {
    TimeData time;
    std::uint64_t epoch{0};
    bool holding{true};  ///< by itself or on command, since `hold_start`
    double hold_start{0.0};
    State hold_origin;
    State desired;
    State actual;
    State error;
    double time_from_start{0.0};
  };

  typedef std::unique_ptr<TrajectoryBuilder<SegmentImpl>> BuilderPtr;
  typedef HoldTrajectoryBuilder<SegmentImpl, HardwareInterface> HoldBuilder;
  typedef StopTrajectoryBuilder<SegmentImpl> StopBuilder;

  // Set-up.
  bool readParameters(ros::NodeHandle& controller_nh);
  bool readRates(ros::NodeHandle& controller_nh);
  bool takeJoints(HardwareInterface* hw, ros::NodeHandle& root_nh);
  void sizeStates();
  void openInterfaces(ros::NodeHandle& controller_nh);

  // In the control loop.
  virtual void updateFuncExtensionPoint(const Trajectory& /*curr_traj*/,
                                        const TimeData& /*time_data*/) {}
  void readMeasuredState();
  void takeCommand();
  bool join(const Command& command);
  void follow(Command* command);
  void beginHold();
  const Trajectory& trajectory() const {
    return holding_ ? hold_trajectory_ : *command_->trajectory;
  }
  double uptime() const { return time_data_.uptime.toSec(); }
  double timeFromStart() const { return uptime() - (holding_ ? hold_start_ : command_->start); }
  const Segment& sampleJoint(std::size_t joint);
  void sampleDesiredState();
  /// @returns false if a violated tolerance ended the goal, and the joints hold from now on.
  bool checkGoal();
  bool checkJointTolerance(std::size_t joint, RealtimeGoal& goal);
  void failGoal(RealtimeGoal& goal, int code, std::size_t joint, const char* kind,
                const StateTolerances<Scalar>& tolerance);
  static void succeed(RealtimeGoal& goal);
  void publishState();
  void publishSnapshot();

  // In callbacks.
  bool checkJoints(const trajectory_msgs::JointTrajectory& msg, std::string& reason) const;
  std::string reasonWithoutEffect() const;
  void putHold(const JointTrajectoryConstPtr& msg, const RealtimeGoalPtr& goal);
  RealtimeGoalPtr goalOf(const RealtimeGoalHandlePtr& handle) const;
  Trajectory callbackTrajectory(const Snapshot& snapshot);
  Trajectory holdTrajectory(double start, const State& origin) const;
  void cancelActiveGoal(const std::string& reason);
  static void endGoal(RealtimeGoal& goal, typename RealtimeGoal::Outcome outcome, int code,
                      const std::string& reason);
  void monitor(const ros::WallTimerEvent& event);
  void reissue(const Command& command);
  void publishFeedback();

  std::vector<hardware_interface::CommandEffectHandle>
      effects_;  ///< of joints whose hardware has one
  Scalar stop_trajectory_duration_{0};
  double action_monitor_rate_{20.0};

  // Of the control loop.
  Command* command_{nullptr};  ///< the present one; owned
  bool holding_{true};
  double hold_start_{0.0};
  State hold_origin_;
  BuilderPtr hold_builder_;
  Trajectory hold_trajectory_;
  std::uint64_t epoch_{0};
  State joint_state_;
  std::vector<SegmentImpl> deviations_;   ///< of each joint from its trajectory, until their ends
  State deviation_;                       ///< of one joint
  State zero_;                            ///< of one joint
  std::vector<const Segment*> segments_;  ///< present segment of each joint
  std::vector<char> joint_succeeded_;
  ros::Time last_state_publish_time_;

  // Shared.
  internal::CommandExchange<Command> exchange_;
  realtime_tools::LatestValue<Snapshot> snapshot_;
  std::atomic<bool> running_{false};
  std::atomic<std::uint64_t> session_{0};  ///< changes with every start and stop

  // Of callbacks, under mutex_.
  std::recursive_mutex mutex_;
  RealtimeGoalPtr active_goal_;
  RealtimeGoalPtr latest_goal_;  ///< of the last accepted command; null: it had none
  std::uint64_t active_goal_session_{0};
  TrajectoryPtr latest_trajectory_;  ///< last one passed to the loop; null: hold
  std::uint64_t latest_epoch_{0};
  std::uint64_t number_{0};
};

}  // namespace joint_trajectory_controller

#include <joint_trajectory_controller/joint_trajectory_controller_callbacks.h>
#include <joint_trajectory_controller/joint_trajectory_controller_impl.h>
#include <joint_trajectory_controller/joint_trajectory_controller_setup.h>

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <joint_trajectory_controller/joint_trajectory_controller.h>
#include <trajectory_interface/quintic_spline_segment.h>

#include <memory>
#include <string>
#include <vector>

#include "signature.h"

using namespace joint_trajectory_controller;

typedef trajectory_interface::QuinticSplineSegment<double> Spline;
typedef JointTrajectorySegment<Spline> Segment;
typedef std::vector<std::vector<Segment>> Trajectory;
typedef trajectory_msgs::JointTrajectoryPoint Point;
typedef realtime_tools::RealtimeServerGoalHandle<control_msgs::FollowJointTrajectoryAction> Goal;
typedef hardware_interface::EffortJointInterface Effort;

EXPECT_TYPE(Goal&, of<Segment::RealtimeGoalHandle>());
EXPECT_TYPE(boost::shared_ptr<Goal>, of<const Segment>().getGoalHandle());
EXPECT_TYPE(void, of<Segment>().setGoalHandle(boost::shared_ptr<Goal>()));
static_assert(std::is_constructible<Segment, ros::Time, Point, Point>::value, "");
static_assert(std::is_constructible<Segment, ros::Time, Point, Point, std::vector<double>>::value,
              "");
static_assert(std::is_constructible<Segment, double, Segment::State, double, Segment::State>::value,
              "");
static_assert(std::is_constructible<Segment::State, Point, std::vector<double>>::value, "");
static_assert(std::is_constructible<Segment::State, unsigned int>::value, "");
EXPECT_TYPE(void, of<Segment::State>().init(Point(), std::vector<double>()));

EXPECT_BASE(TrajectoryBuilder<Spline>, StopTrajectoryBuilder<Spline>);
EXPECT_TYPE(StopTrajectoryBuilder<Spline>, StopTrajectoryBuilder<Spline>(1.0, Segment::State()));
typedef HoldTrajectoryBuilder<Spline, Effort> Hold;
EXPECT_BASE(TrajectoryBuilder<Spline>, Hold);
static_assert(
    std::is_constructible<Hold, const std::vector<hardware_interface::JointHandle>&>::value, "");

/// A user's builder derived from the base class.
class OwnBuilder : public TrajectoryBuilder<Spline> {
 public:
  bool buildTrajectory(Trajectory* trajectory) override {
    if (!getStartTime()) {
      return false;
    }
    const Segment::Time start{getStartTime().get()};
    const boost::shared_ptr<Goal> goal{createGoalHandlePtr()};
    trajectory->resize(1);
    (*trajectory)[0].resize(1);
    Segment::State state(1);
    (*trajectory)[0].front().init(start, state, start, state);
    (*trajectory)[0].front().setGoalHandle(goal ? goal : createDefaultGoalHandle());
    return true;
  }
  void reset() override { TrajectoryBuilder<Spline>::reset(); }
};
EXPECT_TYPE(TrajectoryBuilder<Spline>*, of<OwnBuilder>().setStartTime(1.0));
EXPECT_TYPE(TrajectoryBuilder<Spline>*,
            of<OwnBuilder>().setGoalHandle(of<boost::shared_ptr<Goal>>()));

typedef InitJointTrajectoryOptions<Trajectory> Options;
EXPECT_TYPE(boost::shared_ptr<Goal>, of<Options>().rt_goal_handle);
EXPECT_TYPE(Trajectory, initJointTrajectory<Trajectory>(trajectory_msgs::JointTrajectory(),
                                                        ros::Time(), Options()));

/// A user's derived controller.
class OwnController : public JointTrajectoryController<Spline, Effort> {
 protected:
  typedef JointTrajectoryController<Spline, Effort> Base;
  bool updateTrajectoryCommand(const JointTrajectoryConstPtr& msg, RealtimeGoalHandlePtr gh,
                               std::string* error_string) override {
    return Base::updateTrajectoryCommand(msg, gh, error_string);
  }
  void goalCB(GoalHandle gh) override { Base::goalCB(gh); }
  void cancelCB(GoalHandle gh) override { Base::cancelCB(gh); }
  void preemptActiveGoal() override { Base::preemptActiveGoal(); }
};
EXPECT_BASE(controller_interface::Controller<Effort>, OwnController);
OwnController* make() { return new OwnController; }

// Includes that users of the original's headers rely on.
EXPECT_TYPE(double, angles::shortest_angular_distance(0.0, 1.0));
EXPECT_TYPE(urdf::Model&, of<urdf::Model>());
EXPECT_TYPE(void, of<realtime_tools::RealtimeBox<int>>().set(1));
EXPECT_TYPE(int*, of<realtime_tools::RealtimeBuffer<int>>().readFromRT());
EXPECT_TYPE(std::string, hardware_interface::internal::demangledTypeName<int>());

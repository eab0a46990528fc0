// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// boost::bind's placeholders with generated headers and actionlib only.
#include <actionlib/client/simple_action_client.h>
#include <franka_gripper/MoveAction.h>

namespace bound_callbacks {

class Mover {
 public:
  void move(double width) {
    franka_gripper::MoveGoal goal;
    goal.width = width;
    client_.sendGoal(goal, boost::bind(&Mover::done, this, _1, _2));
  }

 private:
  void done(const actionlib::SimpleClientGoalState& /*state*/,
            const franka_gripper::MoveResultConstPtr& /*result*/) {}

  actionlib::SimpleActionClient<franka_gripper::MoveAction> client_{"move"};
};

void moveTo(double width) { Mover().move(width); }

}  // namespace bound_callbacks

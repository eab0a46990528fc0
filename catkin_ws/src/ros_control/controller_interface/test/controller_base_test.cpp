// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <controller_interface/controller_base.h>
#include <gmock/gmock.h>

#include <string>
#include <vector>

using controller_interface::ControllerBase;
using State = ControllerBase::ControllerState;
using testing::ElementsAre;
using testing::IsEmpty;

namespace {

/// Records every callback with the state at that time.
class Recorder : public ControllerBase {
 public:
  void starting(const ros::Time& time) override { note("starting", time); }
  void update(const ros::Time& time, const ros::Duration& period) override {
    note("update", time);
    EXPECT_EQ(ros::Duration(0.001), period);
  }
  void stopping(const ros::Time& time) override { note("stopping", time); }
  void waiting(const ros::Time& time) override { note("waiting", time); }
  void aborting(const ros::Time& time) override { note("aborting", time); }
  bool initRequest(hardware_interface::RobotHW* /*robot_hw*/, ros::NodeHandle& /*root_nh*/,
                   ros::NodeHandle& /*controller_nh*/, ClaimedResources& /*claimed*/) override {
    return true;
  }

  std::vector<std::string> calls_;
  std::vector<State> states_;

 private:
  void note(const char* call, const ros::Time& time) {
    calls_.emplace_back(call);
    states_.push_back(state_);
    EXPECT_EQ(ros::Time(42.0), time);
  }
};

const ros::Time kTime(42.0);
const std::vector<State> kReadyStates = {State::INITIALIZED, State::RUNNING, State::STOPPED,
                                         State::WAITING, State::ABORTED};

void expectTransition(bool (ControllerBase::*request)(const ros::Time&), const char* callback,
                      State result) {
  for (const State before : kReadyStates) {
    Recorder controller;
    controller.state_ = before;
    EXPECT_TRUE((controller.*request)(kTime));
    EXPECT_THAT(controller.calls_, ElementsAre(callback));
    EXPECT_THAT(controller.states_, ElementsAre(before)) << "the callback runs before the change";
    EXPECT_EQ(result, controller.state_.load());
  }
  Recorder unprepared;
  EXPECT_FALSE((unprepared.*request)(kTime));
  EXPECT_THAT(unprepared.calls_, IsEmpty());
  EXPECT_EQ(State::CONSTRUCTED, unprepared.state_.load());
}

}  // namespace

TEST(ControllerBase, QueriesMatchOneStateEach) {
  Recorder controller;
  EXPECT_EQ(State::CONSTRUCTED, controller.state_.load());
  for (const State state : {State::CONSTRUCTED, State::INITIALIZED, State::RUNNING, State::STOPPED,
                            State::WAITING, State::ABORTED}) {
    controller.state_ = state;
    EXPECT_EQ(state == State::INITIALIZED, controller.isInitialized());
    EXPECT_EQ(state == State::RUNNING, controller.isRunning());
    EXPECT_EQ(state == State::STOPPED, controller.isStopped());
    EXPECT_EQ(state == State::WAITING, controller.isWaiting());
    EXPECT_EQ(state == State::ABORTED, controller.isAborted());
  }
}

TEST(ControllerBase, Start) {
  expectTransition(&ControllerBase::startRequest, "starting", State::RUNNING);
}

TEST(ControllerBase, Stop) {
  expectTransition(&ControllerBase::stopRequest, "stopping", State::STOPPED);
}

TEST(ControllerBase, Wait) {
  expectTransition(&ControllerBase::waitRequest, "waiting", State::WAITING);
}

TEST(ControllerBase, Abort) {
  expectTransition(&ControllerBase::abortRequest, "aborting", State::ABORTED);
}

TEST(ControllerBase, UpdatesOnlyWhileRunning) {
  Recorder controller;
  for (const State state :
       {State::CONSTRUCTED, State::INITIALIZED, State::STOPPED, State::WAITING, State::ABORTED}) {
    controller.state_ = state;
    controller.updateRequest(kTime, ros::Duration(0.001));
  }
  EXPECT_THAT(controller.calls_, IsEmpty());
  controller.state_ = State::RUNNING;
  controller.updateRequest(kTime, ros::Duration(0.001));
  EXPECT_THAT(controller.calls_, ElementsAre("update"));
  EXPECT_TRUE(controller.isRunning());
}

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// A combined robot under the controller manager, with real controllers and a real loop.
#include <controller_interface/controller.h>
#include <controller_manager/controller_manager.h>
#include <gmock/gmock.h>
#include <hardware_interface/joint_command_interface.h>
#include <ros/node_handle.h>
#include <ros_test/eventually.h>

#include <chrono>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "guard.h"
#include "test_combined.h"
#include "test_robot.h"

using combined_robot_hw_test::Combined;
using combined_robot_hw_test::Robot;
typedef std::vector<std::string> Names;
typedef hardware_interface::RobotHW::SwitchState State;

namespace {

constexpr int kStrict = 2;

/// Commands an effort of 1 to the joints in the parameter `joints`.
class Pusher : public controller_interface::Controller<hardware_interface::EffortJointInterface> {
 public:
  bool init(hardware_interface::EffortJointInterface* efforts, ros::NodeHandle& nh) override {
    for (const std::string& name : nh.param("joints", Names())) {
      handles_.push_back(efforts->getHandle(name));
    }
    return true;
  }
  void update(const ros::Time& /*time*/, const ros::Duration& /*period*/) override {
    for (auto& handle : handles_) {
      handle.setCommand(1.0);
    }
  }

 private:
  std::vector<hardware_interface::JointHandle> handles_;
};

class PusherLoader : public controller_manager::ControllerLoaderInterface {
 public:
  PusherLoader() : ControllerLoaderInterface("test") {}
  controller_interface::ControllerBaseSharedPtr createInstance(const std::string&) override {
    return std::make_shared<Pusher>();
  }
  Names getDeclaredClasses() override { return {"test/Pusher"}; }
  void reload() override {}
};

class Managed : public testing::Test {
 protected:
  Managed() {
    manager_.registerControllerLoader(std::make_shared<PusherLoader>());
    load("left", {"l1"});
    load("both", {"l1", "r1"});
    load("right", {"r1"});
  }
  ~Managed() override { nh_.deleteParam(nh_.getNamespace()); }

  void load(const std::string& name, const Names& joints) {
    nh_.setParam(name + "/type", "test/Pusher");
    nh_.setParam(name + "/joints", joints);
    ASSERT_TRUE(manager_.loadController(name));
  }

  void step() {
    time_ += ros::Duration(0.001);
    const ros::Duration period(0.001);
    calls_ += guard::allocationsAndLocks([&] {
      combined_.read(time_, period);
      manager_.update(time_, period);
      combined_.write(time_, period);
    });
    ++steps_;
  }

  /// Switches while the loop runs; calls `during` before each cycle.
  template <class During>
  bool switched(const Names& start, const Names& stop, During during) {
    auto answer = std::async(std::launch::async, [&] {
      return manager_.switchController(start, stop, kStrict, false, 60.0);
    });
    EXPECT_TRUE(ros_test::eventually([&] {
      if (answer.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
        return true;
      }
      during();
      step();
      return false;
    }));
    return answer.get();
  }
  bool switched(const Names& start, const Names& stop) {
    return switched(start, stop, [] {});
  }

  bool runs(const std::string& name) { return manager_.getControllerByName(name)->isRunning(); }

  ros::NodeHandle nh_{"managed"};
  Combined combined_;
  Robot& left_{combined_.add({"l1"})};
  Robot& right_{combined_.add({"r1"})};
  controller_manager::ControllerManager manager_{&combined_, nh_};
  ros::Time time_{1.0};
  std::size_t calls_{0};
  int steps_{0};
};

}  // namespace

TEST_F(Managed, SwitchesReachTheMembersWithoutAnAllocationInTheLoop) {
  ASSERT_TRUE(switched({"both"}, {}));
  EXPECT_TRUE(runs("both"));
  step();
  EXPECT_EQ(1.0, left_.written);
  EXPECT_EQ(1.0, right_.written);
  ASSERT_TRUE(switched({"left", "right"}, {"both"}));
  EXPECT_TRUE(runs("left") && runs("right") && !runs("both"));
  EXPECT_EQ(2, left_.switches);
  EXPECT_EQ(2, right_.switches);
  EXPECT_EQ(0u, calls_) << "allocations and locks in " << steps_ << " cycles";
}

TEST_F(Managed, ControllersWaitForTheSlowestMember) {
  right_.result = State::ONGOING;
  int waited = 0;
  ASSERT_TRUE(switched({"both"}, {}, [&] {
    waited += manager_.getControllerByName("both")->isWaiting();
    if (waited == 5) {
      right_.result = State::DONE;
    }
  }));
  EXPECT_EQ(5, waited);
  EXPECT_TRUE(runs("both"));
  EXPECT_EQ(0u, calls_);
}

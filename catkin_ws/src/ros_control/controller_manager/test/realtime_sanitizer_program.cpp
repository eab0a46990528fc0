// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Functions of the loop, without a ROS master: built and run by test_realtime_sanitizer.py.
#include <controller_manager/internal/controller_watch.h>
#include <controller_manager/internal/loop_gate.h>
#include <controller_manager/internal/switch_request.h>
#include <hardware_interface/joint_command_interface.h>
#include <realtime_tools/detail/turn_lock.h>
#include <realtime_tools/realtime_buffer.h>

#include <cstdio>
#include <cstdlib>
#include <memory>

#ifdef __has_cpp_attribute
#if __has_cpp_attribute(clang::nonblocking)
#define NONBLOCKING [[clang::nonblocking]]
#endif
#endif
#ifndef NONBLOCKING
#define NONBLOCKING
#endif

namespace {

using controller_manager::internal::SwitchRequest;

class Robot : public hardware_interface::RobotHW {
 public:
  Robot() {
    const hardware_interface::JointStateHandle state("joint", &value_, &value_, &value_);
    efforts_.registerHandle({state, &command_});
    registerInterface(&efforts_);
  }
  double command() const { return command_; }

 private:
  double value_{0.0};
  double command_{0.0};
  hardware_interface::EffortJointInterface efforts_;
};

/// Commands the value in its buffer, and locks a message that is read outside.
class Forwarder : public controller_interface::ControllerBase {
 public:
  explicit Forwarder(const hardware_interface::JointHandle& joint) : joint_(joint) {
    state_ = ControllerState::INITIALIZED;
    message_.open();
  }
  void update(const ros::Time& /*time*/, const ros::Duration& /*period*/) override {
    joint_.setCommand(*target_.readFromRT());
    if (message_.tryLock()) {
      ++messages_;
      message_.unlock();
    }
  }
  bool initRequest(hardware_interface::RobotHW*, ros::NodeHandle&, ros::NodeHandle&,
                   ClaimedResources&) override {
    return true;
  }

  realtime_tools::RealtimeBuffer<double> target_{0.0};
  int messages_{0};

 private:
  hardware_interface::JointHandle joint_;
  realtime_tools::detail::TurnLock message_;
};

void cycle(controller_manager::internal::LoopGate& gate,
           controller_manager::internal::ControllerWatch& watch, SwitchRequest& request,
           Robot& robot, const ros::Time& time) NONBLOCKING {
  const controller_manager::internal::LoopGate::Visit visit(gate);
  watch.update(time, ros::Duration(0, 1000000), 0);
  if (request.phase != SwitchRequest::Phase::kDone && request.advance(robot, time)) {
    request.phase = SwitchRequest::Phase::kDone;
  }
}

/// Shows that the sanitizer works.
void misbehave() NONBLOCKING {
  void* volatile memory = std::malloc(1);
  std::free(memory);
}

}  // namespace

int main(int argc, char**) {
  if (argc > 1) {
    misbehave();
    std::puts("an allocation went unnoticed");
    return 0;
  }
  Robot robot;
  const auto controller = std::make_shared<Forwarder>(
      robot.get<hardware_interface::EffortJointInterface>()->getHandle("joint"));
  hardware_interface::ControllerInfo info;
  info.name = "forwarder";
  info.claimed_resources = {{"hardware_interface::EffortJointInterface", {"joint"}}};
  controller_manager::internal::Supervision supervision;
  supervision.abort_faulty = true;
  controller_manager::internal::ControllerWatch watch(*controller, info, robot, supervision, {});
  controller_manager::internal::LoopGate gate;
  SwitchRequest request;
  request.guarded = true;
  request.starts.push_back({controller, info});
  request.start_list.push_back(info);

  ros::Time time(100.0);
  for (int i = 0; i < 100; ++i) {
    controller->target_.writeFromNonRT(i);
    time += ros::Duration(0.001);
    cycle(gate, watch, request, robot, time);
  }
  const bool done = controller->isRunning() && controller->messages_ > 0 && robot.command() == 99.0;
  std::puts(done ? "done" : "the loop did not do its work");
  return done ? 0 : 1;
}

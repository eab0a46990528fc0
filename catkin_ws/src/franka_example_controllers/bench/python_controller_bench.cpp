// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Cost of a Python controller per cycle, compared with one in C++ and a bare call into Python.
// Needs a ROS master for the controllers' parameters.
#include <benchmark/benchmark.h>
#include <controller_interface/controller.h>
#include <franka_example_controllers/python_controller.h>
#include <pybind11/embed.h>
#include <ros/ros.h>

#include <memory>
#include <string>

#include "../test/whole_arm.h"

namespace franka_example_controllers {
namespace {

constexpr double kPeriod = 1e-3;  // [s]

/// A controller that runs a class of this package's Python examples on an arm at rest.
class Running {
 public:
  Running(const std::string& script, const std::string& name) : node_(name) {
    node_.setParam("script", script);
    node_.setParam("class", name);
    node_.setParam("command", "effort");
    node_.setParam("arm_id", "panda");
    node_.setParam("joint_names", arm_.joint_names);
    node_.setParam("k_gains", std::vector<double>(7, 600.0));
    node_.setParam("d_gains", std::vector<double>(7, 50.0));
    node_.setParam("max_update_time", 5.0);
    node_.setParam("max_starting_time", 20.0);
    ros::NodeHandle root;
    controller_interface::ControllerBase::ClaimedResources claims;
    controller_interface::ControllerBase& base = controller_;
    ready_ = base.initRequest(&arm_, root, node_, claims);
    controller_.starting(ros::Time(1.0));
  }

  bool ready() const { return ready_; }
  void update() { controller_.update(ros::Time(1.0), ros::Duration(kPeriod)); }

 private:
  WholeArm arm_;
  ros::NodeHandle node_;
  PythonController controller_;
  bool ready_{false};
};

/// In simulated time (argument 1) or on hardware (0), where the loop sleeps until the script
/// answers.
void run(benchmark::State& state, const std::string& script, const std::string& name) {
  ros::param::set("/use_sim_time", state.range(0) == 1);
  Running controller(script, name);
  if (!controller.ready()) {
    state.SkipWithError("the controller could not be set up");
    return;
  }
  for (auto _ : state) {
    controller.update();
  }
}

// The script's thread works while the loop's thread waits, so wall time is measured.
void jointImpedance(benchmark::State& state) {
  run(state, std::string(EXAMPLES) + "/joint_impedance.py", "JointImpedance");
}
BENCHMARK(jointImpedance)->ArgName("simulated")->Arg(0)->Arg(1)->UseRealTime();

void constantCommand(benchmark::State& state) {
  run(state, std::string(BENCH) + "/constant_command.py", "ConstantCommand");
}
BENCHMARK(constantCommand)->ArgName("simulated")->Arg(0)->Arg(1)->UseRealTime();

void callOfPython(benchmark::State& state) {
  const pybind11::gil_scoped_acquire interpreter;
  const pybind11::object call = pybind11::eval("lambda: None");
  for (auto _ : state) {
    call();
  }
}
BENCHMARK(callOfPython)->UseRealTime();

/// The same command in C++.
class ConstantEffort
    : public controller_interface::Controller<hardware_interface::EffortJointInterface> {
 public:
  explicit ConstantEffort(WholeArm& arm) {
    auto* efforts = arm.get<hardware_interface::EffortJointInterface>();
    for (const std::string& joint : arm.joint_names) {
      handles_.push_back(efforts->getHandle(joint));
    }
  }
  void update(const ros::Time& /*time*/, const ros::Duration& /*period*/) override {
    for (hardware_interface::JointHandle& handle : handles_) {
      handle.setCommand(0.0);
    }
  }

 private:
  std::vector<hardware_interface::JointHandle> handles_;
};

void controllerInCpp(benchmark::State& state) {
  WholeArm arm;
  const std::unique_ptr<controller_interface::ControllerBase> controller =
      std::make_unique<ConstantEffort>(arm);
  for (auto _ : state) {
    controller->update(ros::Time(1.0), ros::Duration(kPeriod));
    benchmark::DoNotOptimize(arm.effort);
  }
}
BENCHMARK(controllerInCpp)->UseRealTime();

}  // namespace
}  // namespace franka_example_controllers

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  ros::init(argc, argv, "python_controller_bench");
  ros::NodeHandle keeps_ros_alive;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_example_controllers/command_claims.h>
#include <franka_example_controllers/controller_parameters.h>
#include <franka_example_controllers/python_controller.h>
#include <franka_example_controllers/robot_handles.h>
#include <pluginlib/class_list_macros.h>
#include <ros/param.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "arm_commander.h"
#include "script_runner.h"
#include "self_stop.h"

namespace franka_example_controllers {

namespace {

constexpr char kName[] = "PythonController";

// A robot's cycle of 1 ms, less the time of hardware and network; and the time without commands
// after which a robot aborts. A simulation waits.
constexpr double kUpdateTime = 0.8e-3;
constexpr double kStartingTime = 0.02;
constexpr double kSimulatedUpdateTime = 0.1;
constexpr double kSimulatedStartingTime = 1.0;

bool inSimulatedTime() {
  bool simulated = false;
  ros::param::get("/use_sim_time", simulated);
  return simulated;
}

bool readTime(const ros::NodeHandle& nh, const char* name, double& value) {
  constexpr double kMaxTime = 3600.0;  // [s] chosen here: a loop that waits longer has failed
  if (nh.hasParam(name) && !(nh.getParam(name, value) && value > 0.0 && value <= kMaxTime)) {
    ROS_ERROR("%s: the parameter %s must be a time above zero and at most 3600, in seconds.", kName,
              nh.resolveName(name).c_str());
    return false;
  }
  return true;
}

/// A name, or a list of names.
bool readCommand(const ros::NodeHandle& nh, franka_hw::ControlMode& mode) {
  std::vector<std::string> names(1);
  if (!nh.getParam("command", names[0]) && !nh.getParam("command", names)) {
    names.clear();
  }
  const CommandClaims claims = checkCommandClaims(names);
  if (!claims.refusal.empty()) {
    ROS_ERROR("%s: the parameter %s cannot be used. %s", kName, nh.resolveName("command").c_str(),
              claims.refusal.c_str());
    return false;
  }
  mode = claims.mode;
  return true;
}

bool readSource(const ros::NodeHandle& nh, ScriptSource& source) {
  nh.getParam("script", source.file);
  nh.getParam("module", source.module);
  if (source.file.empty() == source.module.empty()) {
    ROS_ERROR("%s: set one of the parameters %s (path of a Python file) and %s (name of a module).",
              kName, nh.resolveName("script").c_str(), nh.resolveName("module").c_str());
    return false;
  }
  if (!nh.getParam("class", source.class_name) || source.class_name.empty()) {
    ROS_ERROR("%s: set the parameter %s to the name of the class in the script.", kName,
              nh.resolveName("class").c_str());
    return false;
  }
  nh.getParam("", source.parameters);
  return true;
}

}  // namespace

PythonController::PythonController()
    : MultiInterfaceController(/*allow_optional_interfaces=*/true) {}

PythonController::~PythonController() = default;

bool PythonController::init(hardware_interface::RobotHW* robot_hw, ros::NodeHandle& root_nh,
                            ros::NodeHandle& controller_nh) {
  std::string arm_id;
  std::vector<std::string> joint_names;
  std::unique_ptr<franka_hw::FrankaModelHandle> model;
  commander_ = std::make_unique<ArmCommander>();
  if (!readArmId(kName, controller_nh, arm_id) ||
      !readJointNames(kName, controller_nh, joint_names) || !readCommand(controller_nh, mode_) ||
      !readTimes(controller_nh) ||
      !takeHandles(kName, arm_id,
                   [&] {
                     model = std::make_unique<franka_hw::FrankaModelHandle>(
                         takeHandle<franka_hw::FrankaModelInterface>(robot_hw, arm_id + "_model"));
                     state_handle_ = std::make_unique<franka_hw::FrankaStateHandle>(
                         takeHandle<franka_hw::FrankaStateInterface>(robot_hw, arm_id + "_robot"));
                     commander_->take(robot_hw, arm_id, joint_names, mode_);
                   }) ||
      !loadScript(controller_nh, *model)) {
    return false;
  }
  self_stop_ = std::make_unique<SelfStop>(root_nh, controller_nh, [this] {
    ROS_ERROR("PythonController '%s' has failed and brings the arm to rest. %s",
              self_stop_->name().c_str(), runner_->reason().c_str());
    runner_->interrupt();
  });
  return true;
}

bool PythonController::readTimes(ros::NodeHandle& controller_nh) {
  const bool simulated = inSimulatedTime();
  max_update_time_ = simulated ? kSimulatedUpdateTime : kUpdateTime;
  max_starting_time_ = simulated ? kSimulatedStartingTime : kStartingTime;
  return readTime(controller_nh, "max_update_time", max_update_time_) &&
         readTime(controller_nh, "max_starting_time", max_starting_time_) &&
         readTime(controller_nh, "load_timeout", load_timeout_);
}

bool PythonController::loadScript(ros::NodeHandle& controller_nh,
                                  const franka_hw::FrankaModelHandle& model) {
  ScriptSource source;
  source.mode = mode_;
  if (!readSource(controller_nh, source)) {
    return false;
  }
  try {
    runner_ = std::make_unique<ScriptRunner>(
        inSimulatedTime() ? franka_core::waitModeOfEnvironment() : franka_core::WaitMode::kBlock);
  } catch (const std::exception& error) {
    ROS_ERROR("%s: %s", kName, error.what());
    return false;
  }
  const std::string failure = runner_->load(source, model, load_timeout_);
  if (!failure.empty()) {
    ROS_ERROR("%s: the class '%s' of '%s' cannot be used. %s", kName, source.class_name.c_str(),
              (source.file + source.module).c_str(), failure.c_str());
  }
  return failure.empty();
}

void PythonController::starting(const ros::Time& /*time*/) {
  commander_->holdStill(state_handle_->getRobotState());
  phase_ = Phase::kRunning;
  if (!runner_->start(state_handle_->getRobotState(), max_starting_time_)) {
    fail();
  }
}

void PythonController::update(const ros::Time& /*time*/, const ros::Duration& period) {
  const franka::RobotState& state = state_handle_->getRobotState();
  if (phase_ == Phase::kRunning) {
    ArmCommand command;
    if (runner_->update(state, period.toSec(), max_update_time_, command)) {
      commander_->command(command, period.toSec());
      return;
    }
    fail();
  }
  if (commander_->rest(state, period.toSec()) && phase_ == Phase::kComingToRest) {
    phase_ = Phase::kResting;
    self_stop_->stop();
  }
}

void PythonController::stopping(const ros::Time& /*time*/) { runner_->stop(); }

void PythonController::fail() {
  phase_ = Phase::kComingToRest;
  commander_->beginRest();
  self_stop_->fail();
}

}  // namespace franka_example_controllers

PLUGINLIB_EXPORT_CLASS(franka_example_controllers::PythonController,
                       controller_interface::ControllerBase)

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/numbers.h>
#include <franka_sim_mujoco/gripper_actions.h>
#include <ros/init.h>

#include <chrono>
#include <cmath>
#include <thread>

namespace franka_sim_mujoco {

namespace {

constexpr std::chrono::milliseconds kPoll{5};
/// Maximum wait of a canceled goal for its stop [polls]; the loop may stand still.
constexpr int kCancelPolls = 40;
constexpr double kNoEffort = 1e-4;  ///< below it gripper_action moves instead of grasping [N]

constexpr char kNotRunning[] =
    "The gripper's controller does not run: start it with the controller manager.";
constexpr char kInterrupted[] = "The command was interrupted by another command of the gripper.";
constexpr char kCanceled[] = "The command was canceled; the fingers stay where they are.";
constexpr char kReplaced[] = "The command was replaced by a new goal.";
constexpr char kRefused[] =
    "The gripper refused the command: its numbers are outside their ranges.";

/// Sets what a result says of a command that did not succeed: the reason, or the fingers' width.
template <typename Result>
void explain(Result& result, const std::string& text, double /*width*/) {
  result.error = text;
}
void explain(control_msgs::GripperCommandResult& result, const std::string& /*text*/,
             double width) {
  result.position = width;
}

std::shared_ptr<GripperCommand> makeCommand(GripperCommand::Kind kind) {
  auto command = std::make_shared<GripperCommand>();
  command->kind = kind;
  return command;
}

template <typename Server, typename Result>
void abort(Server& server, Result result, const std::string& text, double width) {
  explain(result, text, width);
  server.setAborted(result, text);
}

std::string millimeters(double meters) { return franka_core::fixedText(meters * 1e3, 3) + " mm"; }

}  // namespace

GripperActions::GripperActions(const ros::NodeHandle& node,
                               const GripperActionParameters& parameters, GripperMailbox& mailbox,
                               const GripperView& view)
    : parameters_(parameters),
      mailbox_(mailbox),
      view_(view),
      stop_server_(node, "stop", [this](const auto& /*goal*/) { stop(); }),
      homing_server_(node, "homing", [this](const auto& /*goal*/) { homing(); }),
      move_server_(
          node, "move", [this](const auto& goal) { move(goal); },
          [this](const auto& goal, auto& result) { return explained(moveFault(goal), result); }),
      grasp_server_(
          node, "grasp", [this](const auto& goal) { grasp(goal); },
          [this](const auto& goal, auto& result) { return explained(graspFault(goal), result); }),
      command_server_(
          node, "gripper_action", [this](const auto& goal) { gripperCommand(goal); },
          [this](const auto& goal, auto& result) {
            return explained(commandFault(goal), result);
          }) {
  stop_server_.start();
  homing_server_.start();
  move_server_.start();
  grasp_server_.start();
  command_server_.start();
}

GripperActions::~GripperActions() {
  ending_ = true;
  stop_server_.shutdown();
  homing_server_.shutdown();
  move_server_.shutdown();
  grasp_server_.shutdown();
  command_server_.shutdown();
}

template <typename Action>
GripperActions::Fate GripperActions::await(Server<Action>& server,
                                           const GripperCommand& command) const {
  // Wall time: while the simulation is paused ROS time stands still, and a shutdown must still
  // work.
  while (!command.isSettled() && !server.isPreemptRequested() && view_.controller_runs &&
         !ending_ && ros::ok()) {
    std::this_thread::sleep_for(kPoll);
  }
  return command.fate.load(std::memory_order_acquire);
}

template <typename Action, typename Result>
bool GripperActions::carryOut(Server<Action>& server,
                              const std::shared_ptr<GripperCommand>& command, Result& result) {
  if (!view_.controller_runs) {
    abort(server, result, kNotRunning, view_.width);
    return false;
  }
  mailbox_.post(command);
  const Fate fate = await(server, *command);
  if (fate == Fate::kSucceeded || fate == Fate::kFailed) {
    return true;
  }
  if (fate == Fate::kRefused) {
    abort(server, result, kRefused, view_.width);
  } else if (fate == Fate::kInterrupted) {
    abort(server, result, view_.controller_runs ? kInterrupted : kNotRunning, view_.width);
  } else if (server.isNewGoalAvailable()) {
    explain(result, kReplaced, view_.width);
    server.setPreempted(result, kReplaced);
  } else if (server.isPreemptRequested()) {
    const auto halt = makeCommand(GripperCommand::Kind::kStop);
    mailbox_.post(halt);
    for (int i = 0; i < kCancelPolls && !halt->isSettled(); ++i) {
      std::this_thread::sleep_for(kPoll);
    }
    explain(result, kCanceled, view_.width);
    server.setPreempted(result, kCanceled);
  } else {
    abort(server, result, view_.controller_runs ? "The simulation is shutting down." : kNotRunning,
          view_.width);
  }
  return false;
}

template <typename Result>
std::string GripperActions::explained(const std::string& fault, Result& result) const {
  if (!fault.empty()) {
    explain(result, fault, view_.width);
  }
  return fault;
}

std::string GripperActions::fingersFault(double width, double speed) const {
  return std::isfinite(speed) && speed > 0.0 ? widthFault(width) : "Only positive speeds allowed";
}

std::string GripperActions::widthFault(double width) const {
  if (std::isfinite(width) && width >= 0.0 && width <= parameters_.max_width) {
    return "";
  }
  return "The width " + franka_core::numberText(width) +
         " m is not possible: it must lie between 0 and " +
         franka_core::numberText(parameters_.max_width) + " m.";
}

std::string GripperActions::moveFault(const franka_gripper::MoveGoal& goal) const {
  return fingersFault(goal.width, goal.speed);
}

std::string GripperActions::graspFault(const franka_gripper::GraspGoal& goal) const {
  const std::string fault = fingersFault(goal.width, goal.speed);
  if (!fault.empty()) {
    return fault;
  }
  if (!(std::isfinite(goal.force) && goal.force >= 0.0)) {
    return "The force must be a finite number of newtons that is not negative.";
  }
  const bool possible = std::isfinite(goal.epsilon.inner) && std::isfinite(goal.epsilon.outer) &&
                        goal.epsilon.inner >= 0.0 && goal.epsilon.outer >= 0.0;
  return possible ? "" : "The epsilons must be finite and not negative.";
}

std::string GripperActions::commandFault(const control_msgs::GripperCommandGoal& goal) const {
  const double position = goal.command.position, effort = goal.command.max_effort;
  if (widthFault(2.0 * position).empty() && std::isfinite(effort)) {
    return "";
  }
  return "The goal is not possible: the position of a finger must lie between 0 and " +
         franka_core::numberText(parameters_.max_width / 2.0) + " m and is " +
         franka_core::numberText(position) + " m; max_effort must be finite and is " +
         franka_core::numberText(effort) + " N.";
}

void GripperActions::stop() {
  franka_gripper::StopResult result;
  if (carryOut(stop_server_, makeCommand(GripperCommand::Kind::kStop), result)) {
    result.success = true;
    stop_server_.setSucceeded(result);
  }
}

void GripperActions::homing() {
  franka_gripper::HomingResult result;
  const auto command = makeCommand(GripperCommand::Kind::kHoming);
  if (!carryOut(homing_server_, command, result)) {
    return;
  }
  if (command->fate == Fate::kSucceeded) {
    result.success = true;
    homing_server_.setSucceeded(result);
  } else {
    abort(homing_server_, result,
          "Homing did not reach the fingers' ends: something is between or beside them. They stand "
          "at " +
              millimeters(view_.width) + ".",
          view_.width);
  }
}

void GripperActions::move(const franka_gripper::MoveGoal& goal) {
  franka_gripper::MoveResult result;
  const auto command = makeCommand(GripperCommand::Kind::kMove);
  command->width = goal.width;
  command->speed = goal.speed;
  if (!carryOut(move_server_, command, result)) {
    return;
  }
  result.success = command->fate == Fate::kSucceeded;
  if (!result.success) {
    result.error = "The fingers stopped at " + millimeters(view_.width) + " instead of " +
                   millimeters(goal.width) + ": something is in their way.";
  }
  move_server_.setSucceeded(result);
}

void GripperActions::grasp(const franka_gripper::GraspGoal& goal) {
  franka_gripper::GraspResult result;
  const auto command = makeCommand(GripperCommand::Kind::kGrasp);
  command->width = goal.width;
  command->epsilon_inner = goal.epsilon.inner;
  command->epsilon_outer = goal.epsilon.outer;
  command->speed = goal.speed;
  command->force = goal.force;
  if (!carryOut(grasp_server_, command, result)) {
    return;
  }
  result.success = command->fate == Fate::kSucceeded;
  if (!result.success) {
    result.error = "The fingers came to rest at " + millimeters(view_.width) +
                   ", outside the expected " + millimeters(goal.width - goal.epsilon.inner) +
                   " to " + millimeters(goal.width + goal.epsilon.outer) +
                   ": there is no object between them, or another one than expected.";
  }
  grasp_server_.setSucceeded(result);
}

void GripperActions::gripperCommand(const control_msgs::GripperCommandGoal& goal) {
  control_msgs::GripperCommandResult result;
  const double width = 2.0 * goal.command.position;  // the message names one finger's position
  const double effort = goal.command.max_effort;
  const bool moves = std::abs(effort) < kNoEffort || width > view_.width;
  const auto command =
      makeCommand(moves ? GripperCommand::Kind::kMove : GripperCommand::Kind::kGrasp);
  command->width = width;
  command->speed = parameters_.gripper_action_speed;
  command->force = std::abs(effort);
  command->epsilon_inner = command->epsilon_outer = parameters_.gripper_action_width_tolerance;
  if (!carryOut(command_server_, command, result)) {
    return;
  }
  const bool reached = command->fate == Fate::kSucceeded;
  const bool holds = reached && !moves;
  result.position = view_.width;
  result.reached_goal = static_cast<unsigned char>(reached);
  // Fingers that hold an object, or that came to rest elsewhere.
  result.stalled = static_cast<unsigned char>(holds || !reached);
  result.effort = holds ? command->force : 0.0;
  if (reached) {
    command_server_.setSucceeded(result);
  } else {
    abort(command_server_, result,
          "The fingers stopped at " + millimeters(view_.width) + " instead of " +
              millimeters(width) + ": something is in their way, or there is nothing to grasp.",
          view_.width);
  }
}

}  // namespace franka_sim_mujoco

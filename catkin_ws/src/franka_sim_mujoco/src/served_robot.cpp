// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "served_robot.h"

#include <franka_core/robot_error.h>
#include <franka_msgs/SetLoad.h>
#include <franka_sim/physics/world.h>
#include <franka_sim/serve/operator_commands.h>
#include <franka_sim/serve/sim_robot.h>
#include <franka_sim_mujoco/GetServedRobot.h>
#include <franka_sim_mujoco/SetPacketDelay.h>
#include <franka_sim_mujoco/SetPacketLoss.h>
#include <ros/console.h>
#include <std_srvs/SetBool.h>

#include <algorithm>
#include <stdexcept>

#include "arm_parameters.h"
#include "robot_instance.h"

namespace franka_sim_mujoco {

namespace {

/// The configuration, which users of a real robot enter in Desk, is read from the same parameters
/// as for controllers in this process; the behavior is that of the FCI.
franka_sim::fci::SimRobot makeRobot(const RobotPlan& plan, const RobotHandle& robot) {
  const SimulatedArm& arm = plan.arms.front();
  if (arm.type.empty()) {
    throw std::runtime_error("its URDF has no joint '" + arm.arm_id +
                             "_joint1'. Does the parameter arm_id ('" + arm.arm_id +
                             "') say the same as the URDF's argument arm_id?");
  }
  if (plan.arms.size() > 1) {
    throw std::runtime_error("it has the arms '" + arm.arm_id + "' and '" + plan.arms[1].arm_id +
                             "', and one address is that of one arm. Give each arm a description "
                             "and a namespace of its own.");
  }
  const franka_sim::ControlUnitParameters unit =
      readArmParameters(ros::NodeHandle(plan.robot_namespace), robot, arm);
  franka_sim::ArmPlant* plant = nullptr;
  std::optional<franka_sim::fci::SimRobot::Hand> hand;
  robot.between_ticks([&] {
    plant = &robot.world->arm(robot.name, arm.arm_id);
    if (unit.has_hand) {
      hand =
          franka_sim::fci::makeHand(robot.world->hand(robot.name, arm.arm_id), arm.physics.gripper);
    }
  });
  return franka_sim::fci::makeSimRobot(plan.fci_ip, franka_sim::protocolsOf(arm.type), unit, *plant,
                                       hand, {}, arm.physics.command_delay);
}

void fill(franka_sim::fci::SimRobot& robot, GetServedRobot::Response& response) {
  const franka_core::RobotState& state = robot.unit().state();
  response.text = franka_sim::fci::describe(robot);
  response.mode = static_cast<std::uint8_t>(state.robot_mode);
  response.protocol = robot.clientVersion();
  for (std::size_t i = 0; i < state.errors.size(); ++i) {
    if (state.errors[i]) {
      response.errors.emplace_back(franka_core::kErrorNames[i]);
    }
  }
  response.hash = robot.hash();
  std::copy(state.q.begin(), state.q.end(), response.q.begin());
}

}  // namespace

ServedRobot::ServedRobot(const RobotPlan& plan, const RobotHandle& robot,
                         const OperatorAccess& access)
    : between_ticks_(robot.between_ticks),
      robot_(makeRobot(plan, robot)),
      services_(ros::NodeHandle(ros::NodeHandle(plan.robot_namespace), "franka_sim")) {
  const auto warn = [name = robot.name](const std::string& what) {
    ROS_WARN_STREAM("Robot '" << name << "': " << what);
  };
  robot_.onCollision(warn);
  robot_.onRefusal(warn);
  robot_.onSilence(warn);
  if (plan.locked) {
    robot_.whole().start(franka_sim::SafetyRules::kDesk);
    robot_.serve(true);  // closes its ports before a client can connect
  }
  franka_sim::addOperatorCommands(
      commands_, {robot_, plan.arms.front().arm_id, access.host, *robot.world, access.scene,
                  access.reset, access.quit});
  if (plan.control_port != 0) {
    openControlInterface(plan);
  }
  offerSwitches();
  offerLink();
  offerStates();
}

void ServedRobot::openControlInterface(const RobotPlan& plan) {
  lines_ = std::make_unique<franka_sim::fci::LineServer>(plan.fci_ip, plan.control_port, commands_);
  if (plan.has_desk) {
    lines_->serveOwnUserOnly();
  }
}

void ServedRobot::addTo(franka_sim::fci::Host& host) {
  host.add(robot_);
  if (lines_) {
    host.add(*lines_);
  }
}

void ServedRobot::removeFrom(franka_sim::fci::Host& host) noexcept {
  host.remove(robot_);
  if (lines_) {
    host.remove(*lines_);
    lines_.reset();
  }
}

template <typename Service>
void ServedRobot::offer(
    const std::string& name,
    std::function<void(typename Service::Request&, typename Service::Response&)> handler) {
  services_.offer<Service>(name, [this, handler](typename Service::Request& request,
                                                 typename Service::Response& response) {
    between_ticks_([&] { handler(request, response); });
  });
}

// A line whose effect does not take time. @throws std::exception with a sentence
void ServedRobot::execute(const std::string& line) const { commands_.execute(line).value(); }

void ServedRobot::offerSwitch(const std::string& name, const std::string& line_on,
                              const std::string& line_off) {
  offer<std_srvs::SetBool>(name, [this, line_on, line_off](auto& request, auto& /*response*/) {
    execute(request.data != 0 ? line_on : line_off);
  });
}

void ServedRobot::offerSwitches() {
  offerSwitch("set_user_stop", "user_stop on", "user_stop off");
  offerSwitch("set_guiding", "guiding on", "guiding off");
  offerSwitch("set_fci", "fci on", "fci off");
  offerSwitch("set_brakes", "brakes close", "brakes open");
}

void ServedRobot::offerLink() {
  offer<SetPacketLoss>("set_packet_loss", [this](auto& request, auto& /*response*/) {
    robot_.link().setLoss(request.probability, request.seed);
    robot_.link().loseNext(request.next);
  });
  offer<SetPacketDelay>("set_packet_delay", [this](auto& request, auto& /*response*/) {
    robot_.link().setDelay(request.ticks);
  });
}

void ServedRobot::offerStates() {
  offer<franka_msgs::SetLoad>("set_load", [this](auto& request, auto& /*response*/) {
    franka_core::Payload load{request.mass, {}, {}};
    std::copy(request.F_x_center_load.begin(), request.F_x_center_load.end(), load.com.begin());
    std::copy(request.load_inertia.begin(), request.load_inertia.end(), load.inertia.begin());
    franka_sim::fci::setLoad(robot_, load);
  });
  offer<GetServedRobot>("get_state",
                        [this](auto& /*request*/, auto& response) { fill(robot_, response); });
}

}  // namespace franka_sim_mujoco

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/numbers.h>
#include <franka_sim/physics/physics_config.h>
#include <franka_sim/physics/world.h>
#include <franka_sim/robot/realism.h>
#include <ros/console.h>
#include <transmission_interface/transmission_parser.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "arm_parameters.h"
#include "param_reader.h"
#include "plugin_element.h"
#include "resources.h"
#include "robot_instance.h"
#include "service_handlers.h"

namespace franka_sim_mujoco {

namespace {

constexpr std::int64_t kFirstFciPort = 1337;  // robot, gripper, vacuum gripper
constexpr std::int64_t kLastFciPort = 1339;

/// "panda" or "fr3"; the result and its reason are logged. @param name of arm or robot in the log
std::string chooseRobotType(const ros::NodeHandle& node, const urdf::Model& urdf,
                            const std::string& arm_id, const std::string& name) {
  const std::string parameter = node.resolveName("robot_type");
  const std::optional<std::string> configured = readString(node, "robot_type");
  if (configured && !isRobotType(*configured)) {
    throw std::invalid_argument("The parameter " + parameter + " is '" + *configured +
                                "'; it must be panda or fr3.");
  }
  const RobotType type = determineRobotType(configured, urdf, arm_id);
  if (!type.warning.empty()) {
    ROS_WARN_NAMED(kLog, "'%s' is simulated as %s, as the parameter %s says, although %s.",
                   name.c_str(), type.name.c_str(), parameter.c_str(), type.warning.c_str());
  } else {
    ROS_INFO_NAMED(kLog, "'%s' is simulated as %s: %s (parameter %s).", name.c_str(),
                   type.name.c_str(), type.why.c_str(), parameter.c_str());
  }
  return type.name;
}

/// As in Gazebo's spawner: the robotNamespace of the description, or that of the order if there is
/// none.
std::string chooseNamespace(const SpawnOrder& order, const PluginElement& plugin) {
  const std::string& own = plugin.robot_namespace;
  if (own.empty()) {
    return order.robot_namespace.empty() ? "/" : order.robot_namespace;
  }
  std::string why;
  if (!order.robot_namespace.empty() && ros::names::validate(own, why) &&
      ros::names::resolve(own) != ros::names::resolve(order.robot_namespace)) {
    ROS_WARN_NAMED(kLog,
                   "'%s' uses the namespace %s, which is the robotNamespace of its description, "
                   "not %s: its parameters and controllers are searched there.",
                   order.name.c_str(), ros::names::resolve(own).c_str(),
                   order.robot_namespace.c_str());
  }
  return own;
}

/// Omits positions of joints that the robot does not have, with a warning: the original's launch
/// files name the fingers even if there is no hand.
std::map<std::string, double> knownPositions(const SpawnOrder& order, const urdf::Model& model) {
  std::map<std::string, double> known;
  std::string unknown;
  for (const auto& [joint, position] : order.initial_positions) {
    const urdf::JointConstSharedPtr described = model.getJoint(joint);
    if (!described || described->type == urdf::Joint::FIXED) {
      unknown += (unknown.empty() ? "" : ", ") + joint;
      continue;
    }
    if (!std::isfinite(position)) {
      throw std::runtime_error("The initial position of '" + joint + "' is not a finite number.");
    }
    known[joint] = position;
  }
  if (!unknown.empty()) {
    ROS_WARN_NAMED(kLog,
                   "The robot '%s' does not move these joints, for which initial positions were "
                   "given: %s. They are ignored.",
                   order.name.c_str(), unknown.c_str());
  }
  return known;
}

void readServing(const ros::NodeHandle& node, RobotPlan* plan) {
  plan->fci_ip = readString(node, "fci_ip").value_or("");
  const auto port = franka_core::wholeNumber(
      readNumber(node, "control_port").value_or(plan->control_port), 0, 65535);
  if (!port || (*port >= kFirstFciPort && *port <= kLastFciPort)) {
    throw std::runtime_error("The parameter " + node.resolveName("control_port") +
                             " is not a port for the control interface: give 0 for none, or 1 to "
                             "65535 without the robot's own ports 1337 to 1339.");
  }
  plan->control_port = static_cast<std::uint16_t>(*port);
  plan->has_desk = readBool(node, "desk").value_or(false);
  const std::string start = readString(node, "fci_start").value_or("ready");
  if (start != "ready" && start != "locked") {
    throw std::runtime_error("The parameter " + node.resolveName("fci_start") + " is '" + start +
                             "'; it must be ready or locked.");
  }
  plan->locked = start == "locked";
}

/// An arm's services are below its name, in which ROS does not take all that a URDF does.
std::string namespaceOf(std::string arm_id) {
  const auto is_refused = [](unsigned char c) { return std::isalnum(c) == 0; };
  std::replace_if(arm_id.begin(), arm_id.end(), is_refused, '_');
  return arm_id;
}

/// @param name in the log. @throw std::runtime_error if another arm has its services there.
void addArm(const ros::NodeHandle& node, const std::string& arm_id, const std::string& name,
            const std::string& service_namespace, RobotPlan* plan) {
  for (const SimulatedArm& other : plan->arms) {
    if (other.service_namespace == service_namespace) {
      throw std::runtime_error("The services of the arms '" + other.arm_id + "' and '" + arm_id +
                               "' would both be below '" + service_namespace +
                               "': ROS takes letters, digits and _ only. Rename one of them.");
    }
  }
  SimulatedArm arm{arm_id, "", {}, service_namespace};
  if (plan->urdf.getJoint(arm_id + "_joint1")) {
    const bool served = !plan->fci_ip.empty();
    arm.type = chooseRobotType(node, plan->urdf, arm_id, name);
    arm.physics = readPhysics(node, arm.type,
                              served ? franka_sim::kServedProfile : franka_sim::kInProcessProfile);
    franka_sim::applyPhysics(arm.physics, arm_id, plan->description);
    if (served) {
      // As a real robot, it rests with a small distance from its initial positions.
      franka_sim::applyRestOffset(franka_sim::kJointStiffness, arm_id, plan->description);
    }
  }
  plan->arms.push_back(std::move(arm));
}

}  // namespace

RobotPlan planRobot(const SpawnOrder& order) {
  RobotPlan plan;
  if (order.name.empty()) {
    throw std::runtime_error("A robot needs a name.");
  }
  if (!plan.urdf.initString(franka_sim::withHeldJoints(order.urdf))) {
    throw std::runtime_error(
        "The robot description of '" + order.name +
        "' is not a URDF that can be read; the lines above in the log say why.");
  }
  const PluginElement plugin = readPluginElement(order.urdf, order.robot_namespace);
  plan.control_ticks = plugin.control_ticks;
  plan.robot_namespace = chooseNamespace(order, plugin);
  std::string why;
  if (!ros::names::validate(plan.robot_namespace, why)) {
    throw std::runtime_error("'" + plan.robot_namespace + "' is not a valid namespace: " + why);
  }
  const ros::NodeHandle node(plan.robot_namespace);
  readServing(node, &plan);
  plan.hardware_type = plan.fci_ip.empty() ? plugin.hardware_type : "";
  if (!plan.hardware_type.empty() &&
      !transmission_interface::TransmissionParser::parse(order.urdf, plan.transmissions)) {
    throw std::runtime_error("The transmissions of '" + order.name + "' cannot be read.");
  }

  std::istringstream names(readString(node, "awaited_controllers").value_or(""));
  plan.awaited_controllers.assign(std::istream_iterator<std::string>(names), {});
  plan.publish_transforms = readBool(node, "publish_transforms").value_or(false);
  plan.joint_state_rate = readNumber(node, "joint_state_rate");
  if (plan.joint_state_rate &&
      !(*plan.joint_state_rate > 0.0 && *plan.joint_state_rate <= 1000.0)) {
    throw std::runtime_error("The parameter " + node.resolveName("joint_state_rate") + " is " +
                             franka_core::numberText(*plan.joint_state_rate) +
                             " Hz; it must be above 0 and at most 1000 Hz.");
  }

  plan.description.name = order.name;
  plan.description.urdf = order.urdf;
  plan.description.resolve = resolveUri;
  plan.description.base = order.pose;
  plan.description.initial_positions = knownPositions(order, plan.urdf);
  if (plugin.arms.size() > 1) {
    for (const std::string& arm_id : plugin.arms) {
      addArm(node, arm_id, arm_id, namespaceOf(arm_id), &plan);
    }
  } else {
    addArm(node, readArmId(node, plan.robot_namespace, order.name), order.name, "", &plan);
  }
  return plan;
}

}  // namespace franka_sim_mujoco

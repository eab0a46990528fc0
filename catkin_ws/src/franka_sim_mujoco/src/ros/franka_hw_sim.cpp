// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim_mujoco/physics/world.h>
#include <franka_sim_mujoco/ros/arm_parameters.h>
#include <franka_sim_mujoco/ros/controller_check.h>
#include <franka_sim_mujoco/ros/franka_hw_sim.h>
#include <franka_sim_mujoco/ros/param_reader.h>
#include <ros/console.h>

#include <algorithm>
#include <cmath>
#include <pluginlib/class_list_macros.hpp>
#include <set>
#include <stdexcept>
#include <utility>

namespace franka_sim_mujoco {

namespace {

constexpr char kLog[] = "franka_hw_sim";
constexpr double kDefaultTauExtLowpassFilter = 1.0;
constexpr double kReportPeriod = 1.0;  ///< [s]

using transmission_interface::TransmissionInfo;

/// Names with and without the package in front are both in use.
bool namesInterface(const std::string& found, const std::string& wanted) {
  return found == wanted || found == "hardware_interface/" + wanted;
}

double readFilter(const ros::NodeHandle& node) {
  const double alpha =
      readNumber(node, "tau_ext_lowpass_filter").value_or(kDefaultTauExtLowpassFilter);
  if (alpha < 0.0 || alpha > 1.0) {
    throw std::invalid_argument("The parameter " + node.resolveName("tau_ext_lowpass_filter") +
                                " is " + std::to_string(alpha) +
                                "; it must lie between 0 (nothing passes) and 1 (no filter).");
  }
  return alpha;
}

/// The world's gravity in the axes of the arm's base.
std::array<double, 3> gravityInBase(World& world, const std::string& base) {
  const std::array<double, 3> g = world.gravity();
  const std::array<double, 4> q = world.bodyPose(base).orientation;
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  return {
      (1 - 2 * (y * y + z * z)) * g[0] + 2 * (x * y + w * z) * g[1] + 2 * (x * z - w * y) * g[2],
      2 * (x * y - w * z) * g[0] + (1 - 2 * (x * x + z * z)) * g[1] + 2 * (y * z + w * x) * g[2],
      2 * (x * z + w * y) * g[0] + 2 * (y * z - w * x) * g[1] + (1 - 2 * (x * x + y * y)) * g[2]};
}

}  // namespace

FrankaHWSim::FrankaHWSim() = default;
FrankaHWSim::~FrankaHWSim() = default;

bool FrankaHWSim::initSim(const std::string& robot_namespace, ros::NodeHandle model_nh,
                          RobotHandle robot, const urdf::Model* urdf_model,
                          std::vector<TransmissionInfo> transmissions) {
  try {
    if (robot.world == nullptr || urdf_model == nullptr) {
      throw std::invalid_argument("it was given no world or no robot model");
    }
    arm_id_ = readArmId(model_nh, robot_namespace, robot.name);
    start(model_nh, robot, *urdf_model, transmissions);
    return true;
  } catch (const std::exception& error) {
    failure_ = error.what();
    return false;
  }
}

void FrankaHWSim::start(const ros::NodeHandle& node, const RobotHandle& robot,
                        const urdf::Model& model,
                        const std::vector<TransmissionInfo>& transmissions) {
  World& world = *robot.world;
  const bool has_hand = world.hasHand(robot.name, arm_id_);
  nameJoints(model, has_hand);
  ControlUnitParameters parameters =
      readArmParameters(node, robot.urdf, arm_id_, model.getLink(arm_id_ + "_hand") != nullptr,
                        gravityInBase(world, arm_id_ + "_link0"));
  parameters.setters_in_motion = true;
  parameters.substeps = World::kSubsteps;
  parameters.rotor_inertia = robot.arm_physics.rotor_inertia;
  parameters.coulomb_friction = robot.arm_physics.coulomb_friction;
  parameters.viscous_friction = robot.arm_physics.damping;
  arm_ = std::make_unique<SimArm>(parameters, world.arm(robot.name, arm_id_), readFilter(node));
  hand_ = has_hand ? &world.hand(robot.name, arm_id_) : nullptr;

  singularity_threshold_ = readNumber(node, "singularity_warning_threshold").value_or(-1.0);
  for (const TransmissionInfo& transmission : transmissions) {
    addTransmission(transmission, model);
  }
  checkComplete();
  registerAll();

  const bool restart_controllers =
      readBool(node, "restart_controllers_after_recovery").value_or(true);
  services_ =
      std::make_unique<ArmServices>(node, arm_id_, *arm_, robot.between_ticks, restart_controllers);
  initialized_ = std::make_unique<realtime_tools::RealtimePublisher<std_msgs::Bool>>(
      node, "initialized", 1, true);
  publishInitialized(false);
  reporter_ = node.createWallTimer(ros::WallDuration(kReportPeriod),
                                   [this](const ros::WallTimerEvent& /*event*/) { report(); });
}

void FrankaHWSim::nameJoints(const urdf::Model& model, bool has_hand) {
  for (std::size_t i = 0; i < kArmJoints; ++i) {
    joints_[i].name = arm_id_ + "_joint" + std::to_string(i + 1);
    if (!model.getJoint(joints_[i].name)) {
      throw std::invalid_argument("its URDF has no joint '" + joints_[i].name +
                                  "'. Does the parameter arm_id ('" + arm_id_ +
                                  "') say the same as the URDF's argument arm_id?");
    }
  }
  if (has_hand) {
    joints_[kArmJoints].name = arm_id_ + "_finger_joint1";
    joints_[kArmJoints + 1].name = arm_id_ + "_finger_joint2";
  }
}

FrankaHWSim::Joint* FrankaHWSim::findJoint(const std::string& name) {
  const auto joint = std::find_if(joints_.begin(), joints_.end(),
                                  [&](const Joint& candidate) { return candidate.name == name; });
  return joint == joints_.end() || name.empty() ? nullptr : &*joint;
}

void FrankaHWSim::addTransmission(const TransmissionInfo& transmission, const urdf::Model& model) {
  if (transmission.type_ == "transmission_interface/SimpleTransmission") {
    addJoint(transmission, model);
  } else if (transmission.type_ == "franka_hw/FrankaStateInterface") {
    addState(transmission, model);
  } else if (transmission.type_ == "franka_hw/FrankaModelInterface") {
    addModel(transmission, model);
  } else {
    ROS_WARN_NAMED(kLog,
                   "%s: the transmission '%s' has the type '%s', which is not simulated: ignored.",
                   arm_id_.c_str(), transmission.name_.c_str(), transmission.type_.c_str());
  }
}

void FrankaHWSim::addJoint(const TransmissionInfo& transmission, const urdf::Model& model) {
  if (transmission.joints_.size() != 1) {
    throw std::invalid_argument("the transmission '" + transmission.name_ +
                                "' must have one joint but has " +
                                std::to_string(transmission.joints_.size()) + ".");
  }
  const auto& info = transmission.joints_.front();
  Joint* joint = findJoint(info.name_);
  if (joint == nullptr) {
    if (!model.getJoint(info.name_)) {
      throw std::invalid_argument("the transmission '" + transmission.name_ +
                                  "' names the joint '" + info.name_ +
                                  "', which the URDF does not have.");
    }
    ROS_WARN_NAMED(kLog,
                   "%s: the joint '%s' of the transmission '%s' is none of this arm's: ignored.",
                   arm_id_.c_str(), info.name_.c_str(), transmission.name_.c_str());
    return;
  }
  joint->has_state = true;
  for (const std::string& interface : info.hardware_interfaces_) {
    if (namesInterface(interface, "EffortJointInterface")) {
      joint->has_effort = true;
    } else if (namesInterface(interface, "PositionJointInterface") ||
               namesInterface(interface, "VelocityJointInterface")) {
      ROS_DEBUG_NAMED(kLog, "%s: %s is not simulated.", info.name_.c_str(), interface.c_str());
    } else if (!namesInterface(interface, "JointStateInterface")) {
      ROS_WARN_NAMED(kLog, "%s: the hardware interface '%s' of the joint '%s' is unknown: ignored.",
                     arm_id_.c_str(), interface.c_str(), info.name_.c_str());
    }
  }
}

void FrankaHWSim::addState(const TransmissionInfo& transmission, const urdf::Model& model) {
  std::set<std::string> names;
  for (const auto& joint : transmission.joints_) {
    if (!model.getJoint(joint.name_)) {
      throw std::invalid_argument("the transmission '" + transmission.name_ +
                                  "' names the joint '" + joint.name_ +
                                  "', which the URDF does not have.");
    }
    names.insert(joint.name_);
  }
  if (transmission.joints_.size() != kArmJoints || names.size() != kArmJoints) {
    throw std::invalid_argument(
        "the transmission '" + transmission.name_ +
        "' (franka_hw/FrankaStateInterface) must have the arm's 7 joints but has " +
        std::to_string(transmission.joints_.size()) + ".");
  }
  franka_states_.registerHandle(franka_hw::FrankaStateHandle(arm_id_ + "_robot", arm_->state()));
}

void FrankaHWSim::addModel(const TransmissionInfo& transmission, const urdf::Model& model) {
  const std::string who =
      "the transmission '" + transmission.name_ + "' (franka_hw/FrankaModelInterface) ";
  if (transmission.joints_.size() != 2) {
    throw std::invalid_argument(who +
                                "must have two joints, with the roles root and tip, but has " +
                                std::to_string(transmission.joints_.size()) + ".");
  }
  const auto jointOfRole = [&](const std::string& role) {
    for (const auto& joint : transmission.joints_) {
      if (joint.role_ == role) {
        const auto found = model.getJoint(joint.name_);
        if (!found) {
          throw std::invalid_argument(who + "names the joint '" + joint.name_ +
                                      "', which the URDF does not have.");
        }
        return found;
      }
    }
    throw std::invalid_argument(who + "has no joint with the role '" + role + "'.");
  };
  const std::string root = jointOfRole("root")->parent_link_name;
  const std::string tip = jointOfRole("tip")->child_link_name;
  model_ = std::make_unique<franka_hw::ModelKDL>(model, root, tip, singularity_threshold_);
  franka_models_.registerHandle(
      franka_hw::FrankaModelHandle(arm_id_ + "_model", *model_, arm_->state()));
}

void FrankaHWSim::checkComplete() const {
  for (std::size_t i = 0; i < kArmJoints; ++i) {
    if (!joints_[i].has_effort) {
      throw std::invalid_argument(
          "its URDF declares no transmission with an EffortJointInterface for '" + joints_[i].name +
          "'. Was it made with the xacro argument gazebo:=true?");
    }
  }
  if (franka_states_.getNames().size() != 1 || !model_) {
    throw std::invalid_argument(
        "its URDF must declare one transmission of the type franka_hw/FrankaStateInterface and one "
        "of the "
        "type franka_hw/FrankaModelInterface. Was it made with the xacro argument gazebo:=true?");
  }
}

void FrankaHWSim::registerAll() {
  for (Joint& joint : joints_) {
    if (!joint.has_state) {
      continue;
    }
    joint_states_.registerHandle(hardware_interface::JointStateHandle(
        joint.name, &joint.position, &joint.velocity, &joint.effort));
    if (joint.has_effort) {
      efforts_.registerHandle(
          hardware_interface::JointHandle(joint_states_.getHandle(joint.name), &joint.command));
    }
  }
  registerInterface(&joint_states_);
  registerInterface(&efforts_);
  registerInterface(&franka_states_);
  registerInterface(&franka_models_);
}

void FrankaHWSim::readSim(ros::Time time, ros::Duration /*period*/) {
  arm_->read(time);
  const franka::RobotState& state = arm_->state();
  for (std::size_t i = 0; i < kArmJoints; ++i) {
    joints_[i].position = state.q[i];
    joints_[i].velocity = state.dq[i];
    joints_[i].effort = state.tau_J[i];
  }
  if (hand_ != nullptr) {
    const HandMeasurement fingers = hand_->measure();
    for (std::size_t i = 0; i < 2; ++i) {
      joints_[kArmJoints + i].position = fingers.q[i];
      joints_[kArmJoints + i].velocity = fingers.dq[i];
      joints_[kArmJoints + i].effort = joints_[kArmJoints + i].command;
    }
  }
  if (!initialized_published_) {
    publishInitialized(true);
  }
}

void FrankaHWSim::writeSim(ros::Time /*time*/, ros::Duration /*period*/) {
  std::array<double, kArmJoints> torque;
  for (std::size_t i = 0; i < kArmJoints; ++i) {
    torque[i] = joints_[i].command;
  }
  arm_->write(torque);
  if (hand_ != nullptr) {
    std::array<double, 2> force{};
    for (std::size_t i = 0; i < 2; ++i) {
      const double command = joints_[kArmJoints + i].command;
      force[i] = std::isfinite(command) ? command : 0.0;
    }
    hand_->applyForces(force);
  }
}

void FrankaHWSim::worldWasReset() {
  arm_->worldWasReset();
  for (Joint& joint : joints_) {
    joint.command = 0.0;
  }
}

bool FrankaHWSim::prepareSwitch(
    const std::list<hardware_interface::ControllerInfo>& start_list,
    const std::list<hardware_interface::ControllerInfo>& /*stop_list*/) {
  for (const auto& controller : start_list) {
    const std::string reason = whyRefused(controller, arm_id_);
    if (!reason.empty()) {
      ROS_ERROR_NAMED(kLog, "%s", reason.c_str());
      return false;
    }
  }
  if (arm_->userStopped() && anyCommandsArm(start_list, arm_id_)) {
    ROS_WARN_NAMED(
        kLog,
        "%s: the user stop is pressed: the controller starts but has no effect before the stop is "
        "released and franka_control/error_recovery called.",
        arm_id_.c_str());
  }
  return true;
}

void FrankaHWSim::doSwitch(const std::list<hardware_interface::ControllerInfo>& start_list,
                           const std::list<hardware_interface::ControllerInfo>& stop_list) {
  const bool starts = anyCommandsArm(start_list, arm_id_);
  const bool stops = anyCommandsArm(stop_list, arm_id_);
  const bool restarts = start_list.empty() && stop_list.empty();
  if (starts || stops || restarts) {
    // The last torque of a controller that went must not act on.
    for (std::size_t i = 0; i < kArmJoints; ++i) {
      joints_[i].command = 0.0;
    }
  }
  if (stops) {
    arm_->controlStops();
  }
  if (starts) {
    arm_->controlStarts();
  } else if (restarts) {
    arm_->controlRestarts();
  }
}

void FrankaHWSim::publishInitialized(bool initialized) {
  if (initialized_->trylock()) {
    initialized_->msg_.data = initialized;
    initialized_->unlockAndPublish();
    initialized_published_ = initialized;
  }
}

void FrankaHWSim::report() {
  const std::uint64_t refused = arm_->refusedCommands();
  if (refused != reported_commands_) {
    ROS_WARN_NAMED(
        kLog,
        "%s: %llu torque commands were not finite numbers and have been ignored: the running "
        "controller computes NaN or infinity.",
        arm_id_.c_str(), static_cast<unsigned long long>(refused - reported_commands_));
    reported_commands_ = refused;
  }
  if (model_->takeSingularityWarning()) {
    ROS_WARN_NAMED(kLog,
                   "%s: the arm is close to a singularity (singularity_warning_threshold %g).",
                   arm_id_.c_str(), singularity_threshold_);
  }
}

}  // namespace franka_sim_mujoco

PLUGINLIB_EXPORT_CLASS(franka_sim_mujoco::FrankaHWSim, franka_sim_mujoco::RobotHWSim)

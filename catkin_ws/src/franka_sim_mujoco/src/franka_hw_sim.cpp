// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/lowpass_filter.h>
#include <franka_core/numbers.h>
#include <franka_core/robot_error.h>
#include <franka_core/transform.h>
#include <franka_sim/physics/world.h>
#include <franka_sim/physics/world_joints.h>
#include <franka_sim/robot/control_unit.h>
#include <franka_sim/serve/sim_robot.h>
#include <franka_sim_mujoco/franka_hw_sim.h>
#include <ros/console.h>

#include <algorithm>
#include <cmath>
#include <pluginlib/class_list_macros.hpp>
#include <stdexcept>
#include <utility>

#include "arm_parameters.h"
#include "controller_check.h"
#include "param_reader.h"
#include "service_handlers.h"

namespace franka_sim_mujoco {

namespace {

constexpr double kDefaultTauExtLowpassFilter = 1.0;
constexpr double kReportPeriod = 1.0;  ///< [s]

using franka_hw::ControlMode;
using transmission_interface::TransmissionInfo;

double readFilter(const ros::NodeHandle& node) {
  const double alpha =
      readNumber(node, "tau_ext_lowpass_filter").value_or(kDefaultTauExtLowpassFilter);
  if (alpha < 0.0 || alpha > 1.0) {
    throw std::invalid_argument("The parameter " + node.resolveName("tau_ext_lowpass_filter") +
                                " is " + franka_core::numberText(alpha) +
                                "; it must lie between 0 (nothing passes) and 1 (no filter).");
  }
  return alpha;
}

double readCutoff(const ros::NodeHandle& node) {
  const double cutoff =
      readNumber(node, "cutoff_frequency").value_or(franka::kDefaultCutoffFrequency);
  if (!(cutoff > 0.0)) {
    throw std::invalid_argument("The parameter " + node.resolveName("cutoff_frequency") + " is " +
                                franka_core::numberText(cutoff) +
                                " Hz; it must be positive (from 1000 on nothing is filtered).");
  }
  return cutoff;
}

franka_core::ControllerMode readController(const ros::NodeHandle& node) {
  const std::string name = readString(node, "internal_controller").value_or("joint_impedance");
  if (name == "joint_impedance") {
    return franka_core::ControllerMode::kJointImpedance;
  }
  if (name == "cartesian_impedance") {
    return franka_core::ControllerMode::kCartesianImpedance;
  }
  throw std::invalid_argument("The parameter " + node.resolveName("internal_controller") + " is '" +
                              name + "'; it must be joint_impedance or cartesian_impedance.");
}

SimArmOptions readOptions(const ros::NodeHandle& node, bool reflexes) {
  SimArmOptions options;
  options.filter_alpha = readFilter(node);
  options.shaping.rate_limiting = readBool(node, "rate_limiting").value_or(true);
  options.shaping.cutoff_frequency = readCutoff(node);
  options.shaping.torques = reflexes;
  options.internal_controller = readController(node);
  return options;
}

void warnOfGains(const ros::NodeHandle& node, const std::string& arm_id) {
  const std::string gains = gainsWithoutEffect(node, arm_id);
  if (!gains.empty()) {
    ROS_WARN_NAMED(kHardwareLog,
                   "%s: these parameters have no effect: %s. The robot's own controller follows "
                   "positions and velocities; only position/gains/*/p counts, as its stiffness "
                   "[Nm/rad], and its damping follows from that.",
                   arm_id.c_str(), gains.c_str());
  }
}

/// Whether the fingers are a hand's, which takes efforts. Those with other interfaces, as in
/// descriptions of 2018, are driven as joints of any other device.
bool fingersTakeEfforts(const std::string& arm_id,
                        const std::vector<TransmissionInfo>& transmissions) {
  for (const TransmissionInfo& transmission : transmissions) {
    for (const auto& joint : transmission.joints_) {
      for (const std::string& interface : joint.hardware_interfaces_) {
        if (joint.name_.rfind(arm_id + "_finger_joint", 0) == 0 &&
            (interface.find("PositionJoint") != std::string::npos ||
             interface.find("VelocityJoint") != std::string::npos)) {
          return false;
        }
      }
    }
  }
  return true;
}

/// Details in parentheses, if there are more than the error's name.
std::string detailOf(const SimArm::Abort& abort, std::size_t error) {
  std::string detail;
  if (error == franka_core::indexOf(franka_core::RobotError::kJointReflex) &&
      abort.joint_collision.happened) {
    detail = franka_sim::describeJointCollision(abort.joint_collision);
  } else if (error == franka_core::indexOf(franka_core::RobotError::kCartesianReflex) &&
             abort.cartesian_collision.happened) {
    detail = franka_sim::describeCartesianCollision(abort.cartesian_collision,
                                                    franka_sim::InterfaceRules::kRosControl);
  } else if (error ==
             franka_core::indexOf(
                 franka_core::RobotError::kCartesianPositionMotionGeneratorInvalidFrameFlag)) {
    detail = "of the commanded pose " + franka_core::transformFault(abort.pose);
  }
  return detail.empty() ? "" : " (" + detail + ")";
}

std::string describe(const SimArm::Abort& abort) {
  std::string text;
  for (std::size_t i = 0; i < franka_core::kErrorNames.size(); ++i) {
    if (abort.errors[i]) {
      text += (text.empty() ? "" : ", ") + std::string(franka_core::kErrorNames[i]) +
              detailOf(abort, i);
    }
  }
  return text;
}

}  // namespace

FrankaHWSim::FrankaHWSim() = default;
FrankaHWSim::~FrankaHWSim() = default;

bool FrankaHWSim::initSim(const std::string& /*robot_namespace*/, ros::NodeHandle model_nh,
                          RobotHandle robot, const urdf::Model* urdf_model,
                          std::vector<TransmissionInfo> transmissions) {
  try {
    if (robot.world == nullptr || urdf_model == nullptr || robot.arms.size() != 1) {
      throw std::invalid_argument("it was given no world, no robot model or not one arm");
    }
    arm_id_ = robot.arms.front().arm_id;
    between_ticks_ = robot.between_ticks;
    start(model_nh, robot, *urdf_model, transmissions);
    return true;
  } catch (...) {
    failure_ = exceptionText();
    return false;
  }
}

void FrankaHWSim::start(const ros::NodeHandle& node, const RobotHandle& robot,
                        const urdf::Model& model,
                        const std::vector<TransmissionInfo>& transmissions) {
  franka_sim::World& world = *robot.world;
  bool has_hand = false;
  robot.between_ticks([&] { has_hand = world.hasHand(robot.name, arm_id_); });
  has_hand = has_hand && fingersTakeEfforts(arm_id_, transmissions);
  nameJoints(model, has_hand);
  franka_sim::ControlUnitParameters parameters = readArmParameters(node, robot, robot.arms.front());
  parameters.rules = readBool(node, "reflexes").value_or(false)
                         ? franka_sim::InterfaceRules::kRosControlWithReflexes
                         : franka_sim::InterfaceRules::kRosControl;
  SimArmOptions options = readOptions(node, hasReflexes(parameters.rules));
  options.control_ticks = robot.control_ticks;
  franka_sim::ArmPlant* plant = nullptr;
  robot.between_ticks([&] {
    plant = &world.arm(robot.name, arm_id_);
    hand_ = has_hand ? &world.hand(robot.name, arm_id_) : nullptr;
  });
  arm_ = std::make_unique<SimArm>(parameters, *plant, options);
  arm_->unit().request(franka_core::fci::SetJointImpedanceRequest{
      readJointStiffness(node, arm_id_, parameters.joint_stiffness)});
  warnOfGains(node, arm_id_);

  singularity_threshold_ = readNumber(node, "singularity_warning_threshold").value_or(-1.0);
  devices_ = std::make_unique<DeviceJoints>(node, robot);
  for (const TransmissionInfo& transmission : transmissions) {
    addTransmission(transmission, model);
  }
  checkComplete();
  registerAll();
  registerLimits(model);

  const bool restart_controllers =
      readBool(node, "restart_controllers_after_recovery").value_or(true);
  PlaceJoint place_joint;
  place_joint.check = [this, &world](const std::string& joint, double position) {
    if (findJoint(joint) == nullptr && devices_->names().count(joint) == 0) {
      throw std::runtime_error("'" + joint + "' is not a joint of this robot that is driven.");
    }
    checkJointPosition(world, joint, position);
  };
  place_joint.place = [&world](const std::string& joint, double position) {
    setJointPosition(world, joint, position);
  };
  services_ = std::make_unique<ArmServices>(node, robot.arms.front(), *arm_, robot.between_ticks,
                                            place_joint, restart_controllers);
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

void FrankaHWSim::readSim(ros::Time time, ros::Duration /*period*/) {
  arm_->read(time);
  const franka::RobotState& state = arm_->state();
  for (std::size_t i = 0; i < kArmJoints; ++i) {
    joints_[i].position = state.q[i];
    joints_[i].velocity = state.dq[i];
    joints_[i].effort = state.tau_J[i];
  }
  if (hand_ != nullptr) {
    const franka_sim::HandMeasurement fingers = hand_->measure();
    for (std::size_t i = 0; i < 2; ++i) {
      joints_[kArmJoints + i].position = fingers.q[i];
      joints_[kArmJoints + i].velocity = fingers.dq[i];
      joints_[kArmJoints + i].effort = joints_[kArmJoints + i].command;
    }
  }
  devices_->read();
  if (!initialized_published_) {
    publishInitialized(true);
  }
}

void FrankaHWSim::writeSim(ros::Time /*time*/, ros::Duration period) {
  arm_->approachCommands();
  holdJointLimits(period);
  arm_->write();
  if (hand_ != nullptr) {
    std::array<double, 2> force{};
    for (std::size_t i = 0; i < 2; ++i) {
      const double command = joints_[kArmJoints + i].command;
      force[i] = std::isfinite(command) ? command : 0.0;
    }
    hand_->applyForces(force);
  }
  devices_->write(period);
}

void FrankaHWSim::eStopActive(bool active) {
  if (active && arm_->mode() != ControlMode::None) {
    arm_->control(ControlMode::None, arm_->mode());
  }
}

std::string FrankaHWSim::condition() const {
  return arm_ ? franka_sim::conditionText(arm_id_, arm_->unit().state()) : "";
}

void FrankaHWSim::worldWasReset() {
  arm_->worldWasReset();
  devices_->worldWasReset();
  position_limits_.reset();
  for (Joint& joint : joints_) {
    joint.command = 0.0;
  }
}

// --- controllers come and go ---------------------------------------------------------------------

bool FrankaHWSim::checkForConflict(
    const std::list<hardware_interface::ControllerInfo>& controllers) const {
  return conflict(controllers, arm_id_);
}

bool FrankaHWSim::prepareSwitch(const std::list<hardware_interface::ControllerInfo>& start_list,
                                const std::list<hardware_interface::ControllerInfo>& stop_list) {
  for (const auto& controller : start_list) {
    const std::string reason = whyRefused(controller, arm_id_, devices_->names());
    if (!reason.empty()) {
      ROS_ERROR_NAMED(kHardwareLog, "%s", reason.c_str());
      return false;
    }
  }
  const ControlMode starts = claimedMode(start_list, arm_id_);
  if (starts == ControlMode::None) {
    return true;
  }
  if (!arm_->connected()) {
    ROS_ERROR_NAMED(kHardwareLog,
                    "%s: controllers cannot be started while the arm is disconnected: call the "
                    "service franka_control/connect first.",
                    arm_id_.c_str());
    return false;
  }
  const std::string reason = reasonWithoutEffect();
  if (!reason.empty()) {
    ROS_WARN_NAMED(kHardwareLog, "%s", reason.c_str());
  }
  return !refusesAtSingularPose(starts, claimedMode(stop_list, arm_id_));
}

std::string FrankaHWSim::reasonWithoutEffect() const {
  const bool stopped = arm_->userStopped();
  if (!stopped && !arm_->needsRecovery()) {
    return "";
  }
  return "'" + arm_id_ + "' is in the mode " + (stopped ? "User stopped" : "Reflex") +
         ": commands of controllers have no effect before " +
         (stopped ? "the user stop is released and " : "") +
         "the action franka_control/error_recovery is called.";
}

// Before the switch, so that a refusal stops nothing.
bool FrankaHWSim::refusesAtSingularPose(ControlMode starts, ControlMode stops) const {
  bool refuses = false;
  try {
    between_ticks_([&] { refuses = arm_->refuses(starts, stops); });
  } catch (const std::exception& error) {
    ROS_ERROR_NAMED(kHardwareLog, "%s: %s", arm_id_.c_str(), error.what());
    return true;
  }
  if (refuses) {
    ROS_ERROR_NAMED(
        kHardwareLog,
        "%s: no Cartesian motion can start here, because the pose is singular: move the "
        "arm away by a controller of its joints, or place it elsewhere (service "
        "set_franka_model_configuration).",
        arm_id_.c_str());
  }
  return refuses;
}

void FrankaHWSim::doSwitch(const std::list<hardware_interface::ControllerInfo>& start_list,
                           const std::list<hardware_interface::ControllerInfo>& stop_list) {
  devices_->doSwitch(start_list, stop_list);
  const ControlMode starts = claimedMode(start_list, arm_id_);
  const ControlMode stops = claimedMode(stop_list, arm_id_);
  switch_concerns_arm_ = starts != ControlMode::None || stops != ControlMode::None;
  if (arm_->control(starts, stops)) {
    position_limits_.reset();
  }
}

FrankaHWSim::SwitchState FrankaHWSim::switchResult() const {
  if (!switch_concerns_arm_) {
    return SwitchState::DONE;
  }
  switch (arm_->switchResult()) {
    case SimArm::Switch::kOngoing:
      return SwitchState::ONGOING;
    case SimArm::Switch::kRefused:
      return SwitchState::ERROR;
    default:
      return SwitchState::DONE;
  }
}

FrankaHWSim::SwitchState FrankaHWSim::switchResult(
    const hardware_interface::ControllerInfo& controller) const {
  // A controller that commands nothing of the arm need not wait for it.
  return commandsArm(controller, arm_id_) ? switchResult() : SwitchState::DONE;
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
    ROS_WARN_NAMED(kHardwareLog,
                   "%s: %llu commands were not finite numbers: the running controller computes NaN "
                   "or infinity. "
                   "Such torques are ignored, such motions end.",
                   arm_id_.c_str(), static_cast<unsigned long long>(refused - reported_commands_));
    reported_commands_ = refused;
  }
  const SimArm::Abort& abort = arm_->lastAbort();
  if (abort.count != reported_aborts_) {
    reported_aborts_ = abort.count;
    ROS_ERROR_NAMED(kHardwareLog,
                    "%s: the motion was ended by the robot: %s. Its controllers have no effect "
                    "before the action franka_control/error_recovery is called.",
                    arm_id_.c_str(), describe(abort).c_str());
  }
  if (model_->takeSingularityWarning()) {
    ROS_WARN_NAMED(kHardwareLog,
                   "%s: the arm is close to a singularity (singularity_warning_threshold %s).",
                   arm_id_.c_str(), franka_core::numberText(singularity_threshold_).c_str());
  }
}

}  // namespace franka_sim_mujoco

PLUGINLIB_EXPORT_CLASS(franka_sim_mujoco::FrankaHWSim, franka_sim_mujoco::RobotHWSim)

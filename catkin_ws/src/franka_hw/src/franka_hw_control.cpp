// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// FrankaHW: the switch of controllers, and the motion.
#include <franka_hw/arm_connection.h>
#include <franka_hw/franka_hw.h>
#include <franka_hw/resource_helpers.h>
#include <ros/console.h>

#include <chrono>
#include <thread>
#include <tuple>

#include "command_permission.h"

namespace franka_hw {

namespace {

// Above these speeds the robot would refuse to end a motion: it has to brake first. [rad/s]
constexpr double kDesiredAtRest = 0.005;
constexpr double kMeasuredAtRest = 0.05;
// A robot needs some hundred milliseconds to come to rest from full speed.
constexpr std::chrono::seconds kMaxStopTime{2};

bool anyAbove(const std::array<double, 7>& values, double limit) noexcept {
  return std::any_of(values.begin(), values.end(),
                     [limit](double value) { return std::abs(value) > limit; });
}

/// The mode that the controllers need on this arm. @returns false for unknown claims
bool modeOf(const std::string& arm_id, const std::list<hardware_interface::ControllerInfo>& list,
            ControlMode& mode) {
  ResourceWithClaimsMap resources = getResourceMap(list);
  ArmClaimedMap claims;
  if (!getArmClaimedMap(resources, claims)) {
    return false;
  }
  mode = getControlMode(arm_id, claims);
  return true;
}

/// Whether one of the controllers claims a resource, even one that belongs to no arm.
bool commands(const std::list<hardware_interface::ControllerInfo>& list) {
  return std::any_of(list.begin(), list.end(), [](const auto& info) {
    return std::any_of(info.claimed_resources.begin(), info.claimed_resources.end(),
                       [](const auto& claimed) { return !claimed.resources.empty(); });
  });
}

std::vector<std::string> namesOf(const std::list<hardware_interface::ControllerInfo>& list) {
  std::vector<std::string> names;
  for (const hardware_interface::ControllerInfo& info : list) {
    names.push_back(info.name);
  }
  return names;
}

}  // namespace

bool FrankaHW::RunSettings::operator==(const RunSettings& other) const {
  return std::tie(mode, limit_rate, cutoff_frequency, internal_controller) ==
         std::tie(other.mode, other.limit_rate, other.cutoff_frequency, other.internal_controller);
}

bool FrankaHW::controllerActive() const noexcept { return controller_active_; }

bool FrankaHW::motionGoesOn() const noexcept { return motion_goes_on_; }

// --- the switch ----------------------------------------------------------------------------------

bool FrankaHW::checkForConflict(const std::list<hardware_interface::ControllerInfo>& info) const {
  ResourceWithClaimsMap resources = getResourceMap(info);
  if (hasConflictingMultiClaim(resources)) {
    return true;
  }
  ArmClaimedMap claims;
  if (!getArmClaimedMap(resources, claims)) {
    ROS_ERROR_STREAM("FrankaHW: a controller claims what is not part of a Franka arm.");
    return true;
  }
  return hasConflictingJointAndCartesianClaim(claims, arm_id_) ||
         partiallyClaimsArmJoints(claims, arm_id_);
}

bool FrankaHW::acceptsSwitch(const std::list<hardware_interface::ControllerInfo>& start_list,
                             const std::list<hardware_interface::ControllerInfo>& stop_list) const {
  ControlMode start_mode = ControlMode::None;
  ControlMode stop_mode = ControlMode::None;
  if (!modeOf(arm_id_, start_list, start_mode) || !modeOf(arm_id_, stop_list, stop_mode)) {
    ROS_ERROR("FrankaHW: unknown interface claimed for starting or stopping!");
    return false;
  }
  if (takesBack(start_list, stop_list)) {
    return true;
  }
  // Before init() no robot is known, so there is nothing to compare with the parameters.
  if (initialized_ && commands(start_list) && !command_permission_->allows(namesOf(start_list))) {
    return false;
  }
  const ControlMode mode = (current_control_mode_ & ~stop_mode) | start_mode;
  if (!supports(mode)) {
    ROS_WARN_STREAM("FrankaHW: no such control mode for '" << arm_id_ << "': " << mode);
    return false;
  }
  return true;
}

bool FrankaHW::prepareSwitch(const std::list<hardware_interface::ControllerInfo>& start_list,
                             const std::list<hardware_interface::ControllerInfo>& stop_list) {
  if (!acceptsSwitch(start_list, stop_list)) {
    return false;
  }
  ControlMode start_mode = ControlMode::None;
  ControlMode stop_mode = ControlMode::None;
  modeOf(arm_id_, start_list, start_mode);
  modeOf(arm_id_, stop_list, stop_mode);
  if (start_mode == ControlMode::None && stop_mode == ControlMode::None) {
    return true;  // controllers that only read do not change a motion
  }
  if (takesBack(start_list, stop_list)) {
    takePreparationBack();
    return true;
  }
  if (start_mode != ControlMode::None) {
    const std::string reason = connection_->reasonWithoutEffect();
    if (!reason.empty()) {
      ROS_WARN_STREAM("FrankaHW: " << reason);
    }
  }
  preparation_pending_ = false;
  const ControlMode mode = (current_control_mode_ & ~stop_mode) | start_mode;
  const RunSettings settings{mode, get_limit_rate_(), get_cutoff_frequency_(),
                             get_internal_controller_()};
  // Torques may pass from one controller to the next within a motion: it need not end.
  if (controller_active_ && mode == ControlMode::JointTorque && settings == run_settings_) {
    return true;
  }

  const bool was_active = controller_active_;
  if (!endMotion()) {
    ROS_ERROR_STREAM("FrankaHW: the motion of '" << arm_id_ << "' did not end within "
                                                 << kMaxStopTime.count() << " s.");
    resumePrevious(was_active);
    return false;
  }
  if (!setRunFunction(mode, settings.limit_rate, settings.cutoff_frequency,
                      settings.internal_controller)) {
    resumePrevious(was_active);
    return false;
  }
  if (mode != current_control_mode_) {
    ROS_INFO_STREAM("FrankaHW: prepared switching '"
                    << arm_id_ << "' to " << mode << " with limit_rate=" << settings.limit_rate
                    << ", cutoff_frequency=" << settings.cutoff_frequency
                    << ", internal_controller="
                    << (settings.internal_controller == franka::ControllerMode::kJointImpedance
                            ? "joint_impedance"
                            : "cartesian_impedance"));
  }
  preparation_ = {namesOf(start_list), namesOf(stop_list), was_active, run_settings_};
  preparation_pending_ = true;
  motion_goes_on_ = was_active && (current_control_mode_ & ~stop_mode) != ControlMode::None;
  current_control_mode_ = mode;
  run_settings_ = settings;
  return true;
}

bool FrankaHW::takesBack(const std::list<hardware_interface::ControllerInfo>& start_list,
                         const std::list<hardware_interface::ControllerInfo>& stop_list) const {
  return preparation_pending_ && namesOf(start_list) == preparation_.stop &&
         namesOf(stop_list) == preparation_.start;
}

void FrankaHW::takePreparationBack() {
  preparation_pending_ = false;
  run_settings_ = preparation_.settings_before;
  current_control_mode_ = run_settings_.mode;
  setRunFunction(run_settings_.mode, run_settings_.limit_rate, run_settings_.cutoff_frequency,
                 run_settings_.internal_controller);
  resumePrevious(preparation_.was_active);
}

void FrankaHW::resumePrevious(bool was_active) {
  motion_goes_on_ = was_active;
  controller_active_ = was_active;
}

bool FrankaHW::endMotion() {
  // Does not use robot_mutex_: a loop that only reads locks it again before other threads wake up.
  controller_active_ = false;
  const auto deadline = std::chrono::steady_clock::now() + kMaxStopTime;
  while (in_control_) {
    if (std::chrono::steady_clock::now() > deadline) {
      return false;
    }
    std::this_thread::sleep_for(std::chrono::microseconds(20));
  }
  return true;
}

void FrankaHW::doSwitch(const std::list<hardware_interface::ControllerInfo>& /*start_list*/,
                        const std::list<hardware_interface::ControllerInfo>& /*stop_list*/) {
  // A switch that changes nothing for this robot, or only passes torques on, prepared nothing.
  const bool prepared = preparation_pending_.exchange(false);
  if (prepared && current_control_mode_ != ControlMode::None) {
    reset();
    controller_active_ = true;
  }
}

// --- the motion ----------------------------------------------------------------------------------

void FrankaHW::control(
    const std::function<bool(const ros::Time&, const ros::Duration&)>& ros_callback) {
  if (!initialized_) {
    ROS_ERROR("FrankaHW: control was called before init.");
    return;
  }
  const InControl in_control(*this);
  if (!controller_active_) {
    return;
  }
  // With two callbacks (torques and a motion generator) the controllers run only once per
  // millisecond.
  franka::Duration last_time = robot_state_libfranka_.time;
  bool first = true;
  const Callback once_a_state = [&](const franka::RobotState& robot_state,
                                    franka::Duration time_step) {
    if (!first && robot_state.time == last_time) {
      return true;
    }
    first = false;
    last_time = robot_state.time;
    const ros::Time time = clock_.update(robot_state.time, ros::Time::now());
    return ros_callback(time, ros::Duration(time_step.toSec()));
  };

  const ArmConnection::Motion motion(*connection_);
  franka::Robot& connected_robot = robot();
  if (!motion) {
    return;
  }
  response_times_.motionBegins();
  try {
    run_function_(connected_robot, once_a_state);
  } catch (const MotionInterrupted&) {
    // The motion was ended on purpose; the robot has braked by itself.
  }
}

bool FrankaHW::isMoving(const franka::RobotState& robot_state) noexcept {
  return anyAbove(robot_state.dq_d, kDesiredAtRest) || anyAbove(robot_state.dq, kMeasuredAtRest);
}

bool FrankaHW::setRunFunction(const ControlMode& requested_control_mode, bool limit_rate,
                              double cutoff_frequency, franka::ControllerMode internal_controller) {
  // Every run function passes its commands through controlCallback, which refers to the members
  // that write() fills.
  const auto callback = [this](const auto& command, const Callback& ros_callback) {
    return [this, &command, ros_callback](const franka::RobotState& state, franka::Duration step) {
      return controlCallback(command, ros_callback, state, step);
    };
  };
  const auto generator = [=](const auto& command) {
    return [=, &command](franka::Robot& robot, Callback ros_callback) {
      robot.control(callback(command, ros_callback), internal_controller, limit_rate,
                    cutoff_frequency);
    };
  };
  const auto torqueAnd = [=](const auto& command) {
    return [=, &command](franka::Robot& robot, Callback ros_callback) {
      robot.control(callback(effort_joint_command_libfranka_, ros_callback),
                    callback(command, ros_callback), limit_rate, cutoff_frequency);
    };
  };

  const bool torques = (requested_control_mode & ControlMode::JointTorque) != ControlMode::None;
  const auto useGenerator = [&](const auto& command) {
    if (torques) {
      run_function_ = torqueAnd(command);
    } else {
      run_function_ = generator(command);
    }
    return true;
  };
  switch (requested_control_mode & ~ControlMode::JointTorque) {
    case ControlMode::None:
      if (torques) {
        run_function_ = [=](franka::Robot& robot, Callback ros_callback) {
          robot.control(callback(effort_joint_command_libfranka_, ros_callback), limit_rate,
                        cutoff_frequency);
        };
      }
      return true;
    case ControlMode::JointPosition:
      return useGenerator(position_joint_command_libfranka_);
    case ControlMode::JointVelocity:
      return useGenerator(velocity_joint_command_libfranka_);
    case ControlMode::CartesianPose:
      return useGenerator(pose_cartesian_command_libfranka_);
    case ControlMode::CartesianVelocity:
      return useGenerator(velocity_cartesian_command_libfranka_);
    default:
      return false;
  }
}

bool FrankaHW::supports(ControlMode mode) const {
  switch (mode & ~ControlMode::JointTorque) {
    case ControlMode::None:
    case ControlMode::JointPosition:
    case ControlMode::JointVelocity:
    case ControlMode::CartesianPose:
    case ControlMode::CartesianVelocity:
      return true;
    default:  // two motion generators at the same time
      return false;
  }
}

}  // namespace franka_hw

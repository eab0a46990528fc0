// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <controller_manager_msgs/ListControllers.h>
#include <controller_manager_msgs/SwitchController.h>
#include <franka_core/transform.h>
#include <franka_hw/setters.h>
#include <franka_sim/robot/control_unit_parameters.h>
#include <franka_sim_mujoco/arm_services.h>
#include <ros/console.h>
#include <ros/service.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

#include "arm_parameters.h"
#include "service_handlers.h"

namespace franka_sim_mujoco {

namespace codec = franka_core::fci;
using franka_sim::Status;

namespace {

constexpr double kSwitchTimeout = 3.0;     ///< [s]
constexpr double kRecoveryTimeout = 20.0;  ///< [s] wall; the unit's own limit is 5 s
constexpr double kRecoveryPoll = 0.005;    ///< [s] wall
constexpr char kNotThresholds[] = "The thresholds must be finite and not negative.";

std::string notATransform(const std::string& name, const std::array<double, 16>& matrix) {
  return name + " is not a column-major 4x4 transform to a frame on the arm: " +
         franka_sim::frameFault(matrix) + ".";
}

/// Logs unusual thresholds. @throws std::runtime_error for the first invalid threshold
franka_sim::CollisionThresholds checked(const franka_sim::CollisionThresholds& thresholds,
                                        const std::string& phase) {
  const std::string fault = checkThresholds(thresholds);
  if (!fault.empty()) {
    throw std::runtime_error(phase + fault);
  }
  const std::string remark = thresholdRemark(thresholds);
  if (!remark.empty()) {
    ROS_WARN_STREAM_NAMED(kHardwareLog, phase << remark);
  }
  return thresholds;
}

/// The setters of franka::Robot for a simulated control unit. Used between ticks.
/// @throws std::runtime_error if the unit refuses
class UnitSetters {
 public:
  using Torques = std::array<double, 7>;  // thresholds [Nm]
  using Forces = std::array<double, 6>;   // thresholds [N, Nm]

  explicit UnitSetters(franka_sim::ControlUnit& unit) : unit_(unit) {}

  void setEE(const std::array<double, 16>& NE_T_EE) {
    request(codec::SetNEToEERequest{NE_T_EE}, notATransform("NE_T_EE", NE_T_EE));
  }
  void setK(const std::array<double, 16>& EE_T_K) {
    request(codec::SetEEToKRequest{EE_T_K}, notATransform("EE_T_K", EE_T_K));
  }
  void setLoad(double mass, const std::array<double, 3>& F_x_Cload,
               const std::array<double, 9>& inertia) {
    const franka_core::Payload load{mass, F_x_Cload, inertia};
    request(franka_sim::loadRequest(load),
            "The load was refused. " + franka_sim::payloadFault(load));
  }
  void setJointImpedance(const std::array<double, 7>& stiffness) {
    request(codec::SetJointImpedanceRequest{stiffness},
            "joint_stiffness must hold seven numbers from 0 to 14250 Nm/rad.");
  }
  void setCartesianImpedance(const std::array<double, 6>& stiffness) {
    request(
        codec::SetCartesianImpedanceRequest{stiffness},
        "cartesian_stiffness must hold three numbers from 10 to 3000 N/m and three from 1 to 300 "
        "Nm/rad.");
  }
  void setCollisionBehavior(const Torques& lower_torques, const Torques& upper_torques,
                            const Forces& lower_forces, const Forces& upper_forces) {
    const franka_sim::CollisionThresholds thresholds =
        checked({lower_torques, upper_torques, lower_forces, upper_forces}, "");
    request(franka_sim::collisionRequest(thresholds, thresholds), kNotThresholds);
  }
  void setCollisionBehavior(
      const Torques& lower_torques_acceleration, const Torques& upper_torques_acceleration,
      const Torques& lower_torques_nominal, const Torques& upper_torques_nominal,
      const Forces& lower_forces_acceleration, const Forces& upper_forces_acceleration,
      const Forces& lower_forces_nominal, const Forces& upper_forces_nominal) {
    const franka_sim::CollisionThresholds acceleration =
        checked({lower_torques_acceleration, upper_torques_acceleration, lower_forces_acceleration,
                 upper_forces_acceleration},
                "Acceleration phase: ");
    const franka_sim::CollisionThresholds nominal = checked(
        {lower_torques_nominal, upper_torques_nominal, lower_forces_nominal, upper_forces_nominal},
        "Nominal phase: ");
    request(franka_sim::collisionRequest(acceleration, nominal), kNotThresholds);
  }

 private:
  void request(const franka_sim::UnitRequest& request, const std::string& why_invalid) {
    const std::optional<Status> status = unit_.request(request);
    if (status == Status::kInvalidArgumentRejected) {
      throw std::runtime_error(why_invalid);
    }
    if (status != Status::kSuccess) {
      throw std::runtime_error(
          unit_.state().robot_mode == franka_core::RobotMode::kMove
              ? "This cannot be done while a controller moves the arm: stop that controller "
                "(controller_manager/switch_controller), then try again."
              : "This cannot be done in the arm's present mode (" +
                    std::to_string(static_cast<int>(unit_.state().robot_mode)) +
                    " in franka_msgs/FrankaState).");
    }
  }

  franka_sim::ControlUnit& unit_;
};

}  // namespace

ArmServices::ArmServices(const ros::NodeHandle& node, const SimulatedArm& described, SimArm& arm,
                         BetweenTicks between_ticks, PlaceJoint place_joint,
                         bool restart_controllers)
    : robot_node_(node),
      arm_node_(node, described.service_namespace),
      control_node_(arm_node_, "franka_control"),
      arm_id_(described.arm_id),
      arm_(arm),
      between_ticks_(std::move(between_ticks)),
      place_joint_(std::move(place_joint)),
      restart_controllers_(restart_controllers),
      recovery_(control_node_, "error_recovery", [this](const auto& /*goal*/) { recover(); }) {
  offerSetters();
  offerUserStop();
  offerConnection("connect", true);
  offerConnection("disconnect", false);
  offerConfiguration();
  recovery_.start();
}

ArmServices::~ArmServices() {
  for (ros::ServiceServer& server : servers_) {
    server.shutdown();
  }
  recovery_.shutdown();
}

template <typename Service>
void ArmServices::offer(ros::NodeHandle& node, const std::string& name,
                        std::function<void(const typename Service::Request&)> handler) {
  using Request = typename Service::Request;
  using Response = typename Service::Response;
  const boost::function<bool(Request&, Response&)> callback =
      [this, name, handler](Request& request, Response& response) {
        answer(
            response, [&] { handler(request); },
            [&](const char* sentence) {
              ROS_ERROR_NAMED(kHardwareLog, "%s: %s: %s", arm_id_.c_str(), name.c_str(), sentence);
            });
        return true;
      };
  servers_.push_back(node.advertiseService<Request, Response>(name, callback));
}

template <typename Service>
void ArmServices::offerBetweenTicks(const std::string& name,
                                    std::function<void(const typename Service::Request&)> handler) {
  offer<Service>(control_node_, name, [this, handler](const typename Service::Request& request) {
    between_ticks_([&] { handler(request); });
  });
}

// --- configuration -------------------------------------------------------------------------------

void ArmServices::offerSetters() {
  franka_hw::forEachSetter([this](auto setter) {
    using Service = typename decltype(setter)::Service;
    offerBetweenTicks<Service>(setter.name, [this](const typename Service::Request& request) {
      UnitSetters setters(arm_.unit());
      franka_hw::configure(setters, franka_hw::checkedRequest(request));
    });
  });
}

// --- user stop and brakes ------------------------------------------------------------------------

void ArmServices::offerUserStop() {
  offer<std_srvs::SetBool>(control_node_, "set_user_stop", [this](const auto& request) {
    between_ticks_([&] { arm_.setUserStop(request.data); });
    ROS_WARN_NAMED(kHardwareLog,
                   request.data ? "%s: user stop pressed: commands of controllers have no effect"
                                : "%s: user stop released: call franka_control/error_recovery to "
                                  "connect the controllers again",
                   arm_id_.c_str());
  });
}

void ArmServices::offerConnection(const std::string& name, bool connects) {
  offerBetweenTicks<std_srvs::Trigger>(name, [this, connects](const auto& /*request*/) {
    if (arm_.connected() == connects) {
      throw std::runtime_error(connects ? "The arm is connected already."
                                        : "The arm is disconnected already.");
    }
    if (!arm_.setConnected(connects)) {
      throw std::runtime_error(
          "A controller commands the arm: stop it (controller_manager/switch_controller) "
          "before disconnecting.");
    }
  });
}

// --- another configuration of the joints ---------------------------------------------------------

void ArmServices::offerConfiguration() {
  offer<franka_msgs::SetJointConfiguration>(arm_node_, "set_franka_model_configuration",
                                            [this](const auto& request) { placeJoints(request); });
}

void ArmServices::placeJoints(const franka_msgs::SetJointConfiguration::Request& request) {
  const std::vector<std::string>& names = request.joint_names;
  if (names.empty() || (names.size() == 1 && names.front().empty())) {
    throw std::runtime_error("No joints are named in joint_names.");
  }
  if (names.size() != request.joint_positions.size()) {
    throw std::runtime_error("joint_names holds " + std::to_string(names.size()) +
                             " names, but joint_positions " +
                             std::to_string(request.joint_positions.size()) + " positions.");
  }
  std::vector<std::string> complaints;
  bool moved = false;
  between_ticks_([&] {
    std::vector<std::size_t> possible;
    for (std::size_t i = 0; i < names.size(); ++i) {
      try {
        place_joint_.check(names[i], request.joint_positions[i]);
        possible.push_back(i);
      } catch (const std::exception& error) {
        complaints.emplace_back(error.what());
      }
    }
    if (possible.empty()) {
      return;  // nothing changes: no motion may end
    }
    moved = moves();
    for (const std::size_t i : possible) {
      place_joint_.place(names[i], request.joint_positions[i]);
    }
    if (restart_controllers_) {
      arm_.jointsWerePlaced();
    } else {
      arm_.worldWasReset();
    }
  });
  for (const std::string& complaint : complaints) {
    ROS_WARN_NAMED(kHardwareLog, "%s: set_franka_model_configuration: %s", arm_id_.c_str(),
                   complaint.c_str());
  }
  if (complaints.size() == names.size()) {
    throw std::runtime_error("No joint could be moved. " + complaints.front());
  }
  // Controllers that a user stop or an error has disconnected wait for the recovery.
  if (moved && restart_controllers_) {
    switchArmControllers(true);
  }
}

// --- recovery ------------------------------------------------------------------------------------

void ArmServices::recover() {
  try {
    recoverUnit();
    if (restart_controllers_ || !moves()) {
      switchArmControllers(restart_controllers_);
    }
    recovery_.setSucceeded();
  } catch (const std::exception& error) {
    ROS_WARN_NAMED(kHardwareLog, "%s: error_recovery: %s", arm_id_.c_str(), error.what());
    recovery_.setAborted(franka_msgs::ErrorRecoveryResult(), error.what());
  }
}

void ArmServices::recoverUnit() {
  between_ticks_([this] {
    if (arm_.userStopped()) {
      throw std::runtime_error(
          "The user stop is pressed: release it (service franka_control/set_user_stop) before "
          "recovering.");
    }
    if (!arm_.recover()) {
      throw std::runtime_error(
          "The arm cannot recover by itself: it stands beyond a joint limit or is led by hand. Put "
          "it elsewhere (service set_franka_model_configuration).");
    }
  });
  const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(kRecoveryTimeout);
  while (recovering()) {
    if (ros::WallTime::now() > deadline) {
      throw std::runtime_error("The recovery did not end within " +
                               std::to_string(static_cast<int>(kRecoveryTimeout)) +
                               " s. Is the simulation paused?");
    }
    ros::WallDuration(kRecoveryPoll).sleep();
  }
  if (arm_.needsRecovery()) {
    throw std::runtime_error("The arm did not come to rest: the recovery has failed.");
  }
}

bool ArmServices::recovering() {
  bool recovering = false;
  between_ticks_([&] { recovering = arm_.recovering(); });
  return recovering;
}

bool ArmServices::moves() {
  bool moves = false;
  between_ticks_([&] { moves = arm_.unit().state().robot_mode == franka_core::RobotMode::kMove; });
  return moves;
}

std::vector<std::string> ArmServices::runningArmControllers() {
  const std::string service = robot_node_.resolveName("controller_manager/list_controllers");
  controller_manager_msgs::ListControllers list;
  // waitForService would sleep in simulated time, without an end while the simulation is paused.
  if (!ros::service::exists(service, false) || !ros::service::call(service, list)) {
    throw std::runtime_error("The controllers cannot be restarted: " + service +
                             " does not answer.");
  }
  std::vector<std::string> names;
  for (const auto& controller : list.response.controller) {
    bool commands_arm = false;
    for (const auto& claim : controller.claimed_resources) {
      for (const std::string& resource : claim.resources) {
        commands_arm = commands_arm || resource.rfind(arm_id_ + "_joint", 0) == 0 ||
                       resource == arm_id_ + "_robot";
      }
    }
    if (controller.state == "running" && commands_arm) {
      names.push_back(controller.name);
    }
  }
  return names;
}

// In two steps, so that the hardware is told which controllers stop and start.
void ArmServices::switchArmControllers(bool restart) {
  const std::vector<std::string> names = runningArmControllers();
  const std::string by =
      " by " + robot_node_.resolveName("controller_manager/switch_controller") + ". ";
  if (!names.empty() && !switches({}, names)) {
    throw std::runtime_error("The arm is ready but its controllers could not be stopped" + by +
                             "Is the simulation paused? Stop them, and start them again.");
  }
  if (restart && !names.empty() && !switches(names, {})) {
    throw std::runtime_error("The arm is ready but its controllers could not be started again" +
                             by + "They are stopped.");
  }
}

bool ArmServices::switches(const std::vector<std::string>& start,
                           const std::vector<std::string>& stop) {
  controller_manager_msgs::SwitchController request;
  request.request.start_controllers = start;
  request.request.stop_controllers = stop;
  request.request.strictness = controller_manager_msgs::SwitchController::Request::STRICT;
  request.request.start_asap = true;
  request.request.timeout = kSwitchTimeout;
  return ros::service::call(robot_node_.resolveName("controller_manager/switch_controller"),
                            request) &&
         request.response.ok;
}

}  // namespace franka_sim_mujoco

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <controller_manager_msgs/ListControllers.h>
#include <controller_manager_msgs/SwitchController.h>
#include <franka_msgs/SetEEFrame.h>
#include <franka_msgs/SetForceTorqueCollisionBehavior.h>
#include <franka_msgs/SetKFrame.h>
#include <franka_msgs/SetLoad.h>
#include <franka_sim_mujoco/ros/arm_parameters.h>
#include <franka_sim_mujoco/ros/arm_services.h>
#include <ros/console.h>
#include <ros/service.h>
#include <std_srvs/SetBool.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace franka_sim_mujoco {

namespace {

constexpr char kLog[] = "franka_hw_sim";
constexpr double kSwitchTimeout = 3.0;  ///< [s]
constexpr char kNotATransform[] =
    " is not a column-major 4x4 transform: its bottom row (entries 4, 8, 12 and 16) must be 0 0 0 "
    "1 and its "
    "first three columns at right angles and of length one.";

/// The messages hold boost arrays.
template <std::size_t N, typename Array>
std::array<double, N> toArray(const Array& values) {
  std::array<double, N> result;
  std::copy(values.begin(), values.end(), result.begin());
  return result;
}

}  // namespace

ArmServices::ArmServices(const ros::NodeHandle& node, const std::string& arm_id, SimArm& arm,
                         BetweenTicks between_ticks, bool restart_controllers)
    : node_(node),
      control_node_(node, "franka_control"),
      arm_id_(arm_id),
      arm_(arm),
      between_ticks_(std::move(between_ticks)),
      restart_controllers_(restart_controllers),
      recovery_(
          control_node_, "error_recovery",
          [this](const franka_msgs::ErrorRecoveryGoalConstPtr& /*goal*/) { recover(); }, false) {
  offer<franka_msgs::SetEEFrame>("set_EE_frame", [this](const auto& request) {
    check(arm_.unit().setEE(toArray<16>(request.NE_T_EE)), std::string("NE_T_EE") + kNotATransform);
  });
  offer<franka_msgs::SetKFrame>("set_K_frame", [this](const auto& request) {
    check(arm_.unit().setK(toArray<16>(request.EE_T_K)), std::string("EE_T_K") + kNotATransform);
  });
  offer<franka_msgs::SetLoad>("set_load", [this](const auto& request) {
    const franka_core::Payload load{request.mass, toArray<3>(request.F_x_center_load),
                                    toArray<9>(request.load_inertia)};
    check(arm_.unit().setLoad(load),
          "The load must be finite, its mass not negative, and its inertia a symmetric matrix that "
          "is not "
          "negative.");
  });
  offer<franka_msgs::SetForceTorqueCollisionBehavior>(
      "set_force_torque_collision_behavior", [this](const auto& request) {
        const CollisionThresholds thresholds{toArray<7>(request.lower_torque_thresholds_nominal),
                                             toArray<7>(request.upper_torque_thresholds_nominal),
                                             toArray<6>(request.lower_force_thresholds_nominal),
                                             toArray<6>(request.upper_force_thresholds_nominal)};
        const std::string fault = checkThresholds(thresholds);
        if (!fault.empty()) {
          throw std::runtime_error(fault);
        }
        check(arm_.unit().setCollisionBehavior(thresholds, thresholds),
              "The thresholds must be finite and not negative.");
      });
  offerUserStop();
  recovery_.start();
}

ArmServices::~ArmServices() {
  for (ros::ServiceServer& server : servers_) {
    server.shutdown();
  }
  recovery_.shutdown();
}

template <typename Service>
void ArmServices::offer(const std::string& name,
                        std::function<void(const typename Service::Request&)> handler) {
  using Request = typename Service::Request;
  using Response = typename Service::Response;
  const boost::function<bool(Request&, Response&)> callback =
      [this, name, handler](Request& request, Response& response) {
        try {
          between_ticks_([&] { handler(request); });
          response.success = true;
        } catch (const std::exception& error) {
          ROS_ERROR_NAMED(kLog, "%s: %s: %s", arm_id_.c_str(), name.c_str(), error.what());
          response.success = false;
          response.error = error.what();
        }
        return true;
      };
  servers_.push_back(control_node_.advertiseService<Request, Response>(name, callback));
}

void ArmServices::offerUserStop() {
  using Request = std_srvs::SetBool::Request;
  using Response = std_srvs::SetBool::Response;
  const boost::function<bool(Request&, Response&)> callback = [this](Request& request,
                                                                     Response& response) {
    try {
      between_ticks_([&] { arm_.setUserStop(request.data); });
      response.success = true;
      ROS_WARN_NAMED(kLog,
                     request.data ? "%s: user stop pressed: commands of controllers have no effect"
                                  : "%s: user stop released: call franka_control/error_recovery to "
                                    "connect the controllers again",
                     arm_id_.c_str());
    } catch (const std::exception& error) {
      response.success = false;
      response.message = error.what();
    }
    return true;
  };
  servers_.push_back(control_node_.advertiseService<Request, Response>("set_user_stop", callback));
}

void ArmServices::check(RequestStatus status, const std::string& why_invalid) {
  switch (status) {
    case RequestStatus::kSuccess:
      return;
    case RequestStatus::kInvalidArgument:
      throw std::runtime_error(why_invalid);
    case RequestStatus::kNotPossible:
      throw std::runtime_error("This cannot be done in the arm's present mode (" +
                               std::to_string(static_cast<int>(arm_.state().robot_mode)) +
                               " in franka_msgs/FrankaState).");
  }
}

void ArmServices::recover() {
  try {
    recoverUnit();
    if (restart_controllers_) {
      restartArmControllers();
    }
    recovery_.setSucceeded();
  } catch (const std::exception& error) {
    ROS_WARN_NAMED(kLog, "%s: error_recovery: %s", arm_id_.c_str(), error.what());
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
    check(arm_.recover(), "");
  });
}

std::vector<std::string> ArmServices::runningArmControllers() {
  const std::string service = node_.resolveName("controller_manager/list_controllers");
  controller_manager_msgs::ListControllers list;
  // Not waitForService: it sleeps in simulated time, for ever while the simulation is paused.
  if (!ros::service::exists(service, false) || !ros::service::call(service, list)) {
    throw std::runtime_error("The controllers cannot be restarted: " + service +
                             " does not answer.");
  }
  std::vector<std::string> names;
  for (const auto& controller : list.response.controller) {
    bool commands_arm = false;
    for (const auto& claim : controller.claimed_resources) {
      for (const std::string& resource : claim.resources) {
        commands_arm = commands_arm || resource.rfind(arm_id_ + "_joint", 0) == 0;
      }
    }
    if (controller.state == "running" && commands_arm) {
      names.push_back(controller.name);
    }
  }
  return names;
}

void ArmServices::restartArmControllers() {
  const std::vector<std::string> names = runningArmControllers();
  if (names.empty()) {
    return;
  }
  const std::string service = node_.resolveName("controller_manager/switch_controller");
  controller_manager_msgs::SwitchController restart;
  restart.request.start_controllers = names;
  restart.request.stop_controllers = names;
  restart.request.strictness = controller_manager_msgs::SwitchController::Request::STRICT;
  restart.request.start_asap = true;
  restart.request.timeout = kSwitchTimeout;
  if (!ros::service::call(service, restart) || !restart.response.ok) {
    throw std::runtime_error(
        "The arm has recovered but its controllers could not be restarted by " + service +
        ". Is the simulation paused? Restart them by hand.");
  }
}

}  // namespace franka_sim_mujoco

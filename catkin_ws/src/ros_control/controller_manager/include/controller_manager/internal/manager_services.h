// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_manager/internal/switch_handover.h>
#include <controller_manager_msgs/ListControllerTypes.h>
#include <controller_manager_msgs/ListControllers.h>
#include <controller_manager_msgs/LoadController.h>
#include <controller_manager_msgs/ReloadControllerLibraries.h>
#include <controller_manager_msgs/SwitchController.h>
#include <controller_manager_msgs/UnloadController.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <ros/spinner.h>

namespace controller_manager {

class ControllerManager;

namespace internal {

/// The six services of a controller manager. Every call is answered; `ok` is its result.
///
/// Switching, and reloading, which switches too, may wait for the loop; loading and unloading take
/// as long as the controllers do. Listing has its own thread, so that it never waits for these or
/// for other callbacks of the program; likewise the services that may wait for the loop. Listing
/// shows the end of a switch that is under way if that takes at most a second.
class ManagerServices {
 public:
  /// @param manager must outlive the services @param handover of its switches, likewise
  /// @param nh above the services' namespace
  ManagerServices(ControllerManager& manager, SwitchHandover& handover, const ros::NodeHandle& nh);
  /// Ends the threads: no switch may be waiting.
  ~ManagerServices();

 private:
  bool listControllers(controller_manager_msgs::ListControllers::Request& request,
                       controller_manager_msgs::ListControllers::Response& response);
  bool listControllerTypes(controller_manager_msgs::ListControllerTypes::Request& request,
                           controller_manager_msgs::ListControllerTypes::Response& response);
  bool loadController(controller_manager_msgs::LoadController::Request& request,
                      controller_manager_msgs::LoadController::Response& response);
  bool unloadController(controller_manager_msgs::UnloadController::Request& request,
                        controller_manager_msgs::UnloadController::Response& response);
  bool switchController(controller_manager_msgs::SwitchController::Request& request,
                        controller_manager_msgs::SwitchController::Response& response);
  bool reloadLibraries(controller_manager_msgs::ReloadControllerLibraries::Request& request,
                       controller_manager_msgs::ReloadControllerLibraries::Response& response);

  ControllerManager& manager_;
  SwitchHandover& handover_;
  ros::NodeHandle nh_;
  ros::NodeHandle listing_nh_;
  ros::NodeHandle waiting_nh_;
  ros::CallbackQueue listing_queue_;
  ros::CallbackQueue waiting_queue_;
  ros::AsyncSpinner listing_spinner_;
  ros::AsyncSpinner waiting_spinner_;
  ros::ServiceServer list_controllers_;
  ros::ServiceServer list_controller_types_;
  ros::ServiceServer load_controller_;
  ros::ServiceServer unload_controller_;
  ros::ServiceServer switch_controller_;
  ros::ServiceServer reload_libraries_;
};

}  // namespace internal
}  // namespace controller_manager

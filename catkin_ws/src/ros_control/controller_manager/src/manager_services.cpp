// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <controller_manager/controller_manager.h>
#include <controller_manager/internal/manager_services.h>

namespace controller_manager {
namespace internal {

namespace {

constexpr std::uint32_t kListingThreads = 1;
constexpr std::uint32_t kWaitingThreads = 2;
// A switch in a loop that runs takes milliseconds; one that a paused robot delays is not waited
// for.
constexpr std::chrono::seconds kMaxWaitForSwitch{1};

const char* stateName(const controller_interface::ControllerBase& controller) {
  using State = controller_interface::ControllerBase::ControllerState;
  switch (controller.state_.load()) {
    case State::INITIALIZED:
      return "initialized";
    case State::RUNNING:
      return "running";
    case State::STOPPED:
      return "stopped";
    case State::WAITING:
      return "waiting";
    case State::ABORTED:
      return "aborted";
    case State::CONSTRUCTED:
      break;
  }
  return "unknown";
}

controller_manager_msgs::ControllerState message(const ControllerSpec& spec) {
  controller_manager_msgs::ControllerState state;
  state.name = spec.info.name;
  state.type = spec.info.type;
  state.state = stateName(*spec.c);
  for (const hardware_interface::InterfaceResources& claimed : spec.info.claimed_resources) {
    controller_manager_msgs::HardwareInterfaceResources resources;
    resources.hardware_interface = claimed.hardware_interface;
    resources.resources.assign(claimed.resources.begin(), claimed.resources.end());
    state.claimed_resources.push_back(resources);
  }
  return state;
}

}  // namespace

ManagerServices::ManagerServices(ControllerManager& manager, SwitchHandover& handover,
                                 const ros::NodeHandle& nh)
    : manager_(manager),
      handover_(handover),
      nh_(nh, "controller_manager"),
      listing_nh_(nh, "controller_manager"),
      waiting_nh_(nh, "controller_manager"),
      listing_spinner_(kListingThreads, &listing_queue_),
      waiting_spinner_(kWaitingThreads, &waiting_queue_) {
  listing_nh_.setCallbackQueue(&listing_queue_);
  waiting_nh_.setCallbackQueue(&waiting_queue_);
  list_controllers_ =
      listing_nh_.advertiseService("list_controllers", &ManagerServices::listControllers, this);
  load_controller_ =
      nh_.advertiseService("load_controller", &ManagerServices::loadController, this);
  unload_controller_ =
      nh_.advertiseService("unload_controller", &ManagerServices::unloadController, this);
  reload_libraries_ = waiting_nh_.advertiseService("reload_controller_libraries",
                                                   &ManagerServices::reloadLibraries, this);
  // May wait for a controller that is being created, like the services of the node's queue.
  list_controller_types_ =
      nh_.advertiseService("list_controller_types", &ManagerServices::listControllerTypes, this);
  switch_controller_ =
      waiting_nh_.advertiseService("switch_controller", &ManagerServices::switchController, this);
  listing_spinner_.start();
  waiting_spinner_.start();
}

ManagerServices::~ManagerServices() {
  for (ros::ServiceServer* server :
       {&list_controllers_, &list_controller_types_, &load_controller_, &unload_controller_,
        &reload_libraries_, &switch_controller_}) {
    server->shutdown();
  }
  listing_spinner_.stop();
  waiting_spinner_.stop();
}

bool ManagerServices::listControllers(
    controller_manager_msgs::ListControllers::Request& /*request*/,
    controller_manager_msgs::ListControllers::Response& response) {
  handover_.awaitEnd(kMaxWaitForSwitch);
  for (const ControllerSpec& spec : manager_.getControllers()) {
    response.controller.push_back(message(spec));
  }
  return true;
}

bool ManagerServices::listControllerTypes(
    controller_manager_msgs::ListControllerTypes::Request& /*request*/,
    controller_manager_msgs::ListControllerTypes::Response& response) {
  for (const ControllerManager::DeclaredType& declared : manager_.getDeclaredTypes()) {
    response.types.push_back(declared.type);
    response.base_classes.push_back(declared.base_class);
  }
  return true;
}

bool ManagerServices::loadController(controller_manager_msgs::LoadController::Request& request,
                                     controller_manager_msgs::LoadController::Response& response) {
  response.ok = manager_.loadController(request.name);
  return true;
}

bool ManagerServices::unloadController(
    controller_manager_msgs::UnloadController::Request& request,
    controller_manager_msgs::UnloadController::Response& response) {
  response.ok = manager_.unloadController(request.name);
  return true;
}

bool ManagerServices::switchController(
    controller_manager_msgs::SwitchController::Request& request,
    controller_manager_msgs::SwitchController::Response& response) {
  response.ok = manager_.switchController(request.start_controllers, request.stop_controllers,
                                          request.strictness, request.start_asap, request.timeout);
  return true;
}

bool ManagerServices::reloadLibraries(
    controller_manager_msgs::ReloadControllerLibraries::Request& request,
    controller_manager_msgs::ReloadControllerLibraries::Response& response) {
  response.ok = manager_.reloadControllerLibraries(request.force_kill);
  return true;
}

}  // namespace internal
}  // namespace controller_manager

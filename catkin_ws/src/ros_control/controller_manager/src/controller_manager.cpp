// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <controller_manager/controller_loader.h>
#include <controller_manager/controller_manager.h>
#include <controller_manager/internal/controller_registry.h>
#include <controller_manager/internal/first_exception.h>
#include <controller_manager/internal/loop_gate.h>
#include <controller_manager/internal/manager_services.h>
#include <controller_manager/internal/supervisor.h>
#include <controller_manager/internal/switch_handover.h>
#include <controller_manager_msgs/SwitchController.h>
#include <ros/console.h>

#include <algorithm>
#include <utility>

namespace controller_manager {

using controller_interface::ControllerBase;
using controller_interface::ControllerBaseSharedPtr;

namespace {

const ControllerManager::ControllerFilter kNone;
const ControllerManager::ControllerFilter kAll = [](const hardware_interface::ControllerInfo&) {
  return true;
};

}  // namespace

ControllerManager::ControllerManager(hardware_interface::RobotHW* robot_hw,
                                     const ros::NodeHandle& nh)
    : robot_hw_(robot_hw),
      root_nh_(nh),
      gate_(std::make_unique<internal::LoopGate>()),
      registry_(std::make_unique<internal::ControllerRegistry>(*gate_)),
      handover_(std::make_unique<internal::SwitchHandover>(*gate_)) {
  controller_loaders_.push_back(std::make_shared<ControllerLoader<ControllerBase>>(
      "controller_interface", "controller_interface::ControllerBase"));
  const ros::NodeHandle own_nh(nh, "controller_manager");
  const internal::Supervision supervision = internal::readSupervision(own_nh);
  default_switch_timeout_ = supervision.default_switch_timeout;
  if (supervision.watches()) {
    supervisor_ = std::make_unique<internal::Supervisor>(
        supervision, *registry_, *gate_, own_nh,
        [this](const std::string& name, bool first) { return handleFault(name, first); });
  }
  services_ = std::make_unique<internal::ManagerServices>(*this, *handover_, nh);
}

ControllerManager::~ControllerManager() {
  handover_->close();
  services_.reset();
  supervisor_.reset();
}

void ControllerManager::update(const ros::Time& time, const ros::Duration& period,
                               bool reset_controllers) {
  update(time, period, reset_controllers ? kAll : kNone);
}

void ControllerManager::update(const ros::Time& time, const ros::Duration& period,
                               const ControllerFilter& restarts) {
  const internal::LoopGate::Visit visit(*gate_);
  const internal::ControllerList& list = registry_->forLoop();
  internal::FirstException thrown;
  if (restarts) {
    for (const ControllerSpec& spec : list.specs()) {
      if (restarts(spec.info)) {
        thrown.capture([&] { restart(spec, time); });
      }
    }
  }
  if (supervisor_) {
    thrown.capture([&] { supervisor_->update(list, time, period); });
  } else {
    for (ControllerBase* controller : list.controllers()) {
      thrown.capture([&] { controller->updateRequest(time, period); });
    }
  }
  // Also if a controller throws in every cycle: this is how it is stopped.
  thrown.capture([&] { handover_->serve(*robot_hw_, time); });
  thrown.rethrow();
}

void ControllerManager::restart(const ControllerSpec& spec, const ros::Time& time) {
  if (spec.watch) {
    spec.watch->restart(time);
  } else if (spec.c->isRunning()) {
    spec.c->stopRequest(time);
    spec.c->startRequest(time);
  }
}

bool ControllerManager::refusedInLoop(const char* action) const {
  if (!gate_->isVisitedByThisThread()) {
    return false;
  }
  ROS_ERROR(
      "Could not %s controllers from a callback of the control loop, because that would wait for "
      "the loop's next cycle for ever. Do it in another thread.",
      action);
  return true;
}

std::vector<ControllerSpec> ControllerManager::getControllers() const {
  return registry_->snapshot()->specs();
}

ControllerBase* ControllerManager::getControllerByName(const std::string& name) {
  const internal::ControllerListPtr list = registry_->snapshot();
  const ControllerSpec* spec = list->find(name);
  return spec == nullptr ? nullptr : spec->c.get();
}

void ControllerManager::registerControllerLoader(
    ControllerLoaderInterfaceSharedPtr controller_loader) {
  const std::lock_guard<std::mutex> lock(loaders_mutex_);
  controller_loaders_.push_back(std::move(controller_loader));
}

std::vector<ControllerManager::DeclaredType> ControllerManager::getDeclaredTypes() {
  const std::lock_guard<std::mutex> lock(loaders_mutex_);
  std::vector<DeclaredType> declared;
  for (const ControllerLoaderInterfaceSharedPtr& loader : controller_loaders_) {
    for (const std::string& type : loader->getDeclaredClasses()) {
      declared.push_back({type, loader->getName()});
    }
  }
  return declared;
}

bool ControllerManager::loadController(const std::string& name) {
  if (refusedInLoop("load")) {
    return false;
  }
  const std::lock_guard<std::mutex> lock(services_mutex_);
  const internal::ControllerListPtr list = registry_->snapshot();
  if (list->find(name) != nullptr) {
    ROS_ERROR("A controller named '%s' was already loaded inside the controller manager",
              name.c_str());
    return false;
  }

  ControllerSpec spec;
  spec.info.name = name;
  try {
    ros::NodeHandle controller_nh(root_nh_, name);
    if (!controller_nh.getParam("type", spec.info.type)) {
      ROS_ERROR(
          "Could not load controller '%s' because the type was not specified. Did you load the "
          "controller configuration on the parameter server (namespace: '%s')?",
          name.c_str(), controller_nh.getNamespace().c_str());
      return false;
    }
    spec.c = createController(name, spec.info.type);
    if (!spec.c || !initController(spec, controller_nh) || !watchController(spec, controller_nh)) {
      return false;
    }
  } catch (const ros::InvalidNameException& error) {
    ROS_ERROR("Could not load controller '%s' because the name cannot be used as a namespace: %s",
              name.c_str(), error.what());
    return false;
  }

  std::vector<ControllerSpec> specs = list->specs();
  specs.push_back(std::move(spec));
  registry_->replace(std::move(specs));
  return true;
}

ControllerBaseSharedPtr ControllerManager::createController(const std::string& name,
                                                            const std::string& type) {
  const std::lock_guard<std::mutex> lock(loaders_mutex_);
  try {
    for (const ControllerLoaderInterfaceSharedPtr& loader : controller_loaders_) {
      const std::vector<std::string> declared = loader->getDeclaredClasses();
      if (std::find(declared.begin(), declared.end(), type) != declared.end()) {
        ControllerBaseSharedPtr controller = loader->createInstance(type);
        if (!controller) {
          ROS_ERROR("Could not load class '%s': its loader returned nothing", type.c_str());
        }
        return controller;
      }
    }
  } catch (const std::exception& error) {
    ROS_ERROR("Could not load class '%s': %s", type.c_str(), error.what());
    return nullptr;
  }
  ROS_ERROR("Could not load controller '%s' because controller type '%s' does not exist.",
            name.c_str(), type.c_str());
  ROS_ERROR(
      "Use 'rosservice call controller_manager/list_controller_types' to get the available types");
  return nullptr;
}

bool ControllerManager::initController(ControllerSpec& spec, ros::NodeHandle& controller_nh) {
  const char* const name = spec.info.name.c_str();
  bool initialized = false;
  try {
    initialized =
        spec.c->initRequest(robot_hw_, root_nh_, controller_nh, spec.info.claimed_resources);
  } catch (const std::exception& error) {
    ROS_ERROR("Exception thrown while initializing controller '%s'.\n%s", name, error.what());
  } catch (...) {
    ROS_ERROR("Exception thrown while initializing controller '%s'.\nIt is of an unknown type.",
              name);
  }
  if (!initialized) {
    ROS_ERROR("Initializing controller '%s' failed", name);
  }
  return initialized;
}

bool ControllerManager::watchController(ControllerSpec& spec, const ros::NodeHandle& nh) {
  if (!supervisor_) {
    return true;
  }
  std::vector<std::string> fallbacks;
  if (nh.hasParam("fallback_controllers") && !nh.getParam("fallback_controllers", fallbacks)) {
    ROS_ERROR("Could not load controller '%s' because '%s' is not a list of controllers' names",
              spec.info.name.c_str(), nh.resolveName("fallback_controllers").c_str());
    return false;
  }
  spec.watch = std::make_shared<internal::ControllerWatch>(
      *spec.c, spec.info, *robot_hw_, supervisor_->supervision(), std::move(fallbacks));
  return true;
}

bool ControllerManager::unloadController(const std::string& name) {
  if (refusedInLoop("unload")) {
    return false;
  }
  const std::lock_guard<std::mutex> lock(services_mutex_);
  std::vector<ControllerSpec> specs = registry_->snapshot()->specs();
  const auto found = std::find_if(specs.begin(), specs.end(), [&](const ControllerSpec& spec) {
    return spec.info.name == name;
  });
  if (found == specs.end()) {
    ROS_ERROR(
        "Could not unload controller with name '%s' because no controller with this name exists",
        name.c_str());
    return false;
  }
  if (found->c->isRunning()) {
    ROS_ERROR("Could not unload controller with name '%s' because it is still running",
              name.c_str());
    return false;
  }
  if (handover_->involves(name)) {
    ROS_ERROR(
        "Could not unload controller with name '%s' because it takes part in a switch that has not "
        "finished. Is the control loop running?",
        name.c_str());
    return false;
  }
  specs.erase(found);
  registry_->replace(std::move(specs));
  return true;
}

bool ControllerManager::reloadControllerLibraries(bool force_kill) {
  // Names only: a reference to a controller would prevent unloading its library.
  std::vector<std::string> loaded;
  std::vector<std::string> running;
  for (const ControllerSpec& spec : getControllers()) {
    loaded.push_back(spec.info.name);
    if (spec.c->isRunning()) {
      running.push_back(spec.info.name);
    }
  }
  if (!loaded.empty() && !force_kill) {
    ROS_ERROR(
        "Controller manager: Cannot reload controller libraries because there are still %i "
        "controllers running",
        static_cast<int>(loaded.size()));
    return false;
  }
  // Without running controllers this must not wait for the loop.
  constexpr int kBestEffort = controller_manager_msgs::SwitchControllerRequest::BEST_EFFORT;
  if (!running.empty() && !switchController({}, running, kBestEffort)) {
    ROS_ERROR(
        "Controller manager: Cannot reload controller libraries because the running "
        "controllers could not be stopped");
    return false;
  }
  for (const std::string& name : loaded) {
    if (!unloadController(name)) {
      ROS_ERROR(
          "Controller manager: Cannot reload controller libraries because controller '%s' "
          "could not be unloaded",
          name.c_str());
      return false;
    }
  }
  return reloadLoaders();
}

bool ControllerManager::reloadLoaders() {
  const std::lock_guard<std::mutex> services_lock(services_mutex_);
  if (!registry_->snapshot()->specs().empty()) {
    ROS_ERROR(
        "Controller manager: Cannot reload controller libraries because a controller was "
        "loaded meanwhile");
    return false;
  }
  const std::lock_guard<std::mutex> loaders_lock(loaders_mutex_);
  for (const ControllerLoaderInterfaceSharedPtr& loader : controller_loaders_) {
    loader->reload();
    ROS_INFO("Controller manager: reloaded controller libraries for '%s'",
             loader->getName().c_str());
  }
  return true;
}

}  // namespace controller_manager

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// A switch from outside the loop: the request, whether it is possible, and its result.
#include <controller_manager/controller_manager.h>
#include <controller_manager/internal/controller_registry.h>
#include <controller_manager/internal/loop_gate.h>
#include <controller_manager/internal/supervisor.h>
#include <controller_manager/internal/switch_handover.h>
#include <controller_manager_msgs/SwitchController.h>
#include <ros/console.h>

#include <algorithm>
#include <memory>
#include <utility>

namespace controller_manager {

using controller_manager_msgs::SwitchControllerRequest;
using internal::ControllerList;
using internal::SwitchHandover;
using internal::SwitchRequest;

namespace {

typedef std::vector<std::string> Names;

// [s] for the robot to replace an aborted controller.
constexpr double kFaultTimeout = 1.0;

bool contains(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void remove(Names& names, const std::string& name) {
  names.erase(std::remove(names.begin(), names.end(), name), names.end());
}

/// Removes unknown and duplicate names, keeping the order. @returns false, in strict mode, if a
/// name is unknown.
bool resolve(const ControllerList& list, const Names& requested, const char* verb, bool strict,
             Names& resolved) {
  for (const std::string& name : requested) {
    if (list.find(name) != nullptr) {
      if (!contains(resolved, name)) {
        resolved.push_back(name);
      }
    } else if (strict) {
      ROS_ERROR(
          "Could not %s controller with name '%s' because no controller with this name exists",
          verb, name.c_str());
      return false;
    } else {
      ROS_DEBUG(
          "Could not %s controller with name '%s' because no controller with this name "
          "exists",
          verb, name.c_str());
    }
  }
  return true;
}

/// Removes controllers that are already stopped or running. @returns false, in strict mode, if
/// there are any.
bool dropPointless(const ControllerList& list, bool strict, Names& start, Names& stop) {
  for (const ControllerSpec& spec : list.specs()) {
    const std::string& name = spec.info.name;
    const bool running = spec.c->isRunning();
    if (!running && contains(stop, name)) {
      if (strict) {
        ROS_ERROR("Could not stop controller '%s' since it is not running", name.c_str());
        return false;
      }
      remove(stop, name);
    }
    if (running && contains(start, name) && !contains(stop, name)) {
      if (strict) {
        ROS_ERROR("Controller '%s' is already running", name.c_str());
        return false;
      }
      remove(start, name);
    }
  }
  return true;
}

/// The running controllers after the switch.
std::list<hardware_interface::ControllerInfo> runningAfter(const ControllerList& list,
                                                           const Names& start, const Names& stop) {
  std::list<hardware_interface::ControllerInfo> infos;
  for (const ControllerSpec& spec : list.specs()) {
    if (contains(start, spec.info.name) ||
        (spec.c->isRunning() && !contains(stop, spec.info.name))) {
      infos.push_back(spec.info);
    }
  }
  return infos;
}

std::unique_ptr<SwitchRequest> makeRequest(const ControllerList& list, const Names& start,
                                           const Names& stop) {
  auto request = std::make_unique<SwitchRequest>();
  for (const std::string& name : stop) {
    const ControllerSpec& spec = *list.find(name);
    request->stops.push_back({spec.c, name});
    request->stop_list.push_back(spec.info);
  }
  for (const std::string& name : start) {
    const ControllerSpec& spec = *list.find(name);
    request->starts.push_back({spec.c, spec.info, SwitchRequest::Outcome::kPending});
    request->start_list.push_back(spec.info);
  }
  return request;
}

void reportOutcome(const SwitchRequest& request) {
  for (const SwitchRequest::Start& start : request.starts) {
    switch (start.outcome) {
      case SwitchRequest::Outcome::kRobotError:
        ROS_ERROR("Controller '%s' was not started, because the robot could not switch to it",
                  start.info.name.c_str());
        break;
      case SwitchRequest::Outcome::kTimeout:
        ROS_ERROR_STREAM("Controller '" << start.info.name
                                        << "' was not started, because the robot was not ready for "
                                           "it after "
                                        << request.timeout << " s");
        break;
      case SwitchRequest::Outcome::kThrew:
        ROS_ERROR("Controller '%s' was not started, because its %s threw: %s",
                  start.info.name.c_str(), start.thrower, start.thrown.data());
        break;
      default:
        break;
    }
    if (start.thrower != nullptr && start.outcome != SwitchRequest::Outcome::kThrew) {
      ROS_ERROR("Controller '%s' threw in its %s: %s", start.info.name.c_str(), start.thrower,
                start.thrown.data());
    }
  }
}

Names thrownBy(const SwitchRequest& request) {
  Names names;
  for (const SwitchRequest::Start& start : request.starts) {
    if (start.outcome == SwitchRequest::Outcome::kThrew) {
      names.push_back(start.info.name);
    }
  }
  return names;
}

}  // namespace

std::unique_ptr<SwitchRequest> ControllerManager::planSwitch(const Names& start_controllers,
                                                             const Names& stop_controllers,
                                                             bool strict) {
  const internal::ControllerListPtr list = registry_->snapshot();
  Names start;
  Names stop;
  if (!resolve(*list, stop_controllers, "stop", strict, stop) ||
      !resolve(*list, start_controllers, "start", strict, start) ||
      !dropPointless(*list, strict, start, stop)) {
    return nullptr;
  }
  if (robot_hw_->checkForConflict(runningAfter(*list, start, stop))) {
    ROS_ERROR("Could not switch controllers, due to resource conflict");
    return nullptr;
  }
  std::unique_ptr<SwitchRequest> request = makeRequest(*list, start, stop);
  if (!robot_hw_->prepareSwitch(request->start_list, request->stop_list)) {
    ROS_ERROR(
        "Could not switch controllers. The hardware interface combination for the requested "
        "controllers is unfeasible.");
    return nullptr;
  }
  return request;
}

bool ControllerManager::switchController(const Names& start_controllers,
                                         const Names& stop_controllers, const int strictness,
                                         bool start_asap, double timeout) {
  if (refusedInLoop("switch")) {
    return false;
  }
  Names thrown;
  const bool carried_out = carryOut(start_controllers, stop_controllers, strictness, start_asap,
                                    timeout > 0.0 ? timeout : default_switch_timeout_, thrown);
  for (const std::string& name : thrown) {
    if (!handleFault(name, true)) {
      supervisor_->handleLater(name);
    }
  }
  return carried_out;
}

bool ControllerManager::carryOut(const Names& start_controllers, const Names& stop_controllers,
                                 int strictness, bool start_asap, double timeout, Names& thrown) {
  const bool strict = strictness == SwitchControllerRequest::STRICT;
  if (!strict && strictness != SwitchControllerRequest::BEST_EFFORT) {
    ROS_WARN(
        "Controller Manager: To switch controllers you need to specify a strictness level of "
        "controller_manager_msgs::SwitchController::STRICT (%d) or ::BEST_EFFORT (%d), not %d. "
        "Defaulting to ::BEST_EFFORT.",
        SwitchControllerRequest::STRICT, SwitchControllerRequest::BEST_EFFORT, strictness);
  }

  SwitchHandover::Turn turn(*handover_, timeout);
  if (!turn) {
    if (handover_->mustEnd()) {
      ROS_WARN("Could not switch controllers, because the controller manager is shutting down");
      return false;
    }
    ROS_ERROR_STREAM(
        "Could not switch controllers, because the switch before this one has not finished after "
        << turn.elapsed() << " s. Is the control loop running?");
    return false;
  }
  std::list<hardware_interface::ControllerInfo> start_list;
  std::list<hardware_interface::ControllerInfo> stop_list;
  {
    const std::lock_guard<std::mutex> lock(services_mutex_);
    auto request = planSwitch(start_controllers, stop_controllers, strict);
    if (!request) {
      return false;
    }
    request->start_asap = start_asap;
    request->guarded = supervisor_ && supervisor_->supervision().abort_faulty;
    request->timeout = timeout;
    start_list = request->start_list;
    stop_list = request->stop_list;
    turn.post(std::move(request));
  }

  switch (turn.await()) {
    case SwitchHandover::Result::kDone:
      reportOutcome(turn.request());
      thrown = thrownBy(turn.request());
      if (turn.request().broken) {
        ROS_ERROR(
            "Could not finish switching controllers, because an exception went through the "
            "control loop: %s. What had not been started or stopped yet was aborted.",
            turn.request().broken_by.data());
        return false;
      }
      return true;
    case SwitchHandover::Result::kAbandoned:
      ROS_ERROR_STREAM(
          "Could not finish switching controllers, because the control loop stood still for "
          << turn.elapsed()
          << " s after it had begun. The controllers to start will be aborted when it runs again.");
      return false;
    case SwitchHandover::Result::kWithdrawn:
      break;
  }
  explainWithdrawal(turn.elapsed());
  // The robot prepared for a switch that was withdrawn: let it prepare the reverse switch.
  const std::lock_guard<std::mutex> lock(services_mutex_);
  if (!robot_hw_->prepareSwitch(stop_list, start_list)) {
    ROS_WARN("The robot refused to take the preparations of that switch back");
  }
  return false;
}

void ControllerManager::explainWithdrawal(double elapsed) const {
  if (handover_->mustEnd()) {
    ROS_WARN("Could not switch controllers, because the controller manager is shutting down");
  } else {
    ROS_ERROR_STREAM("Could not switch controllers, because the control loop did not run for "
                     << elapsed << " s. Is the robot connected, or the simulation paused?");
  }
}

std::unique_ptr<SwitchRequest> ControllerManager::planFallback(const ControllerSpec& aborted) {
  const internal::ControllerListPtr list = registry_->snapshot();
  Names start;
  for (const std::string& name : aborted.watch->fallbacks()) {
    const ControllerSpec* const spec = list->find(name);
    if (spec == nullptr) {
      ROS_ERROR("The fallback '%s' of controller '%s' is not loaded", name.c_str(),
                aborted.info.name.c_str());
    } else if (!spec->c->isRunning() && spec->c != aborted.c && !contains(start, name)) {
      start.push_back(name);
    }
  }
  if (!start.empty() && robot_hw_->checkForConflict(runningAfter(*list, start, {}))) {
    ROS_ERROR("The fallbacks of controller '%s' were not started, due to resource conflict",
              aborted.info.name.c_str());
    start.clear();
  }
  std::unique_ptr<SwitchRequest> request = makeRequest(*list, start, {});
  request->stop_list.push_back(aborted.info);
  if (!robot_hw_->prepareSwitch(request->start_list, request->stop_list)) {
    ROS_ERROR("The robot refused to stop what controller '%s' commanded",
              aborted.info.name.c_str());
    return nullptr;
  }
  return request;
}

bool ControllerManager::handleFault(const std::string& name, bool first) {
  SwitchHandover::Turn turn(*handover_, kFaultTimeout);
  if (!turn) {
    if (first && !handover_->mustEnd()) {
      ROS_ERROR(
          "The robot could not be notified yet that controller '%s' was aborted: another switch is "
          "under way. It will be notified when that has ended.",
          name.c_str());
    }
    return false;
  }
  {
    const std::lock_guard<std::mutex> lock(services_mutex_);
    const internal::ControllerListPtr list = registry_->snapshot();
    const ControllerSpec* const spec = list->find(name);
    // It may have been started or unloaded meanwhile.
    if (spec == nullptr || !spec->c->isAborted()) {
      return true;
    }
    std::unique_ptr<SwitchRequest> request = planFallback(*spec);
    if (!request) {
      return true;
    }
    request->timeout = kFaultTimeout;
    request->guarded = true;
    turn.post(std::move(request));
  }
  switch (turn.await()) {
    case SwitchHandover::Result::kDone:
      reportOutcome(turn.request());
      return true;
    case SwitchHandover::Result::kAbandoned:
      // The robot has been notified; only the fallbacks are lost.
      explainWithdrawal(turn.elapsed());
      return true;
    case SwitchHandover::Result::kWithdrawn:
      break;
  }
  if (first) {
    explainWithdrawal(turn.elapsed());
  }
  return false;
}

}  // namespace controller_manager

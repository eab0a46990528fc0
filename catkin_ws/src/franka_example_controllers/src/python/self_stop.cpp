// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "self_stop.h"

#include <controller_manager_msgs/SwitchController.h>
#include <ros/console.h>
#include <ros/service.h>

#include <atomic>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "waking.h"

namespace franka_example_controllers {

namespace {

constexpr double kSwitchTimeout = 5.0;  // [s]
constexpr double kEndLimit = 1.0;       // [s] for the thread to end in the destructor

std::string nameBelow(const std::string& root, const std::string& space) {
  const std::size_t skip = root == "/" ? 1 : root.size() + 1;
  return space.size() > skip && space.compare(0, root.size(), root) == 0 ? space.substr(skip)
                                                                         : space;
}

}  // namespace

struct SelfStop::Shared {
  std::string service, name;
  std::vector<std::string> fallbacks;
  Semaphore happened, ended;
  std::atomic<bool> failed{false}, rests{false}, quits{false};
  std::mutex mutex;  // guards the report, which must not outlive the controller
  std::function<void()> report;

  void work();
  void stopController() const;
};

void SelfStop::Shared::work() {
  for (;;) {
    happened.wait();
    if (quits) {
      break;
    }
    if (failed.exchange(false)) {
      const std::lock_guard<std::mutex> lock(mutex);
      if (report) {
        report();
      }
    }
    if (rests.exchange(false)) {
      stopController();
    }
  }
  ended.post();
}

void SelfStop::Shared::stopController() const {
  controller_manager_msgs::SwitchController order;
  order.request.stop_controllers = {name};
  order.request.start_controllers = fallbacks;
  order.request.strictness = controller_manager_msgs::SwitchControllerRequest::BEST_EFFORT;
  order.request.timeout = kSwitchTimeout;
  if (!ros::service::call(service, order) || !order.response.ok) {
    ROS_ERROR(
        "PythonController '%s' has failed and could not be stopped through %s; it holds the arm at "
        "rest. Stop it by hand.",
        name.c_str(), service.c_str());
  }
}

SelfStop::SelfStop(ros::NodeHandle& root_nh, ros::NodeHandle& controller_nh,
                   std::function<void()> report)
    : shared_(std::make_shared<Shared>()) {
  shared_->service = root_nh.resolveName("controller_manager/switch_controller");
  shared_->name = nameBelow(root_nh.getNamespace(), controller_nh.getNamespace());
  controller_nh.getParam("fallback_controllers", shared_->fallbacks);
  shared_->report = std::move(report);
  std::thread([shared = shared_] { shared->work(); }).detach();
}

SelfStop::~SelfStop() {
  {
    const std::lock_guard<std::mutex> lock(shared_->mutex);
    shared_->report = nullptr;
  }
  shared_->quits = true;
  shared_->happened.post();
  // The thread may wait for a service that waits for this destructor; it then ends by itself.
  shared_->ended.waitUntil(deadlineAfter(kEndLimit));
}

void SelfStop::fail() {
  shared_->failed = true;
  shared_->happened.post();
}

void SelfStop::stop() {
  shared_->rests = true;
  shared_->happened.post();
}

const std::string& SelfStop::name() const { return shared_->name; }

}  // namespace franka_example_controllers

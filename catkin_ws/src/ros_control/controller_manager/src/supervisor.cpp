// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <controller_manager/internal/first_exception.h>
#include <controller_manager/internal/supervisor.h>
#include <ros/console.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace controller_manager {
namespace internal {

namespace {

// Period of handling faults; too short for users to notice.
constexpr std::chrono::milliseconds kFaultPeriod{2};
// Chosen here: three years; the sum of a longer one and the clock could leave the clock's range.
constexpr double kMaxPeriod = 1e8;  // [s]

double readPositive(const ros::NodeHandle& nh, const std::string& name) {
  XmlRpc::XmlRpcValue value;
  if (!nh.getParam(name, value)) {
    return 0.0;
  }
  double number = -1.0;
  if (value.getType() == XmlRpc::XmlRpcValue::TypeInt) {
    number = static_cast<int>(value);
  } else if (value.getType() == XmlRpc::XmlRpcValue::TypeDouble) {
    number = static_cast<double>(value);
  }
  if (!std::isfinite(number) || number < 0.0) {
    throw std::invalid_argument("The parameter '" + nh.resolveName(name) +
                                "' must be a number not below zero");
  }
  return number;
}

bool readBool(const ros::NodeHandle& nh, const std::string& name) {
  bool value = false;
  if (nh.hasParam(name) && !nh.getParam(name, value)) {
    throw std::invalid_argument("The parameter '" + nh.resolveName(name) +
                                "' must be true or false");
  }
  return value;
}

}  // namespace

Supervision readSupervision(const ros::NodeHandle& nh) {
  Supervision supervision;
  supervision.statistics_rate = readPositive(nh, "statistics_rate");
  supervision.abort_faulty = readBool(nh, "abort_faulty_controllers");
  supervision.max_update_time = readPositive(nh, "max_update_time");
  supervision.default_switch_timeout = readPositive(nh, "default_switch_timeout");
  return supervision;
}

Supervisor::Supervisor(const Supervision& supervision, ControllerRegistry& registry, LoopGate& gate,
                       const ros::NodeHandle& nh, Settle settle)
    : supervision_(supervision), registry_(registry), gate_(gate), settle_(std::move(settle)) {
  if (supervision_.statistics_rate > 0.0) {
    ros::NodeHandle advertiser(nh);
    publisher_ =
        advertiser.advertise<controller_manager_msgs::ControllersStatistics>("statistics", 1);
  }
  thread_ = std::thread([this] { run(); });
}

Supervisor::~Supervisor() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ended_ = true;
  }
  ending_.notify_all();
  thread_.join();
}

// --- in the loop ---------------------------------------------------------------------------------

void Supervisor::update(const ControllerList& list, const ros::Time& time,
                        const ros::Duration& period) {
  const std::size_t window = window_.load(std::memory_order_seq_cst);
  const auto begin = Clock::now();
  if (last_cycle_ != Clock::time_point()) {
    cycle_[window].add(std::chrono::duration<double>(begin - last_cycle_).count());
  }
  last_cycle_ = begin;
  FirstException thrown;
  for (const ControllerSpec& spec : list.specs()) {
    thrown.capture([&] { spec.watch->update(time, period, window); });
  }
  const std::chrono::duration<double> elapsed = Clock::now() - begin;
  execution_[window].add(elapsed.count());
  if (period > ros::Duration(0.0) && elapsed.count() > period.toSec()) {
    execution_[window].addOverrun(time.toSec());
  }
  thrown.rethrow();
}

// --- outside -------------------------------------------------------------------------------------

void Supervisor::run() {
  const bool publishes = supervision_.statistics_rate > 0.0;
  const std::chrono::duration<double> period(
      publishes ? std::min(1.0 / supervision_.statistics_rate, kMaxPeriod) : 1.0);
  auto next = Clock::now() + std::chrono::duration_cast<Clock::duration>(period);
  const bool settles = supervision_.abort_faulty || supervision_.max_update_time > 0.0;

  std::unique_lock<std::mutex> lock(mutex_);
  while (!ended_) {
    ending_.wait_until(lock, settles ? std::min(next, Clock::now() + kFaultPeriod) : next);
    lock.unlock();
    if (settles) {
      handleFaults();
    }
    if (Clock::now() >= next) {
      next += std::chrono::duration_cast<Clock::duration>(period);
      if (publishes) {
        publish();
      }
    }
    lock.lock();
  }
}

void Supervisor::handleFaults() {
  const ControllerListPtr list = registry_.snapshot();
  for (const ControllerSpec& spec : list->specs()) {
    if (spec.watch->fault() == ControllerWatch::Fault::kNone) {
      continue;
    }
    ROS_ERROR("Controller '%s' was aborted, because %s.", spec.info.name.c_str(),
              spec.watch->reason().c_str());
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      unsettled_[spec.info.name] = true;
    }
    spec.watch->settle();
  }
  std::map<std::string, bool> unsettled;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    unsettled.swap(unsettled_);
  }
  for (const auto& [name, first] : unsettled) {
    if (!settle_(name, first)) {
      handleLater(name);
    }
  }
}

void Supervisor::handleLater(const std::string& name) {
  const std::lock_guard<std::mutex> lock(mutex_);
  unsettled_.emplace(name, false);
}

controller_manager_msgs::ControllerStatistics Supervisor::message(const std::string& name,
                                                                  const std::string& type,
                                                                  TimeStatistics& statistics) {
  std::pair<std::uint32_t, double>& overruns = overruns_[name + " " + type];
  if (statistics.overruns() > 0) {
    overruns.first += statistics.overruns();
    overruns.second = statistics.lastOverrun();
  }
  controller_manager_msgs::ControllerStatistics entry;
  entry.name = name;
  entry.type = type;
  entry.timestamp = ros::Time::now();
  entry.max_time = ros::Duration(statistics.max());
  entry.mean_time = ros::Duration(statistics.mean());
  entry.variance_time = ros::Duration(std::sqrt(statistics.variance()));
  entry.num_control_loop_overruns = static_cast<std::int32_t>(overruns.first);
  entry.time_last_control_loop_overrun = ros::Time(overruns.second);
  entry.running = statistics.count() > 0;
  statistics = TimeStatistics();
  return entry;
}

void Supervisor::publish() {
  const ControllerListPtr list = registry_.snapshot();
  const std::size_t filled = window_.load(std::memory_order_relaxed);
  window_.store(1 - filled, std::memory_order_seq_cst);
  if (!gate_.waitUntilLeft(LoopGate::kMaxCycleTime)) {
    // The loop may still write the statistics to read: try again next time.
    window_.store(filled, std::memory_order_seq_cst);
    return;
  }
  controller_manager_msgs::ControllersStatistics statistics;
  statistics.header.stamp = ros::Time::now();
  for (const ControllerSpec& spec : list->specs()) {
    statistics.controller.push_back(
        message(spec.info.name, spec.info.type, spec.watch->statistics(filled)));
    statistics.controller.back().running = spec.c->isRunning();
  }
  statistics.controller.push_back(message("control_loop", "execution", execution_[filled]));
  statistics.controller.push_back(message("control_loop", "period", cycle_[filled]));
  publisher_.publish(statistics);
}

}  // namespace internal
}  // namespace controller_manager

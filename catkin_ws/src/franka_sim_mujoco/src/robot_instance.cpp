// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot_instance.h"

#include <franka_sim/physics/world.h>
#include <franka_sim/robot/control_unit.h>
#include <ros/console.h>

#include <algorithm>
#include <exception>
#include <stdexcept>
#include <utility>

#include "combined_hw_sim.h"
#include "joint_state_publisher.h"
#include "pace.h"
#include "service_handlers.h"
#include "transform_publisher.h"

namespace franka_sim_mujoco {

namespace {

/// Messages with joint states that may wait for their transforms, half of what the queue holds.
constexpr double kMaxWaitingTransforms = 500;

/// The URDF uses the original's name of the hardware; if the package franka_gazebo is not ours (it
/// steps aside for the original) the same hardware has our own name. Likewise Gazebo's default.
std::string availableName(HardwareLoader& loader, const std::string& type) {
  if (!loader.isClassAvailable(type)) {
    for (const std::string original : {"franka_gazebo/", "gazebo_ros_control/"}) {
      if (type.compare(0, original.size(), original) == 0) {
        return "franka_sim_mujoco/" + type.substr(original.size());
      }
    }
  }
  return type;
}

/// Interval of checks whether the awaited controllers run [ticks].
constexpr int kStartReview = 50;

/// Adds the time since its construction to a sum, unless null.
class Stopwatch {
 public:
  explicit Stopwatch(bool runs) noexcept : last_(runs ? threadNanoseconds() : 0) {}
  void lap(std::int64_t& sum) noexcept {
    const std::int64_t now = threadNanoseconds();
    sum += now - last_;
    last_ = now;
  }

 private:
  std::int64_t last_;
};

std::set<std::string> resourcesOf(const hardware_interface::RobotHW& hardware) {
  std::set<std::string> resources;
  for (const std::string& interface : hardware.getNames()) {
    for (const std::string& resource : hardware.getInterfaceResources(interface)) {
      resources.insert(resource);
    }
  }
  return resources;
}

template <typename Names>
bool containsAny(const std::set<std::string>& names, const Names& searched) {
  return std::any_of(searched.begin(), searched.end(),
                     [&](const std::string& name) { return names.count(name) > 0; });
}

bool claimsAnyOf(const hardware_interface::ControllerInfo& controller,
                 const std::set<std::string>& resources) {
  return std::any_of(controller.claimed_resources.begin(), controller.claimed_resources.end(),
                     [&](const hardware_interface::InterfaceResources& claimed) {
                       return containsAny(resources, claimed.resources);
                     });
}

}  // namespace

RobotInstance::RobotInstance(const RobotPlan& plan, franka_sim::World& world,
                             HardwareLoader& loader, BetweenTicks between_ticks,
                             const OperatorAccess& access)
    : name_(plan.description.name), control_ticks_(plan.control_ticks) {
  for (const SimulatedArm& arm : plan.arms) {
    if (!arm.type.empty()) {
      in_scene_.push_back({arm.arm_id, arm.type});
    }
  }
  for (const auto& joint : plan.urdf.joints_) {
    joints_.insert(joint.first);
  }
  start(plan, world, loader, std::move(between_ticks), access);
}

RobotInstance::~RobotInstance() = default;

void RobotInstance::start(const RobotPlan& plan, franka_sim::World& world, HardwareLoader& loader,
                          BetweenTicks between_ticks, const OperatorAccess& access) {
  const RobotHandle robot{&world,
                          name_,
                          franka_sim::withHeldJoints(plan.description.urdf),
                          std::move(between_ticks),
                          plan.arms,
                          plan.control_ticks};
  if (!plan.fci_ip.empty()) {
    serve(plan, robot, access);
  } else if (!plan.hardware_type.empty()) {
    startHardware(plan, robot, loader);
  } else {
    ROS_INFO_NAMED(kLog, "'%s' names no robotSimType: it stands in the world without hardware.",
                   name_.c_str());
  }
}

void RobotInstance::serve(const RobotPlan& plan, const RobotHandle& robot,
                          const OperatorAccess& access) {
  try {
    served_ = std::make_unique<ServedRobot>(plan, robot, access);
  } catch (...) {
    throw std::runtime_error("'" + name_ + "' cannot be served at " + plan.fci_ip + ": " +
                             exceptionText());
  }
  ROS_INFO_NAMED(kLog, "'%s' is served over the FCI at %s.", name_.c_str(), plan.fci_ip.c_str());
}

void RobotInstance::loadHardware(const std::string& type, std::size_t arms,
                                 HardwareLoader& loader) {
  try {
    if (arms == 1) {
      hardware_ = loader.createSharedInstance(type);
      return;
    }
    std::vector<std::shared_ptr<RobotHWSim>> members;
    while (members.size() < arms) {
      members.push_back(loader.createSharedInstance(type));
    }
    hardware_ = std::make_shared<CombinedHWSim>(std::move(members));
  } catch (const pluginlib::PluginlibException& error) {
    throw std::runtime_error("The hardware plugin '" + type + "' of '" + name_ +
                             "' cannot be loaded: " + error.what());
  }
}

void RobotInstance::startHardware(const RobotPlan& plan, const RobotHandle& robot,
                                  HardwareLoader& loader) {
  const std::string type = availableName(loader, plan.hardware_type);
  loadHardware(type, plan.arms.size(), loader);
  const ros::NodeHandle node(plan.robot_namespace);
  if (!hardware_->initSim(plan.robot_namespace, node, robot, &plan.urdf, plan.transmissions)) {
    const std::string reason = hardware_->failure();
    throw std::runtime_error("The hardware of '" + name_ + "' (" + type + ") does not start: " +
                             (reason.empty() ? "the simulation's log has the reason." : reason));
  }
  manager_ = std::make_unique<controller_manager::ControllerManager>(hardware_.get(), node);
  if (plan.joint_state_rate) {
    joint_states_ = std::make_unique<JointStatePublisher>(
        node, *plan.joint_state_rate, plan.urdf, *hardware_, *robot.world, robot.between_ticks);
    max_transform_lag_ = ros::Duration(kMaxWaitingTransforms / *plan.joint_state_rate);
  }
  if (plan.publish_transforms) {
    transforms_ = std::make_unique<TransformPublisher>(node, plan.urdf);
  }
  awaited_controllers_ = plan.awaited_controllers;
  start_ticks_left_ = awaited_controllers_.empty() ? 0 : kMaxStartTicks;
}

bool RobotInstance::hasAnyOf(const std::vector<std::string>& joints) const {
  return containsAny(joints_, joints);
}

void RobotInstance::tick(const ros::Time& time, TickTimes* times) {
  if (!hardware_) {
    return;
  }
  Stopwatch watch(times != nullptr);
  TickTimes unused;
  TickTimes& sums = times != nullptr ? *times : unused;
  const ros::Duration tick(franka_sim::World::kTick);
  hardware_->readSim(time, tick);
  if (times != nullptr) {
    watch.lap(sums.read);
  }
  if (ticks_to_control_ > 0) {
    --ticks_to_control_;
  } else {
    updateControllers(time, ros::Duration(control_ticks_ * franka_sim::World::kTick));
    restarts_ = nullptr;
    ticks_to_control_ = control_ticks_ - 1;
  }
  if (times != nullptr) {
    watch.lap(sums.update);
  }
  if (joint_states_ && joint_states_->tick(time)) {
    limitTransformLag(time);
  }
  hardware_->writeSim(time, tick);
  if (times != nullptr) {
    watch.lap(sums.write);
  }
  if (isStarting() && --start_ticks_left_ % kStartReview == 0) {
    reviewStart();
  }
}

void RobotInstance::limitTransformLag(const ros::Time& time) {
  if (first_joint_states_.isZero()) {
    first_joint_states_ = time;
  }
  if (transforms_ && time - first_joint_states_ > max_transform_lag_) {
    transforms_->waitFor(time - max_transform_lag_);
  }
}

void RobotInstance::publishNow(const ros::Time& time) {
  if (joint_states_) {
    joint_states_->publishNow(time);
  }
}

void RobotInstance::waitForTransforms(const ros::Time& time) {
  if (joint_states_ && transforms_) {
    transforms_->waitFor(time);
  }
}

void RobotInstance::reviewStart() {
  std::vector<std::string> missing = awaited_controllers_;
  for (const controller_manager::ControllerSpec& spec : manager_->getControllers()) {
    if (spec.c->isRunning()) {
      missing.erase(std::remove(missing.begin(), missing.end(), spec.info.name), missing.end());
    }
  }
  if (missing.empty()) {
    start_ticks_left_ = 0;
  } else if (!isStarting()) {
    std::string names;
    for (const std::string& name : missing) {
      names += (names.empty() ? "'" : "', '") + name;
    }
    ROS_WARN_NAMED(kLog,
                   "'%s' has waited %d s of simulated time for its launch file to start %s': time "
                   "does not wait for that any longer.",
                   name_.c_str(), kMaxStartTicks / 1000, names.c_str());
  }
}

void RobotInstance::updateControllers(const ros::Time& time, const ros::Duration& period) {
  try {
    manager_->update(time, period, restarts_);
  } catch (...) {
    // A single controller must not end the simulation.
    thrown_report_.report(name_, exceptionText(),
                          "The robot is stopped until another controller is started in its place.");
    hardware_->eStopActive(true);
  }
}

void RobotInstance::requireRest() const {
  if (served_ && served_->isCommanded()) {
    throw std::runtime_error("A client moves '" + name_ +
                             "' over the FCI: end its motion before anything is put elsewhere.");
  }
}

std::string RobotInstance::condition() const {
  if (served_) {
    return franka_sim::conditionText(name_, served_->robot().unit().state());
  }
  return hardware_ ? hardware_->condition() : "";
}

void RobotInstance::halt() {
  if (served_) {
    served_->robot().halt();
  }
}

void RobotInstance::worldWasReset() {
  if (served_) {
    served_->robot().restart();
  }
  if (hardware_) {
    hardware_->worldWasReset();
    restarts_ = [](const hardware_interface::ControllerInfo&) { return true; };
    ticks_to_control_ = 0;
  }
}

void RobotInstance::jointsWereSet(const std::vector<std::string>& joints) {
  if (!hardware_) {
    worldWasReset();
    return;
  }
  std::set<std::string> concerned;
  for (RobotHWSim* part : hardware_->parts()) {
    std::set<std::string> resources = resourcesOf(*part);
    if (containsAny(resources, joints)) {
      part->worldWasReset();
      concerned.merge(resources);
    }
  }
  restarts_ = [concerned,
               before = restarts_](const hardware_interface::ControllerInfo& controller) {
    return (before && before(controller)) || claimsAnyOf(controller, concerned);
  };
}

}  // namespace franka_sim_mujoco

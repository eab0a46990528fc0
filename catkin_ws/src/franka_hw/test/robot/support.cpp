// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "support.h"

#include <franka_core/arm_model.h>
#include <franka_hw/arm_connection.h>
#include <gtest/gtest.h>
#include <source_file.h>

#include <cctype>
#include <chrono>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace franka_hw_test {

using hardware_interface::EffortJointInterface;
using hardware_interface::PositionJointInterface;
using hardware_interface::VelocityJointInterface;

std::string nameOf(std::string claims) {
  for (char& letter : claims) {
    letter = std::isalnum(static_cast<unsigned char>(letter)) != 0 ? letter : '_';
  }
  return claims;
}

std::string urdfOf(const std::string& arm_id, const std::string& robot) {
  std::string urdf = franka_test::readSource("libfranka/test/data/" + robot + "_hand.urdf");
  for (size_t at = 0; (at = urdf.find(robot + "_", at)) != std::string::npos; at += arm_id.size()) {
    urdf.replace(at, robot.size(), arm_id);
  }
  return urdf;
}

namespace {

/// Adds another arm in the same world to a description.
std::string withArm(std::string urdf, const std::string& arm_id) {
  const std::string world = "<link name=\"world\" />", end = "</robot>";
  std::string more = urdfOf(arm_id);
  more.erase(0, more.find("<link name="));
  more.erase(more.find(world), world.size());
  more.insert(more.find("world_joint"), arm_id + "_");
  return urdf.replace(urdf.find(end), end.size(), more);
}

}  // namespace

// --- the robot -----------------------------------------------------------------------------------

ros::NodeHandle FakeArm::freshNamespace() {
  static int count = 0;
  return ros::NodeHandle("test" + std::to_string(++count));
}

std::vector<std::string> FakeArm::joints(const std::string& arm_id) {
  std::vector<std::string> names;
  for (int i = 1; i <= 7; i++) {
    names.push_back(arm_id + "_joint" + std::to_string(i));
  }
  return names;
}

FakeArm::FakeArm(const std::string& id, const ros::NodeHandle& namespace_nh)
    : arm_id(id), nh(namespace_nh), robot_nh(namespace_nh, id) {
  const std::string served = urdfOf("fr3");
  robot.script([&](auto& script) { script.urdf.assign(served.begin(), served.end()); });
  robot.change([&](auto& state) {
    state.F_T_NE = state.F_T_EE = franka_core::nominalEndEffectorFromUrdf(served, "fr3").value();
  });
  std::string others;  // arms in the same namespace
  nh.setParam("robot_description",
              nh.getParam("robot_description", others) ? withArm(others, arm_id) : urdfOf(arm_id));
  robot_nh.setParam("joint_names", joints(arm_id));
  robot_nh.setParam("arm_id", arm_id);
  robot_nh.setParam("robot_ip", robot.address());
  robot_nh.setParam("rate_limiting", false);
  robot_nh.setParam("cutoff_frequency", 1000.0);
  robot_nh.setParam("internal_controller", "joint_impedance");
  robot_nh.setParam("realtime_config", "ignore");
}

// --- the controller ------------------------------------------------------------------------------

template <typename Interface>
void TestController::claim(hardware_interface::RobotHW* robot_hw,
                           const std::vector<std::string>& names,
                           std::vector<typename Interface::ResourceHandleType>& handles,
                           ClaimedResources& claimed) {
  auto* const interface = robot_hw->get<Interface>();
  if (interface == nullptr) {
    throw std::runtime_error("the robot has no such interface");
  }
  interface->clearClaims();
  for (const std::string& name : names) {
    handles.push_back(interface->getHandle(name));
  }
  claimed.emplace_back(hardware_interface::internal::demangledTypeName<Interface>(),
                       interface->getClaims());
  interface->clearClaims();
}

bool TestController::initRequest(hardware_interface::RobotHW* robot_hw, ros::NodeHandle& /*root*/,
                                 ros::NodeHandle& nh, ClaimedResources& claimed) {
  const std::string arm_id = nh.param<std::string>("arm_id", "");
  std::vector<std::string> claims;
  nh.getParam("claims", claims);
  std::vector<std::string> joints = FakeArm::joints(arm_id);
  joints.resize(nh.param("joints", 7));
  const std::vector<std::string> robot{arm_id + "_robot"};
  for (const std::string& kind : claims) {
    if (kind == "JT") {
      claim<EffortJointInterface>(robot_hw, joints, torques_, claimed);
    } else if (kind == "JP") {
      claim<PositionJointInterface>(robot_hw, joints, positions_, claimed);
    } else if (kind == "JV") {
      claim<VelocityJointInterface>(robot_hw, joints, velocities_, claimed);
    } else if (kind == "CP") {
      claim<franka_hw::FrankaPoseCartesianInterface>(robot_hw, robot, poses_, claimed);
    } else if (kind == "CV") {
      claim<franka_hw::FrankaVelocityCartesianInterface>(robot_hw, robot, twists_, claimed);
    } else if (kind != "looks") {
      return false;
    }
  }
  state_ = ControllerState::INITIALIZED;
  return true;
}

void TestController::starting(const ros::Time& /*time*/) {
  ++starts;
  updates_since_start = 0;
  for (size_t i = 0; i < positions_.size(); i++) {
    q_[i] = positions_[i].getPosition();
  }
  if (!poses_.empty()) {
    pose_ = poses_[0].getRobotState().O_T_EE_c;
  }
}

void TestController::update(const ros::Time& /*time*/, const ros::Duration& period) {
  ++updates;
  ++updates_since_start;
  const Fault what = fault;
  if (what == Fault::kThrow) {
    throw std::runtime_error("this controller has had enough");
  }
  if (what == Fault::kSleep) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));  // the fault itself
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double error = what == Fault::kNan ? nan : 0.0;
  for (auto& handle : torques_) {
    handle.setCommand(torque + error);
  }
  for (size_t i = 0; i < positions_.size(); i++) {
    q_[i] += speed * period.toSec();
    positions_[i].setCommand(q_[i] + error);
  }
  for (auto& handle : velocities_) {
    handle.setCommand(speed + error);
  }
  for (auto& handle : poses_) {
    pose_[14] += speed * period.toSec();
    std::array<double, 16> command = pose_;
    command[12] += error;
    handle.setCommand(command);
  }
  for (auto& handle : twists_) {
    std::array<double, 6> command{0.0, 0.0, speed + error, 0.0, 0.0, 0.0};
    handle.setCommand(command);
  }
}

// --- the loop ------------------------------------------------------------------------------------

class Loop::Loader : public controller_manager::ControllerLoaderInterface {
 public:
  Loader() : ControllerLoaderInterface("franka_hw_test::TestController") {}
  controller_interface::ControllerBaseSharedPtr createInstance(const std::string& type) override {
    if (type != "test/Test") {
      throw std::runtime_error("unknown type " + type);
    }
    last = std::make_shared<TestController>();
    return last;
  }
  std::vector<std::string> getDeclaredClasses() override { return {"test/Test"}; }
  void reload() override {}

  std::shared_ptr<TestController> last;
};

Loop::Loop(franka_hw::FrankaHW& robot, const FakeArm& arm, bool considerate)
    : robot_(robot),
      nh_(arm.nh),
      arm_id_(arm.arm_id),
      considerate_(considerate),
      loader_(std::make_shared<Loader>()),
      manager_(&robot, arm.nh),
      thread_([this] { run(); }) {
  manager_.registerControllerLoader(loader_);
}

Loop::~Loop() {
  std::vector<std::string> all;
  for (const auto& [claims, controller] : controllers_) {
    if (controller->isRunning()) {
      all.push_back(nameOf(claims));
    }
  }
  manager_.switchController({}, all, 1, false, 60.0);
  ending_ = true;
  thread_.join();
}

controller_manager::ControllerLoaderInterfaceSharedPtr Loop::makeLoader() {
  return std::make_shared<Loader>();
}

std::string Loop::describe(const ros::NodeHandle& nh, const std::string& arm_id,
                           const std::string& claims) {
  std::vector<std::string> kinds;
  std::stringstream stream(claims.substr(0, claims.find(':')));
  for (std::string kind; std::getline(stream, kind, '+');) {
    kinds.push_back(kind);
  }
  const std::string name = nameOf(claims);
  nh.setParam(name + "/type", "test/Test");
  nh.setParam(name + "/claims", kinds);
  nh.setParam(name + "/arm_id", arm_id);
  return name;
}

TestController& Loop::controller(const std::string& claims) {
  if (controllers_.count(claims) == 0) {
    const std::string name = describe(nh_, arm_id_, claims);
    if (!manager_.loadController(name)) {
      throw std::runtime_error(claims + " could not be loaded");
    }
    controllers_[claims] = loader_->last.get();
  }
  return *controllers_.at(claims);
}

bool Loop::switchTo(const std::vector<std::string>& start, const std::vector<std::string>& stop) {
  const auto names = [this](std::vector<std::string> all) {
    for (std::string& name : all) {
      controller(name);
      name = nameOf(name);
    }
    return all;
  };
  return manager_.switchController(names(start), names(stop), 2, false, 60.0);
}

hardware_interface::ControllerInfo Loop::info(const std::string& claims) const {
  for (const controller_manager::ControllerSpec& spec : manager_.getControllers()) {
    if (spec.info.name == nameOf(claims)) {
      return spec.info;
    }
  }
  throw std::runtime_error(claims + " is not loaded");
}

std::vector<std::string> Loop::errors() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return errors_;
}

void Loop::forgetErrors() {
  const std::lock_guard<std::mutex> lock(mutex_);
  errors_.clear();
  has_error_ = false;
}

void Loop::run() {
  while (!ending_) {
    try {
      cycle();
    } catch (const std::exception& error) {
      const std::lock_guard<std::mutex> lock(mutex_);
      errors_.emplace_back(error.what());
      has_error_ = true;
    }
  }
}

void Loop::cycle() {
  if (robot_.controllerActive() && !has_error_) {
    robot_.control([this](const ros::Time& time, const ros::Duration& period) {
      const bool first = period.isZero();
      manager_.update(time, period, first && robot_.motionGoesOn());
      robot_.checkJointLimits();
      if (first) {
        robot_.reset();
      } else {
        robot_.enforceLimits(period);
      }
      return true;
    });
    return;
  }
  {
    const std::lock_guard<std::mutex> lock(robot_.robotMutex());
    if (robot_.connected()) {
      robot_.update(robot_.robot().readOnce());
    }
  }
  manager_.update(ros::Time::now(), ros::Duration(0.001));
  if (considerate_) {
    robot_.armConnection().mutex().yieldToRequests();
  }
}

}  // namespace franka_hw_test

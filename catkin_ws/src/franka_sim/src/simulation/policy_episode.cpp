// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/simulation/policy_episode.h>

#include <algorithm>
#include <stdexcept>

namespace franka_sim {

namespace {

constexpr double kMaxRecoveryTime = 1.0;  // [s]; one that succeeds takes less than half of it
constexpr std::size_t kArmSize = 7 + 7 + 3 + 6;
constexpr std::size_t kBodySize = 3 + 4 + 3;

Eigen::Isometry3d baseOf(const RobotSetup& setup) {
  Eigen::Isometry3d base = Eigen::Isometry3d::Identity();
  base.translation() = Eigen::Vector3d(setup.base.data());
  base.linear() = Eigen::AngleAxisd(setup.yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return base;
}

}  // namespace

PolicyEpisode::PolicyEpisode(Simulation& simulation, const Setting& setting)
    : simulation_(&simulation), setting_(setting) {
  for (SimulatedRobot& robot : simulation.robots()) {
    const Eigen::Isometry3d base = baseOf(robot.setup());
    robots_.push_back({&robot, base, {setting.control, robot, base, setting.workspace}, false});
    if (setting.hands) {
      GripperUnit* hand = robot.units().hand();
      if (hand == nullptr) {
        throw std::runtime_error("The robot '" + robot.setup().arm_id + "' has no hand.");
      }
      hands_.emplace_back(*hand);
    }
  }
  restart();
}

std::size_t PolicyEpisode::actionSize() const noexcept {
  return robots_.size() * sizeOfAction(setting_.control) + hands_.size();
}

std::size_t PolicyEpisode::observationSize() const noexcept {
  const std::size_t body = setting_.body.empty() ? 0 : kBodySize + robots_.size() + 1;
  return robots_.size() * kArmSize + hands_.size() + body;
}

void PolicyEpisode::restart() {
  reflexes_ = 0;
  waited_ = 0.0;
  for (Robot& robot : robots_) {
    robot.arm.restart();
    robot.stopped = false;
  }
  for (HandPolicy& hand : hands_) {
    hand.restart();
  }
  if (!setting_.body.empty()) {
    before_ = simulation_->world().bodyPose(setting_.body).position;
  }
}

void PolicyEpisode::apply(const double* action, double seconds) {
  for (std::size_t i = 0; i < robots_.size(); i++) {
    robots_[i].arm.apply(action, seconds);
    action += sizeOfAction(setting_.control);
    if (!hands_.empty()) {
      hands_[i].apply(*action++);
    }
  }
}

void PolicyEpisode::recover(double seconds) {
  for (Robot& robot : robots_) {
    const bool stopped = robot.robot->state().robot_mode == franka_core::RobotMode::kReflex;
    reflexes_ += stopped && !robot.stopped ? 1 : 0;
    robot.stopped = stopped;
    if (stopped) {
      try {
        robot.robot->recover();
      } catch (const RequestRefused&) {  // it still brakes: the next step tries again
      }
    }
  }
  waited_ = stopped() ? waited_ + seconds : 0.0;
}

bool PolicyEpisode::stopped() const noexcept {
  return std::any_of(robots_.begin(), robots_.end(),
                     [](const Robot& robot) { return robot.stopped; });
}

bool PolicyEpisode::stuck() const noexcept { return waited_ > kMaxRecoveryTime; }

void PolicyEpisode::observe(double seconds, double* observation) {
  double* to = observation;
  const auto put = [&to](const auto& values) { to = std::copy(values.begin(), values.end(), to); };
  for (std::size_t i = 0; i < robots_.size(); i++) {
    const franka_core::RobotState& state = robots_[i].robot->state();
    put(state.q);
    put(state.dq);
    const Eigen::Matrix4d tool =
        robots_[i].base.matrix() * Eigen::Map<const Eigen::Matrix4d>(state.O_T_EE.data());
    for (const int column : {3, 0, 1}) {
      to = std::copy_n(tool.col(column).data(), 3, to);
    }
    if (!hands_.empty()) {
      *to++ = robots_[i].robot->units().hand()->width();
    }
  }
  if (!setting_.body.empty()) {
    observeBody(seconds, to);
  }
}

void PolicyEpisode::observeBody(double seconds, double* to) {
  const World& world = simulation_->world();
  const Pose pose = world.bodyPose(setting_.body);
  to = std::copy(pose.position.begin(), pose.position.end(), to);
  const double sign = pose.orientation[0] >= 0.0 ? 1.0 : -1.0;
  for (const double value : pose.orientation) {
    *to++ = sign * value;
  }
  for (std::size_t i = 0; i < 3; i++) {
    *to++ = seconds > 0.0 ? (pose.position[i] - before_[i]) / seconds : 0.0;
  }
  before_ = pose.position;
  const Touches touches = world.touches(setting_.body);
  for (const Robot& robot : robots_) {
    const auto found =
        std::find(touches.robots.begin(), touches.robots.end(), robot.robot->setup().arm_id);
    *to++ = found == touches.robots.end() ? 0.0 : 1.0;
  }
  *to = touches.others ? 1.0 : 0.0;
}

}  // namespace franka_sim

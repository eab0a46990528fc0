// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "combined_hw_sim.h"

#include <utility>

namespace franka_sim_mujoco {

namespace {

using hardware_interface::ControllerInfo;
using transmission_interface::TransmissionInfo;

/// Index of the arm whose joints these are, the first one's for other devices. Of two names that
/// fit, the longer one counts: arm_2_joint1 belongs to arm_2, not to arm.
std::size_t armOf(const TransmissionInfo& transmission, const std::vector<SimulatedArm>& arms) {
  std::size_t found = 0, length = 0;
  for (std::size_t i = 0; i < arms.size(); ++i) {
    const std::string prefix = arms[i].arm_id + "_";
    if (prefix.size() > length && !transmission.joints_.empty() &&
        transmission.joints_.front().name_.rfind(prefix, 0) == 0) {
      found = i;
      length = prefix.size();
    }
  }
  return found;
}

}  // namespace

CombinedHWSim::CombinedHWSim(std::vector<std::shared_ptr<RobotHWSim>> members)
    : members_(std::move(members)) {}

bool CombinedHWSim::initSim(const std::string& robot_namespace, ros::NodeHandle model_nh,
                            RobotHandle robot, const urdf::Model* urdf_model,
                            std::vector<TransmissionInfo> transmissions) {
  std::vector<std::vector<TransmissionInfo>> parts(members_.size());
  for (TransmissionInfo& transmission : transmissions) {
    parts[armOf(transmission, robot.arms)].push_back(std::move(transmission));
  }
  for (std::size_t i = 0; i < members_.size(); ++i) {
    RobotHandle part = robot;
    part.arms = {robot.arms[i]};
    if (!members_[i]->initSim(robot_namespace, model_nh, part, urdf_model, std::move(parts[i]))) {
      failure_ = members_[i]->failure();
      return false;
    }
    switches_.add(members_[i]);
    registerInterfaceManager(members_[i].get());
  }
  return true;
}

std::string CombinedHWSim::condition() const {
  std::string text;
  for (const auto& member : members_) {
    const std::string line = member->condition();
    text += (text.empty() || line.empty() ? "" : "; ") + line;
  }
  return text;
}

void CombinedHWSim::readSim(ros::Time time, ros::Duration period) {
  for (const auto& member : members_) {
    member->readSim(time, period);
  }
}

void CombinedHWSim::writeSim(ros::Time time, ros::Duration period) {
  for (const auto& member : members_) {
    member->writeSim(time, period);
  }
}

void CombinedHWSim::eStopActive(bool active) {
  for (const auto& member : members_) {
    member->eStopActive(active);
  }
}

void CombinedHWSim::worldWasReset() {
  for (const auto& member : members_) {
    member->worldWasReset();
  }
}

std::vector<RobotHWSim*> CombinedHWSim::parts() {
  std::vector<RobotHWSim*> parts;
  for (const auto& member : members_) {
    parts.push_back(member.get());
  }
  return parts;
}

bool CombinedHWSim::checkForConflict(const std::list<ControllerInfo>& controllers) const {
  return switches_.checkForConflict(controllers);
}

bool CombinedHWSim::prepareSwitch(const std::list<ControllerInfo>& start_list,
                                  const std::list<ControllerInfo>& stop_list) {
  return switches_.prepareSwitch(start_list, stop_list);
}

void CombinedHWSim::doSwitch(const std::list<ControllerInfo>& start_list,
                             const std::list<ControllerInfo>& stop_list) {
  switches_.doSwitch(start_list, stop_list);
}

RobotHWSim::SwitchState CombinedHWSim::switchResult() const { return switches_.switchResult(); }

RobotHWSim::SwitchState CombinedHWSim::switchResult(const ControllerInfo& controller) const {
  return switches_.switchResult(controller);
}

}  // namespace franka_sim_mujoco

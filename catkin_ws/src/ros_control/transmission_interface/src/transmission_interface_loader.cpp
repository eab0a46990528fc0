// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <hardware_interface/actuator_state_interface.h>
#include <ros/console.h>
#include <transmission_interface/detail/provider_tools.h>
#include <transmission_interface/transmission_interface_loader.h>
#include <transmission_interface/transmission_parser.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace transmission_interface {

using hardware_interface::ActuatorStateHandle;
using hardware_interface::ActuatorStateInterface;

namespace {

std::string roleOf(const JointInfo& joint) { return joint.role_; }

std::string roleOf(const ActuatorInfo& actuator) {
  TiXmlDocument document;
  document.Parse(actuator.xml_element_.c_str());
  const TiXmlElement* root = document.RootElement();
  const TiXmlElement* role = root == nullptr ? nullptr : root->FirstChildElement("role");
  const char* text = role == nullptr ? nullptr : role->GetText();
  return text == nullptr ? std::string() : std::string(text);
}

/// Sorts parts with the roles <base>1, <base>2, ... in that order, in which transmissions use their
/// values. Parts with other roles are unchanged.
template <class Part>
void sortByRole(const std::string& base, std::vector<Part>& parts) {
  std::vector<Part> sorted(parts.size());
  std::vector<bool> taken(parts.size(), false);
  for (const Part& part : parts) {
    std::size_t place = 0;
    while (place < parts.size() && roleOf(part) != base + std::to_string(place + 1)) {
      ++place;
    }
    if (place == parts.size() || taken[place]) {
      return;
    }
    sorted[place] = part;
    taken[place] = true;
  }
  parts = std::move(sorted);
}

bool jointsAgreeOnInterfaces(const TransmissionInfo& info) {
  const std::vector<std::string>& expected = info.joints_.front().hardware_interfaces_;
  for (const JointInfo& joint : info.joints_) {
    const std::vector<std::string>& found = joint.hardware_interfaces_;
    if (!std::is_permutation(found.begin(), found.end(), expected.begin(), expected.end())) {
      ROS_ERROR_STREAM("Failed to load transmission '"
                       << info.name_ << "'. All its joints must have the same hardware interfaces, "
                       << "but those of '" << joint.name_ << "' and of '"
                       << info.joints_.front().name_ << "' differ.");
      return false;
    }
  }
  return true;
}

}  // namespace

TransmissionInterfaceLoader::TransmissionInterfaceLoader(hardware_interface::RobotHW* robot_hw,
                                                         RobotTransmissions* robot_transmissions)
    : transmission_class_loader_("transmission_interface",
                                 "transmission_interface::TransmissionLoader"),
      req_provider_loader_("transmission_interface", "transmission_interface::RequisiteProvider"),
      robot_hw_ptr_(robot_hw),
      robot_transmissions_ptr_(robot_transmissions) {
  if (robot_hw == nullptr) {
    throw std::invalid_argument("Invalid robot hardware pointer.");
  }
  if (robot_transmissions == nullptr) {
    throw std::invalid_argument("Invalid robot transmissions pointer.");
  }
  loader_data_.robot_hw = robot_hw;
  loader_data_.robot_transmissions = robot_transmissions;
}

bool TransmissionInterfaceLoader::load(const std::string& urdf_string) {
  std::vector<TransmissionInfo> infos;
  if (!TransmissionParser::parse(urdf_string, infos)) {
    return false;
  }
  if (infos.empty()) {
    ROS_ERROR("No transmissions were found in the robot description.");
    return false;
  }
  return load(infos);
}

bool TransmissionInterfaceLoader::load(const TransmissionInfo& transmission_info) {
  return load(std::vector<TransmissionInfo>{transmission_info});
}

bool TransmissionInterfaceLoader::load(const std::vector<TransmissionInfo>& transmission_info_vec) {
  std::vector<Plan> plans(transmission_info_vec.size());
  for (std::size_t i = 0; i < plans.size(); ++i) {
    if (!makePlan(transmission_info_vec[i], plans[i])) {
      return false;
    }
  }
  return std::all_of(plans.begin(), plans.end(),
                     [this](const Plan& plan) { return carryOut(plan); });
}

bool TransmissionInterfaceLoader::makePlan(const TransmissionInfo& info, Plan& plan) {
  if (info.joints_.empty() || info.actuators_.empty()) {
    ROS_ERROR_STREAM("Failed to load transmission '" << info.name_ << "'. It needs at least one "
                                                     << "joint and one actuator.");
    return false;
  }
  plan.info = info;
  sortByRole("joint", plan.info.joints_);
  sortByRole("actuator", plan.info.actuators_);
  if (!jointsAgreeOnInterfaces(info)) {
    return false;
  }
  plan.transmission = createTransmission(info);
  if (!plan.transmission) {
    return false;
  }
  if (plan.transmission->numJoints() != info.joints_.size() ||
      plan.transmission->numActuators() != info.actuators_.size()) {
    ROS_ERROR_STREAM("Failed to load transmission '"
                     << info.name_ << "'. Its type '" << info.type_ << "' has "
                     << plan.transmission->numJoints() << " joint(s) and "
                     << plan.transmission->numActuators() << " actuator(s), its description "
                     << info.joints_.size() << " and " << info.actuators_.size() << ".");
    return false;
  }
  if (!createProviders(info, plan.providers)) {
    return false;
  }
  return std::all_of(plan.providers.begin(), plan.providers.end(), [&](const auto& provider) {
    return provider->findsActuators(plan.info, robot_hw_ptr_);
  });
}

TransmissionSharedPtr TransmissionInterfaceLoader::createTransmission(
    const TransmissionInfo& info) {
  TransmissionLoaderSharedPtr loader;
  try {
    loader = transmission_class_loader_.createUniqueInstance(info.type_);
  } catch (const pluginlib::PluginlibException& error) {
    ROS_ERROR_STREAM("Failed to load transmission '" << info.name_ << "'. Its type '" << info.type_
                                                     << "' cannot be used: " << error.what());
    return nullptr;
  }
  return loader->load(info);
}

bool TransmissionInterfaceLoader::createProviders(const TransmissionInfo& info,
                                                  std::vector<RequisiteProviderPtr>& providers) {
  std::set<std::string> seen;
  for (const std::string& interface : info.joints_.front().hardware_interfaces_) {
    if (!seen.insert(interface).second) {
      continue;
    }
    try {
      providers.push_back(req_provider_loader_.createUniqueInstance(interface));
    } catch (const pluginlib::PluginlibException& error) {
      ROS_WARN_STREAM("Transmission '" << info.name_ << "': the hardware interface '"
                                       << interface << "' is left out. " << error.what());
    }
  }
  if (providers.empty()) {
    ROS_ERROR_STREAM("Failed to load transmission '" << info.name_ << "'. None of the hardware "
                                                     << "interfaces of its joints can be used.");
    return false;
  }
  return true;
}

bool TransmissionInterfaceLoader::carryOut(const Plan& plan) {
  if (!loaded_.insert(plan.info.name_).second) {
    ROS_WARN_STREAM("Transmission '" << plan.info.name_ << "' is described twice: the later "
                                     << "description takes the place of the earlier one. Give each "
                                     << "transmission a name of its own.");
  }
  bool absolute = plan.transmission->hasActuatorToJointAbsolutePosition();
  bool torque = plan.transmission->hasActuatorToJointTorqueSensor();
  if (auto* states = robot_hw_ptr_->get<ActuatorStateInterface>()) {
    for (const ActuatorInfo& actuator : plan.info.actuators_) {
      // A third-party provider may not need states.
      const ActuatorStateHandle handle = internal::hasResource(actuator.name_, *states)
                                             ? states->getHandle(actuator.name_)
                                             : ActuatorStateHandle();
      absolute = absolute && handle.hasAbsolutePosition();
      torque = torque && handle.hasTorqueSensor();
    }
  }
  for (const JointInfo& joint : plan.info.joints_) {
    const auto made = loader_data_.raw_joint_data_map.emplace(joint.name_, RawJointData());
    if (made.second) {
      made.first->second.hasAbsolutePosition = absolute;
      made.first->second.hasTorqueSensor = torque;
    }
  }
  for (const RequisiteProviderPtr& provider : plan.providers) {
    if (!provider->updateJointInterfaces(plan.info, robot_hw_ptr_, loader_data_.joint_interfaces,
                                         loader_data_.raw_joint_data_map) ||
        !provider->loadTransmissionMaps(plan.info, loader_data_, plan.transmission)) {
      return false;
    }
    loader_data_.transmission_data.push_back(plan.transmission);
  }
  return true;
}

}  // namespace transmission_interface

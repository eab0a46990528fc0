// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/exception.h>
#include <franka/mobile_model.h>
#include <franka_core/rotations.h>
#include <tinyxml2.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace franka {

namespace {

constexpr std::array<const char*, 4> kSuffixes{"_joint_0", "_joint_1", "_joint_2", "_joint_3"};
// The joints that move the two drive modules.
constexpr std::array<std::size_t, 2> kDriveJoints{1, 3};
constexpr int kNoVariable = -1;

struct Joint {
  Eigen::Isometry3d origin{Eigen::Isometry3d::Identity()};
  Eigen::Vector3d axis{Eigen::Vector3d::UnitX()};
  bool slides{false};
  int variable{kNoVariable};  // index of kSuffixes
};

using Chain = std::vector<Joint>;  // from the root on

[[noreturn]] void refuse(const std::string& reason) {
  throw ModelException("libfranka: The model of a mobile base cannot be made. " + reason);
}

std::string attributeOf(const tinyxml2::XMLElement* element, const char* name) {
  const char* text = element != nullptr ? element->Attribute(name) : nullptr;
  return text != nullptr ? text : "";
}

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

Eigen::Vector3d vectorOf(const tinyxml2::XMLElement* element, const char* name,
                         const Eigen::Vector3d& otherwise) {
  const std::string text = attributeOf(element, name);
  if (text.empty()) {
    return otherwise;
  }
  std::istringstream numbers(text);
  Eigen::Vector3d vector;
  if (!(numbers >> vector.x() >> vector.y() >> vector.z()) || !vector.allFinite()) {
    refuse("Its description (URDF) has " + std::string(name) + "=\"" + text +
           "\" where three numbers must stand.");
  }
  return vector;
}

Joint jointOf(const tinyxml2::XMLElement& element) {
  const tinyxml2::XMLElement* origin = element.FirstChildElement("origin");
  const Eigen::Vector3d rpy = vectorOf(origin, "rpy", Eigen::Vector3d::Zero());
  Joint joint;
  joint.origin.translation() = vectorOf(origin, "xyz", Eigen::Vector3d::Zero());
  joint.origin.linear() = franka_core::rotationFromRpy(rpy);
  joint.axis = vectorOf(element.FirstChildElement("axis"), "xyz", Eigen::Vector3d::UnitX());
  if (!(joint.axis.norm() > 0.0)) {
    refuse("Its description (URDF) has a joint without an axis: " + attributeOf(&element, "name") +
           ".");
  }
  joint.axis.normalize();
  joint.slides = attributeOf(&element, "type") == "prismatic";
  const auto suffix = std::find_if(kSuffixes.begin(), kSuffixes.end(), [&](const char* end) {
    return endsWith(attributeOf(&element, "name"), end);
  });
  if (suffix != kSuffixes.end() && attributeOf(&element, "type") != "fixed") {
    joint.variable = static_cast<int>(suffix - kSuffixes.begin());
  }
  return joint;
}

using Elements = std::vector<const tinyxml2::XMLElement*>;

Elements jointsOf(const tinyxml2::XMLElement& robot) {
  Elements joints;
  for (const auto* joint = robot.FirstChildElement("joint"); joint != nullptr;
       joint = joint->NextSiblingElement("joint")) {
    joints.push_back(joint);
  }
  return joints;
}

/// The joints from the root to the one whose name ends with the suffix, inclusive.
Chain chainTo(const Elements& joints, const std::string& suffix) {
  const auto find = [&joints](auto matches) {
    const auto found = std::find_if(joints.begin(), joints.end(), matches);
    return found != joints.end() ? *found : nullptr;
  };
  const tinyxml2::XMLElement* joint = find([&](const tinyxml2::XMLElement* candidate) {
    return endsWith(attributeOf(candidate, "name"), suffix);
  });
  if (joint == nullptr) {
    refuse("Its description (URDF) has no joint whose name ends with " + suffix + ".");
  }
  Chain chain;
  while (joint != nullptr) {
    if (chain.size() == joints.size()) {
      refuse("Its description (URDF) has a circle of joints.");
    }
    chain.push_back(jointOf(*joint));
    const std::string link = attributeOf(joint->FirstChildElement("parent"), "link");
    joint = find([&](const tinyxml2::XMLElement* candidate) {
      return attributeOf(candidate->FirstChildElement("child"), "link") == link;
    });
  }
  std::reverse(chain.begin(), chain.end());
  return chain;
}

bool isMobile(const tinyxml2::XMLElement* robot) {
  return attributeOf(robot, "name").compare(0, 3, "tmr") == 0;
}

}  // namespace

struct MobileModel::Data {
  std::array<Chain, kDriveJoints.size()> chains;
};

bool isMobileRobotUrdf(const std::string& urdf) {
  tinyxml2::XMLDocument document;
  return document.Parse(urdf.data(), urdf.size()) == tinyxml2::XML_SUCCESS &&
         isMobile(document.FirstChildElement("robot"));
}

MobileModel::MobileModel(const std::string& urdf) : data_(std::make_unique<Data>()) {
  tinyxml2::XMLDocument document;
  if (document.Parse(urdf.data(), urdf.size()) != tinyxml2::XML_SUCCESS) {
    refuse("Its description (URDF) is no XML.");
  }
  const tinyxml2::XMLElement* robot = document.FirstChildElement("robot");
  if (!isMobile(robot)) {
    refuse(
        "The description (URDF) is of the robot \"" + attributeOf(robot, "name") +
        "\", but that of a mobile base has a robot whose name begins with \"tmr\". Of an arm, use "
        "franka::Model (Robot::loadModel).");
  }
  const Elements joints = jointsOf(*robot);
  for (const char* suffix : kSuffixes) {
    chainTo(joints, suffix);  // each must exist
  }
  for (std::size_t i = 0; i < kDriveJoints.size(); i++) {
    data_->chains[i] = chainTo(joints, kSuffixes[kDriveJoints[i]]);
  }
}

MobileModel::MobileModel(MobileModel&& other) noexcept = default;
MobileModel& MobileModel::operator=(MobileModel&& other) noexcept = default;
MobileModel::~MobileModel() noexcept = default;

std::array<double, 16> MobileModel::pose(MobileFrame frame, const MobileJointPositions& q) const {
  const auto index = static_cast<std::size_t>(frame);
  if (index >= data_->chains.size()) {
    throw std::invalid_argument("libfranka: Invalid mobile frame given.");
  }
  const std::array<double, kSuffixes.size()> positions{q.joint_0, q.joint_1, q.joint_2, q.joint_3};
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (const Joint& joint : data_->chains[index]) {
    pose = pose * joint.origin;
    if (joint.variable == kNoVariable) {
      continue;
    }
    const double position = positions[static_cast<std::size_t>(joint.variable)];
    if (joint.slides) {
      pose.translate(joint.axis * position);
    } else {
      pose.rotate(Eigen::AngleAxisd(position, joint.axis));
    }
  }
  std::array<double, 16> result{};
  Eigen::Map<Eigen::Matrix4d>(result.data()) = pose.matrix();
  return result;
}

}  // namespace franka

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/exception.h>
#include <franka/mobile_model.h>
#include <urdf_parser/urdf_parser.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>
#include <vector>

namespace franka {

constexpr int kNoVariable = -1;

struct DriveJoint {
  Eigen::Isometry3d origin{Eigen::Isometry3d::Identity()};
  Eigen::Vector3d axis{Eigen::Vector3d::UnitX()};
  bool slides{false};
  int variable{kNoVariable};  // index of kSuffixes
};

namespace {

constexpr std::array<const char*, 4> kSuffixes{"_joint_0", "_joint_1", "_joint_2", "_joint_3"};
// The joints that move the two drive modules.
constexpr std::array<std::size_t, 2> kDriveJoints{1, 3};
using Chain = std::vector<DriveJoint>;  // from the root on

[[noreturn]] void refuse(const std::string& reason) {
  throw ModelException("libfranka: The model of a mobile base cannot be made. " + reason);
}

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

DriveJoint jointOf(const urdf::Joint& described) {
  const urdf::Vector3& position = described.parent_to_joint_origin_transform.position;
  const urdf::Rotation& turn = described.parent_to_joint_origin_transform.rotation;
  DriveJoint joint;
  joint.origin.translation() << position.x, position.y, position.z;
  joint.origin.linear() = Eigen::Quaterniond(turn.w, turn.x, turn.y, turn.z).toRotationMatrix();
  joint.slides = described.type == urdf::Joint::PRISMATIC;
  const auto suffix = std::find_if(kSuffixes.begin(), kSuffixes.end(),
                                   [&](const char* end) { return endsWith(described.name, end); });
  if (suffix == kSuffixes.end() || described.type == urdf::Joint::FIXED) {
    return joint;
  }
  joint.variable = static_cast<int>(suffix - kSuffixes.begin());
  joint.axis << described.axis.x, described.axis.y, described.axis.z;
  if (!(joint.axis.norm() > 0.0)) {
    refuse("Its description (URDF) has a joint without an axis: " + described.name + ".");
  }
  joint.axis.normalize();
  return joint;
}

/// The joints from the root to the one whose name ends with the suffix, inclusive.
Chain chainTo(const urdf::ModelInterface& robot, const std::string& suffix) {
  const auto last = std::find_if(robot.joints_.begin(), robot.joints_.end(),
                                 [&](const auto& joint) { return endsWith(joint.first, suffix); });
  if (last == robot.joints_.end()) {
    refuse("Its description (URDF) has no joint whose name ends with " + suffix + ".");
  }
  Chain chain;
  for (urdf::JointSharedPtr joint = last->second; joint != nullptr;
       joint = robot.links_.at(joint->parent_link_name)->parent_joint) {
    if (chain.size() == robot.joints_.size()) {
      refuse("Its description (URDF) has a circle of joints.");
    }
    chain.push_back(jointOf(*joint));
  }
  std::reverse(chain.begin(), chain.end());
  return chain;
}

bool isMobile(const urdf::ModelInterface& robot) { return robot.name_.compare(0, 3, "tmr") == 0; }

}  // namespace

struct MobileModel::Data {
  std::array<Chain, kDriveJoints.size()> chains;
};

bool isMobileRobotUrdf(const std::string& urdf) {
  const urdf::ModelInterfaceSharedPtr robot = urdf.empty() ? nullptr : urdf::parseURDF(urdf);
  return robot != nullptr && isMobile(*robot);
}

MobileModel::MobileModel(const std::string& urdf) : data_(std::make_unique<Data>()) {
  const urdf::ModelInterfaceSharedPtr robot = urdf.empty() ? nullptr : urdf::parseURDF(urdf);
  if (robot == nullptr) {
    refuse("Its description (URDF) cannot be read; the lines above name the mistake.");
  }
  if (!isMobile(*robot)) {
    refuse(
        "The description (URDF) is of the robot \"" + robot->name_ +
        "\", but that of a mobile base has a robot whose name begins with \"tmr\". Of an arm, use "
        "franka::Model (Robot::loadModel).");
  }
  for (const char* suffix : kSuffixes) {
    chainTo(*robot, suffix);  // each must exist
  }
  for (std::size_t i = 0; i < kDriveJoints.size(); i++) {
    data_->chains[i] = chainTo(*robot, kSuffixes[kDriveJoints[i]]);
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
  for (const DriveJoint& joint : data_->chains[index]) {
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

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/mjcf/robot_model.h"

#include <franka_sim/physics/pose_conversions.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "physics/mjcf/xml_util.h"

namespace franka_sim::physics {
namespace {

/// Apparent mass of a finger when the description gives none [kg]. Chosen here: motor and gear of
/// the hand are far heavier than the 15 g finger, and it keeps a finger's force loop at 1 kHz well
/// damped.
constexpr double kFingerArmature = 0.1;
/// MuJoCo refuses moving bodies lighter than this [kg], [kg m^2].
constexpr double kMinInertial = 1e-12;

[[noreturn]] void fail(const RobotDescription& robot, const std::string& what) {
  throw std::runtime_error("Robot '" + robot.name + "': " + what);
}

Eigen::Matrix3d steiner(double mass, const Eigen::Vector3d& offset) {
  return mass * (offset.squaredNorm() * Eigen::Matrix3d::Identity() - offset * offset.transpose());
}

UrdfInertial moved(const UrdfInertial& inertial, const Eigen::Isometry3d& pose) {
  UrdfInertial result;
  result.mass = inertial.mass;
  result.com = pose * inertial.com;
  result.inertia = pose.linear() * inertial.inertia * pose.linear().transpose();
  return result;
}

UrdfInertial joined(const UrdfInertial& a, const UrdfInertial& b) {
  if (a.mass == 0 || b.mass == 0) {
    return a.mass == 0 ? b : a;
  }
  UrdfInertial result;
  result.mass = a.mass + b.mass;
  result.com = (a.mass * a.com + b.mass * b.com) / result.mass;
  result.inertia = a.inertia + steiner(a.mass, a.com - result.com) + b.inertia +
                   steiner(b.mass, b.com - result.com);
  return result;
}

class Builder {
 public:
  explicit Builder(RobotModel* robot) : robot_(robot), urdf_(robot->urdf) {}

  void build() {
    const UrdfLink& root = urdf_.links[urdf_.root];
    if (root.name != "world") {
      startSegment(urdf_.root, -1, -1, base());
      return;
    }
    // The link `world` is MuJoCo's world itself.
    for (const int joint : root.child_joints) {
      const UrdfJoint& j = urdf_.joints[joint];
      startSegment(j.child, -1, j.type == UrdfJoint::Type::kFixed ? -1 : joint, j.origin);
    }
  }

 private:
  Eigen::Isometry3d base() const {
    const Pose& pose = robot_->description.base;
    if (!hasUnitOrientation(pose)) {
      fail(robot_->description, "the orientation of its base is not a unit quaternion.");
    }
    if (!vector(pose.position).allFinite()) {
      fail(robot_->description, "the position of its base is not finite.");
    }
    return toIsometry(pose);
  }

  void startSegment(int link, int parent, int joint, const Eigen::Isometry3d& pose) {
    Segment segment;
    segment.link = link;
    segment.parent = parent;
    segment.joint = joint;
    segment.pose = pose;
    robot_->segments.push_back(segment);
    const int index = static_cast<int>(robot_->segments.size()) - 1;
    gather(index, link, Eigen::Isometry3d::Identity());
    checkMass(robot_->segments[index]);
  }

  void gather(int segment, int link, const Eigen::Isometry3d& pose) {
    robot_->segments[segment].links.emplace_back(link, pose);
    if (const auto& inertial = urdf_.links[link].inertial) {
      UrdfInertial& total = robot_->segments[segment].inertial;
      total = joined(total, moved(*inertial, pose));
    }
    for (const int joint : urdf_.links[link].child_joints) {
      const UrdfJoint& j = urdf_.joints[joint];
      if (j.type == UrdfJoint::Type::kFixed) {
        gather(segment, j.child, pose * j.origin);
      } else {
        startSegment(j.child, segment, joint, pose * j.origin);
      }
    }
  }

  void checkMass(const Segment& segment) const {
    if (segment.joint >= 0 && (segment.inertial.mass < kMinInertial ||
                               segment.inertial.inertia.trace() < 3 * kMinInertial)) {
      fail(robot_->description, "link '" + urdf_.links[segment.link].name +
                                    "' moves but has no mass and inertia; make its URDF with the "
                                    "xacro argument gazebo:=true.");
    }
  }

  RobotModel* robot_;
  const UrdfRobot& urdf_;
};

void checkNames(const RobotModel& robot, const std::map<std::string, double>& values,
                const char* what, bool negative_allowed) {
  for (const auto& [joint, value] : values) {
    if (!robot.moves(joint)) {
      fail(robot.description, std::string(what) + " is given for '" + joint +
                                  "', which is not a moving joint of its URDF.");
    }
    if (!std::isfinite(value) || (!negative_allowed && value < 0)) {
      fail(robot.description, std::string(what) + " of joint '" + joint + "' is " +
                                  toText({value}) + "; it must be " +
                                  (negative_allowed ? "finite." : "finite and not negative."));
    }
  }
}

void checkFriction(const RobotModel& robot) {
  for (const auto& [joint, law] : robot.description.friction) {
    checkNames(robot, {{joint, law.amplitude}}, "an amplitude of friction", false);
    checkNames(robot, {{joint, law.slope}}, "a slope of friction", false);
    checkNames(robot, {{joint, law.offset}}, "an offset of friction", true);
    checkNames(robot, {{joint, law.coulomb}}, "a Coulomb friction", false);
    checkNames(robot, {{joint, law.viscous}}, "a viscous friction", false);
    checkNames(robot, {{joint, law.damping}}, "a viscous friction of the motor side", false);
  }
}

void checkStops(const RobotModel& robot) {
  for (const auto& [joint, stops] : robot.description.stops) {
    if (!robot.moves(joint)) {
      fail(robot.description,
           "stops are given for '" + joint + "', which is not a moving joint of its URDF.");
    }
    if (!(stops[0] < stops[1])) {
      fail(robot.description, "the stops of joint '" + joint + "' are not in order.");
    }
  }
}

void checkStarts(const RobotModel& robot) {
  for (const UrdfJoint& joint : robot.urdf.joints) {
    if (joint.type == UrdfJoint::Type::kFixed || joint.type == UrdfJoint::Type::kContinuous) {
      continue;
    }
    const double start = robot.initialPosition(joint);
    const auto stops = robot.stops(joint);
    if (start < stops[0] || start > stops[1]) {
      fail(robot.description, "joint '" + joint.name + "' cannot start at " + toText({start}) +
                                  ", its stops are at " + toText({stops[0]}) + " and " +
                                  toText({stops[1]}) + ".");
    }
  }
}

void applyLinkErrors(RobotModel& robot) {
  for (const auto& [name, error] : robot.description.link_errors) {
    const int index = robot.urdf.link(name);
    if (index < 0) {
      fail(robot.description,
           "an error of link '" + name + "' is given, but its URDF has no such link.");
    }
    if (!(error.mass > -1.0) || !(error.added_mass >= 0.0)) {
      fail(robot.description, "with its error link '" + name + "' would have no mass.");
    }
    UrdfInertial inertial = robot.urdf.links[index].inertial.value_or(UrdfInertial{});
    inertial.mass *= 1.0 + error.mass;
    inertial.inertia *= 1.0 + error.mass;
    inertial.com += Eigen::Vector3d::Map(error.center.data());
    UrdfInertial added;
    added.mass = error.added_mass;
    added.com = Eigen::Vector3d::Map(error.added_at.data());
    robot.urdf.links[index].inertial = joined(inertial, added);
  }
}

double valueOf(const std::map<std::string, double>& values, const std::string& name,
               double fallback) {
  const auto found = values.find(name);
  return found == values.end() ? fallback : found->second;
}

/// Whether any joint below a link moves.
bool movesSomething(const UrdfRobot& urdf, const UrdfLink& link) noexcept {
  return std::any_of(link.child_joints.begin(), link.child_joints.end(), [&](int index) {
    const UrdfJoint& joint = urdf.joints[index];
    return joint.type != UrdfJoint::Type::kFixed || movesSomething(urdf, urdf.links[joint.child]);
  });
}

/// Whether a joint is called <any prefix><middle>N, N = 1 to count, and the others are there too.
bool isOneOf(const UrdfRobot& urdf, const std::string& joint, const std::string& middle,
             int count) {
  const std::size_t end = joint.size() - 1;
  if (joint.size() <= middle.size() + 1 || joint[end] < '1' || joint[end] > '0' + count ||
      joint.compare(end - middle.size(), middle.size(), middle) != 0) {
    return false;
  }
  const std::string stem = joint.substr(0, end);
  for (int i = 1; i <= count; ++i) {
    if (urdf.joint(stem + std::to_string(i)) < 0) {
      return false;
    }
  }
  return true;
}

}  // namespace

bool RobotModel::moves(const std::string& joint) const noexcept {
  const int index = urdf.joint(joint);
  return index >= 0 && urdf.joints[index].type != UrdfJoint::Type::kFixed;
}

std::array<double, 2> RobotModel::stops(const UrdfJoint& joint) const {
  const auto found = description.stops.find(joint.name);
  return found != description.stops.end() ? found->second
                                          : std::array<double, 2>{joint.lower, joint.upper};
}

double RobotModel::initialPosition(const UrdfJoint& joint) const {
  const auto found = description.initial_positions.find(joint.name);
  if (found != description.initial_positions.end()) {
    return found->second;
  }
  if (!joint.mimic.empty()) {
    const UrdfJoint& leader = urdf.joints[urdf.joint(joint.mimic)];
    // A mimic of a mimic is not followed, so that a loop of mimics ends.
    const double start = leader.mimic.empty() ? initialPosition(leader) : 0.0;
    return joint.mimic_multiplier * start + joint.mimic_offset;
  }
  if (joint.type == UrdfJoint::Type::kContinuous) {
    return 0.0;
  }
  const auto range = stops(joint);
  return std::clamp(0.0, range[0], range[1]);
}

double RobotModel::armature(const UrdfJoint& joint) const {
  const double fallback = isFinger(urdf.links[joint.child]) ? kFingerArmature : 0.0;
  return valueOf(description.rotor_inertia, joint.name, fallback);
}

double RobotModel::damping(const UrdfJoint& joint) const {
  return hasPhysics(joint) ? 0.0 : joint.damping;
}

double RobotModel::friction(const UrdfJoint& joint) const {
  return hasPhysics(joint) ? 0.0 : joint.friction;
}

bool RobotModel::isFinger(const UrdfLink& link) const noexcept {
  return link.parent_joint >= 0 &&
         urdf.joints[link.parent_joint].type == UrdfJoint::Type::kPrismatic &&
         !movesSomething(urdf, link);
}

bool RobotModel::isFranka(const UrdfJoint& joint) const {
  return isOneOf(urdf, joint.name, "_joint", 7) || isOneOf(urdf, joint.name, "_finger_joint", 2);
}

bool RobotModel::hasPhysics(const UrdfJoint& joint) const {
  const auto is_given = [this](const std::string& name) {
    return description.rotor_inertia.count(name) > 0;
  };
  const std::size_t finger = joint.name.rfind("_finger_joint");
  return is_given(joint.name) ||
         (finger != std::string::npos && isOneOf(urdf, joint.name, "_finger_joint", 2) &&
          is_given(joint.name.substr(0, finger) + "_joint1"));
}

RobotModel buildRobot(const RobotDescription& description) {
  if (description.name.empty() || description.name.find('/') != std::string::npos) {
    throw std::runtime_error("A robot needs a name without '/'; this one is called '" +
                             description.name + "'.");
  }
  RobotModel robot;
  robot.description = description;
  robot.urdf = readUrdf(description.urdf, description.name);
  checkNames(robot, description.initial_positions, "an initial position", true);
  checkNames(robot, description.rotor_inertia, "a rotor inertia", false);
  checkFriction(robot);
  checkNames(robot, description.torque_offset, "an offset of the torque sensor", true);
  applyLinkErrors(robot);
  checkStops(robot);
  checkStarts(robot);
  Builder(&robot).build();
  return robot;
}

}  // namespace franka_sim::physics

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/numbers.h>
#include <urdf_parser/urdf_parser.h>

#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "spatial.h"

namespace franka_core {

namespace {

using spatial::Pose;

// Deviation of a joint axis from +z that counts as rounding in the text.
constexpr double kAxisTolerance = 1e-9;

// From the frame of a Franka Hand to the point between its fingertips [m] (protocol 8.3).
constexpr double kHandToTcp = 0.1034;

[[noreturn]] void fail(const std::string& sentence) {
  throw std::invalid_argument("URDF of the arm: " + sentence);
}

std::string quoted(const std::string& name) { return "'" + name + "'"; }

urdf::ModelInterfaceSharedPtr parse(const std::string& text) {
  urdf::ModelInterfaceSharedPtr model;
  if (!text.empty()) {
    model = urdf::parseURDF(text);
  }
  if (!model) {
    fail("the text cannot be read as a robot description (" + std::to_string(text.size()) +
         " characters). Check that it is the output of xacro; the lines above name the mistake.");
  }
  return model;
}

bool hasChain(const urdf::ModelInterface& model, const std::string& prefix) {
  for (int i = 0; i <= 8; i++) {
    if (!model.getLink(prefix + "link" + std::to_string(i))) {
      return false;
    }
  }
  return true;
}

std::vector<std::string> findPrefixes(const urdf::ModelInterface& model) {
  const std::string base = "link0";
  std::vector<std::string> prefixes;
  for (const auto& link : model.links_) {
    const std::string& name = link.first;
    if (name.size() >= base.size() &&
        name.compare(name.size() - base.size(), base.size(), base) == 0) {
      const std::string prefix = name.substr(0, name.size() - base.size());
      if (hasChain(model, prefix)) {
        prefixes.push_back(prefix);
      }
    }
  }
  return prefixes;
}

std::string listOf(const std::vector<std::string>& prefixes) {
  std::string list;
  for (const std::string& prefix : prefixes) {
    list += (list.empty() ? "" : ", ") + quoted(prefix.substr(0, prefix.find_last_of('_')));
  }
  return list.empty() ? "none" : list;
}

std::string choosePrefix(const urdf::ModelInterface& model, const std::string& arm_id) {
  if (!arm_id.empty() && hasChain(model, arm_id + "_")) {
    return arm_id + "_";
  }
  const std::vector<std::string> prefixes = findPrefixes(model);
  if (!arm_id.empty()) {
    fail("it has no chain " + quoted(arm_id + "_link0") + " to " + quoted(arm_id + "_link8") +
         ". Arms found: " + listOf(prefixes) + ". Set arm_id to one of them.");
  }
  if (prefixes.empty()) {
    fail(
        "it has no chain of links <arm_id>_link0 to <arm_id>_link8. Give the description of a "
        "seven-joint Franka arm.");
  }
  if (prefixes.size() > 1) {
    fail("it describes several arms: " + listOf(prefixes) + ". Name one of them by arm_id.");
  }
  return prefixes.front();
}

Pose toPose(const urdf::Pose& pose) {
  const urdf::Rotation& r = pose.rotation;
  const auto rotated = [&r](double x, double y, double z) {
    const urdf::Vector3 v = r * urdf::Vector3(x, y, z);
    return spatial::Vector{v.x, v.y, v.z};
  };
  return {rotated(1, 0, 0),
          rotated(0, 1, 0),
          rotated(0, 0, 1),
          {pose.position.x, pose.position.y, pose.position.z}};
}

Pose operator*(const Pose& a, const Pose& b) { return compose(a, toArray(b)); }

Pose inverse(const Pose& pose) {
  const spatial::Vector &x = pose.x, &y = pose.y, &z = pose.z;
  return {{x.x, y.x, z.x},
          {x.y, y.y, z.y},
          {x.z, y.z, z.z},
          {-dot(x, pose.p), -dot(y, pose.p), -dot(z, pose.p)}};
}

const Pose kIdentity = spatial::toPose(kIdentityTransform);

void checkFinite(const Pose& pose, const std::string& owner) {
  for (double value : toArray(pose)) {
    if (!std::isfinite(value)) {
      fail("the origin of " + quoted(owner) + " is not finite.");
    }
  }
}

// The link's one revolute joint turns about +z; fixed joints may precede it.
void checkArmJoint(const urdf::Joint& joint) {
  if (joint.type != urdf::Joint::REVOLUTE && joint.type != urdf::Joint::CONTINUOUS) {
    fail("joint " + quoted(joint.name) +
         " must be of type revolute, since it moves the arm's link " +
         quoted(joint.child_link_name) + ".");
  }
  const urdf::Vector3& axis = joint.axis;
  const double length = std::sqrt(axis.x * axis.x + axis.y * axis.y + axis.z * axis.z);
  if (!(std::abs(axis.x) <= kAxisTolerance * length &&
        std::abs(axis.y) <= kAxisTolerance * length && axis.z > 0.0)) {
    fail("joint " + quoted(joint.name) +
         " must turn about +z of its own frame (axis 0 0 1), not about " +
         franka_core::numberText(axis.x) + " " + franka_core::numberText(axis.y) + " " +
         franka_core::numberText(axis.z) + ". Put the direction into the joint's origin.");
  }
}

// From `ancestor` down to `link`; `moves` allows the joint of `link` itself to move.
Pose transformBetween(const urdf::Link& ancestor, const urdf::LinkConstSharedPtr& link,
                      bool moves) {
  Pose transform = kIdentity;
  for (urdf::LinkConstSharedPtr at = link; at->name != ancestor.name; at = at->getParent()) {
    if (!at->parent_joint || !at->getParent()) {
      fail("link " + quoted(link->name) + " does not hang below " + quoted(ancestor.name) + ".");
    }
    const urdf::Joint& joint = *at->parent_joint;
    if (at == link && moves) {
      checkArmJoint(joint);
    } else if (joint.type != urdf::Joint::FIXED) {
      fail("joint " + quoted(joint.name) + " between " + quoted(ancestor.name) + " and " +
           quoted(link->name) + " must be fixed.");
    }
    const Pose origin = toPose(joint.parent_to_joint_origin_transform);
    checkFinite(origin, joint.name);
    transform = origin * transform;
  }
  return transform;
}

// Pose of a link in the frame of a link above it, joints at position 0; empty if it is not above.
std::optional<Pose> poseIn(const urdf::Link& ancestor, const urdf::LinkConstSharedPtr& link) {
  Pose pose = kIdentity;
  urdf::LinkConstSharedPtr at = link;
  for (; at && at->name != ancestor.name; at = at->getParent()) {
    if (!at->parent_joint) {
      return std::nullopt;
    }
    const Pose origin = toPose(at->parent_joint->parent_to_joint_origin_transform);
    checkFinite(origin, at->parent_joint->name);
    pose = origin * pose;
  }
  return at ? std::optional<Pose>(pose) : std::nullopt;
}

// The pose in the flange frame of a link that is mounted on the arm; empty if there is no such
// link. Some descriptions mount the hand on link 7 instead of the flange.
std::optional<Pose> poseInFlange(const urdf::ModelInterface& model, const std::string& prefix,
                                 const std::string& name) {
  const urdf::LinkConstSharedPtr link = model.getLink(prefix + name);
  if (!link) {
    return std::nullopt;
  }
  const urdf::LinkConstSharedPtr flange = model.getLink(prefix + "link8");
  if (const std::optional<Pose> pose = poseIn(*flange, link)) {
    return pose;
  }
  const urdf::LinkConstSharedPtr last = model.getLink(prefix + "link7");
  const std::optional<Pose> pose = poseIn(*last, link);
  return pose ? std::optional<Pose>(inverse(transformBetween(*last, flange, false)) * *pose)
              : std::nullopt;
}

// A link's own mass; `at` is the link's pose in the frame of the result.
Payload ownMass(const urdf::Link& link, const Pose& at) {
  const urdf::Inertial& inertial = *link.inertial;
  const Pose frame = at * toPose(inertial.origin);
  checkFinite(frame, link.name);
  const std::array<double, 9> inertia{inertial.ixx, inertial.ixy, inertial.ixz,
                                      inertial.ixy, inertial.iyy, inertial.iyz,
                                      inertial.ixz, inertial.iyz, inertial.izz};
  double sum = inertial.mass;
  for (double value : inertia) {
    sum += value;
  }
  if (!std::isfinite(sum) || inertial.mass < 0.0) {
    fail("the inertial of link " + quoted(link.name) +
         " needs a mass that is not negative and a finite inertia.");
  }
  const spatial::Symmetric i = rotateInertia(frame, inertia.data());
  return {inertial.mass,
          {frame.p.x, frame.p.y, frame.p.z},
          {i.xx, i.xy, i.xz, i.xy, i.yy, i.yz, i.xz, i.yz, i.zz}};
}

// All bodies rigidly fixed to an arm link, except `flange_name` and those below it.
void addRigidBodies(const urdf::Link& link, const Pose& at, const std::string& flange_name,
                    Payload& sum) {
  if (link.inertial) {
    sum = combine(sum, ownMass(link, at));
  }
  for (const urdf::JointSharedPtr& joint : link.child_joints) {
    if (joint->type == urdf::Joint::FIXED && joint->child_link_name != flange_name) {
      for (const urdf::LinkSharedPtr& child : link.child_links) {
        if (child->name == joint->child_link_name) {
          addRigidBodies(*child, at * toPose(joint->parent_to_joint_origin_transform), flange_name,
                         sum);
        }
      }
    }
  }
}

// All bodies below a link, joints at position 0. The hand and moving links must have a mass; other
// links (tool center points, coarse collision bodies) need none.
void addSubtree(const urdf::Link& link, const Pose& at, const std::string& hand_name,
                Payload& sum) {
  const bool moves = link.parent_joint && link.parent_joint->type != urdf::Joint::FIXED;
  if (link.inertial) {
    sum = combine(sum, ownMass(link, at));
  } else if (moves || link.name == hand_name) {
    fail("link " + quoted(link.name) +
         " has no inertial, so the end effector's mass is unknown. Generate the description with "
         "the "
         "xacro argument gazebo:=true, or set mass, center of mass and inertia by parameters.");
  }
  for (const urdf::LinkSharedPtr& child : link.child_links) {
    addSubtree(*child, at * toPose(child->parent_joint->parent_to_joint_origin_transform),
               hand_name, sum);
  }
}

ArmModel::Link readLink(const urdf::ModelInterface& model, const std::string& prefix, int number) {
  const urdf::LinkConstSharedPtr parent =
      model.getLink(prefix + "link" + std::to_string(number - 1));
  const urdf::LinkConstSharedPtr link = model.getLink(prefix + "link" + std::to_string(number));
  const Pose origin = transformBetween(*parent, link, true);
  if (!link->inertial) {
    fail("link " + quoted(link->name) +
         " has no inertial, so the arm's dynamics are unknown. Generate the description with the "
         "xacro argument gazebo:=true.");
  }
  if (!(link->inertial->mass > 0.0)) {
    fail("the mass of link " + quoted(link->name) + " must be greater than 0 kg.");
  }
  Payload body;
  addRigidBodies(*link, kIdentity, prefix + "link8", body);
  return {toArray(origin), body.mass, body.com, body.inertia};
}

}  // namespace

ArmModel ArmModel::fromUrdf(const std::string& urdf, const std::string& arm_id) {
  const urdf::ModelInterfaceSharedPtr model = parse(urdf);
  const std::string prefix = choosePrefix(*model, arm_id);
  std::array<Link, 7> links;
  for (int i = 0; i < 7; i++) {
    links[i] = readLink(*model, prefix, i + 1);
  }
  const Pose flange =
      transformBetween(*model->getLink(prefix + "link7"), model->getLink(prefix + "link8"), false);
  return {links, toArray(flange)};
}

Payload endEffectorFromUrdf(const std::string& urdf, const std::string& arm_id) {
  const urdf::ModelInterfaceSharedPtr model = parse(urdf);
  const std::string prefix = choosePrefix(*model, arm_id);
  Payload sum;
  addSubtree(*model->getLink(prefix + "link8"), kIdentity, prefix + "hand", sum);
  return sum;
}

std::optional<std::array<double, 16>> nominalEndEffectorFromUrdf(const std::string& urdf,
                                                                 const std::string& arm_id) {
  const urdf::ModelInterfaceSharedPtr model = parse(urdf);
  const std::string prefix = choosePrefix(*model, arm_id);
  if (const std::optional<Pose> tcp = poseInFlange(*model, prefix, "hand_tcp")) {
    return toArray(*tcp);
  }
  const std::optional<Pose> hand = poseInFlange(*model, prefix, "hand");
  // Another tool may have the hand's name, but not its fingers.
  if (!hand || !model->getLink(prefix + "leftfinger") || !model->getLink(prefix + "rightfinger")) {
    return std::nullopt;
  }
  Pose tcp = kIdentity;
  tcp.p.z = kHandToTcp;
  return toArray(*hand * tcp);
}

}  // namespace franka_core

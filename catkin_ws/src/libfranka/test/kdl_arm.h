// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <urdf_parser/urdf_parser.h>

#include <cstddef>
#include <kdl/chain.hpp>
#include <string>

#include "franka_core/arm_model.h"

namespace franka_test {

/// A frame or array in KDL's types.
inline KDL::Frame toKdl(const std::array<double, 16>& t) {
  return {KDL::Rotation(t[0], t[4], t[8], t[1], t[5], t[9], t[2], t[6], t[10]),
          KDL::Vector(t[12], t[13], t[14])};
}

inline KDL::RotationalInertia toKdl(const std::array<double, 9>& inertia) {
  return KDL::RotationalInertia(inertia[0], inertia[4], inertia[8], inertia[3], inertia[6],
                                inertia[7]);
}

inline KDL::Frame toKdl(const urdf::Pose& pose) {
  const urdf::Rotation& r = pose.rotation;
  return {KDL::Rotation::Quaternion(r.x, r.y, r.z, r.w),
          KDL::Vector(pose.position.x, pose.position.y, pose.position.z)};
}

/// The arm in KDL, read from the URDF without ArmModel: segment i moves link i, the last segment is
/// the flange. `count` moving segments, then the flange if count is 7.
inline KDL::Chain kdlArm(const std::string& text, const std::string& arm_id,
                         std::size_t count = 7) {
  const auto model = urdf::parseURDF(text);
  KDL::Chain chain;
  for (std::size_t i = 1; i <= count + (count == 7 ? 1 : 0); i++) {
    const auto link = model->getLink(arm_id + "_link" + std::to_string(i));
    const KDL::Frame origin = toKdl(link->parent_joint->parent_to_joint_origin_transform);
    KDL::RigidBodyInertia inertia = KDL::RigidBodyInertia::Zero();
    if (link->inertial) {
      const auto& in = *link->inertial;
      const KDL::Frame at = toKdl(in.origin);
      inertia = at.M * KDL::RigidBodyInertia(
                           in.mass, KDL::Vector::Zero(),
                           KDL::RotationalInertia(in.ixx, in.iyy, in.izz, in.ixy, in.ixz, in.iyz));
      inertia = KDL::RigidBodyInertia(in.mass, at.p, inertia.getRotationalInertia());
    }
    if (i <= 7) {
      const auto& axis = link->parent_joint->axis;
      const KDL::Joint joint("joint" + std::to_string(i), origin.p,
                             origin.M * KDL::Vector(axis.x, axis.y, axis.z), KDL::Joint::RotAxis);
      chain.addSegment(KDL::Segment(joint, origin, inertia));
    } else {
      chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::Fixed), origin, inertia));
    }
  }
  return chain;
}

/// The payload as another body fixed to the flange.
inline void addPayload(KDL::Chain& chain, const franka_core::Payload& payload) {
  chain.addSegment(KDL::Segment(
      KDL::Joint(KDL::Joint::Fixed), KDL::Frame::Identity(),
      KDL::RigidBodyInertia(payload.mass,
                            KDL::Vector(payload.com[0], payload.com[1], payload.com[2]),
                            toKdl(payload.inertia))));
}

}  // namespace franka_test

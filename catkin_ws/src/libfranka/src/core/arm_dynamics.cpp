// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// The composite rigid body algorithm (mass matrix) and the recursive Newton-Euler algorithm
// (inverse dynamics), with the names of Featherstone, Rigid Body Dynamics Algorithms. Everything is
// expressed in O about the point O: inertias can then be added without a change of frame, and both
// algorithms and gravity share one backward recursion.
#include "arm_chain.h"

namespace franka_core {

using spatial::Body;
using spatial::Joints;
using spatial::Pose;
using spatial::Screw;
using spatial::Vector;

namespace {

using Axes = std::array<Screw, 7>;
using Bodies = std::array<Body, 7>;
using Forces = std::array<Screw, 7>;

constexpr Screw kRest{{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};

void jointAxes(const Joints& joints, Axes& axes) noexcept {
  for (std::size_t i = 0; i < 7; i++) {
    axes[i] = jointAxis(joints[i]);
  }
}

// The payload is rigidly fixed to link 7.
void linkBodies(const std::array<ArmModel::Link, 7>& links, const std::array<double, 16>& flange,
                const Payload& payload, const Joints& joints, Bodies& bodies) noexcept {
  for (std::size_t i = 0; i < 7; i++) {
    bodies[i] = toBody(joints[i], links[i].mass, links[i].com, links[i].inertia);
  }
  bodies[6] =
      bodies[6] + toBody(compose(joints[6], flange), payload.mass, payload.com, payload.inertia);
}

// Forward recursion of Newton-Euler: the force of each body alone. `a` is the base's acceleration.
void bodyForces(const Axes& axes, const Bodies& bodies, const std::array<double, 7>& dq,
                const std::array<double, 7>& ddq, Screw a, Forces& forces) noexcept {
  Screw v = kRest;
  for (std::size_t i = 0; i < 7; i++) {
    const Screw joint_motion = dq[i] * axes[i];
    v = v + joint_motion;
    a = a + crossMotion(v, joint_motion) + ddq[i] * axes[i];
    forces[i] = bodyForce(bodies[i], v, a);
  }
}

// Torque about a joint that holds a composite body (its link and all that follow) against gravity.
double holdingTorque(const Screw& axis, const Body& body, const Vector& gravity_earth) noexcept {
  return -dot(axis, Screw{cross(body.moment, gravity_earth), body.mass * gravity_earth});
}

// One column and row of the mass matrix: the momentum that joint j gives to its composite body.
void fillMassColumn(const Axes& axes, const Body& composite, std::size_t j,
                    std::array<double, 49>& mass) noexcept {
  const Screw momentum = composite * axes[j];
  for (std::size_t i = 0; i <= j; i++) {
    const double value = dot(axes[i], momentum);
    mass[7 * j + i] = value;
    mass[7 * i + j] = value;
  }
}

}  // namespace

std::array<double, 49> ArmModel::mass(const std::array<double, 7>& q,
                                      const Payload& payload) const noexcept {
  Joints joints;
  Axes axes;
  Bodies bodies;
  jointPoses(links_, q, 7, joints);
  jointAxes(joints, axes);
  linkBodies(links_, flange_, payload, joints, bodies);
  std::array<double, 49> result;
  for (std::size_t j = 7; j-- > 0;) {
    if (j < 6) {
      bodies[j] = bodies[j] + bodies[j + 1];
    }
    fillMassColumn(axes, bodies[j], j, result);
  }
  return result;
}

std::array<double, 7> ArmModel::coriolis(const std::array<double, 7>& q,
                                         const std::array<double, 7>& dq,
                                         const Payload& payload) const noexcept {
  return inverseDynamics(q, dq, {}, payload, {});
}

std::array<double, 7> ArmModel::gravity(const std::array<double, 7>& q, const Payload& payload,
                                        const std::array<double, 3>& gravity_earth) const noexcept {
  Joints joints;
  jointPoses(links_, q, 7, joints);
  // Gravity needs only mass and first moment, so inertias are not rotated.
  double mass = payload.mass;
  const Pose flange = compose(joints[6], flange_);
  Vector moment = mass * (flange.p + rotate(flange, payload.com.data()));
  const Vector earth = spatial::toVector(gravity_earth.data());
  std::array<double, 7> result;
  for (std::size_t i = 7; i-- > 0;) {
    const double link_mass = links_[i].mass;
    mass += link_mass;
    moment += link_mass * (joints[i].p + rotate(joints[i], links_[i].com.data()));
    result[i] = -dot(joints[i].z, cross(moment - mass * joints[i].p, earth));
  }
  return result;
}

std::array<double, 7> ArmModel::inverseDynamics(
    const std::array<double, 7>& q, const std::array<double, 7>& dq,
    const std::array<double, 7>& ddq, const Payload& payload,
    const std::array<double, 3>& gravity_earth) const noexcept {
  Joints joints;
  Axes axes;
  Bodies bodies;
  Forces forces;
  jointPoses(links_, q, 7, joints);
  jointAxes(joints, axes);
  linkBodies(links_, flange_, payload, joints, bodies);
  // Gravity acts like an acceleration of the base in the opposite direction.
  bodyForces(axes, bodies, dq, ddq,
             Screw{{0.0, 0.0, 0.0}, -1.0 * spatial::toVector(gravity_earth.data())}, forces);
  std::array<double, 7> result;
  Screw force = kRest;
  for (std::size_t i = 7; i-- > 0;) {
    force = force + forces[i];
    result[i] = dot(axes[i], force);
  }
  return result;
}

void ArmModel::computeDynamics(ArmFrame frame, const std::array<double, 7>& q,
                               const std::array<double, 7>& dq,
                               const std::array<double, 16>& F_T_EE,
                               const std::array<double, 16>& EE_T_K, const Payload& payload,
                               const std::array<double, 3>& gravity_earth,
                               ArmDynamics& result) const noexcept {
  Joints joints;
  Axes axes;
  Bodies bodies;
  Forces forces;
  jointPoses(links_, q, 7, joints);
  jointAxes(joints, axes);
  linkBodies(links_, flange_, payload, joints, bodies);
  bodyForces(axes, bodies, dq, {}, kRest, forces);

  const Vector earth = spatial::toVector(gravity_earth.data());
  Body composite{0.0, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0, 0.0, 0.0, 0.0}};
  Screw force = kRest;
  for (std::size_t j = 7; j-- > 0;) {
    composite = composite + bodies[j];
    force = force + forces[j];
    fillMassColumn(axes, composite, j, result.mass);
    result.coriolis[j] = dot(axes[j], force);
    result.gravity[j] = holdingTorque(axes[j], composite, earth);
  }

  const Pose tip = framePose(frame, joints, flange_, F_T_EE, EE_T_K);
  result.pose = toArray(tip);
  fillZeroJacobian(joints, spatial::jointsBefore(frame), tip.p, result.zero_jacobian);
}

}  // namespace franka_core

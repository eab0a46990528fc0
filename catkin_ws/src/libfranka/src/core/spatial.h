// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>

#include <array>
#include <cmath>
#include <cstddef>

/// @file
/// Vectors, frames and rigid bodies, all expressed in the base frame O; internal to ArmModel.
/// Inline, fixed-size and free of branches, so that the compiler can keep values in registers.

namespace franka_core {
namespace spatial {

struct Vector {
  double x, y, z;
};

inline Vector operator+(const Vector& a, const Vector& b) noexcept {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vector operator-(const Vector& a, const Vector& b) noexcept {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vector operator*(double s, const Vector& a) noexcept { return {s * a.x, s * a.y, s * a.z}; }
inline Vector& operator+=(Vector& a, const Vector& b) noexcept { return a = a + b; }
inline double dot(const Vector& a, const Vector& b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vector cross(const Vector& a, const Vector& b) noexcept {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Vector toVector(const double* values) noexcept { return {values[0], values[1], values[2]}; }

/// Axes and origin of a frame.
struct Pose {
  Vector x, y, z, p;
};

inline Vector rotate(const Pose& pose, const double* v) noexcept {
  return v[0] * pose.x + v[1] * pose.y + v[2] * pose.z;
}

/// pose * transform, the transform 4x4 column-major.
inline Pose compose(const Pose& pose, const std::array<double, 16>& transform) noexcept {
  const double* t = transform.data();
  return {rotate(pose, t), rotate(pose, t + 4), rotate(pose, t + 8), pose.p + rotate(pose, t + 12)};
}

/// Rotates the frame about its own z axis.
inline void turn(Pose& pose, double angle) noexcept {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  const Vector x = c * pose.x + s * pose.y;
  pose.y = c * pose.y - s * pose.x;
  pose.x = x;
}

inline Pose toPose(const std::array<double, 16>& transform) noexcept {
  const double* t = transform.data();
  return {toVector(t), toVector(t + 4), toVector(t + 8), toVector(t + 12)};
}

inline std::array<double, 16> toArray(const Pose& pose) noexcept {
  return {pose.x.x, pose.x.y, pose.x.z, 0.0, pose.y.x, pose.y.y, pose.y.z, 0.0,
          pose.z.x, pose.z.y, pose.z.z, 0.0, pose.p.x, pose.p.y, pose.p.z, 1.0};
}

/// Symmetric 3x3 matrix.
struct Symmetric {
  double xx, yy, zz, xy, xz, yz;
};

inline Symmetric operator+(const Symmetric& a, const Symmetric& b) noexcept {
  return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.xz + b.xz, a.yz + b.yz};
}
inline Vector operator*(const Symmetric& a, const Vector& v) noexcept {
  return {a.xx * v.x + a.xy * v.y + a.xz * v.z, a.xy * v.x + a.yy * v.y + a.yz * v.z,
          a.xz * v.x + a.yz * v.y + a.zz * v.z};
}

/// R inertia R^T, inertia 3x3 column-major in the frame's axes.
inline Symmetric rotateInertia(const Pose& r, const double* inertia) noexcept {
  const Vector a = rotate(r, inertia);
  const Vector b = rotate(r, inertia + 3);
  const Vector c = rotate(r, inertia + 6);
  return {a.x * r.x.x + b.x * r.y.x + c.x * r.z.x, a.y * r.x.y + b.y * r.y.y + c.y * r.z.y,
          a.z * r.x.z + b.z * r.y.z + c.z * r.z.z, a.x * r.x.y + b.x * r.y.y + c.x * r.z.y,
          a.x * r.x.z + b.x * r.y.z + c.x * r.z.z, a.y * r.x.z + b.y * r.y.z + c.y * r.z.z};
}

/// The parallel-axis term for a mass at c: m (|c|^2 1 - c c^T).
inline Symmetric pointInertia(double m, const Vector& c) noexcept {
  const double xx = m * c.x * c.x;
  const double yy = m * c.y * c.y;
  const double zz = m * c.z * c.z;
  return {yy + zz, xx + zz, xx + yy, -m * c.x * c.y, -m * c.x * c.z, -m * c.y * c.z};
}

/// A rigid body, or several that move as one: mass, first moment and inertia about O.
struct Body {
  double mass;
  Vector moment;
  Symmetric inertia;
};

inline Body operator+(const Body& a, const Body& b) noexcept {
  return {a.mass + b.mass, a.moment + b.moment, a.inertia + b.inertia};
}

inline Body toBody(const Pose& pose, double mass, const std::array<double, 3>& com,
                   const std::array<double, 9>& inertia) noexcept {
  const Vector c = pose.p + rotate(pose, com.data());
  return {mass, mass * c, rotateInertia(pose, inertia.data()) + pointInertia(mass, c)};
}

/// A motion (angular velocity, velocity of the point at O) or a force (torque about O, force).
struct Screw {
  Vector angular;
  Vector linear;
};

inline Screw operator+(const Screw& a, const Screw& b) noexcept {
  return {a.angular + b.angular, a.linear + b.linear};
}
inline Screw operator*(double s, const Screw& a) noexcept { return {s * a.angular, s * a.linear}; }
/// Power of a force along a motion.
inline double dot(const Screw& a, const Screw& b) noexcept {
  return dot(a.angular, b.angular) + dot(a.linear, b.linear);
}

/// Motion per unit of joint velocity: the axis through the joint.
inline Screw jointAxis(const Pose& joint) noexcept { return {joint.z, cross(joint.p, joint.z)}; }

/// Rate of change of motion b that moves with motion a.
inline Screw crossMotion(const Screw& a, const Screw& b) noexcept {
  return {cross(a.angular, b.angular), cross(a.angular, b.linear) + cross(a.linear, b.angular)};
}

/// Rate of change of force f that moves with motion a.
inline Screw crossForce(const Screw& a, const Screw& f) noexcept {
  return {cross(a.angular, f.angular) + cross(a.linear, f.linear), cross(a.angular, f.linear)};
}

/// Momentum of a body in motion v (or the force that gives it acceleration v).
inline Screw operator*(const Body& body, const Screw& v) noexcept {
  return {body.inertia * v.angular + cross(body.moment, v.linear),
          body.mass * v.linear + cross(v.angular, body.moment)};
}

/// Force on the body for motion v and acceleration a.
inline Screw bodyForce(const Body& body, const Screw& v, const Screw& a) noexcept {
  return body * a + crossForce(v, body * v);
}

}  // namespace spatial
}  // namespace franka_core

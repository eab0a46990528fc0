// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/robot/limits.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "limit_profile.h"
#include "motion/motion_fixture.h"
#include "robot/motion/cartesian_motion.h"
#include "robot/safety/collisions.h"

namespace franka_sim::test {

enum class Part { kTranslation, kRotation, kElbow };

inline franka_core::DerivativeLimits boundsOf(const MotionLimits& limits, Part part) {
  return part == Part::kTranslation ? limits.arm.translation
         : part == Part::kRotation  ? limits.arm.rotation
                                    : limits.elbow();
}

/// A path on which one part of the Cartesian motion reaches a limit: straight along, or about, an
/// axis in O, or of the elbow alone. With a massless rod in the hand, whose tip is the end
/// effector, the tip may also circle the robot's first axis: far out it is faster than on any
/// straight path.
struct Way {
  Part part;
  Joints start;                         ///< [rad]
  Eigen::Vector3d axis{0.0, 0.0, 1.0};  ///< need not be of length 1
  double rod{0.0};                      ///< NE_T_EE: along z of the hand [m]
  bool round{false};                    ///< circles z of O, with kTranslation
};

/// On a circle the velocity's direction uses its share of the acceleration.
inline Profile profileOf(const Way& way, Derivative what,
                         const franka_core::DerivativeLimits& bounds, double share) {
  return reach(what, bounds, share, way.round ? 0.4 : 0.8);
}

/// A desired position of end effector and elbow.
struct Waypoint {
  Eigen::Vector3d position;
  Eigen::Matrix3d rotation;
  double q3;
};

inline Waypoint along(const Way& way, const Waypoint& start, double distance) {
  Waypoint point = start;
  if (way.round) {
    const double radius = start.position.head<2>().norm();
    const Eigen::AngleAxisd turn(distance / radius, Eigen::Vector3d::UnitZ());
    point.position = turn * start.position;
    point.rotation = turn * start.rotation;
  } else if (way.part == Part::kTranslation) {
    point.position += distance * way.axis.normalized();
  } else if (way.part == Part::kRotation) {
    point.rotation = Eigen::AngleAxisd(distance, way.axis.normalized()) * start.rotation;
  } else {
    point.q3 += distance;
  }
  return point;
}

/// One point per tick, from the start pose.
inline std::vector<Waypoint> waypoints(const Way& way, const Profile& profile) {
  Transform F_T_EE = kHandF_T_NE;
  F_T_EE[14] += way.rod;
  const Transform pose = model().pose(franka_core::ArmFrame::kEndEffector, way.start, F_T_EE);
  const Eigen::Map<const Eigen::Matrix4d> O_T_EE(pose.data());
  const Waypoint start{O_T_EE.topRightCorner<3, 1>(), O_T_EE.topLeftCorner<3, 3>(), way.start[2]};
  std::vector<Waypoint> points{start};
  double distance = 0.0, velocity = 0.0, acceleration = 0.0;
  for (const double jerk : profile) {
    acceleration += jerk * kTick;
    velocity += acceleration * kTick;
    distance += velocity * kTick;
    points.push_back(along(way, start, distance));
  }
  return points;
}

struct Judgement {
  double share{0.0};
  const char* by{""};  ///< what uses that share
};

/// The largest share that a path uses of any limit of the arm besides those of the commands: joint
/// velocities, accelerations and jerks as far as the control unit allows, joint ranges, singular
/// poses, self-collision. Above 1: not possible.
class WayJudge {
 public:
  explicit WayJudge(const MotionLimits& limits) : limits_(limits) {}

  /// Stops early above `enough`.
  Judgement judge(const Way& way, const Profile& profile, double enough = 1.0) {
    Transform F_T_EE = kHandF_T_NE;
    F_T_EE[14] += way.rod;
    worst_ = {};
    Joints q = way.start, dq{}, ddq{};
    int tick = 0;
    for (const Waypoint& point : waypoints(way, profile)) {
      Transform pose = franka_core::kIdentityTransform;
      Eigen::Map<Eigen::Matrix4d> O_T_EE(pose.data());
      O_T_EE.topLeftCorner<3, 3>() = point.rotation;
      O_T_EE.topRightCorner<3, 1>() = point.position;
      const InverseKinematics::Solution solution =
          InverseKinematics::solve(q, pose, point.q3, F_T_EE, model());
      for (std::size_t i = 0; i < 7; i++) {
        const double velocity = (solution.q[i] - q[i]) / kTick;
        const double acceleration = (velocity - dq[i]) / kTick;
        if (way.part != Part::kElbow || i != 2) {
          addJoint(i, q[i], velocity, acceleration, (acceleration - ddq[i]) / kTick);
        }
        dq[i] = velocity;
        ddq[i] = acceleration;
      }
      q = solution.q;
      if (tick++ % kEvery == 0) {
        addPose(solution);
      }
      if (solution.near_singularity) {
        add(kNever, "a singular pose");
      }
      if (!(worst_.share <= enough)) {
        return worst_;
      }
    }
    return worst_;
  }

 private:
  static constexpr int kEvery = 10;
  static constexpr double kRangeMargin = 0.03;      // [rad]
  static constexpr double kSingular = 0.02;         // start of damping in the inverse kinematics
  static constexpr double kCollisionMargin = 0.01;  // [m]
  static constexpr double kSolvedJerk = 3.5;        // docs/fidelity.md
  static constexpr double kNever = 1e9;

  void add(double share, const char* by) {
    if (!(share <= worst_.share)) {
      worst_ = {share, by};
    }
  }

  void addJoint(std::size_t i, double from, double velocity, double acceleration, double jerk) {
    const double highest =
        velocity > 0.0 ? limits_.highestVelocity(i, from) : -limits_.lowestVelocity(i, from);
    add(std::abs(velocity) / std::max(highest, 1e-9), "a joint's velocity");
    add(std::abs(acceleration) / limits_.arm.ddq[i], "a joint's acceleration");
    add(std::abs(jerk) / (kSolvedJerk * limits_.arm.dddq[i]), "a joint's jerk");
  }

  void addPose(const InverseKinematics::Solution& solution) {
    for (std::size_t i = 0; i < 7; i++) {
      const double middle = 0.5 * (limits_.arm.q_max[i] + limits_.arm.q_min[i]);
      const double half = 0.5 * (limits_.arm.q_max[i] - limits_.arm.q_min[i]) - kRangeMargin;
      if (!(std::abs(solution.q[i] - middle) <= half)) {
        add(kNever, "a joint's range");
      }
    }
    Eigen::Matrix<double, 7, 7> matrix = Eigen::Matrix<double, 7, 7>::Zero();
    matrix.topRows<6>() = Eigen::Map<const Eigen::Matrix<double, 6, 7>>(solution.jacobian.data());
    matrix(6, 2) = 1.0;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 7, 7>> squares(
        Eigen::Matrix<double, 7, 7>(matrix * matrix.transpose()), Eigen::EigenvaluesOnly);
    add(kSingular / std::sqrt(std::max(squares.eigenvalues()[0], 1e-12)), "a singular pose");
    if (collision_.closest(model(), solution.q).distance < kCollisionMargin) {
      add(kNever, "the arm's own volumes");
    }
  }

  MotionLimits limits_;
  SelfCollision collision_{true};
  Judgement worst_;
};

}  // namespace franka_sim::test

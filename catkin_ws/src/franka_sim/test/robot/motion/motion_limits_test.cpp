// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The limits of velocity, acceleration and jerk of each commanded coordinate: 99 % is accepted, and
// 101 % raises only the flag of its stage (docs/design/limits.md).
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "motion_fixture.h"
#include "robot/motion/cartesian_motion.h"
#include "robot/motion/joint_motion.h"

namespace franka_sim::test {

using franka_core::RobotError;

namespace {

constexpr double kAccepted = 0.99;
constexpr double kRefused = 1.01;
constexpr std::size_t kTranslation = 7, kRotation = 8,
                      kElbow = 9;  ///< coordinates after the joints

using Stages = std::array<RobotError, 3>;
constexpr Stages kJointFlags{{RobotError::kJointMotionGeneratorVelocityLimitsViolation,
                              RobotError::kJointMotionGeneratorVelocityDiscontinuity,
                              RobotError::kJointMotionGeneratorAccelerationDiscontinuity}};
constexpr Stages kCartesianFlags{{RobotError::kCartesianMotionGeneratorVelocityLimitsViolation,
                                  RobotError::kCartesianMotionGeneratorVelocityDiscontinuity,
                                  RobotError::kCartesianMotionGeneratorAccelerationDiscontinuity}};

enum class Derivative { kVelocity, kAcceleration, kJerk };

/// After each tick of a motion from rest to rest: the distance from the start, and the velocity.
struct Tick {
  double way, velocity;
};
using Profile = std::vector<Tick>;

/// Integrated from jerk by backward Euler. Reaches a share of one limit and stays well below the
/// others; acceleration and deceleration are symmetric.
Profile reach(Derivative what, const franka_core::DerivativeLimits& limits, double share) {
  int ramp = 10, hold = 10, cruise = 0;  // ticks; the ramp has a fifth of the jerk limit
  double acceleration = share * limits.acceleration;
  if (what == Derivative::kJerk) {
    ramp = 1;
    hold = 0;
    acceleration = share * limits.jerk * kTick;
  } else if (what == Derivative::kVelocity) {
    // Ticks at 0.8 of the full acceleration; two ramps count as one.
    const int full =
        static_cast<int>(std::ceil(limits.velocity / (0.8 * limits.acceleration * kTick)));
    ramp = std::min(40, full / 2);
    hold = full - ramp;
    cruise = 10;
    acceleration = share * limits.velocity / (full * kTick);
  }
  Profile profile;
  double way = 0.0, velocity = 0.0, present = 0.0;
  const auto append = [&](int ticks, double change) {
    for (int i = 0; i < ticks; i++) {
      present += change / ramp;
      velocity += present * kTick;
      way += velocity * kTick;
      profile.push_back({way, velocity});
    }
  };
  for (int half = 0; half < (what == Derivative::kJerk ? 20 : 2); half++) {
    const double sign = half % 2 == 0 ? 1.0 : -1.0;
    append(ramp, sign * acceleration);
    append(hold, 0.0);
    append(ramp, -sign * acceleration);
    append(sign > 0.0 ? cruise : 0, 0.0);
  }
  return profile;
}

enum class Sends { kPositions, kVelocities, kRoundedPositions, kRoundedVelocities };

/// Moves one coordinate by commands of one kind.
class LimitTest : public ::testing::TestWithParam<std::tuple<unsigned, std::size_t>> {
 protected:
  franka_core::DerivativeLimits bounds() const {
    const franka_core::ArmLimits& arm = limits.arm;
    return coordinate == kTranslation ? arm.translation
           : coordinate == kRotation  ? arm.rotation
           : coordinate == kElbow
               ? limits.elbow()
               : franka_core::DerivativeLimits{arm.dq[coordinate], arm.ddq[coordinate],
                                               arm.dddq[coordinate]};
  }

  RobotError flag(std::size_t stage) const {
    return coordinate == kElbow ? RobotError::kCartesianMotionGeneratorElbowLimitViolation
           : coordinate > 6     ? kCartesianFlags[stage]
                                : kJointFlags[stage];
  }

  ErrorSet move(const Profile& profile, Sends sends) const {
    return coordinate > 6 ? moveEndEffector(profile, sends) : moveJoint(profile, sends);
  }

  const franka_core::MotionLimits limits{
      franka_core::motionLimitsOfProtocol(std::get<0>(GetParam()))};
  const std::size_t coordinate{std::get<1>(GetParam())};

 private:
  /// Through the middle of the joint's range, where an FR3's velocity limits are not reduced.
  ErrorSet moveJoint(const Profile& profile, Sends sends) const {
    const bool rounds = sends == Sends::kRoundedPositions || sends == Sends::kRoundedVelocities;
    const auto sent = [&](double value) { return rounds ? asFloat(value) : value; };
    const double middle = 0.5 * (limits.arm.q_min[coordinate] + limits.arm.q_max[coordinate]);
    Joints q = kReady, dq{};
    q[coordinate] = sent(middle - 0.5 * profile.back().way);
    JointMotion motion;
    motion.start(q);
    const bool positions = sends == Sends::kPositions || sends == Sends::kRoundedPositions;
    ErrorSet errors = positions ? motion.takePositions(q, limits) : ErrorSet();
    for (const Tick& next : profile) {
      Joints command = q;
      command[coordinate] = sent(q[coordinate] + next.way);
      dq[coordinate] = sent(next.velocity);
      errors.add(positions ? motion.takePositions(command, limits)
                           : motion.takeVelocities(dq, limits));
      if (errors) {
        break;
      }
    }
    return errors;
  }

  ErrorSet moveEndEffector(const Profile& profile, Sends sends) const {
    const Eigen::Vector3d axis = Eigen::Vector3d(-0.11, -0.28, -0.89).normalized();
    CartesianMotion motion;
    motion.start(startPose(), {{kReady[2], -1.0}});
    const ElbowCommand still{true, {{kReady[2], -1.0}}};
    ErrorSet errors = sends == Sends::kPositions ? motion.takePose(startPose(), still, -1.0, limits)
                                                 : motion.takeTwist({}, still, -1.0, limits);
    for (const Tick& next : profile) {
      Transform pose = startPose();
      Eigen::Map<Eigen::Matrix4d> matrix(pose.data());
      Twist twist{};
      ElbowCommand elbow = still;
      if (coordinate == kTranslation) {
        matrix.topRightCorner<3, 1>() += next.way * axis;
        Eigen::Map<Eigen::Vector3d>(twist.data()) = next.velocity * axis;
      } else if (coordinate == kRotation) {
        const Eigen::AngleAxisd turn(next.way, axis);
        matrix.topLeftCorner<3, 3>() = Eigen::Matrix3d(turn * matrix.topLeftCorner<3, 3>());
        Eigen::Map<Eigen::Vector3d>(twist.data() + 3) = next.velocity * axis;
      } else {
        elbow.elbow[0] += next.way;
      }
      errors.add(sends == Sends::kPositions ? motion.takePose(pose, elbow, -1.0, limits)
                                            : motion.takeTwist(twist, elbow, -1.0, limits));
      if (errors) {
        break;
      }
    }
    return errors;
  }
};

TEST_P(LimitTest, IsAcceptedUpToItsValueAndRaisesOnlyItsFlagBeyond) {
  for (const Sends sends : {Sends::kPositions, Sends::kVelocities}) {
    for (std::size_t stage = 0; stage < 3; stage++) {
      SCOPED_TRACE(::testing::Message() << "stage " << stage << ", sends " << int(sends));
      const auto derivative = static_cast<Derivative>(stage);
      EXPECT_EQ(ErrorSet(), move(reach(derivative, bounds(), kAccepted), sends));
      EXPECT_EQ(ErrorSet(flag(stage)), move(reach(derivative, bounds(), kRefused), sends));
    }
  }
}

TEST_P(LimitTest, IsExceededByPositionsThatAreRoundedToFloatsButNotByVelocities) {
  if (coordinate != 3) {
    return;  // the rounding depends on the position
  }
  const Profile profile = reach(Derivative::kJerk, bounds(), kAccepted);
  EXPECT_EQ(ErrorSet(flag(2)), move(profile, Sends::kRoundedPositions));
  EXPECT_EQ(ErrorSet(), move(profile, Sends::kRoundedVelocities));
}

const char* const kNames[]{"Joint1", "Joint2", "Joint3",      "Joint4",   "Joint5",
                           "Joint6", "Joint7", "Translation", "Rotation", "Elbow"};
INSTANTIATE_TEST_SUITE_P(Robots, LimitTest,
                         ::testing::Combine(::testing::ValuesIn(kProtocols),
                                            ::testing::Range(std::size_t{0}, kElbow + 1)),
                         [](const auto& row) {
                           return "Protocol" + std::to_string(std::get<0>(row.param)) +
                                  kNames[std::get<1>(row.param)];
                         });

/// The fastest straight path that was found, by its share of the limit of translation.
struct StraightWay {
  unsigned protocol;
  double share;
  Joints start;
  Eigen::Vector3d axis;
};
const std::array<StraightWay, 2> kStraightWays{
    {{5, 0.65, {{0, 0.92, -0.38, -1.74, 0.55, 2.54, 1.48}}, {0.08, 0.38, -0.03}},
     {10, 0.40, {{0, 1.15, 1.10, -1.52, 2.20, 2.03, -1.95}}, {0.30, -0.66, 0.27}}}};

TEST(StraightPaths, ReachJointLimitsFirst) {
  for (const StraightWay& way : kStraightWays) {
    for (const double share : {way.share, kAccepted}) {
      Motion motion(way.protocol, MotionGeneratorMode::kCartesianPosition, way.start);
      Transform pose = forward(way.start);
      ErrorSet errors = motion.step(test::pose(pose)).errors;
      const Eigen::Vector3d start(pose.data() + 12);
      for (const Tick& next :
           reach(Derivative::kVelocity, motion.limits().arm.translation, share)) {
        Eigen::Map<Eigen::Vector3d>(pose.data() + 12) = start + next.way * way.axis.normalized();
        if (!errors) {
          errors = motion.step(test::pose(pose)).errors;
        }
      }
      EXPECT_EQ(share == way.share
                    ? ErrorSet()
                    : RobotError::kCartesianMotionGeneratorJointVelocityDiscontinuity,
                errors)
          << "protocol " << way.protocol << ", " << share;
    }
  }
}

}  // namespace

}  // namespace franka_sim::test

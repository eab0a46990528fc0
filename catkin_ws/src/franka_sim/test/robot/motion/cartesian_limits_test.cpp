// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Cartesian commands integrated from jerk: just inside each limit they pass, just outside they
// raise only the flag of their stage. Only the commands are checked here, so that no joint limit
// comes first.
#include <franka_sim/robot/motion/cartesian_motion.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "motion_fixture.h"

namespace franka_sim::test {

using franka_core::RobotError;

namespace {

enum class Part { kTranslation, kRotation, kElbow };

struct CartesianClient {
  bool poses;  // or twists
  bool reads_floats;
};

double seenBy(const CartesianClient& client, double value) {
  return client.reads_floats ? asFloat(value) : value;
}

Transform startPose() {
  return model().pose(franka_core::ArmFrame::kEndEffector, kReady, kHandF_T_NE);
}

/// Drives one part along (or about) an oblique direction by jerk, backward Euler; the rest stands.
class CartesianDrive {
 public:
  CartesianDrive(unsigned protocol, CartesianClient client, Part part)
      : limits_(motionLimitsOfProtocol(protocol)), client_(client), part_(part) {
    motion_.start(startPose(), {{0.1, -1.0}});
    command_ = startPose();
    q3_ = 0.1;
    send();
  }

  void tick(double jerk) {
    if (fault_) {
      return;
    }
    observe();
    a_ += jerk * kTick;
    v_ += a_ * kTick;
    const Eigen::Vector3d way = direction() * v_ * kTick;
    Eigen::Map<Eigen::Matrix4d> pose(command_.data());
    if (part_ == Part::kTranslation) {
      pose.topRightCorner<3, 1>() += way;
    } else if (part_ == Part::kRotation) {
      const Eigen::AngleAxisd turn(v_ * kTick, direction());
      pose.topLeftCorner<3, 3>() = Eigen::Matrix3d(turn * pose.topLeftCorner<3, 3>());
    } else {
      q3_ += v_ * kTick;
    }
    send();
  }

  void tickTowards(double acceleration, double jerk) {
    if (!fault_) {
      observe();
      tick(std::min(std::max((acceleration - a_) / kTick, -jerk), jerk));
    }
  }

  void accelerateTo(double acceleration, double jerk) {
    while (!fault_ && std::abs(acceleration - a_) > 1e-9) {
      tickTowards(acceleration, jerk);
    }
  }

  franka_core::DerivativeLimits bounds() const {
    return part_ == Part::kTranslation ? limits_.arm.translation
           : part_ == Part::kRotation  ? limits_.arm.rotation
                                       : limits_.elbow();
  }
  double velocity() const { return v_; }
  ErrorSet fault() const { return fault_; }

 private:
  static Eigen::Vector3d direction() { return Eigen::Vector3d(2, -3, 6) / 7.0; }

  void observe() {
    if (!client_.reads_floats) {
      return;
    }
    const CartesianSample& last = motion_.last();
    std::transform(last.pose.begin(), last.pose.end(), command_.begin(),
                   [this](double value) { return seenBy(client_, value); });
    q3_ = seenBy(client_, last.elbow.q3);
    v_ = component(last.twist, last.elbow.dq3);
    a_ = component(last.acceleration, last.elbow.ddq3);
  }

  double component(const Twist& values, double elbow) const {
    const std::size_t first = part_ == Part::kRotation ? 3 : 0;
    Eigen::Vector3d vector;
    for (std::size_t i = 0; i < 3; i++) {
      vector[static_cast<int>(i)] = seenBy(client_, values[first + i]);
    }
    return part_ == Part::kElbow ? seenBy(client_, elbow) : vector.dot(direction());
  }

  void send() {
    const ElbowCommand elbow{true, {{q3_, -1.0}}};
    Twist twist{};
    if (part_ != Part::kElbow) {
      const std::size_t first = part_ == Part::kRotation ? 3 : 0;
      Eigen::Map<Eigen::Vector3d>(twist.data() + first) = direction() * v_;
    }
    fault_ = client_.poses ? motion_.takePose(command_, elbow, -1.0, limits_)
                           : motion_.takeTwist(twist, elbow, -1.0, limits_);
  }

  MotionLimits limits_;
  CartesianClient client_;
  Part part_;
  CartesianMotion motion_;
  Transform command_{};
  double q3_{0.0}, v_{0.0}, a_{0.0};
  ErrorSet fault_;
};

void reachJerk(CartesianDrive& drive, double share) {
  for (int i = 0; i < 20; i++) {
    drive.tick((i % 2 == 0 ? share : -share) * drive.bounds().jerk);
  }
}

void reachAcceleration(CartesianDrive& drive, double share) {
  const double acceleration = share * drive.bounds().acceleration;
  drive.accelerateTo(acceleration, 0.5 * drive.bounds().jerk);
  for (int i = 0; i < 20; i++) {
    drive.tickTowards(acceleration, 0.5 * drive.bounds().jerk);
  }
}

void speedUpTo(CartesianDrive& drive, double velocity, double acceleration) {
  while (!drive.fault() && drive.velocity() < velocity) {
    drive.tickTowards(acceleration, 0.5 * drive.bounds().jerk);
  }
}

void reachVelocity(CartesianDrive& drive, double share) {
  const franka_core::DerivativeLimits bounds = drive.bounds();
  const double acceleration = 0.8 * bounds.acceleration;
  const double rest = acceleration * acceleration / bounds.jerk + 2.0 * acceleration * kTick;
  speedUpTo(drive, share * bounds.velocity - rest, acceleration);
  drive.accelerateTo(0.0, 0.5 * bounds.jerk);
  speedUpTo(drive, share * bounds.velocity, 0.1 * acceleration);
}

struct Stage {
  RobotError flag;
  std::function<void(CartesianDrive&, double)> reach;
};

const std::vector<Stage> kStages{
    {RobotError::kCartesianMotionGeneratorAccelerationDiscontinuity, reachJerk},
    {RobotError::kCartesianMotionGeneratorVelocityDiscontinuity, reachAcceleration},
    {RobotError::kCartesianMotionGeneratorVelocityLimitsViolation, reachVelocity}};

void passesInsideAndFailsOutside(CartesianClient client, unsigned protocol) {
  for (const Part part : {Part::kTranslation, Part::kRotation, Part::kElbow}) {
    for (const Stage& stage : kStages) {
      SCOPED_TRACE(::testing::Message() << "protocol " << protocol << ", part "
                                        << static_cast<int>(part) << ", flag " << stage.flag);
      CartesianDrive inside(protocol, client, part);
      stage.reach(inside, 0.99);
      EXPECT_FALSE(inside.fault()) << inside.fault();
      CartesianDrive beyond(protocol, client, part);
      stage.reach(beyond, 1.01);
      ASSERT_TRUE(beyond.fault());
      EXPECT_EQ(part == Part::kElbow
                    ? ErrorSet(RobotError::kCartesianMotionGeneratorElbowLimitViolation)
                    : ErrorSet(stage.flag),
                beyond.fault());
    }
  }
}

TEST(CartesianLimits, PosesPassInsideAndRaiseTheirFlagOutside) {
  for (unsigned protocol : kProtocols) {
    passesInsideAndFailsOutside({true, false}, protocol);
  }
}

TEST(CartesianLimits, TwistsPassInsideAndRaiseTheirFlagOutside) {
  for (unsigned protocol : kProtocols) {
    passesInsideAndFailsOutside({false, false}, protocol);
  }
}

TEST(CartesianLimits, ClientsThatReadFloatsPassInsideAndFailOutside) {
  passesInsideAndFailsOutside({true, true}, 10);
  passesInsideAndFailsOutside({false, true}, 10);
}

}  // namespace

}  // namespace franka_sim::test

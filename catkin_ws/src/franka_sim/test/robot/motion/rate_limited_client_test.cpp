// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// A client that limits its commands as libfranka does is never aborted, whatever its targets:
// random targets, every robot, states as doubles and as floats.
#include <franka/rate_limiting.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "motion_fixture.h"
#include "robot/motion/cartesian_motion.h"
#include "robot/motion/joint_motion.h"

namespace franka_sim::test {

namespace {

constexpr int kSeeds = 8;
constexpr int kTicks = 20000;

/// The limits of the client's rate limiter: franka/rate_limiting.h for the Panda. The FR3's client
/// has no margin for lost packets (protocol 5.6).
struct Bounds {
  explicit Bounds(unsigned protocol)
      : protocol(protocol), limits(franka_core::motionLimitsOfProtocol(protocol)) {}

  franka_core::DerivativeLimits shrunk(const franka_core::DerivativeLimits& full) const {
    const double packets = protocol <= 5 ? franka::kTolNumberPacketsLost : 0.0;
    const double acceleration = full.acceleration - franka::kLimitEps;
    return {full.velocity - franka::kLimitEps - packets * franka::kDeltaT * acceleration,
            acceleration, full.jerk - franka::kLimitEps};
  }

  unsigned protocol;
  franka_core::MotionLimits limits;
};

/// Reads states as sent over the network.
struct Wire {
  bool floats;
  double operator()(double value) const { return floats ? asFloat(value) : value; }
  template <std::size_t kSize>
  std::array<double, kSize> operator()(std::array<double, kSize> values) const {
    for (double& value : values) {
      value = (*this)(value);
    }
    return values;
  }
};

// The FR3's limiter, with the two velocity limits at q (protocol 5.6).
Joints limitFr3(const Bounds& bounds, const Joints& q, const Joints& desired, const Joints& v,
                const Joints& a) {
  Joints limited{};
  for (std::size_t i = 0; i < 7; i++) {
    const auto b = bounds.shrunk({0.0, bounds.limits.arm.ddq[i], bounds.limits.arm.dddq[i]});
    const auto& table = bounds.limits.velocity_near_ends;
    const double high = franka_core::upperVelocityLimit(table, i, q[i]) - franka::kLimitEps;
    const double low = franka_core::lowerVelocityLimit(table, i, q[i]) + franka::kLimitEps;
    const double jerk = ((desired[i] - v[i]) / kTick - a[i]) / kTick;
    const double acceleration = a[i] + std::max(std::min(jerk, b.jerk), -b.jerk) * kTick;
    const double gain = b.jerk / b.acceleration;
    const double up = std::min(gain * (high - v[i]), b.acceleration);
    const double down = std::max(gain * (low - v[i]), -b.acceleration);
    limited[i] = v[i] + std::max(std::min(acceleration, up), down) * kTick;
  }
  return limited;
}

Joints limitVelocities(const Bounds& bounds, const Joints& q, const Joints& desired,
                       const Joints& v, const Joints& a) {
  return bounds.protocol <= 5
             ? franka::limitRate(franka::kMaxJointVelocity, franka::kMaxJointAcceleration,
                                 franka::kMaxJointJerk, desired, v, a)
             : limitFr3(bounds, q, desired, v, a);
}

Joints limitPositions(const Bounds& bounds, const Joints& desired, const Joints& q, const Joints& v,
                      const Joints& a) {
  Joints velocities{};
  for (std::size_t i = 0; i < 7; i++) {
    velocities[i] = (desired[i] - q[i]) / kTick;
  }
  Joints limited = limitVelocities(bounds, q, velocities, v, a);
  for (std::size_t i = 0; i < 7; i++) {
    limited[i] = q[i] + limited[i] * kTick;
  }
  return limited;
}

class Random {
 public:
  explicit Random(int seed) : engine_(static_cast<unsigned>(seed)) {}
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  int ticks() { return std::uniform_int_distribution<int>(1, 600)(engine_); }
  Eigen::Vector3d vector(double size) {
    return {between(-size, size), between(-size, size), between(-size, size)};
  }

 private:
  std::mt19937 engine_;
};

/// The middle half of a joint's range, where the limiter, which ignores positions, can stop.
Joints middle(const franka_core::MotionLimits& limits, Random& random) {
  Joints q{};
  for (std::size_t i = 0; i < 7; i++) {
    const double span = limits.arm.q_max[i] - limits.arm.q_min[i];
    q[i] = limits.arm.q_min[i] + random.between(0.25, 0.75) * span;
  }
  return q;
}

/// Faster than allowed, towards the middle.
Joints wildVelocities(const franka_core::MotionLimits& limits, const Joints& q, Random& random) {
  Joints dq{};
  for (std::size_t i = 0; i < 7; i++) {
    const double center = 0.5 * (limits.arm.q_max[i] + limits.arm.q_min[i]);
    dq[i] = std::copysign(random.between(0.0, 8.0), center - q[i]);
  }
  return dq;
}

class RateLimitedClient : public ::testing::TestWithParam<unsigned> {
 protected:
  const Bounds bounds{GetParam()};
  const Wire wire{bounds.limits.echoes_floats};
};

TEST_P(RateLimitedClient, IsNeverAbortedWithJointPositions) {
  for (int seed = 0; seed < kSeeds; seed++) {
    Random random(seed);
    JointMotion motion;
    Joints target = middle(bounds.limits, random);
    motion.start(target);
    ASSERT_FALSE(motion.takePositions(wire(target), bounds.limits));
    for (int tick = 0, change = 0; tick < kTicks; tick++) {
      if (tick == change) {
        target = middle(bounds.limits, random);
        change += random.ticks();
      }
      const JointSample& last = motion.last();
      const Joints q = limitPositions(bounds, target, wire(last.q), wire(last.dq), wire(last.ddq));
      const ErrorSet fault = motion.takePositions(q, bounds.limits);
      ASSERT_FALSE(fault) << fault << " in tick " << tick << " of seed " << seed;
    }
  }
}

TEST_P(RateLimitedClient, IsNeverAbortedWithJointVelocities) {
  for (int seed = 0; seed < kSeeds; seed++) {
    Random random(seed);
    JointMotion motion;
    motion.start(middle(bounds.limits, random));
    Joints target{};
    for (int tick = 0, change = 0; tick < kTicks; tick++) {
      const JointSample& last = motion.last();
      if (tick == change) {
        target = wildVelocities(bounds.limits, last.q, random);
        change += std::min(random.ticks(), 200);
      }
      const Joints dq =
          limitVelocities(bounds, wire(last.q), target, wire(last.dq), wire(last.ddq));
      const ErrorSet fault = motion.takeVelocities(dq, bounds.limits);
      ASSERT_FALSE(fault) << fault << " in tick " << tick << " of seed " << seed;
    }
  }
}

/// A random elbow, limited.
double elbow(const Bounds& bounds, double target, const ElbowSample& last, const Wire& wire) {
  const auto b = bounds.shrunk(bounds.limits.arm.elbow);
  return franka::limitRate(b.velocity, b.acceleration, b.jerk, target, wire(last.q3),
                           wire(last.dq3), wire(last.ddq3));
}

TEST_P(RateLimitedClient, IsNeverAbortedWithCartesianPoses) {
  const auto v = bounds.shrunk(bounds.limits.arm.translation);
  const auto w = bounds.shrunk(bounds.limits.arm.rotation);
  for (int seed = 0; seed < kSeeds; seed++) {
    Random random(seed);
    CartesianMotion motion;
    motion.start(franka_core::kIdentityTransform, {{0.0, -1.0}});
    Transform target = franka_core::kIdentityTransform;
    double q3 = 0.0;
    ASSERT_FALSE(motion.takePose(target, {true, {{q3, -1.0}}}, -1.0, bounds.limits));
    for (int tick = 0, change = 0; tick < kTicks; tick++) {
      if (tick == change) {
        Eigen::Map<Eigen::Matrix4d> pose(target.data());
        const Eigen::Vector3d turn = random.vector(2.0);
        pose.topLeftCorner<3, 3>() =
            Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
        pose.topRightCorner<3, 1>() = random.vector(1.0);
        q3 = random.between(-1.5, 1.5);
        change += random.ticks();
      }
      const CartesianSample& last = motion.last();
      const Transform pose =
          franka::limitRate(v.velocity, v.acceleration, v.jerk, w.velocity, w.acceleration, w.jerk,
                            target, wire(last.pose), wire(last.twist), wire(last.acceleration));
      const ElbowCommand command{true, {{elbow(bounds, q3, last.elbow, wire), -1.0}}};
      const ErrorSet fault = motion.takePose(pose, command, -1.0, bounds.limits);
      ASSERT_FALSE(fault) << fault << " in tick " << tick << " of seed " << seed;
    }
  }
}

TEST_P(RateLimitedClient, IsNeverAbortedWithCartesianVelocities) {
  const auto v = bounds.shrunk(bounds.limits.arm.translation);
  const auto w = bounds.shrunk(bounds.limits.arm.rotation);
  for (int seed = 0; seed < kSeeds; seed++) {
    Random random(seed);
    CartesianMotion motion;
    motion.start(franka_core::kIdentityTransform, {{0.0, -1.0}});
    Twist target{};
    for (int tick = 0, change = 0; tick < kTicks; tick++) {
      if (tick == change) {
        Eigen::Map<Eigen::Vector3d>(target.data()) = random.vector(4.0);
        Eigen::Map<Eigen::Vector3d>(target.data() + 3) = random.vector(4.0);
        change += random.ticks();
      }
      const CartesianSample& last = motion.last();
      const Twist twist =
          franka::limitRate(v.velocity, v.acceleration, v.jerk, w.velocity, w.acceleration, w.jerk,
                            target, wire(last.twist), wire(last.acceleration));
      const ErrorSet fault = motion.takeTwist(twist, {}, -1.0, bounds.limits);
      ASSERT_FALSE(fault) << fault << " in tick " << tick << " of seed " << seed;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, RateLimitedClient, ::testing::ValuesIn(kProtocols));

}  // namespace

}  // namespace franka_sim::test

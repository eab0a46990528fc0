// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The limits of every motion generator through the whole control unit, with a moving arm: 99 % of
// each is reached and the motion ends well, 101 % raises only the flag of its stage, and after a
// recovery 99 % is reached again. docs/design/limits.md lists the start poses and reasons.
#include <cstdlib>
#include <functional>
#include <memory>

#include "fci_fixture.h"
#include "limit_client.h"
#include "limit_search.h"
#include "limit_ways.h"

namespace franka_sim::test {

using franka_core::RobotError;

namespace {

constexpr std::array<Derivative, 3> kStages{
    {Derivative::kVelocity, Derivative::kAcceleration, Derivative::kJerk}};
constexpr std::array<RobotError, 3> kJointFlags{
    {RobotError::kJointMotionGeneratorVelocityLimitsViolation,
     RobotError::kJointMotionGeneratorVelocityDiscontinuity,
     RobotError::kJointMotionGeneratorAccelerationDiscontinuity}};
constexpr std::array<RobotError, 3> kCartesianFlags{
    {RobotError::kCartesianMotionGeneratorVelocityLimitsViolation,
     RobotError::kCartesianMotionGeneratorVelocityDiscontinuity,
     RobotError::kCartesianMotionGeneratorAccelerationDiscontinuity}};

double of(const franka_core::DerivativeLimits& limits, Derivative what) {
  return what == Derivative::kVelocity       ? limits.velocity
         : what == Derivative::kAcceleration ? limits.acceleration
                                             : limits.jerk;
}

franka_core::DerivativeLimits ofJoint(const MotionLimits& limits, std::size_t joint) {
  return {limits.arm.dq[joint], limits.arm.ddq[joint], limits.arm.dddq[joint]};
}

/// One limit, and how to reach a share of it.
struct Approach {
  MotionGeneratorMode mode;
  Joints start;  ///< [rad]
  std::function<std::unique_ptr<LimitClient>(double share)> client;
  std::function<double(const LimitClient&)> reached;  ///< share of the limit
  RobotError flag;
  double rod{0.0};
};

class UnitLimits : public FciTest, public ::testing::WithParamInterface<unsigned> {
 protected:
  const MotionLimits limits{motionLimitsOfProtocol(GetParam())};

  void standAt(const Joints& start, double rod) {
    parameters.rules = InterfaceRules::kFci;
    parameters.protocol_version = GetParam();
    parameters.NE_T_EE[14] = rod;
    FciTest::standAt(start);
    ignoreCollisions();
  }

  void putBack(const Joints& start) {
    arm.put(start);
    unit.restart();
    run(3);
  }

  /// @returns the share of the limit that was sent
  double move(const Approach& approach, double share) {
    const std::unique_ptr<LimitClient> client = approach.client(share);
    startMove(approach.mode);
    drive(10000, [&](int, const RobotState& state) { return client->next(state); });
    return approach.reached(*client);
  }

  void expectToEndWell(const Approach& approach) {
    const double reached = move(approach, 0.99);
    EXPECT_EQ(std::vector<int>{}, raised());
    EXPECT_EQ(RobotMode::kIdle, unit.state().robot_mode);
    EXPECT_GE(reached, 0.985);
    EXPECT_LT(reached, 1.0);
    EXPECT_EQ(Status::kSuccess, waitFor(PendingAnswer::kMotion));
  }

  void expectToFail(const Approach& approach) {
    const double reached = move(approach, 1.01);
    EXPECT_EQ(std::vector<int>{static_cast<int>(indexOf(approach.flag))}, raised());
    EXPECT_EQ(RobotMode::kReflex, unit.state().robot_mode);
    EXPECT_GT(reached, 1.0);
    EXPECT_EQ(Status::kReflexAborted, unit.takeAnswer(PendingAnswer::kMotion));
  }

  void recover() {
    EXPECT_FALSE(unit.request(codec::AutomaticErrorRecoveryRequest{}));
    EXPECT_EQ(Status::kSuccess, waitFor(PendingAnswer::kRecovery));
    EXPECT_EQ(RobotMode::kIdle, unit.state().robot_mode);
    EXPECT_EQ(std::vector<int>{}, raised());
  }

  void expectLimit(const Approach& approach) {
    standAt(approach.start, approach.rod);
    expectToEndWell(approach);
    putBack(approach.start);
    expectToFail(approach);
    recover();
    putBack(approach.start);
    expectToEndWell(approach);
  }

  /// Clients use floats only if the robot's protocol and their precision allow it.
  std::vector<Floats> clientsOf(MotionGeneratorMode mode) const {
    std::vector<Floats> clients{Floats::kNone};
    if (limits.echoes_floats) {
      clients.push_back(Floats::kReads);
    }
    if (mode == MotionGeneratorMode::kJointVelocity ||
        mode == MotionGeneratorMode::kCartesianVelocity) {
      clients.push_back(Floats::kSends);
    }
    return clients;
  }

  /// The middle of a joint's path is the middle of its range: there an FR3's velocity limits are
  /// not reduced.
  Joints startOf(std::size_t joint, const Profile& profile) const {
    Joints q = kReady;
    q[joint] = 0.5 * (limits.arm.q_min[joint] + limits.arm.q_max[joint] - lengthOf(profile));
    return q;
  }

  Approach approachOfJoint(MotionGeneratorMode mode, std::size_t joint, std::size_t stage,
                           Floats floats) const {
    const Derivative what = kStages[stage];
    const franka_core::DerivativeLimits bounds = ofJoint(limits, joint);
    Approach approach;
    approach.mode = mode;
    approach.flag = kJointFlags[stage];
    approach.start = startOf(joint, reach(what, bounds, 1.0));
    approach.client = [=](double share) {
      return std::make_unique<JointClient>(mode, joint, reach(what, bounds, share), what, floats);
    };
    approach.reached = [=](const LimitClient& client) {
      return client.peak([=](const Vector7& x) { return std::abs(x[static_cast<int>(joint)]); }) /
             of(bounds, what);
    };
    return approach;
  }

  Approach approachOfWay(MotionGeneratorMode mode, const Way& way, Derivative what,
                         Floats floats) const {
    const franka_core::DerivativeLimits bounds = boundsOf(limits, way.part);
    Approach approach;
    approach.mode = mode;
    approach.flag = way.part == Part::kElbow
                        ? RobotError::kCartesianMotionGeneratorElbowLimitViolation
                        : kCartesianFlags[static_cast<std::size_t>(what)];
    approach.start = way.start;
    approach.rod = way.rod;
    approach.client = [=](double share) {
      return std::make_unique<CartesianClient>(mode, way, profileOf(way, what, bounds, share), what,
                                               floats);
    };
    approach.reached = [=](const LimitClient& client) {
      return client.peak([=](const Vector7& x) { return sizeOf(x, way.part); }) / of(bounds, what);
    };
    return approach;
  }

  static double sizeOf(const Vector7& x, Part part) {
    return part == Part::kTranslation ? x.head<3>().norm()
           : part == Part::kRotation  ? x.segment<3>(3).norm()
                                      : std::abs(x[6]);
  }

  void expectEachJointLimit(MotionGeneratorMode mode) {
    for (const Floats floats : clientsOf(mode)) {
      for (std::size_t joint = 0; joint < 7; joint++) {
        for (std::size_t stage = 0; stage < kStages.size(); stage++) {
          SCOPED_TRACE(::testing::Message() << "joint " << joint + 1 << ", stage " << stage
                                            << ", floats " << static_cast<int>(floats));
          expectLimit(approachOfJoint(mode, joint, stage, floats));
        }
      }
    }
  }

  void expectEachCartesianLimit(MotionGeneratorMode mode) {
    for (const Floats floats : clientsOf(mode)) {
      for (const LimitWay& row : kLimitWays) {
        // The elbow is always sent as a position: see docs/design/limits.md.
        const bool too_coarse = floats == Floats::kSends && row.way.part == Part::kElbow;
        if (row.protocol != GetParam() || too_coarse) {
          continue;
        }
        for (const Derivative what : row.stages) {
          SCOPED_TRACE(::testing::Message()
                       << "part " << static_cast<int>(row.way.part) << ", stage "
                       << static_cast<int>(what) << ", floats " << static_cast<int>(floats));
          expectLimit(approachOfWay(mode, row.way, what, floats));
        }
      }
    }
  }
};

TEST_P(UnitLimits, PositionsSentAsFloatsExceedTheJerkLimit) {
  const Approach approach =
      approachOfJoint(MotionGeneratorMode::kJointPosition, 3, 2, Floats::kSends);
  standAt(approach.start, 0.0);
  move(approach, 0.99);
  EXPECT_EQ(std::vector<int>{static_cast<int>(
                indexOf(RobotError::kJointMotionGeneratorAccelerationDiscontinuity))},
            raised());
}

TEST_P(UnitLimits, StraightPathsReachJointLimitsFirst) {
  for (const StraightWay& row : kStraightWays) {
    if (row.protocol != GetParam()) {
      continue;
    }
    const Approach approach = approachOfWay(MotionGeneratorMode::kCartesianPosition, row.way,
                                            Derivative::kVelocity, Floats::kNone);
    standAt(row.way.start, 0.0);
    EXPECT_NEAR(row.share, move(approach, row.share), 0.005);
    EXPECT_EQ(std::vector<int>{}, raised());
    standAt(row.way.start, 0.0);
    EXPECT_LT(move(approach, 0.99), 0.99);
    EXPECT_EQ(std::vector<int>{static_cast<int>(
                  indexOf(RobotError::kCartesianMotionGeneratorJointVelocityDiscontinuity))},
              raised());
  }
}

TEST_P(UnitLimits, JointPositionsReachEachLimitAndRaiseItsFlagBeyond) {
  expectEachJointLimit(MotionGeneratorMode::kJointPosition);
}

TEST_P(UnitLimits, JointVelocitiesReachEachLimitAndRaiseItsFlagBeyond) {
  expectEachJointLimit(MotionGeneratorMode::kJointVelocity);
}

TEST_P(UnitLimits, PosesReachEachLimitAndRaiseItsFlagBeyond) {
  expectEachCartesianLimit(MotionGeneratorMode::kCartesianPosition);
}

TEST_P(UnitLimits, TwistsReachEachLimitAndRaiseItsFlagBeyond) {
  expectEachCartesianLimit(MotionGeneratorMode::kCartesianVelocity);
}

INSTANTIATE_TEST_SUITE_P(Robots, UnitLimits, ::testing::Values(5U, 10U));

/// An FR3's joints approaching an end, where the velocity limit shrinks.
class JointEnds : public UnitLimits {
 protected:
  static constexpr double kCruise = 0.05;  // [rad/s]
  // A pose at which no joint's end causes a self-collision.
  static constexpr Joints kClear{{0, 0, 0, -1.57, 0, 2.6, 0.79}};

  /// Where the limit equals the cruise speed: its formula solved for the position (protocol 5.5).
  double endOfCruise(std::size_t joint, bool upper) const {
    const franka_core::PositionVelocityLimits& near = limits.velocity_near_ends;
    const double root = kCruise + near.offset[joint];
    const double margin = root * root / near.deceleration[joint];
    return upper ? near.q_max[joint] - margin : near.q_min[joint] + margin;
  }

  /// The largest share that velocities use of the limit at the joint's position.
  double largestShare(std::size_t joint, double q, const std::vector<double>& velocities) const {
    double largest = 0.0;
    for (const double velocity : velocities) {
      const double limit =
          velocity > 0.0 ? limits.highestVelocity(joint, q) : limits.lowestVelocity(joint, q);
      largest = std::max(largest, velocity / limit);
      q += velocity * kTick;
    }
    return largest;
  }

  static std::vector<double> velocitiesOf(const Profile& profile, std::size_t joint) {
    std::vector<double> velocities;
    for (const Intended& next : planOfJoint(joint, profile)) {
      velocities.push_back(next.velocity[static_cast<int>(joint)]);
    }
    return velocities;
  }

  /// By bisection: the cruise that uses exactly this share.
  Profile profileFor(std::size_t joint, double start, double sign, double share) const {
    double low = 0.0, high = 2.0 * kCruise;
    for (int i = 0; i < 50; i++) {
      const double middle = 0.5 * (low + high);
      const Profile profile = cruise(sign * middle);
      (largestShare(joint, start, velocitiesOf(profile, joint)) < share ? low : high) = middle;
    }
    return cruise(sign * low);
  }

  Approach approachOfEnd(MotionGeneratorMode mode, std::size_t joint, bool upper,
                         Floats floats) const {
    const double sign = upper ? 1.0 : -1.0;
    Profile way = cruise(sign * kCruise);
    way.resize(kCruiseEnd);
    const double start = endOfCruise(joint, upper) - lengthOf(way);
    Approach approach;
    approach.mode = mode;
    approach.flag = RobotError::kJointMotionGeneratorVelocityLimitsViolation;
    approach.start = kClear;
    approach.start[joint] = start;
    approach.client = [=](double share) {
      return std::make_unique<JointClient>(mode, joint, profileFor(joint, start, sign, share),
                                           Derivative::kVelocity, floats);
    };
    approach.reached = [=](const LimitClient& client) {
      std::vector<double> velocities;
      for (const Intended& sent : client.sent()) {
        velocities.push_back(sent.velocity[static_cast<int>(joint)]);
      }
      return largestShare(joint, start, velocities);
    };
    return approach;
  }
};

TEST_P(JointEnds, SpeedsFollowTheShrinkingLimit) {
  for (const MotionGeneratorMode mode :
       {MotionGeneratorMode::kJointPosition, MotionGeneratorMode::kJointVelocity}) {
    for (const Floats floats : clientsOf(mode)) {
      for (std::size_t joint = 0; joint < 7; joint++) {
        for (const bool upper : {false, true}) {
          SCOPED_TRACE(::testing::Message()
                       << "joint " << joint + 1 << (upper ? ", upper end" : ", lower end")
                       << ", floats " << static_cast<int>(floats));
          expectLimit(approachOfEnd(mode, joint, upper, floats));
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Fr3, JointEnds, ::testing::Values(10U));

TEST(LimitWays, LeaveTheJointMarginsOfTheTable) {
  for (const LimitWay& row : kLimitWays) {
    const Judgement judgement = judge({row.protocol, row.stages, row.way.part}, row.way);
    SCOPED_TRACE(judgement.by);
    EXPECT_NEAR(row.taken, judgement.share, 0.005);
    EXPECT_LE(row.taken, 0.9);
  }
}

TEST(LimitWays, MatchTheResultsOfTheSearch) {
  if (std::getenv("FRANKA_TEST_LONG") == nullptr) {
    GTEST_SKIP() << "searches for half a minute: ./franka test --long";
  }
  for (const LimitWay& row : kLimitWays) {
    WaySearch search({row.protocol, row.stages, row.way.part, 0.99, row.way.rod, row.way.round});
    EXPECT_NEAR(row.taken, search.best(row.draws).judgement.share, 0.02);
  }
  for (const StraightWay& row : kStraightWays) {
    for (const double more : {0.0, kTooMuch}) {
      WaySearch search({row.protocol, kVelocityOnly, row.way.part, row.share + more});
      const Judgement judgement = search.best(kStraightDraws).judgement;
      EXPECT_EQ(more > 0.0, judgement.share > 1.0) << judgement.share << " by " << judgement.by;
    }
  }
}

}  // namespace

}  // namespace franka_sim::test

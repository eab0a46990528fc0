// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Our own libfranka against the simulated robot in lock-step, in every version of the protocol.
#include <franka/active_control_base.h>
#include <franka/exception.h>
#include <franka/gripper.h>
#include <franka/log.h>
#include <franka/model.h>
#include <franka_core/limits.h>
#include <franka_sim/physics/world.h>
#include <franka_sim/physics/world_pushes.h>
#include <gtest/gtest.h>
#include <transform_sweep.h>

#include <iomanip>
#include <sstream>
#include <stdexcept>

#include "simulated_robots.h"

namespace franka_sim::fci {
namespace {

constexpr std::array<double, 16> kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

std::array<double, 7> sevenTimes(double value) {
  std::array<double, 7> values;
  values.fill(value);
  return values;
}

std::array<double, 6> sixTimes(double value) {
  std::array<double, 6> values;
  values.fill(value);
  return values;
}

class OwnClient : public ::testing::TestWithParam<int> {
 protected:
  OwnClient()
      : simulated_(std::vector<Place>{{static_cast<std::uint16_t>(GetParam())}}),
        robot(simulated_.address(), franka::RealtimeConfig::kIgnore) {}

 private:
  SimulatedRobots simulated_;

 protected:
  franka::Robot robot;
};

constexpr double kAngle = 0.1;  // [rad]

TEST_P(OwnClient, NegotiatesTheVersionAndReadsStates) {
  EXPECT_EQ(robot.serverVersion(), GetParam());
  const franka::RobotState first = robot.readOnce();
  EXPECT_EQ(first.robot_mode, franka::RobotMode::kIdle);
  test::expectNear(first.q, kReadyPose, 1e-4);
  int count = 0;
  robot.read([&count](const franka::RobotState&) { return ++count < 10; });
  EXPECT_EQ(count, 10);
}

TEST_P(OwnClient, TakesEverySetterAndRefusesInvalidValues) {
  robot.setCollisionBehavior(sevenTimes(20), sevenTimes(30), sixTimes(20), sixTimes(30));
  robot.setJointImpedance({3000, 3000, 3000, 2500, 2500, 2000, 2000});
  robot.setCartesianImpedance({2000, 2000, 2000, 100, 100, 100});
  robot.setGuidingMode({true, true, true, false, false, false}, true);
  std::array<double, 16> frame = kIdentity;
  frame[14] = 0.05;
  robot.setK(frame);
  robot.setEE(frame);
  robot.setLoad(0.5, {0, 0, 0.1}, {0.001, 0, 0, 0, 0.001, 0, 0, 0, 0.001});
  const franka::RobotState state = robot.readOnce();
  EXPECT_DOUBLE_EQ(state.m_load, 0.5);
  // States of version 10 carry float32.
  EXPECT_EQ(state.EE_T_K[14], GetParam() == 10 ? static_cast<double>(0.05F) : 0.05);
  EXPECT_THROW(robot.setLoad(-1.0, {}, {}), franka::CommandException);
}

TEST_P(OwnClient, MovesJointsByPositionAndByVelocity) {
  const double begin = robot.readOnce().q[3];
  swing(robot, kAngle);
  EXPECT_NEAR(robot.readOnce().q[3], begin + kAngle, 2e-3);
  double time = 0.0;
  robot.control([&](const franka::RobotState&, franka::Duration period) {
    time += period.toSec();
    franka::JointVelocities velocities({0, 0, 0, -kAngle * speed(time), 0, 0, 0});
    return time >= kDuration + 0.2 ? franka::MotionFinished(velocities) : velocities;
  });
  EXPECT_NEAR(robot.readOnce().q[3], begin, 3e-3);
}

/// Whether the client accepts the pose of this motion.
bool accepts(const std::function<void()>& motion) {
  try {
    motion();
    return true;
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string::npos, std::string(error.what()).find("exactly 0 0 0 1")) << error.what();
    return false;
  }
}

void controlOnce(franka::Robot& robot, const std::array<double, 16>& pose, bool limited,
                 double cutoff) {
  robot.control(
      [&](const franka::RobotState&, franka::Duration) {
        return franka::MotionFinished(franka::CartesianPose(pose));
      },
      franka::ControllerMode::kJointImpedance, limited, cutoff);
}

/// A motion that the program drives itself.
void writeOnce(franka::Robot& robot, const std::array<double, 16>& pose) {
  const auto motion = robot.startCartesianPoseControl(
      research_interface::robot::Move::ControllerMode::kJointImpedance);
  motion->readOnce();
  motion->writeOnce(franka::MotionFinished(franka::CartesianPose(pose)));
}

class OwnClientWithRounding : public OwnClient {};

TEST_P(OwnClientWithRounding, SetsTheFramesThatTheRobotTakes) {
  for (const auto& set : {&franka::Robot::setEE, &franka::Robot::setK}) {
    for (const franka_test::PerturbedMatrix& perturbed : franka_test::perturbations(kIdentity)) {
      if (perturbed.accepted) {
        EXPECT_NO_THROW((robot.*set)(perturbed.matrix)) << perturbed;
      } else {
        EXPECT_THROW((robot.*set)(perturbed.matrix), franka::CommandException) << perturbed;
      }
    }
    (robot.*set)(kIdentity);
  }
}

TEST_P(OwnClientWithRounding, IsTakenOrRefusedAsTheRobotDoes) {
  const std::array<double, 16> pose = robot.readOnce().O_T_EE_c;
  int count = 0;
  for (const franka_test::PerturbedMatrix& perturbed : franka_test::perturbations(pose)) {
    count++;
    const double cutoff = count % 3 == 0 ? 100.0 : 1000.0;
    EXPECT_EQ(perturbed.accepted,
              accepts([&] { controlOnce(robot, perturbed.matrix, count % 2 == 0, cutoff); }))
        << perturbed;
    EXPECT_EQ(perturbed.accepted, accepts([&] { writeOnce(robot, perturbed.matrix); }))
        << perturbed;
  }
  EXPECT_EQ(franka::RobotMode::kIdle, robot.readOnce().robot_mode);
}

TEST_P(OwnClient, HoldsByTorques) {
  const std::array<double, 7> begin = robot.readOnce().q;
  double time = 0.0;
  robot.control([&](const franka::RobotState& state, franka::Duration period) {
    time += period.toSec();
    franka::Torques torques(sevenTimes(0));
    for (std::size_t i = 0; i < 7; i++) {
      torques.tau_J[i] = 200.0 * (begin[i] - state.q[i]) - 20.0 * state.dq[i];
    }
    return time >= 0.5 ? franka::MotionFinished(torques) : torques;
  });
  const franka::RobotState state = robot.readOnce();
  test::expectNear(state.q, begin, 2e-3);
}

TEST_P(OwnClient, LoadsAModelThatMatchesTheState) {
  const franka::Model model = robot.loadModel();
  const franka::RobotState state = robot.readOnce();
  const std::array<double, 16> pose = model.pose(franka::Frame::kEndEffector, state);
  test::expectNear(pose, state.O_T_EE, 1e-5);
}

TEST_P(OwnClient, IsStoppedByAReflexRecoversAndMovesAgain) {
  double time = 0.0;
  std::array<double, 7> begin{};
  try {
    robot.control(
        [&](const franka::RobotState& state, franka::Duration period) {
          if (time == 0.0) {
            begin = state.q_d;
          }
          time += period.toSec();
          franka::JointPositions positions(begin);
          positions.q[3] += time > 0.1 ? 0.05 : 0.0;  // a jump
          return positions;
        },
        franka::ControllerMode::kJointImpedance, false);
    FAIL() << "A jump of 0.05 rad within a tick raised no error.";
  } catch (const franka::ControlException& error) {
    EXPECT_NE(std::string(error.what()).find("joint_motion_generator_velocity"), std::string::npos)
        << error.what();
    EXPECT_FALSE(error.log.empty());
  }
  EXPECT_EQ(robot.readOnce().robot_mode, franka::RobotMode::kReflex);
  robot.automaticErrorRecovery();
  EXPECT_EQ(robot.readOnce().robot_mode, franka::RobotMode::kIdle);
  const double joint = robot.readOnce().q_d[3];
  swing(robot, kAngle);
  EXPECT_NEAR(robot.readOnce().q[3], joint + kAngle, 2e-3);
}

enum class Cause { kJumpAtOnce, kJump, kPush };

/// What a client sees of a motion that the robot aborts, and of the arm after it: the exception's
/// text and log. The robot's clock runs by the wall's between motions: times of the log count from
/// its first state.
std::string abortSeen(std::uint16_t version, Cause cause) {
  SimulatedRobots simulated(std::vector<Place>{{version}});
  franka::Robot robot(simulated.address(), franka::RealtimeConfig::kIgnore);
  robot.setCollisionBehavior(sevenTimes(20), sevenTimes(20), sixTimes(20), sixTimes(20));
  int cycle = 0;
  std::array<double, 7> begin{};
  std::ostringstream seen;
  try {
    robot.control(
        [&](const franka::RobotState& state, franka::Duration) {
          if (cycle == 0) {
            begin = state.q_d;
          }
          if (cycle == 80 && cause == Cause::kPush) {
            simulated.between([&](SimRobot&, World& world, Host&) {
              pushBody(world, version <= 5 ? "panda_link6" : "fr3_link6", {0, 60, 60}, {}, 100);
            });
          }
          const int jump = cause == Cause::kJumpAtOnce ? 1 : 80;
          franka::JointPositions positions(begin);
          positions.q[3] += kAngle * way(cycle * 1e-3);
          positions.q[3] += cause != Cause::kPush && cycle >= jump ? 0.01 : 0.0;
          cycle++;
          return cycle > 400 ? franka::MotionFinished(positions) : positions;
        },
        franka::ControllerMode::kJointImpedance, false);
    seen << "no abort";
  } catch (const franka::ControlException& error) {
    std::vector<franka::Record> log = error.log;
    const std::uint64_t first = log.empty() ? 0 : log.front().state.time.toMSec();
    for (franka::Record& record : log) {
      record.state.time = franka::Duration(record.state.time.toMSec() - first);
    }
    seen << error.what() << "\n" << franka::logToCSV(log);
  }
  const franka::RobotState after = robot.readOnce();
  seen << "afterwards:" << std::setprecision(17);
  for (const double q : after.q) {
    seen << " " << q;
  }
  return seen.str();
}

TEST(Aborts, LookTheSameToTheirClientInLockStep) {
  for (const std::uint16_t version : {5, 10}) {
    for (const Cause cause : {Cause::kJumpAtOnce, Cause::kJump, Cause::kPush}) {
      const std::string first = abortSeen(version, cause);
      EXPECT_NE(std::string::npos, first.find("motion aborted by reflex!")) << first;
      EXPECT_EQ(std::string::npos, first.find("packets lost")) << first;
      for (int run = 1; run < 3; run++) {
        EXPECT_EQ(first, abortSeen(version, cause)) << version << " " << static_cast<int>(cause);
      }
    }
  }
}

constexpr std::chrono::milliseconds kLonger{1300};  // than the client's timeout for states

TEST(BlockedCallback, IsNamedByTheClientAndByTheRobot) {
  SimulatedRobots simulated({{5}}, std::chrono::milliseconds(50));
  std::vector<std::string> reports;  // of the host's thread
  simulated.between([&](SimRobot& robot, World&, Host&) {
    robot.onSilence([&](const std::string& what) { reports.push_back(what); });
  });
  franka::Robot robot(simulated.address(), franka::RealtimeConfig::kIgnore);
  franka::Gripper hand(simulated.gripperAddress());
  int calls = 0;
  const auto control = [&] {
    robot.control([&](const franka::RobotState&, franka::Duration) {
      if (++calls == 100) {
        hand.move(0.03, 0.1);
      }
      return franka::Torques({0, 0, 0, 0, 0, 0, 0});
    });
  };
  test::expectSentence(control, {"communication_constraints_violation", "Gripper"});
  simulated.finish();
  ASSERT_EQ(1u, reports.size());
  EXPECT_NE(std::string::npos, reports[0].find("callback")) << reports[0];
}

TEST(StarvedMachine, ClientAndRobotWaitForEachOther) {
  SimulatedRobots simulated(std::vector<Place>{{5}});
  franka::Robot robot(simulated.address(), franka::RealtimeConfig::kIgnore);
  swing(robot, kAngle, [&](int cycle) {
    // From here on the client can detect that the robot's time is not the wall's.
    if (cycle == 500) {
      std::this_thread::sleep_for(std::chrono::seconds(1));  // the fault itself
    } else if (cycle == 600) {
      simulated.holdUp(kLonger);
    }
  });
  EXPECT_NEAR(robot.readOnce().q[3], kReadyPose[3] + kAngle, 2e-3);
}

TEST(StarvedMachine, ClientsWaitWhileAnotherClientIsAwaited) {
  SimulatedRobots simulated({{5, 0.0}, {10, 1.0}});
  franka::Robot panda(simulated.address(0), franka::RealtimeConfig::kIgnore);
  franka::Robot fr3(simulated.address(1), franka::RealtimeConfig::kIgnore);
  franka::Gripper gripper(simulated.gripperAddress(0));
  std::atomic<bool> done{false};
  std::thread reading([&] {
    while (!done) {
      EXPECT_NO_THROW(gripper.readOnce());
    }
  });
  auto other = std::async(std::launch::async, [&fr3] { swing(fr3, -kAngle); });
  swing(panda, kAngle, [](int cycle) {
    if (cycle == 300) {
      std::this_thread::sleep_for(kLonger);  // the fault itself
    }
  });
  EXPECT_NO_THROW(other.get());
  EXPECT_NO_THROW(fr3.readOnce());
  done = true;
  reading.join();
  EXPECT_NEAR(panda.readOnce().q[3], kReadyPose[3] + kAngle, 2e-3);
  EXPECT_NEAR(fr3.readOnce().q[3], kReadyPose[3] - kAngle, 2e-3);
}

INSTANTIATE_TEST_SUITE_P(Version, OwnClient, ::testing::Range(3, 11));
INSTANTIATE_TEST_SUITE_P(NewestOfEachRobot, OwnClientWithRounding, ::testing::Values(5, 10));

}  // namespace
}  // namespace franka_sim::fci

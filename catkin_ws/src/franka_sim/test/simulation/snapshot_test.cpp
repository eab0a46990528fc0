// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Snapshots of world and robots: in the middle of motions and grasps, and of other simulations.
#include <franka_sim/physics/world_bodies.h>
#include <franka_sim/physics/world_pushes.h>
#include <franka_sim/simulation/simulation.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <string>

#include "../physics/test_support.h"

namespace franka_sim::test {
namespace {

using franka_core::RobotCommand;
using franka_core::RobotMode;

class SnapshotTest : public ::testing::TestWithParam<const char*> {
 protected:
  std::unique_ptr<Simulation> simulationOf(const std::string& realism, bool hand = true) const {
    Simulation::Robot robot;
    robot.setup.robot = robot.setup.arm_id = GetParam();
    robot.setup.realism = realism;
    robot.setup.base[0] = -0.5;  // beside the stone's table
    robot.hand = hand;
    return std::make_unique<Simulation>("stone.xml", std::vector<Simulation::Robot>{robot});
  }
  static SimulatedRobot& arm(Simulation& simulation) { return simulation.robot(GetParam()); }

  struct Hashes {
    std::uint64_t world, robot;
    bool operator==(const Hashes& other) const {
      return world == other.world && robot == other.robot;
    }
  };
  static Hashes hashes(Simulation& simulation) {
    return {simulation.world().stateHash(), arm(simulation).units().hash()};
  }
};

INSTANTIATE_TEST_SUITE_P(Robots, SnapshotTest, ::testing::Values("panda", "fr3"),
                         [](const auto& param) { return std::string(param.param); });

/// A tick of each kind of motion.
struct Motion {
  const char* name;
  std::function<void(SimulatedRobot&, int)> command;
};

std::vector<Motion> motions() {
  using franka_core::MotionGeneratorMode;
  const auto generator = [](MotionGeneratorMode mode) {
    franka_core::fci::MoveRequest motion;
    motion.motion_generator_mode = mode;
    return motion;
  };
  const auto way = [](int k) { return 0.02 * (1 - std::cos(0.004 * k)); };
  return {
      {"torques", [](SimulatedRobot& robot,
                     int k) { robot.commandTorques({0, 0, 0, std::sin(0.01 * k), 0, 0, 0.2}); }},
      {"joint law",
       [](SimulatedRobot& robot, int k) {
         auto target = robot.state().q;
         target[5] += 0.3;
         if (k == 0) {
           robot.jointLaw().setTarget(target, 0.5);
         }
       }},
      {"Cartesian law",
       [](SimulatedRobot& robot, int k) {
         auto target = robot.state().O_T_EE;
         target[13] += 0.05;
         if (k == 0) {
           robot.cartesianLaw().setTarget(target, 0.5);
         }
       }},
      {"joint positions",
       [=, first = std::array<double, 7>{}](SimulatedRobot& robot, int k) mutable {
         first = k == 0 ? robot.state().q_d : first;
         RobotCommand command;
         command.q_c = first;
         command.q_c[0] += way(k);
         robot.command(generator(MotionGeneratorMode::kJointPosition), command);
       }},
      {"Cartesian poses",
       [=, first = std::array<double, 16>{}](SimulatedRobot& robot, int k) mutable {
         first = k == 0 ? robot.state().O_T_EE_c : first;
         RobotCommand command;
         command.O_T_EE_c = first;
         command.O_T_EE_c[14] += way(k);
         robot.command(generator(MotionGeneratorMode::kCartesianPosition), command);
       }},
  };
}

TEST_P(SnapshotTest, InTheMiddleOfAMotionGoesOnBitForBit) {
  for (const char* realism : {"ideal", "recorded,seed=3,delay=2"}) {
    for (Motion& motion : motions()) {
      const auto simulation = simulationOf(realism);
      SimulatedRobot& robot = arm(*simulation);
      const franka_core::RobotState* const state = &robot.state();
      const auto run = [&](int from, int to) {
        for (int k = from; k < to; k++) {
          motion.command(robot, k);
          simulation->step(1);
        }
        ASSERT_TRUE(robot.moving()) << motion.name << ", " << realism;
      };
      run(0, 200);
      const SimulationSnapshot snapshot = simulation->snapshot();
      const Hashes then = hashes(*simulation);
      const std::uint64_t message = state->message_id;
      run(200, 400);
      const Hashes end = hashes(*simulation);
      robot.finish();
      robot.units().hand()->move(0.05, 0.1);
      simulation->step(700);
      EXPECT_FALSE(robot.moving());
      for (int repetition = 0; repetition < 2; repetition++) {
        simulation->restore(snapshot);
        EXPECT_TRUE(robot.moving()) << motion.name;
        EXPECT_EQ(std::nullopt, robot.lastResult()) << motion.name;
        EXPECT_EQ(then, hashes(*simulation)) << motion.name;
        EXPECT_EQ(message, state->message_id) << "the address of the state stays";
        run(200, 400);
        EXPECT_EQ(end, hashes(*simulation)) << motion.name << ", " << realism;
      }
    }
  }
}

constexpr double kWeight = 0.1024 * 9.81;  // of the stone of stone.xml [N]

/// Opens the hand about the stone, which floats there for two seconds, and begins to close it.
class Grasping {
 public:
  explicit Grasping(Simulation& simulation, const std::string& arm)
      : hand_(*simulation.robot(arm).units().hand()) {
    hand_.move(0.05, 0.1);
    simulation.step(2500);
    setBodyPose(simulation.world(), "stone", bodyPose(simulation.world(), arm + "_hand_tcp"));
    pushBody(simulation.world(), "stone", {0, 0, kWeight}, {}, 2000);
    ticket_ = hand_.grasp(0.032, 0.01, 0.01, 0.03, 30.0);
  }
  GripperUnit& hand() { return hand_; }
  GripperOutcome outcome() const { return hand_.outcome(ticket_); }

 private:
  GripperUnit& hand_;
  GripperUnit::Ticket ticket_;
};

TEST_P(SnapshotTest, OfAnEqualSimulationIsRestored) {
  const auto second = simulationOf("ideal,seed=8");
  Grasping other(*second, GetParam());
  SimulationSnapshot snapshot;
  Hashes then{};
  Hashes end{};
  {
    const auto first = simulationOf("ideal,seed=7");
    Grasping grasping(*first, GetParam());
    arm(*first).jointLaw();
    first->step(300);
    snapshot = first->snapshot();
    then = hashes(*first);
    first->step(1000);
    end = hashes(*first);
  }
  second->restore(snapshot);
  EXPECT_EQ(then, hashes(*second));
  EXPECT_EQ(GripperOutcome::kInterrupted, other.outcome()) << "its own command is over";
  second->step(1000);
  EXPECT_EQ(end, hashes(*second));
  EXPECT_TRUE(other.hand().isGrasped());
  EXPECT_EQ("ideal,seed=8", arm(*second).setup().realism);
}

TEST_P(SnapshotTest, OfOtherRobotsIsRefusedAndChangesNothing) {
  const auto simulation = simulationOf("ideal");
  arm(*simulation).jointLaw();
  simulation->step(20);
  const Hashes before = hashes(*simulation);
  const SimulationSnapshot others[] = {
      simulationOf("real")->snapshot(),           simulationOf("ideal,delay=1")->snapshot(),
      simulationOf("ideal,noise=on")->snapshot(), simulationOf("ideal", false)->snapshot(),
      Simulation("stone.xml", {}).snapshot(),     SimulationSnapshot()};
  for (const SimulationSnapshot& other : others) {
    expectSentence([&] { simulation->restore(other); }, {"of a simulation with other"});
  }
  EXPECT_EQ(before, hashes(*simulation));
  EXPECT_TRUE(arm(*simulation).moving());
  const auto noisy = simulationOf("recorded,seed=1");
  EXPECT_THROW(noisy->restore(simulationOf("recorded,seed=2")->snapshot()), std::runtime_error)
      << "noise and links differ with the seed";
}

/// Its motions are those of clients, who would wait for answers without end.
TEST_P(SnapshotTest, LeavesARobotOfAClientIdle) {
  const auto simulation = simulationOf("ideal");
  SimulatedRobot& robot = arm(*simulation);
  robot.jointLaw();
  simulation->step(20);
  const SimulationSnapshot snapshot = simulation->snapshot();
  const auto q = robot.state().q;
  robot.setServed(true);
  simulation->restore(snapshot);
  EXPECT_FALSE(robot.moving());
  EXPECT_EQ(RobotMode::kIdle, robot.state().robot_mode);
  EXPECT_EQ(q, robot.state().q);
}

}  // namespace
}  // namespace franka_sim::test

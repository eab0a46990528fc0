// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// `franka_sim_contact_scenario_test ROBOT`: ten seconds in which an arm presses twice on a table,
/// in C++. The motion is that of tests/support/contact_motion.py. Prints the hashes of the robot's
/// states and of the world after these ticks, then those of the robot in each tick in which the
/// motion ends and the arm comes to rest. python/test/test_equal_hashes.py compares them with those
/// of the same motion by other ways.
#include <franka_sim/simulation/simulation.h>

#include <cmath>
#include <cstdio>
#include <exception>
#include <string>

namespace {

using franka_core::RobotCommand;
using franka_core::fci::MoveRequest;
using Joints = std::array<double, 7>;

constexpr int kTicks = 10000;
constexpr int kTicksOfEnd = 2000;
constexpr std::array<double, 3> kBase{-0.5, 0, 0.149};

Joints downAndBack(const Joints& first, int k) {
  const double phase = 2 * M_PI * k / kTicks;
  const double x = std::pow(std::sin(phase), 4);
  Joints q = first;
  q[1] += 0.5 * x;
  q[3] -= 0.2 * x;
  q[0] += 0.05 * std::pow(std::sin(phase), 3);
  return q;
}

void allowContact(franka_sim::SimulatedRobot& robot) {
  franka_core::fci::SetCollisionBehaviorRequest thresholds;
  for (auto* const torques :
       {&thresholds.lower_torques_acceleration, &thresholds.upper_torques_acceleration,
        &thresholds.lower_torques_nominal, &thresholds.upper_torques_nominal}) {
    torques->fill(100.0);
  }
  for (auto* const forces :
       {&thresholds.lower_forces_acceleration, &thresholds.upper_forces_acceleration,
        &thresholds.lower_forces_nominal, &thresholds.upper_forces_nominal}) {
    forces->fill(300.0);
  }
  robot.request(thresholds, "The collision behavior");
}

void run(const std::string& kind) {
  franka_sim::Simulation::Robot described;
  described.setup.robot = described.setup.arm_id = kind;
  described.setup.base = kBase;
  franka_sim::Simulation simulation("stone.xml", {described});
  franka_sim::SimulatedRobot& robot = simulation.robot(kind);
  allowContact(robot);
  const Joints first = robot.state().q_d;
  MoveRequest motion;
  motion.motion_generator_mode = franka_core::MotionGeneratorMode::kJointPosition;
  for (int k = 0; k < kTicks; k++) {
    RobotCommand command;
    command.q_c = downAndBack(first, k);
    robot.command(motion, command);
    simulation.step(1);
  }
  std::printf("%016llx %016llx\n", static_cast<unsigned long long>(robot.units().hash()),
              static_cast<unsigned long long>(simulation.world().stateHash()));
  RobotCommand last;
  last.q_c = downAndBack(first, kTicks);
  robot.command(motion, last);
  robot.finish();
  for (int k = 0; k < kTicksOfEnd; k++) {
    simulation.step(1);
    std::printf("%016llx\n", static_cast<unsigned long long>(robot.units().hash()));
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    run(argc > 1 ? argv[1] : "panda");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}

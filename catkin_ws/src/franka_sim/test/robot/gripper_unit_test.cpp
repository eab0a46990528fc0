// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The gripper's commands on simulated fingers, with and without an object.
#include <franka_sim/robot/hands/gripper_unit.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "fake_hand.h"

namespace franka_sim::test {

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

class GripperTest : public ::testing::Test {
 protected:
  void tick() {
    hand.applyForces(gripper.step(hand.measure(), 1e-3));
    hand.step();
    narrowest = std::min(narrowest, gripper.width());
    widest = std::max(widest, gripper.width());
  }

  void run(int ticks) {
    for (int i = 0; i < ticks; i++) {
      tick();
    }
  }

  /// Opens the resting hand so far [m].
  void startAt(double width) {
    hand.put(width);
    run(10);
    narrowest = widest = width;
  }

  /// Runs until a command has ended. @returns seconds, or 100 if never
  double finish(GripperUnit::Ticket ticket) {
    for (int i = 0; i < 20000; i++) {
      if (gripper.outcome(ticket) != GripperOutcome::kRunning) {
        return 1e-3 * i;
      }
      tick();
    }
    return 100.0;
  }

  /// The stone of the demo: 25 mm wide, centered or `beside` the center [m].
  void putStone(double width = 0.025, double beside = 0.0) {
    hand.has_object = true;
    hand.object = FakeHand::Object{};
    hand.object.left = 0.5 * width;
    hand.object.right = 0.5 * width;
    hand.object.position = beside;
    hand.object.movable = true;
  }

  void openAroundTheStone() {
    putStone();
    startAt(0.06);
  }

  GripperUnit::Ticket graspTheStone() { return gripper.grasp(0.025, 0.005, 0.005, 0.1, 5); }

  FakeHand hand;
  GripperUnit gripper{GripperParameters{}};
  double narrowest{1.0}, widest{0.0};  ///< of all ticks [m]
};

TEST_F(GripperTest, TemperatureFollowsTheSquaredForce) {
  const GripperParameters parameters;
  putStone();
  run(1000);
  EXPECT_NEAR(parameters.room_temperature, gripper.temperature(), 1e-3);
  const double force = 70.0;
  finish(gripper.grasp(0.025, 0.005, 0.005, 0.1, force));
  ASSERT_TRUE(gripper.isGrasped());
  const double begin = gripper.temperature();
  run(100000);
  const double share = force / parameters.max_force;
  const double end = parameters.room_temperature + parameters.temperature_rise * share * share;
  EXPECT_NEAR(end + (begin - end) * std::exp(-100.0 / parameters.temperature_time),
              gripper.temperature(), 0.01);
  const double warm = gripper.temperature();
  gripper.stop();
  run(100000);
  EXPECT_NEAR(parameters.room_temperature + (warm - parameters.room_temperature) *
                                                std::exp(-100.0 / parameters.temperature_time),
              gripper.temperature(), 0.01);
  gripper.restart();
  EXPECT_EQ(parameters.room_temperature, gripper.temperature());
}

TEST_F(GripperTest, MovesEndWhereTheFingersArriveOrStandStill) {
  struct Row {
    double from, to, speed, obstacle;  // [m], [m/s]; an obstacle of no width is none
    double time, tolerance;            // [s]
    GripperOutcome outcome;
  };
  for (const Row& row : {Row{0.0, 0.08, 0.1, 0, 0.9, 0.1, GripperOutcome::kSucceeded},
                         Row{0.08, 0.03, 0.02, 0, 2.52, 0.1, GripperOutcome::kSucceeded},
                         Row{0.04, 0.0405, 0.0005, 0, 1.0, 0.1, GripperOutcome::kSucceeded},
                         Row{0.04, 0.04, 0.1, 0, 0.0, 0.01, GripperOutcome::kSucceeded},
                         Row{0.04, 0.08, 0.0, 0, 0.2, 0.01, GripperOutcome::kFailed},
                         Row{0.03, 0.0, 0.1, 0.03, 0.2, 0.05, GripperOutcome::kFailed},
                         Row{0.06, 0.0, 0.1, 0.025, 0.375, 0.1, GripperOutcome::kFailed}}) {
    SCOPED_TRACE(::testing::Message() << row.from << " to " << row.to);
    hand = FakeHand();
    gripper = GripperUnit(GripperParameters{});
    putStone(row.obstacle);
    hand.has_object = row.obstacle > 0.0;
    hand.object.movable = false;
    startAt(row.from);
    const GripperUnit::Ticket ticket = gripper.move(row.to, row.speed);
    EXPECT_NEAR(row.time, finish(ticket), row.tolerance);
    EXPECT_EQ(row.outcome, gripper.outcome(ticket));
    EXPECT_EQ(GripperState::kIdle, gripper.state());
    run(500);
    EXPECT_EQ(row.outcome == GripperOutcome::kSucceeded, std::abs(row.to - gripper.width()) < 1e-4);
    EXPECT_LT(hand.padForce()[0], 0.1) << "nothing keeps pressing";
    EXPECT_GT(narrowest, std::min(row.from, row.to) - 1e-3) << "overshoots";
    EXPECT_LT(widest, std::max(row.from, row.to) + 1e-3) << "overshoots";
  }
}

/// As users report of the real hand: about a second even for tiny moves.
TEST_F(GripperTest, LatencyDelaysTheStartAndTheOutcome) {
  GripperParameters parameters;
  parameters.latency = {0.2, 1.0};
  gripper = GripperUnit(parameters);
  run(10);
  const double before = gripper.width();
  const GripperUnit::Ticket tiny = gripper.move(before + 1e-3, 0.1);
  run(195);
  EXPECT_NEAR(before, gripper.width(), 1e-5);
  EXPECT_NEAR(1.0, 0.195 + finish(tiny), 2e-3);
  EXPECT_EQ(GripperOutcome::kSucceeded, gripper.outcome(tiny));
  EXPECT_NEAR(before + 1e-3, gripper.width(), 1e-4);
  const double way = gripper.width();
  const GripperUnit::Ticket close = gripper.move(0.0, 0.02);
  EXPECT_NEAR(way / 0.02 + 0.2, finish(close), 0.1) << "a long way takes no further second";
  const GripperUnit::Ticket interrupted = gripper.move(0.04, 0.1);
  run(100);
  const GripperUnit::Ticket next = gripper.homing();
  EXPECT_EQ(GripperOutcome::kInterrupted, gripper.outcome(interrupted));
  run(100);
  const GripperUnit::Ticket stop = gripper.stop();
  EXPECT_EQ(GripperOutcome::kInterrupted, gripper.outcome(next));
  EXPECT_EQ(GripperOutcome::kSucceeded, gripper.outcome(stop)) << "stop does not wait";
  run(500);
  EXPECT_NEAR(0.0, gripper.width(), 1e-3) << "a stopped command began after all";
}

TEST_F(GripperTest, HeldObjectIsHeldUntilTheNextCommandBegins) {
  GripperParameters parameters;
  parameters.latency = {0.2, 1.0};
  gripper = GripperUnit(parameters);
  openAroundTheStone();
  EXPECT_GE(finish(gripper.grasp(0.025, 0.005, 0.005, 0.1, 20.0)), 1.0);
  ASSERT_TRUE(gripper.isGrasped());
  gripper.move(0.08, 0.1);
  run(190);
  EXPECT_TRUE(gripper.isGrasped());
  run(100);
  EXPECT_FALSE(gripper.isGrasped());
}

/// A grasp with its outcome.
struct GraspRow {
  const char* name;
  double object;    ///< its width, or the inner one of a hollow object; 0: none [m]
  double from, to;  ///< width of the hand, and of the grasp [m]
  double end;       ///< width afterwards [m]
  double inner{0.005}, outer{0.005};
  double force{5.0};                      ///< [N]
  double mass{0.115}, coupling{20000.0};  ///< of the fingers [kg], [N/m]
  double beside{0.0};                     ///< of the center [m]
  bool hollow{false};
};

class Grasp : public GripperTest, public ::testing::WithParamInterface<GraspRow> {};

TEST_P(Grasp, HoldsAnObjectOfItsWidthWithHalfOfTheForceOnEachFinger) {
  const GraspRow& row = GetParam();
  hand = FakeHand(row.mass, row.coupling);
  putStone(row.object, row.beside);
  hand.has_object = row.object > 0.0;
  hand.object.hollow = row.hollow;
  hand.object.movable = !row.hollow;
  startAt(row.from);
  const GripperUnit::Ticket ticket = gripper.grasp(row.to, row.inner, row.outer, 0.1, row.force);
  EXPECT_LT(finish(ticket), 3.0);
  const double excess = row.object - row.to;
  const bool holds = row.object > 0.0 && excess < row.outer && excess > -row.inner;
  EXPECT_EQ(holds ? GripperOutcome::kSucceeded : GripperOutcome::kFailed, gripper.outcome(ticket));
  run(2000);
  EXPECT_EQ(holds ? GripperState::kHolding : GripperState::kIdle, gripper.state());
  EXPECT_EQ(holds, gripper.isGrasped());
  const double expected = holds ? 0.5 * row.force : 0.0;
  for (const double force : hand.padForce()) {
    // Friction beside the center takes a part.
    EXPECT_NEAR(expected, force, row.beside == 0.0 ? 0.05 * row.force : hand.object.friction);
  }
  EXPECT_NEAR(row.end, gripper.width(), 1e-3);
  EXPECT_NEAR(0.0, hand.object.position, holds ? 1e-3 : 0.02) << "the fingers center an object";
  hand.has_object = false;
  const GripperUnit::Ticket open = gripper.move(0.08, 0.1);
  finish(open);
  EXPECT_EQ(GripperOutcome::kSucceeded, gripper.outcome(open));
  EXPECT_NEAR(0.08, gripper.width(), 1e-3);
}

constexpr GraspRow kGrasps[] = {
    {"Gently", 0.025, 0.06, 0.025, 0.025, 0.005, 0.005, 1.0},
    {"Strongly", 0.025, 0.06, 0.025, 0.025, 0.005, 0.005, 40.0},
    {"Nothing", 0.0, 0.06, 0.025, 0.0},
    {"TooWide", 0.035, 0.06, 0.025, 0.035},
    {"TooNarrow", 0.015, 0.06, 0.025, 0.015},
    {"WithinAWideOuterEpsilon", 0.035, 0.06, 0.025, 0.035, 0.005, 0.011},
    {"WithinAWideInnerEpsilon", 0.015, 0.06, 0.025, 0.015, 0.011, 0.005},
    {"WithinTheOuterEpsilon", 0.029, 0.06, 0.025, 0.029},
    {"WithinTheInnerEpsilon", 0.021, 0.06, 0.025, 0.021},
    {"LightFingers", 0.025, 0.06, 0.025, 0.025, 0.005, 0.005, 5.0, 0.015},
    {"HeavyFingers", 0.025, 0.06, 0.025, 0.025, 0.005, 0.005, 5.0, 0.3},
    {"LightUncoupledFingers", 0.025, 0.06, 0.025, 0.025, 0.005, 0.005, 5.0, 0.015, 0.0},
    {"HeavyUncoupledFingers", 0.025, 0.06, 0.025, 0.025, 0.005, 0.005, 5.0, 0.3, 0.0},
    {"BesideTheCenter", 0.025, 0.07, 0.025, 0.025, 0.005, 0.005, 5.0, 0.115, 20000.0, 0.01},
    {"OnTheOtherSide", 0.025, 0.07, 0.025, 0.025, 0.005, 0.005, 5.0, 0.115, 20000.0, -0.01},
    {"FromInside", 0.06, 0.02, 0.06, 0.06, 0.005, 0.005, 5.0, 0.115, 20000.0, 0.0, true},
    {"NothingFromInside", 0.0, 0.02, 0.06, 0.08},
};
INSTANTIATE_TEST_SUITE_P(Rows, Grasp, ::testing::ValuesIn(kGrasps),
                         [](const auto& row) { return row.param.name; });

TEST_F(GripperTest, GraspDoesNotThrowTheObject) {
  putStone(0.025, 0.01);
  hand.object.friction = 0.01;
  startAt(0.07);
  const GripperUnit::Ticket ticket = graspTheStone();
  double furthest = 0.01;
  while (gripper.outcome(ticket) == GripperOutcome::kRunning) {
    tick();
    furthest = std::min(furthest, hand.object.position);
  }
  EXPECT_EQ(GripperOutcome::kSucceeded, gripper.outcome(ticket));
  EXPECT_GT(furthest, -0.005);
}

TEST_F(GripperTest, GraspingAHeldObjectAgainKeepsHolding) {
  openAroundTheStone();
  finish(graspTheStone());
  const GripperUnit::Ticket again = gripper.grasp(0.0251, 0.005, 0.005, 0.1, 10);
  widest = 0.0;
  finish(again);
  EXPECT_EQ(GripperOutcome::kSucceeded, gripper.outcome(again));
  EXPECT_LT(widest, 0.0252);
  run(500);
  EXPECT_NEAR(5.0, hand.padForce()[0], 0.25);
}

TEST_F(GripperTest, LosingTheObjectIsReportedAndClosesTheFingers) {
  openAroundTheStone();
  finish(graspTheStone());
  ASSERT_TRUE(gripper.isGrasped());
  hand.has_object = false;
  run(1000);
  EXPECT_FALSE(gripper.isGrasped());
  EXPECT_EQ(GripperState::kHolding, gripper.state());
  EXPECT_NEAR(0.0, gripper.width(), 1e-3);
}

TEST_F(GripperTest, StopReleasesAGraspWithoutMotion) {
  openAroundTheStone();
  finish(graspTheStone());
  const GripperUnit::Ticket stop = gripper.stop();
  EXPECT_EQ(GripperOutcome::kSucceeded, gripper.outcome(stop));
  EXPECT_EQ(GripperState::kIdle, gripper.state());
  EXPECT_FALSE(gripper.isGrasped());
  run(1000);
  EXPECT_LT(hand.padForce()[0], 0.05);
  EXPECT_NEAR(0.025, gripper.width(), 1e-3);
}

TEST_F(GripperTest, StopDuringAMoveHoldsTheWidth) {
  startAt(0.08);
  for (const bool grasping : {false, true}) {
    const GripperUnit::Ticket ticket =
        grasping ? gripper.grasp(0.01, 0.005, 0.005, 0.1, 5) : gripper.move(0.0, 0.1);
    run(300);
    const double width = gripper.width();
    gripper.stop();
    EXPECT_EQ(GripperOutcome::kInterrupted, gripper.outcome(ticket));
    run(2000);
    EXPECT_NEAR(width, gripper.width(), 2e-3);
    EXPECT_NEAR(0.0, hand.speed(), 1e-4);
  }
}

TEST_F(GripperTest, HomingClosesAndOpensFully) {
  startAt(0.05);
  const GripperUnit::Ticket ticket = gripper.homing();
  const double time = finish(ticket);
  EXPECT_EQ(GripperOutcome::kSucceeded, gripper.outcome(ticket));
  EXPECT_LT(narrowest, 1e-3);
  EXPECT_NEAR(0.08, gripper.width(), 1e-3);
  EXPECT_NEAR((0.05 + 0.08) / 0.02, time, 0.5);
}

TEST_F(GripperTest, IsHomedAfterAHomingThatSucceeds) {
  EXPECT_TRUE(gripper.isHomed());
  gripper.invalidateHoming();
  EXPECT_EQ(0U, gripper.move(0.02, 0.1));
  EXPECT_EQ(0U, gripper.grasp(0.02, 0.1, 0.1, 0.1, 10.0));
  const GripperUnit::Ticket interrupted = gripper.homing();
  run(4500);
  gripper.stop();
  EXPECT_EQ(GripperOutcome::kInterrupted, gripper.outcome(interrupted));
  EXPECT_FALSE(gripper.isHomed());
  finish(gripper.homing());
  EXPECT_TRUE(gripper.isHomed());
  finish(gripper.move(0.02, 0.1));
  gripper.restart();
  EXPECT_TRUE(gripper.isHomed()) << "a reset of the world does not switch the hand off";
}

TEST_F(GripperTest, HomingFailsOnAnObstacle) {
  putStone();
  hand.object.movable = false;
  startAt(0.05);
  const GripperUnit::Ticket ticket = gripper.homing();
  EXPECT_LT(finish(ticket), 2.0);
  EXPECT_EQ(GripperOutcome::kFailed, gripper.outcome(ticket));
}

TEST_F(GripperTest, InvalidCommandsAreRefusedAndInterruptNothing) {
  startAt(0.08);
  const GripperUnit::Ticket running = gripper.move(0.02, 0.05);
  run(50);
  for (const double bad : {kNan, kInfinity, -kInfinity, -0.001}) {
    EXPECT_EQ(0u, gripper.move(bad, 0.1));
    EXPECT_EQ(0u, gripper.move(0.05, bad));
    EXPECT_EQ(0u, gripper.grasp(bad, 0.005, 0.005, 0.1, 5));
    EXPECT_EQ(0u, gripper.grasp(0.02, 0.005, 0.005, bad, 5));
    EXPECT_EQ(0u, gripper.grasp(0.02, 0.005, 0.005, 0.1, bad));
  }
  EXPECT_EQ(0u, gripper.move(0.0801, 0.1));
  EXPECT_EQ(0u, gripper.grasp(0.0801, 0.005, 0.005, 0.1, 5));
  EXPECT_EQ(0u, gripper.grasp(0.02, kNan, 0.005, 0.1, 5));
  EXPECT_EQ(0u, gripper.grasp(0.02, 0.005, kInfinity, 0.1, 5));
  EXPECT_EQ(GripperOutcome::kFailed, gripper.outcome(0));
  EXPECT_EQ(GripperOutcome::kRunning, gripper.outcome(running));
  finish(running);
  EXPECT_EQ(GripperOutcome::kSucceeded, gripper.outcome(running));
}

TEST_F(GripperTest, CommandBeforeTheFirstStepStartsFromTheMeasuredWidth) {
  hand.put(0.08);
  putStone();
  const GripperUnit::Ticket ticket = graspTheStone();
  finish(ticket);
  EXPECT_EQ(GripperOutcome::kSucceeded, gripper.outcome(ticket));
}

TEST_F(GripperTest, SpeedsAndForcesSaturateAtTheHandsLimits) {
  putStone();
  startAt(0.08);
  const GripperUnit::Ticket ticket = gripper.grasp(0.025, 0.005, 0.005, 1e9, 1e9);
  double fastest = 0.0;
  while (gripper.outcome(ticket) == GripperOutcome::kRunning && gripper.width() > 0.03) {
    tick();
    fastest = std::max(fastest, std::abs(hand.speed()));
  }
  EXPECT_LT(fastest, 0.11);
  finish(ticket);
  run(500);
  EXPECT_NEAR(70, hand.padForce()[0], 1.0);
}

TEST_F(GripperTest, RestartIdlesAtTheNewWidth) {
  startAt(0.08);
  const GripperUnit::Ticket ticket = gripper.move(0.0, 0.1);
  run(100);
  hand.put(0.03);
  gripper.restart();
  EXPECT_EQ(GripperOutcome::kInterrupted, gripper.outcome(ticket));
  run(1000);
  EXPECT_EQ(GripperState::kIdle, gripper.state());
  EXPECT_NEAR(0.03, gripper.width(), 1e-6);
}

TEST_F(GripperTest, NonFiniteMeasurementsGiveNoForceAndAreIgnored) {
  const GripperUnit::Ticket ticket = gripper.move(0.08, 0.1);
  run(100);
  HandMeasurement bad = hand.measure();
  bad.q[1] = kNan;
  EXPECT_EQ((std::array<double, 2>{}), gripper.step(bad, 1e-3));
  EXPECT_EQ((std::array<double, 2>{}), gripper.step(hand.measure(), kNan));
  finish(ticket);
  EXPECT_EQ(GripperOutcome::kSucceeded, gripper.outcome(ticket));
}

TEST(GripperParameters, InvalidOnesAreRefusedByName) {
  const std::pair<const char*, std::function<void(GripperParameters&)>> rows[] = {
      {"finger2/gains", [](auto& p) { p.gains[1].p = -1; }},
      {"max_width", [](auto& p) { p.max_width = 0; }},
      {"move/width_tolerance", [](auto& p) { p.move_tolerance = kNan; }},
      {"grasp/resting_threshold", [](auto& p) { p.resting_threshold = -1; }},
      {"grasp/consecutive_samples", [](auto& p) { p.consecutive_samples = 0; }},
      {"homing_speed", [](auto& p) { p.homing_speed = 0; }},
      {"max_speed", [](auto& p) { p.max_speed = kNan; }},
      {"max_force", [](auto& p) { p.max_force = -1; }},
      {"latency", [](auto& p) { p.latency.start = -1; }},
      {"temperature_time", [](auto& p) { p.temperature_time = 0; }}};
  for (const auto& [name, change] : rows) {
    GripperParameters parameters;
    change(parameters);
    try {
      GripperUnit gripper(parameters);
      ADD_FAILURE() << name << " was accepted";
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string::npos, std::string(error.what()).find(name)) << error.what();
    }
  }
}

}  // namespace

}  // namespace franka_sim::test

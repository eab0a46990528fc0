// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// The control loops: every mode, the order of callbacks, filters, limits, and bad values.
#include <franka/active_control_base.h>
#include <franka/control_tools.h>
#include <franka/rate_limiting.h>

#include <cmath>
#include <cstdlib>
#include <franka/logging/logger.hpp>
#include <limits>

#include "franka/arm_rate_limits.h"
#include "robot_fixture.h"

namespace franka_test {
namespace {

using franka::CartesianPose;
using franka::CartesianVelocities;
using franka::ControllerMode;
using franka::Duration;
using franka::JointPositions;
using franka::JointVelocities;
using franka::kMaxCutoffFrequency;
using franka::RobotState;
using franka::Torques;
using franka_core::MotionGeneratorMode;

constexpr std::array<double, 2> kElbow{0.25, -1.0};

template <typename Value>
using Callback = std::function<Value(const RobotState&, Duration)>;

/// Returns the same value for some cycles.
template <typename Value>
std::function<Value(const RobotState&, Duration)> constant(Value value, int cycles = 5) {
  auto left = std::make_shared<int>(cycles);
  return [value, left](const RobotState&, Duration) {
    return --*left <= 0 ? franka::MotionFinished(value) : value;
  };
}

using Modes = EveryVersion;

/// Compares the commands at the robot, without filter and limits.
template <typename Value>
void expectUnchanged(FakeRobot& fake, franka::Robot& robot, const Value& value,
                     MotionGeneratorMode generator,
                     const std::function<bool(const franka_core::RobotCommand&)>& arrives) {
  for (auto mode : {ControllerMode::kJointImpedance, ControllerMode::kCartesianImpedance}) {
    robot.control(constant(value), mode, false, kMaxCutoffFrequency);
    const auto move = std::get<franka_core::fci::MoveRequest>(fake.requests().back());
    EXPECT_EQ(generator, move.motion_generator_mode);
    EXPECT_EQ(static_cast<int>(mode), static_cast<int>(move.controller_mode));
    EXPECT_EQ(10.0, move.max_path_deviation.translation);
    ASSERT_EQ(5u, fake.exchanges().size());
    for (const auto& exchange : fake.exchanges()) {
      EXPECT_TRUE(arrives(exchange.command));
      EXPECT_EQ((std::array<double, 7>{}), exchange.command.tau_J_d);
    }
    EXPECT_TRUE(fake.exchanges().back().command.motion_generation_finished);
  }
  // The same with torques.
  robot.control(constant(Torques(kTorques), 100), constant(value), false, kMaxCutoffFrequency);
  const auto move = std::get<franka_core::fci::MoveRequest>(fake.requests().back());
  EXPECT_EQ(generator, move.motion_generator_mode);
  EXPECT_EQ(franka_core::ControllerMode::kExternalController, move.controller_mode);
  ASSERT_EQ(5u, fake.exchanges().size());
  for (const auto& exchange : fake.exchanges()) {
    EXPECT_TRUE(arrives(exchange.command));
    EXPECT_EQ(kTorques, exchange.command.tau_J_d);
    EXPECT_FALSE(exchange.command.torque_command_finished);
  }
  EXPECT_TRUE(fake.exchanges().back().command.motion_generation_finished);
}

TEST_P(Modes, TransmitTheirValues) {
  const auto robot = connect(fake);
  expectUnchanged(fake, *robot, JointPositions(kJoints), MotionGeneratorMode::kJointPosition,
                  [](const auto& c) { return c.q_c == kJoints && !c.valid_elbow; });
  expectUnchanged(fake, *robot, JointVelocities(kJoints), MotionGeneratorMode::kJointVelocity,
                  [](const auto& c) { return c.dq_c == kJoints && !c.valid_elbow; });
  expectUnchanged(fake, *robot, CartesianPose(kPose), MotionGeneratorMode::kCartesianPosition,
                  [](const auto& c) { return c.O_T_EE_c == kPose && !c.valid_elbow; });
  expectUnchanged(
      fake, *robot, CartesianPose(kPose, kElbow), MotionGeneratorMode::kCartesianPosition,
      [](const auto& c) { return c.O_T_EE_c == kPose && c.valid_elbow && c.elbow_c == kElbow; });
  expectUnchanged(fake, *robot, CartesianVelocities(kTwist),
                  MotionGeneratorMode::kCartesianVelocity,
                  [](const auto& c) { return c.O_dP_EE_c == kTwist && !c.valid_elbow; });
  expectUnchanged(
      fake, *robot, CartesianVelocities(kTwist, kElbow), MotionGeneratorMode::kCartesianVelocity,
      [](const auto& c) { return c.O_dP_EE_c == kTwist && c.valid_elbow && c.elbow_c == kElbow; });
  robot->control(constant(Torques(kTorques)), false, kMaxCutoffFrequency);
  EXPECT_EQ(kTorques, fake.exchanges().front().command.tau_J_d);
}

INSTANTIATE_TEST_SUITE_P(All, Modes, ::testing::ValuesIn(kVersions), versionName);

class Loop : public ::testing::Test {
 protected:
  FakeRobot fake{5};
  std::unique_ptr<franka::Robot> robot{connect(fake)};
};

// y' = g y + (1 - g) y_last with g = T / (T + 1 / (2 pi f)), against the answered state.
double filtered(double value, double last, double frequency) {
  const double gain = 1e-3 / (1e-3 + 1.0 / (2.0 * M_PI * frequency));
  return gain * value + (1.0 - gain) * last;
}

TEST_F(Loop, FiltersAgainstTheAnsweredState) {
  robot->control(constant(JointPositions(kJoints), 50), ControllerMode::kJointImpedance, false);
  for (const auto& exchange : fake.exchanges()) {
    for (std::size_t i = 0; i < 7; i++) {
      EXPECT_NEAR(filtered(kJoints[i], exchange.state.q_d[i], 100.0), exchange.command.q_c[i],
                  1e-15);
    }
  }
  robot->control(constant(Torques(kTorques), 50), constant(JointVelocities(kJoints), 50), false,
                 20.0);
  auto exchanges = fake.exchanges();
  // The value that ends the motion is sent with the torques of the cycle before.
  EXPECT_EQ(exchanges[48].command.tau_J_d, exchanges[49].command.tau_J_d);
  exchanges.pop_back();
  for (const auto& exchange : exchanges) {
    for (std::size_t i = 0; i < 7; i++) {
      EXPECT_NEAR(filtered(kJoints[i], exchange.state.dq_d[i], 20.0), exchange.command.dq_c[i],
                  1e-15);
      EXPECT_NEAR(filtered(kTorques[i], exchange.state.tau_J_d[i], 20.0),
                  exchange.command.tau_J_d[i], 1e-15);
    }
  }
  robot->control(constant(CartesianVelocities(kTwist, kElbow), 50), ControllerMode::kJointImpedance,
                 false);
  for (const auto& exchange : fake.exchanges()) {
    EXPECT_NEAR(filtered(kElbow[0], exchange.state.elbow_c[0], 100.0), exchange.command.elbow_c[0],
                1e-15);
    EXPECT_NEAR(filtered(kTwist[5], exchange.state.O_dP_EE_c[5], 100.0),
                exchange.command.O_dP_EE_c[5], 1e-15);
  }
}

/// The states of a motion and the commands to them, limited but not filtered.
template <typename Value>
std::vector<FakeRobot::Exchange> runLimited(FakeRobot& fake, franka::Robot& robot,
                                            const Value& value) {
  robot.control(constant(value, 50), ControllerMode::kJointImpedance, true, kMaxCutoffFrequency);
  return fake.exchanges();
}

/// Which values the limiter lets pass is tested without a robot: arm_rate_limits_test.cpp.
using Limited = EveryVersion;

TEST_P(Limited, ValuesPassTheLimiterOfTheConnectedRobot) {
  const auto robot = connect(fake);
  const franka::ArmRateLimits limits = franka::rateLimitsOfProtocol(GetParam());
  const auto& [v, a, j] = limits.translation;
  const auto& [w, dw, ddw] = limits.rotation;
  const auto limitElbow = [&limits](const franka_core::RobotState& state) {
    const auto& [velocity, acceleration, jerk] = limits.elbow;
    return franka::limitRate(velocity, acceleration, jerk, kElbow[0], state.elbow_c[0],
                             state.delbow_c[0], state.ddelbow_c[0]);
  };
  for (const auto& [state, command] : runLimited(fake, *robot, JointPositions(kJoints))) {
    EXPECT_NE(kJoints, command.q_c);
    EXPECT_EQ(limits.limitPositions(kJoints, state.q_d, state.dq_d, state.ddq_d), command.q_c);
  }
  constexpr std::array<double, 7> kFast{4, -4, 4, -4, 4, -4, 4};
  for (const auto& [state, command] : runLimited(fake, *robot, JointVelocities(kFast))) {
    EXPECT_NE(kFast, command.dq_c);
    EXPECT_EQ(limits.limitVelocities(state.q_d, kFast, state.dq_d, state.ddq_d), command.dq_c);
  }
  for (const auto& [state, command] : runLimited(fake, *robot, CartesianPose(kPose, kElbow))) {
    EXPECT_NE(kPose, command.O_T_EE_c);
    EXPECT_EQ(franka::limitRate(v, a, j, w, dw, ddw, kPose, state.O_T_EE_c, state.O_dP_EE_c,
                                state.O_ddP_EE_c),
              command.O_T_EE_c);
    EXPECT_EQ(limitElbow(state), command.elbow_c[0]);
  }
  constexpr std::array<double, 6> kFastTwist{3, -3, 3, -3, 3, -3};
  for (const auto& [state, command] :
       runLimited(fake, *robot, CartesianVelocities(kFastTwist, kElbow))) {
    EXPECT_NE(kFastTwist, command.O_dP_EE_c);
    EXPECT_EQ(franka::limitRate(v, a, j, w, dw, ddw, kFastTwist, state.O_dP_EE_c, state.O_ddP_EE_c),
              command.O_dP_EE_c);
    EXPECT_EQ(limitElbow(state), command.elbow_c[0]);
  }
  robot->control(constant(Torques(kTorques), 3), true, kMaxCutoffFrequency);
  for (const auto& [state, command] : fake.exchanges()) {
    EXPECT_EQ(franka::limitRate(limits.torque_rate, kTorques, state.tau_J_d), command.tau_J_d);
  }
}

// States of version 10 are in single precision; the fake robot's own are not.
INSTANTIATE_TEST_SUITE_P(DoublePrecision, Limited, ::testing::Values(3, 5, 6, 9), versionName);

TEST_F(Loop, CallsTheMotionFirstByDefault) {
  for (bool control_first : {false, true}) {
    franka::ControlOptions options;
    if (control_first) {
      options.callback_order = franka::CallbackOrder::kControlFirst;
    }
    robot->setControlOptions(options);
    std::string order;
    robot->control(
        [&](const RobotState&, Duration) {
          order += 'c';
          return Torques(kTorques);
        },
        [&](const RobotState& state, Duration) {
          order += 'm';
          const JointPositions q(state.q_d);
          return order.size() >= 7 ? franka::MotionFinished(q) : q;
        });
    // The torques sent with the last value are those of the cycle before.
    EXPECT_EQ(control_first ? "cmcmcmcm" : "mcmcmcm", order);
  }
}

TEST_F(Loop, TorqueCallbackMayEndTheMotion) {
  robot->control(constant(Torques(kTorques), 4),
                 constant(JointVelocities({0, 0, 0, 0, 0, 0, 0}), 100));
  EXPECT_EQ(4u, fake.exchanges().size());
  EXPECT_TRUE(fake.exchanges().back().command.motion_generation_finished);
}

TEST_F(Loop, FirstValueMayBeItsOwnReference) {
  const std::array<double, 7> start = fake.state().q_d;
  std::array<double, 7> q = start;
  q[0] += 1e-4;
  robot->control(constant(JointPositions(q), 3));
  EXPECT_GT(q[0] - fake.exchanges()[0].command.q_c[0], 5e-5);
  fake.change([&](auto& s) { s.q_d = start; });
  franka::ControlOptions options;
  options.first_cycle_reference = franka::FirstCycleReference::kCommand;
  robot->setControlOptions(options);
  robot->control(constant(JointPositions(q), 3));
  EXPECT_NEAR(q[0], fake.exchanges()[0].command.q_c[0], 1e-15);
  robot->control(constant(CartesianPose(kPose), 3));
  for (std::size_t i = 0; i < 16; i++) {
    EXPECT_NEAR(kPose[i], fake.exchanges()[0].command.O_T_EE_c[i], 1e-12);
  }
}

TEST_F(Loop, InvalidValuesStopTheRobot) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  const std::function<void()> bad[] = {
      [&] { robot->control(constant(Torques({0, 0, nan, 0, 0, 0, 0}))); },
      [&] { robot->control(constant(JointPositions({0, 0, 0, inf, 0, 0, 0}))); },
      [&] { robot->control(constant(JointVelocities({0, 0, 0, 0, -inf, 0, 0}))); },
      [&] { robot->control(constant(CartesianVelocities({0, nan, 0, 0, 0, 0}))); },
      [&] { robot->control(constant(CartesianVelocities({0, 0, 0, 0, 0, 0}, {0.1, 0.5}))); },
      [&] { robot->control(constant(CartesianVelocities({0, 0, 0, 0, 0, 0}, {nan, 1.0}))); },
      [&] { robot->control(constant(CartesianPose(kPose, {0.1, 0.0}))); },
      [&] {
        robot->control(constant(CartesianPose(std::array<double, 16>{})),
                       ControllerMode::kJointImpedance, false, kMaxCutoffFrequency);
      },
  };
  int stops = 0;
  for (const auto& command : bad) {
    EXPECT_TRUE(startsWith(textOf<std::invalid_argument>(command), "libfranka"));
    EXPECT_EQ(++stops, fake.count(Command::kStopMove));
    EXPECT_TRUE(fake.exchanges().empty());
  }
}

TEST_F(Loop, InvalidSettingsDoNotStartAMotion) {
  using ControlCallback = std::function<Torques(const RobotState&, Duration)>;
  using MotionCallback = std::function<JointPositions(const RobotState&, Duration)>;
  const auto torques = constant(Torques(kTorques));
  const auto positions = constant(JointPositions(kJoints));
  EXPECT_THROW(robot->control(ControlCallback()), std::invalid_argument);
  EXPECT_THROW(robot->control(MotionCallback()), std::invalid_argument);
  EXPECT_THROW(robot->control(ControlCallback(), positions), std::invalid_argument);
  EXPECT_THROW(robot->control(torques, MotionCallback()), std::invalid_argument);
  EXPECT_THROW(robot->control(torques, true, 0.0), std::invalid_argument);
  EXPECT_THROW(robot->control(torques, true, std::nan("")), std::invalid_argument);
  EXPECT_THROW(robot->control(positions, static_cast<ControllerMode>(7)), std::invalid_argument);
  EXPECT_EQ(0, fake.count(Command::kMove));
}

// A busy robot is reported before other errors of a call. Settings are the robot's responsibility.
TEST_F(Loop, BusyRobotIsReportedFirst) {
  const Callback<Torques> no_torques;
  const Callback<JointPositions> no_positions;
  const auto no_mode = static_cast<ControllerMode>(7);
  using ActiveMode = research_interface::robot::Move::ControllerMode;
  const auto no_active_mode = static_cast<ActiveMode>(7);
  const auto torques = constant(Torques(kTorques));
  const std::vector<std::function<void()>> wrong{
      [&] { robot->control(no_torques); },
      [&] { robot->control(torques, true, -1.0); },
      [&] { robot->control(no_torques, no_positions); },
      [&] { robot->control(no_positions, no_mode); },
      [&] { robot->read(nullptr); },
      [&] { robot->readOnce(); },
      [&] { robot->control(torques); },
      [&] { robot->startTorqueControl(); },
      [&] { robot->startJointPositionControl(no_active_mode); },
      [&] { robot->startAsyncJointPositionControl(no_active_mode, std::nullopt); },
  };
  const auto motion = robot->startTorqueControl();
  for (std::size_t i = 0; i < wrong.size(); i++) {
    EXPECT_THROW(wrong[i](), franka::InvalidOperationException) << i;
  }
  EXPECT_NO_THROW(robot->setJointImpedance({}));
}

/// Sets an environment variable for its lifetime; null: not set.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    if (value != nullptr) {
      setenv(name, value, 1);
    } else {
      unsetenv(name);
    }
  }
  ~Variable() { unsetenv(name_); }

 private:
  const char* name_;
};

/// A motion with callbacks and one driven by the program, of a robot on a loopback address.
class SimulatedRobot {
 public:
  void move() { robot_.control(constant(Torques(kTorques))); }
  void drive() { robot_.startTorqueControl()->readOnce(); }
  int motions() { return fake_.count(Command::kMove); }
  void readOnce() { robot_.readOnce(); }

 private:
  FakeRobot fake_{5};
  franka::Robot robot_{fake_.address(), franka::RealtimeConfig::kEnforce};
};

/// Collects the library's warnings instead of printing them.
class Warnings : public franka::LoggingSinkInterface {
 public:
  std::string getName() const override { return "Warnings"; }
  void logInfo(const std::string&) override {}
  void logWarn(const std::string& message) override { texts.push_back(message); }
  void logError(const std::string&) override {}
  std::vector<std::string> texts;
};

class LoopRealtime : public ::testing::Test {
 protected:
  LoopRealtime() { franka::logging::addLogger(warnings_); }
  ~LoopRealtime() override { franka::logging::removeAllLoggers(); }

  const std::shared_ptr<Warnings> warnings_ = std::make_shared<Warnings>();
};

TEST_F(LoopRealtime, SimulatedRobotsNeedNoRealtimeKernelAndWarnOnce) {
  // On a kernel with real-time support the variable stands for one without.
  const bool has_realtime = franka::hasRealtimeKernel();
  const Variable variable("FRANKA_REALTIME", has_realtime ? "ignore" : nullptr);
  SimulatedRobot robot;
  robot.readOnce();
  EXPECT_TRUE(warnings_->texts.empty()) << "reading needs none";
  robot.move();
  robot.drive();
  robot.move();
  EXPECT_EQ(3, robot.motions());
  ASSERT_EQ(has_realtime ? 0u : 1u, warnings_->texts.size());
  EXPECT_TRUE(has_realtime ||
              startsWith(warnings_->texts[0],
                         "libfranka: The running kernel has no real-time support. The robot is on "
                         "a loopback address"));
}

TEST_F(LoopRealtime, UnknownRulesAreRefusedBeforeTheMotion) {
  const Variable variable("FRANKA_REALTIME", "perhaps");
  SimulatedRobot robot;
  EXPECT_THROW(robot.move(), franka::RealtimeException);
  EXPECT_EQ(0, robot.motions());
}

// The thread gets real-time priority where the kernel has real-time support.
using LoopRealtimeOnWallClock = LoopRealtime;

TEST_F(LoopRealtimeOnWallClock, EnvironmentVariableEnforcesIt) {
  const Variable variable("FRANKA_REALTIME", "enforce");
  SimulatedRobot robot;
  if (franka::hasRealtimeKernel() && franka::setCurrentThreadToHighestSchedulerPriority(nullptr)) {
    robot.move();
    EXPECT_EQ(1, robot.motions());
  } else {
    const std::string refusal =
        franka::hasRealtimeKernel()
            ? "libfranka: The thread cannot be given realtime priority"
            : "libfranka: Running kernel does not have realtime capabilities.";
    EXPECT_TRUE(startsWith(textOf<franka::RealtimeException>([&] { robot.move(); }), refusal));
    EXPECT_TRUE(startsWith(textOf<franka::RealtimeException>([&] { robot.drive(); }), refusal));
    EXPECT_EQ(0, robot.motions());
  }
  EXPECT_TRUE(warnings_->texts.empty());
  // Reading has no requirement.
  EXPECT_NO_THROW(robot.readOnce());
}

TEST(LoopWait, AnyModeGivesTheSameMotion) {
  for (const char* mode : {"auto", "spin", "block", ""}) {
    const Variable variable("FRANKA_WAIT", mode);
    FakeRobot fake(5);
    const auto robot = connect(fake);
    int count = 0;
    robot->control([&](const RobotState&, Duration) {
      return ++count < 100 ? Torques(kTorques) : franka::MotionFinished(Torques(kTorques));
    });
    EXPECT_EQ(100, count) << mode;
  }
}

TEST(LoopWait, UnknownModesAreRefusedBeforeThereIsARobot) {
  const Variable variable("FRANKA_WAIT", "sleep");
  FakeRobot fake(5);
  EXPECT_THROW(connect(fake), franka::InvalidOperationException);
}

TEST(LoopLog, MayBeEmpty) {
  FakeRobot fake(5);
  fake.script([](FakeRobot::Script& s) { s.abort_after = 10; });
  for (std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{100}}) {
    const auto robot = connect(fake, size);
    try {
      robot->control(constant(Torques(kTorques), 100));
      FAIL() << "no exception";
    } catch (const franka::ControlException& error) {
      EXPECT_EQ(std::min<std::size_t>(size, 11), error.log.size() > 11 ? 11 : error.log.size());
      EXPECT_EQ(size > 1, std::string(error.what()).find("control_command_success_rate") !=
                              std::string::npos);
    }
    fake.change([](auto& s) { s.robot_mode = franka_core::RobotMode::kIdle; });
  }
}

// Record i holds the command that was sent just before state i.
TEST(LoopLog, PairsEachStateWithTheCommandBeforeIt) {
  FakeRobot fake(5);
  fake.script([](FakeRobot::Script& s) { s.abort_after = 40; });
  const auto robot = connect(fake, 10);
  double torque = 0.0;
  try {
    robot->control(
        [&](const RobotState&, Duration) {
          torque += 0.5;
          return Torques({torque, 0, 0, 0, 0, 0, 0});
        },
        false, kMaxCutoffFrequency);
    FAIL() << "no exception";
  } catch (const franka::ControlException& error) {
    ASSERT_EQ(10u, error.log.size());
    for (std::size_t i = 0; i < 9; i++) {
      EXPECT_EQ(error.log[i].command.torques.tau_J[0], error.log[i].state.tau_J_d[0]);
    }
    EXPECT_EQ(20.0, error.log[9].command.torques.tau_J[0]);
  }
}

}  // namespace
}  // namespace franka_test

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// The whole simulated robot over real sockets, stepped in lock-step and by the clock.
#include <franka_sim_mujoco/fci/host.h>
#include <franka_sim_mujoco/fci/sim_robot.h>
#include <franka_sim_mujoco/physics/world.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <fstream>
#include <random>
#include <sstream>
#include <thread>

#include "test_client.h"

namespace franka_sim_mujoco::fci {
namespace {

namespace codec = franka_core::fci;
using codec::Command;
using codec::Status;
using franka_core::ControllerMode;
using franka_core::MotionGeneratorMode;
using franka_core::RobotMode;
using franka_test::TestClient;

constexpr std::array<double, 7> kReady{0, -M_PI_4, 0, -3 * M_PI_4, 0, M_PI_2, M_PI_4};

std::string urdfText() {
  std::ifstream file(std::string(FRANKA_SIM_TEST_DATA) + "/panda_hand.urdf");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// A Panda on the network, in a thread of its own.
class Stage {
 public:
  explicit Stage(const Pace& pace) : host_([this] { world_.step(); }, pace) {
    const std::string urdf = urdfText();
    RobotDescription description;
    description.name = "panda";
    description.urdf = urdf;
    description.resolve = [](const std::string&) { return std::string(); };
    ControlUnitParameters unit{franka_core::ArmModel::fromUrdf(urdf, "panda")};
    for (std::size_t i = 0; i < 7; i++) {
      const std::string joint = "panda_joint" + std::to_string(i + 1);
      description.initial_positions[joint] = kReady[i];
      description.rotor_inertia[joint] = unit.rotor_inertia[i];
    }
    unit.end_effector = franka_core::endEffectorFromUrdf(urdf, "panda");
    behaveAsOverFci(unit, 5);
    world_.addRobot(description);
    RobotServerParameters server;
    server.port = 0;
    SimRobot::Hand hand{&world_.hand("panda", "panda"), {}, 0};
    hand.parameters.gains = {FingerGains{100, 0, 1}, FingerGains{100, 0, 1}};
    robot_ = std::make_unique<SimRobot>(unit, world_.arm("panda", "panda"), server, hand);
    host_.add(*robot_);
    thread_ = std::thread([this] { host_.run(stop_); });
  }
  ~Stage() { finish(); }
  void finish() {
    stop_ = true;
    if (thread_.joinable()) {
      thread_.join();
    }
  }

  std::uint16_t port() const { return robot_->server().port(); }
  /// Only after finish().
  std::uint64_t hash() const { return robot_->hash(); }
  std::uint64_t ticks() const { return host_.ticks(); }

 private:
  World world_;
  std::unique_ptr<SimRobot> robot_;
  Host host_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

Pace lockStep() {
  Pace pace;
  pace.lockstep = true;
  return pace;
}

void connect(TestClient& client, std::uint16_t version = 5) {
  client.connect(version);
  const auto answer = client.answer(Command::kConnect);
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->reply.status, Status::kSuccess);
}

/// Starts a motion and drives it as genuine clients do. @returns the last reply's status.
Status drive(TestClient& client, const codec::MoveRequest& request, int cycles,
             const std::function<void(int, const franka_core::RobotState& first,
                                      franka_core::RobotCommand&)>& fill) {
  client.request(request);
  auto answer = client.answer(Command::kMove);
  if (!answer || answer->reply.status != Status::kMotionStarted) {
    return answer ? answer->reply.status : Status::kError;
  }
  auto state = client.state();
  while (state && state->robot_mode != RobotMode::kMove) {
    state = client.state();
  }
  state = client.state();  // the second that shows the motion is the first to be answered
  if (!state) {
    return Status::kError;
  }
  const franka_core::RobotState first = *state;
  for (int cycle = 0; state && state->robot_mode == RobotMode::kMove; cycle++) {
    franka_core::RobotCommand command;
    command.message_id = state->message_id;
    fill(cycle, first, command);
    command.motion_generation_finished = cycle >= cycles;
    client.command(command);
    state = client.state();
  }
  answer = client.answer(Command::kMove);
  return answer ? answer->reply.status : Status::kError;
}

// Joint 4 out and back by 0.2 rad, at rest at both ends.
void swing(int cycle, const franka_core::RobotState& first, franka_core::RobotCommand& command) {
  constexpr int kCycles = 1500;
  const double x = std::min(cycle, kCycles) / static_cast<double>(kCycles);
  command.q_c = first.q_d;
  command.q_c[3] += 0.2 * std::pow(std::sin(M_PI * x), 4);
}

std::uint64_t hashOfARun(unsigned delays) {
  Stage stage(lockStep());
  TestClient client(stage.port());
  connect(client);
  std::mt19937 engine(delays);
  const Status end = drive(
      client, codec::MoveRequest{}, 1500,
      [&](int cycle, const franka_core::RobotState& first, franka_core::RobotCommand& command) {
        if (delays != 0 && engine() % 50 == 0) {
          std::this_thread::sleep_for(std::chrono::microseconds(engine() % 3000));
        }
        swing(cycle, first, command);
      });
  EXPECT_EQ(end, Status::kSuccess);
  // A setter's answer comes when the world has come to rest.
  client.request(codec::SetLoadRequest{});
  EXPECT_TRUE(client.answer(Command::kSetLoad));
  client.close();
  stage.finish();
  return stage.hash();
}

TEST(LockStep, repeatsBitForBitWhateverTheClientsPauses) {
  const std::uint64_t first = hashOfARun(0);
  for (unsigned delays = 1; delays <= 4; delays++) {
    EXPECT_EQ(hashOfARun(delays), first) << delays;
  }
}

TEST(LockStep, standsStillWhileNobodyMoves) {
  Stage stage(lockStep());
  TestClient client(stage.port());
  connect(client);
  const auto first = client.state();
  ASSERT_TRUE(first);
  for (int i = 0; i < 200; i++) {
    const auto next = client.state();
    ASSERT_TRUE(next);
    EXPECT_EQ(next->q, first->q);
  }
  stage.finish();
  // The arm came to rest after it was put there, and then time stood still.
  EXPECT_LT(stage.ticks(), 1500U);
}

TEST(LockStep, treatsASilentClientAsLost) {
  Pace pace = lockStep();
  pace.silence = std::chrono::milliseconds(50);
  Stage stage(pace);
  TestClient client(stage.port());
  connect(client);
  const auto begin = std::chrono::steady_clock::now();
  const codec::MoveRequest request;
  client.request(request);
  ASSERT_EQ(client.answer(Command::kMove)->reply.status, Status::kMotionStarted);
  auto state = client.state();
  while (state->robot_mode != RobotMode::kMove) {
    state = client.state();
  }
  for (int cycle = 0; cycle < 50; cycle++) {
    franka_core::RobotCommand command;
    command.message_id = state->message_id;
    command.q_c = state->q_d;
    client.command(command);
    state = client.state();
  }
  // From here on it says nothing.
  const auto end = client.answer(Command::kMove);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->reply.status, Status::kReflexAborted);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
  while (state && state->robot_mode != RobotMode::kReflex) {
    state = client.state();
  }
  ASSERT_TRUE(state);
  EXPECT_TRUE(state->errors[25]);  // communication_constraints_violation
}

TEST(LockStep, stopsAMotionOnDemand) {
  Stage stage(lockStep());
  TestClient client(stage.port());
  connect(client);
  bool asked = false;
  const Status end = drive(
      client, codec::MoveRequest{}, 100000,
      [&](int cycle, const franka_core::RobotState& first, franka_core::RobotCommand& command) {
        swing(cycle, first, command);
        if (cycle == 500 && !asked) {
          asked = true;
          client.request(codec::StopMoveRequest{});
        }
      });
  EXPECT_EQ(end, Status::kPreempted);
  const auto stopped = client.answer(Command::kStopMove);
  ASSERT_TRUE(stopped);
  EXPECT_EQ(stopped->reply.status, Status::kSuccess);
  // In every mode: also when there is nothing to stop.
  client.request(codec::StopMoveRequest{});
  EXPECT_TRUE(client.answer(Command::kStopMove));
}

TEST(RealTime, keepsToTheClock) {
  Stage stage(Pace{});
  TestClient client(stage.port());
  connect(client);
  const auto first = client.state();
  const auto begin = std::chrono::steady_clock::now();
  auto last = first;
  for (int i = 0; i < 300; i++) {
    last = client.state();
    ASSERT_TRUE(last);
  }
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
  EXPECT_EQ(last->message_id - first->message_id, 300U);
  EXPECT_GT(passed.count(), 0.25);
  EXPECT_LT(passed.count(), 2.0);  // on a machine that does much else
}

// On a machine that may stand still for longer than a robot does without commands.
TEST(RealTime, runsAMotionByTheClockForAPatientRobot) {
  Pace pace;
  pace.lockstep = pace.flows = pace.by_clock = true;
  pace.factor = 0.2;
  Stage stage(pace);
  TestClient client(stage.port());
  connect(client);
  const auto begin = std::chrono::steady_clock::now();
  const Status end = drive(
      client, codec::MoveRequest{}, 300,
      [](int cycle, const franka_core::RobotState& first, franka_core::RobotCommand& command) {
        command.q_c = first.q_d;
        command.q_c[3] += 0.02 * std::pow(std::sin(M_PI * std::min(cycle, 300) / 300.0), 4);
      });
  EXPECT_EQ(end, Status::kSuccess);
  EXPECT_GT(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(1400));
}

}  // namespace
}  // namespace franka_sim_mujoco::fci

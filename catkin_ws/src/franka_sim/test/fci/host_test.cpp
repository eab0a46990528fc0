// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// The whole simulated robot over real sockets, in lock-step.
#include <franka_sim/fci/host.h>
#include <franka_sim/fci/sim_robot.h>
#include <franka_sim/physics/physics_config.h>
#include <franka_sim/physics/world.h>
#include <ros_test/eventually.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <fstream>
#include <functional>
#include <future>
#include <mutex>
#include <random>
#include <sstream>
#include <thread>

#include "test_client.h"

namespace franka_sim::fci {
namespace {

namespace codec = franka_core::fci;
using codec::Command;
using codec::Status;
using franka_core::ControllerMode;
using franka_core::MotionGeneratorMode;
using franka_core::RobotMode;
using franka_test::TestClient;

std::string urdfText() {
  std::ifstream file(std::string(FRANKA_SIM_ROBOTS) + "/panda.urdf");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Runs jobs between two ticks.
class Jobs final : public Service {
 public:
  void serve() override {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (std::packaged_task<void()>& job : due_) {
      job();
    }
    due_.clear();
  }
  void addDescriptors(std::vector<pollfd>& /*fds*/) const override {}
  void run(std::function<void()> job) {
    std::packaged_task<void()> task(std::move(job));
    std::future<void> done = task.get_future();
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      due_.push_back(std::move(task));
    }
    done.get();
  }

 private:
  std::mutex mutex_;
  std::vector<std::packaged_task<void()>> due_;
};

/// A Panda on the network, in its own thread.
class Fixture {
 public:
  explicit Fixture(const Pace& pace) : host_([this] { world_.step(); }, pace) {
    const std::string urdf = urdfText();
    RobotDescription description;
    description.name = "panda";
    description.urdf = urdf;
    description.resolve = [](const std::string&) { return std::string(); };
    ControlUnitParameters unit{franka_core::ArmModel::fromUrdf(urdf, "panda")};
    startAt(kReadyPose, "panda", description);
    applyPhysics(RobotPhysics{}, "panda", description);
    unit.end_effector = franka_core::endEffectorFromUrdf(urdf, "panda");
    unit.rules = InterfaceRules::kFci;
    unit.protocol_version = 5;
    world_.addRobot(description);
    RobotServerParameters server;
    server.port = 0;
    SimRobot::Hand hand{&world_.hand("panda", "panda"), {}, 0};
    hand.parameters.gains = {FingerGains{100, 0, 1}, FingerGains{100, 0, 1}};
    robot_ = std::make_unique<SimRobot>(unit, world_.arm("panda", "panda"), server, hand);
    host_.add(*robot_);
    host_.add(jobs_);
    thread_ = std::thread([this] { host_.run(stop_); });
  }
  ~Fixture() { finish(); }
  void finish() {
    stop_ = true;
    if (thread_.joinable()) {
      thread_.join();
    }
  }

  std::uint16_t port() const { return robot_->server().port(); }
  std::uint16_t gripperPort() const { return robot_->gripperPort(); }
  /// Call only after finish().
  std::uint64_t hash() const { return robot_->hash(); }
  std::uint64_t ticks() const { return host_.ticks(); }

  /// Runs a job on the host's thread between two ticks and waits for it.
  void between(std::function<void(SimRobot&, World&, Host&)> job) {
    jobs_.run([&] { job(*robot_, world_, host_); });
  }
  double width() {
    double width = 0.0;
    between([&](SimRobot&, World& world, Host&) {
      const HandMeasurement hand = world.hand("panda", "panda").measure();
      width = hand.q[0] + hand.q[1];
    });
    return width;
  }

 private:
  World world_;
  std::unique_ptr<SimRobot> robot_;
  Host host_;
  Jobs jobs_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

Pace lockStep() {
  Pace pace;
  pace.mode = PaceMode::kLockStep;
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
  state = client.state();  // the second state that shows the motion is the first to be answered
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
  Fixture fixture(lockStep());
  TestClient client(fixture.port());
  connect(client);
  std::mt19937 engine(delays);
  const Status end = drive(
      client, codec::MoveRequest{}, 1500,
      [&](int cycle, const franka_core::RobotState& first, franka_core::RobotCommand& command) {
        if (delays != 0 && engine() % 50 == 0) {
          const std::chrono::microseconds pause(engine() % 3000);
          std::this_thread::sleep_for(pause);  // the fault itself
        }
        swing(cycle, first, command);
      });
  EXPECT_EQ(end, Status::kSuccess);
  // A setter is answered after the world has come to rest.
  client.request(codec::SetLoadRequest{});
  EXPECT_TRUE(client.answer(Command::kSetLoad));
  client.close();
  fixture.finish();
  return fixture.hash();
}

TEST(LockStep, RepeatsBitForBitForAnyPausesOfTheClient) {
  const std::uint64_t first = hashOfARun(0);
  for (unsigned delays = 1; delays <= 4; delays++) {
    EXPECT_EQ(hashOfARun(delays), first) << delays;
  }
}

TEST(LockStep, StandsStillWithoutAMotion) {
  Fixture fixture(lockStep());
  TestClient client(fixture.port());
  connect(client);
  const auto first = client.state();
  ASSERT_TRUE(first);
  for (int i = 0; i < 200; i++) {
    const auto next = client.state();
    ASSERT_TRUE(next);
    EXPECT_EQ(next->q, first->q);
  }
  fixture.finish();
  // The arm came to rest after the teleport, then time stood still.
  EXPECT_LT(fixture.ticks(), 1500U);
}

TEST(LockStep, TreatsASilentClientAsLost) {
  Pace pace = lockStep();
  pace.patience = std::chrono::milliseconds(50);
  Fixture fixture(pace);
  TestClient client(fixture.port());
  connect(client);
  client.request(codec::MoveRequest{});
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
  // From here on the client is silent.
  const auto end = client.answer(Command::kMove);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->reply.status, Status::kReflexAborted);
  while (state && state->robot_mode != RobotMode::kReflex) {
    state = client.state();
  }
  ASSERT_TRUE(state);
  EXPECT_TRUE(state->errors[25]);  // communication_constraints_violation
}

/// The first state in that mode; empty if there is none in time.
std::optional<franka_core::RobotState> stateIn(TestClient& client, RobotMode mode) {
  std::optional<franka_core::RobotState> state;
  const bool found = ros_test::eventually(
      [&] {
        state = client.state();
        return !state || state->robot_mode == mode;
      },
      std::chrono::microseconds(0));
  return found ? state : std::nullopt;
}

TEST(LockStep, AClientThatDiesBeforeItsFirstCommandEndsItsMotion) {
  Fixture fixture(lockStep());
  {
    TestClient client(fixture.port());
    connect(client);
    client.request(codec::MoveRequest{});
    ASSERT_EQ(client.answer(Command::kMove)->reply.status, Status::kMotionStarted);
  }
  TestClient next(fixture.port());
  connect(next);
  const auto state = stateIn(next, RobotMode::kReflex);
  ASSERT_TRUE(state) << "the robot is left in Move";
  EXPECT_TRUE(state->errors[25]);  // communication_constraints_violation
  next.request(codec::AutomaticErrorRecoveryRequest{});
  const auto recovered = next.answer(Command::kAutomaticErrorRecovery);
  ASSERT_TRUE(recovered);
  EXPECT_EQ(recovered->reply.status, Status::kSuccess);
}

TEST(LockStep, AnArmThatCoastsInGuidingDoesNotDeferRequests) {
  Fixture fixture(lockStep());
  TestClient client(fixture.port());
  connect(client);
  fixture.between([](SimRobot& robot, World& world, Host& host) {
    robot.unit().request(Guiding{true});
    world.push("panda_link5", {0, 8, 0}, {}, 100);
    host.runFree(100);
  });
  for (int i = 0; i < 3; i++) {
    client.request(codec::SetLoadRequest{});
    const auto answer = client.answer(Command::kSetLoad);
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->reply.status, Status::kSuccess);
  }
  double fastest = 0.0;
  std::uint64_t ticks = 0;
  fixture.between([&](SimRobot& robot, World&, Host& host) {
    for (const double dq : robot.unit().state().dq) {
      fastest = std::max(fastest, std::abs(dq));
    }
    ticks = host.ticks();
  });
  EXPECT_GT(fastest, 1e-3) << "the arm came to rest by itself: the test is void";
  const auto begin = client.state();
  ASSERT_TRUE(begin);
  for (int i = 0; i < 50; i++) {
    ASSERT_TRUE(client.state());
  }
  fixture.between([&](SimRobot&, World&, Host& host) { EXPECT_EQ(ticks, host.ticks()); });
}

TEST(LockStep, AHandFinishesItsCommandAfterItsClientDies) {
  namespace hand = franka_core::fci::gripper;
  Fixture fixture(lockStep());
  {
    TestClient client(fixture.gripperPort());
    hand::RequestMessage message;
    hand::encodeRequest(0, hand::ConnectRequest{3, client.udpPort()}, message);
    ASSERT_TRUE(client.sendBytes(message.data, message.size));
    hand::encodeRequest(1, hand::MoveRequest{0.06, 0.02}, message);
    ASSERT_TRUE(client.sendBytes(message.data, message.size));
    EXPECT_TRUE(ros_test::eventually([&] { return fixture.width() > 0.005; }));
  }
  EXPECT_TRUE(ros_test::eventually([&] { return std::abs(fixture.width() - 0.06) < 1e-3; }));
}

TEST(LockStep, StopsAMotionOnDemand) {
  Fixture fixture(lockStep());
  TestClient client(fixture.port());
  connect(client);
  bool requested = false;
  const Status end = drive(
      client, codec::MoveRequest{}, 100000,
      [&](int cycle, const franka_core::RobotState& first, franka_core::RobotCommand& command) {
        swing(cycle, first, command);
        if (cycle == 500 && !requested) {
          requested = true;
          client.request(codec::StopMoveRequest{});
        }
      });
  EXPECT_EQ(end, Status::kPreempted);
  const auto stopped = client.answer(Command::kStopMove);
  ASSERT_TRUE(stopped);
  EXPECT_EQ(stopped->reply.status, Status::kSuccess);
  // In every mode: also without a motion to stop.
  client.request(codec::StopMoveRequest{});
  EXPECT_TRUE(client.answer(Command::kStopMove));
}

}  // namespace
}  // namespace franka_sim::fci

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// The vacuum gripper alone, and through our own client.
#include <franka/exception.h>
#include <franka/vacuum_gripper.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <ros_test/eventually.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

#include "fci/hand_server.h"
#include "test_client.h"

namespace franka_sim {
namespace {

using namespace std::chrono_literals;

constexpr double kTick = 1e-3;

void run(VacuumGripperUnit& unit, int ticks) {
  for (int i = 0; i < ticks; i++) {
    unit.step(kTick);
  }
}

/// @returns milliseconds until the command has ended; 100000 if never.
int finish(VacuumGripperUnit& unit, VacuumGripperUnit::Ticket ticket) {
  for (int i = 0; i < 100000; i++) {
    if (unit.outcome(ticket) != GripperOutcome::kRunning) {
      return i;
    }
    unit.step(kTick);
  }
  return 100000;
}

TEST(VacuumGripperUnit, ReachesAVacuumAtTheTimeOfThePumpsLawAndHoldsIt) {
  const VacuumGripperParameters parameters;
  VacuumGripperUnit unit;
  unit.setPart(true);
  for (const double target : {100.0, 400.0, 700.0}) {
    unit.restart();
    const auto ticket = unit.vacuum(target, 5000);
    EXPECT_EQ(unit.power(), 100.0);
    EXPECT_FALSE(unit.inControlRange());
    const double time =
        -parameters.pump_time * std::log(1.0 - target / parameters.sealed_vacuum);  // closed form
    EXPECT_NEAR(finish(unit, ticket), 1e3 * time, 1.0);
    EXPECT_EQ(unit.outcome(ticket), GripperOutcome::kSucceeded);
    run(unit, 1000);
    EXPECT_GE(unit.vacuum(), target);
    EXPECT_LE(unit.vacuum(), target + 10.0);
    EXPECT_TRUE(unit.inControlRange());
    EXPECT_TRUE(unit.partPresent());
    EXPECT_FALSE(unit.partDetached());
    EXPECT_EQ(unit.power(), parameters.idle_power);
  }
}

TEST(VacuumGripperUnit, TimesOutWithoutAPart) {
  VacuumGripperUnit unit;
  const auto ticket = unit.vacuum(500.0, 300);
  run(unit, 299);
  EXPECT_EQ(unit.outcome(ticket), GripperOutcome::kRunning);
  run(unit, 1);
  EXPECT_EQ(unit.outcome(ticket), GripperOutcome::kFailed);
  EXPECT_FALSE(unit.partPresent());
  EXPECT_EQ(unit.power(), 0.0);
}

TEST(VacuumGripperUnit, ReportsALostPartAndHoldsItAgain) {
  VacuumGripperUnit unit;
  unit.setPart(true);
  finish(unit, unit.vacuum(500.0, 5000));
  unit.setPart(false);
  run(unit, 500);
  EXPECT_FALSE(unit.partPresent());
  EXPECT_FALSE(unit.inControlRange());
  EXPECT_FALSE(unit.partDetached());
  EXPECT_EQ(unit.power(), 100.0);
  unit.setPart(true);
  run(unit, 500);
  EXPECT_TRUE(unit.partPresent());
  EXPECT_TRUE(unit.inControlRange());
}

TEST(VacuumGripperUnit, ReportsADetachedPartUntilTheNextCommand) {
  const VacuumGripperParameters parameters;
  VacuumGripperUnit unit;
  unit.setPart(true);
  finish(unit, unit.vacuum(500.0, 5000));
  const double begin = unit.vacuum();
  const auto ticket = unit.dropOff(1000);
  EXPECT_NEAR(finish(unit, ticket),
              1e3 * parameters.blow_time * std::log(begin / parameters.detached_vacuum), 1.0);
  EXPECT_EQ(unit.outcome(ticket), GripperOutcome::kSucceeded);
  EXPECT_TRUE(unit.partDetached());
  EXPECT_FALSE(unit.partPresent());
  finish(unit, unit.vacuum(500.0, 5000));
  EXPECT_FALSE(unit.partDetached());
  const auto too_short = unit.dropOff(20);
  finish(unit, too_short);
  EXPECT_EQ(unit.outcome(too_short), GripperOutcome::kFailed);
  EXPECT_FALSE(unit.partDetached());
}

TEST(VacuumGripperUnit, StopAndOtherCommandsInterrupt) {
  const VacuumGripperParameters parameters;
  VacuumGripperUnit unit;
  unit.setPart(true);
  const auto first = unit.vacuum(700.0, 5000);
  run(unit, 50);
  const auto second = unit.vacuum(200.0, 5000);
  EXPECT_EQ(unit.outcome(first), GripperOutcome::kInterrupted);
  const auto stop = unit.stop();
  EXPECT_EQ(unit.outcome(second), GripperOutcome::kInterrupted);
  EXPECT_EQ(unit.outcome(stop), GripperOutcome::kSucceeded);
  const double begin = unit.vacuum();
  run(unit, 200);
  EXPECT_NEAR(unit.vacuum(), begin * std::exp(-0.2 / parameters.leak_time), 1e-9);
}

TEST(VacuumGripperUnit, RefusesInvalidArguments) {
  VacuumGripperUnit unit;
  EXPECT_EQ(unit.vacuum(0.0, 100), 0U);
  EXPECT_EQ(unit.vacuum(-1.0, 100), 0U);
  EXPECT_EQ(unit.vacuum(std::numeric_limits<double>::quiet_NaN(), 100), 0U);
  EXPECT_EQ(unit.vacuum(2550.0, 100), 0U);
  EXPECT_EQ(unit.vacuum(100.0, -1), 0U);
  EXPECT_EQ(unit.dropOff(-1), 0U);
  VacuumGripperParameters parameters;
  parameters.pump_time = 0.0;
  EXPECT_THROW(VacuumGripperUnit{parameters}, std::invalid_argument);
}

TEST(VacuumGripperUnit, APumpFailureEndsTheCommand) {
  VacuumGripperUnit unit;
  unit.setPart(true);
  const auto ticket = unit.vacuum(500.0, 5000);
  run(unit, 10);
  unit.setHealth(PumpHealth::kOrange);
  EXPECT_EQ(unit.outcome(ticket), GripperOutcome::kRunning);
  unit.setHealth(PumpHealth::kRed);
  EXPECT_EQ(unit.outcome(ticket), GripperOutcome::kFailed);
  EXPECT_EQ(unit.vacuum(500.0, 5000), 0U);
}

TEST(HandServer, SendsAStateWhenACommandEnds) {
  namespace vacuum = franka_core::fci::vacuum;
  VacuumGripperUnit unit;
  unit.setPart(true);
  fci::VacuumServer server("127.0.0.1", 0, unit);
  franka_test::TestClient client(server.port());
  const auto send = [&](const vacuum::Request& request) {
    vacuum::RequestMessage message;
    vacuum::encodeRequest(1, request, message);
    ASSERT_TRUE(client.sendBytes(message.data, message.size));
  };
  const auto until = [&](const auto& condition) {
    return ros_test::eventually([&] {
      server.serve();
      return condition();
    });
  };
  send(vacuum::ConnectRequest{1, client.udpPort()});
  ASSERT_TRUE(until([&] { return server.hasClient(); }));
  server.publish(1);
  send(vacuum::VacuumRequest{50, vacuum::Profile::kP0, 5000});
  ASSERT_TRUE(until([&] { return server.busy(); }));
  for (int i = 0; i < 5000 && server.busy(); i++) {
    unit.step(kTick);
  }
  server.publish(1);  // less than 33 ms after the last state
  vacuum::State newest;
  for (auto bytes = client.datagram(); !bytes.empty(); bytes = client.datagram(0)) {
    ASSERT_EQ(vacuum::decodeState({bytes.data(), bytes.size()}, newest),
              franka_core::fci::CodecError::kNone);
  }
  EXPECT_GE(newest.vacuum, 500);
}

/// The unit behind its server, in its own thread, a few times faster than the wall clock.
class VacuumGripperOnTheNetwork : public ::testing::Test {
 protected:
  VacuumGripperOnTheNetwork() : server_("127.0.0.1", 0, unit_), thread_([this] { serve(); }) {}
  ~VacuumGripperOnTheNetwork() override {
    stop_ = true;
    thread_.join();
  }

  franka::VacuumGripper client() const {
    return franka::VacuumGripper("127.0.0.1:" + std::to_string(server_.port()));
  }
  template <typename Change>
  void change(Change&& change) {
    const std::lock_guard<std::mutex> lock(mutex_);
    change(unit_);
  }
  /// Waits for a state that fulfills the condition.
  template <typename Condition>
  static bool becomes(const franka::VacuumGripper& gripper, Condition&& condition) {
    return ros_test::eventually([&] { return condition(gripper.readOnce()); });
  }

 private:
  void serve() {
    while (!stop_) {
      std::vector<pollfd> fds;
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        server_.serve();
        run(unit_, kTicksPerMillisecond);
        server_.publish(kTicksPerMillisecond);
        server_.addDescriptors(fds);
      }
      ::poll(fds.data(), fds.size(), 1);
    }
  }

  static constexpr int kTicksPerMillisecond = 5;

  VacuumGripperUnit unit_;
  fci::VacuumServer server_;
  std::mutex mutex_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

TEST_F(VacuumGripperOnTheNetwork, PicksHoldsAndDropsAPart) {
  const franka::VacuumGripper gripper = client();
  EXPECT_EQ(gripper.serverVersion(), 1);
  change([](VacuumGripperUnit& unit) { unit.setPart(true); });
  using Profile = franka::VacuumGripper::ProductionSetupProfile;
  for (const Profile profile : {Profile::kP3, Profile::kP2, Profile::kP1, Profile::kP0}) {
    EXPECT_TRUE(gripper.vacuum(50, 5s, profile)) << "profiles have no effect";
  }
  EXPECT_TRUE(becomes(gripper, [](const franka::VacuumGripperState& state) {
    return state.part_present && state.in_control_range && !state.part_detached &&
           state.vacuum >= 500 && state.vacuum <= 510 && state.actual_power == 20 &&
           state.device_status == franka::VacuumGripperDeviceStatus::kGreen;
  }));
  EXPECT_TRUE(gripper.dropOff(5s));
  EXPECT_TRUE(becomes(gripper, [](const franka::VacuumGripperState& state) {
    return state.part_detached && !state.part_present && state.actual_power == 0;
  }));
  EXPECT_TRUE(gripper.stop());
}

TEST_F(VacuumGripperOnTheNetwork, ReportsFailures) {
  const franka::VacuumGripper gripper = client();
  EXPECT_FALSE(gripper.vacuum(50, 100ms, franka::VacuumGripper::ProductionSetupProfile::kP3));
  EXPECT_THROW(gripper.vacuum(0, 100ms), franka::CommandException);
  change([](VacuumGripperUnit& unit) { unit.setHealth(PumpHealth::kRed); });
  EXPECT_THROW(gripper.vacuum(50, 100ms), franka::CommandException);
  EXPECT_TRUE(becomes(gripper, [](const franka::VacuumGripperState& state) {
    return state.device_status == franka::VacuumGripperDeviceStatus::kRed;
  }));
}

}  // namespace
}  // namespace franka_sim

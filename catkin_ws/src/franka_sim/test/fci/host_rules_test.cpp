// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// When the host runs a tick, tested with a robot that only counts.
#include <franka_sim/fci/host.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

namespace franka_sim::fci {

namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

/// A robot in a motion whose client answers some time after each state, or never.
class CountingRobot : public HostedRobot {
 public:
  void observe() override { observed++; }
  void actuate() override {
    actuated++;
    begun = true;
    answered += moving && receiveCommand() ? 1 : 0;
  }
  void serve(bool stops_only) override {
    served++;
    if (moves_when_served) {
      moves_when_served = begun = seen = false;
      moving = true;
    }
    served_all += stops_only ? 0 : 1;
  }
  void publish(std::uint64_t ticks, bool same_moment) override {
    (same_moment ? repeated : published)++;
    message_ids += ticks;
    seen = true;
    if (!same_moment || !begun) {
      shown_at = Clock::now();
    }
  }
  void repeat() override { repeats++; }
  bool hasNews() const override { return false; }
  bool receiveCommand() override { return answers && seen && Clock::now() - shown_at >= delay; }
  bool expectsCommand() const override { return moving; }
  bool asynchronous() const override { return has_asynchronous_motion; }
  bool motionHasBegun() const override { return begun; }
  bool settling() const override { return never_settles; }
  bool handBusy() const override { return false; }
  void addCommandDescriptor(std::vector<pollfd>& /*fds*/) const override {}
  void addDescriptors(std::vector<pollfd>& fds) const override {
    if (descriptor >= 0) {
      fds.push_back({descriptor, POLLIN, 0});
    }
  }
  bool idle() const override { return is_idle; }

  int descriptor{-1};
  std::atomic<bool> is_idle{false};
  bool moving{false}, has_asynchronous_motion{false}, never_settles{false};
  bool answers{true};
  bool moves_when_served{false}, begun{true}, seen{true};
  milliseconds delay{0};
  Clock::time_point shown_at;
  std::uint64_t message_ids{0};
  int observed{0}, actuated{0}, answered{0}, served{0}, served_all{0}, published{0}, repeated{0},
      repeats{0};
};

class HostRules : public ::testing::Test {
 protected:
  void use(const Pace& pace) {
    host.setPace(pace);
    host.add(robot);
  }
  milliseconds timeOf(int ticks) {
    const Clock::time_point begin = Clock::now();
    for (int i = 0; i < ticks; i++) {
      host.tick();
    }
    return std::chrono::duration_cast<milliseconds>(Clock::now() - begin);
  }

  /// Runs until the world stands still, which it does after `due` steps or later.
  int stepsUntilStill(int due) {
    std::atomic<bool> stop{false};
    std::thread running([&] { host.run(stop); });
    const Clock::time_point deadline = Clock::now() + std::chrono::seconds(10);
    while (steps < due && Clock::now() < deadline) {
      std::this_thread::sleep_for(milliseconds(1));
    }
    std::this_thread::sleep_for(milliseconds(50));  // time for a running world to go on
    const int ran = steps;
    stop = true;
    running.join();
    return ran;
  }

  std::atomic<int> steps{0};
  CountingRobot robot;
  Host host{[this] { steps++; }, Pace{}};
};

Pace waiting(PaceMode mode) {
  Pace pace;
  pace.mode = mode;
  pace.patience = milliseconds(50);
  return pace;
}

TEST_F(HostRules, RealTimeDoesNotWaitForAnswers) {
  // Measured from the clock's start: the host makes up for delays.
  const Clock::time_point begin = Clock::now();
  use(Pace{});
  robot.moving = true;
  robot.answers = false;
  timeOf(20);
  EXPECT_GE(Clock::now() - begin, milliseconds(20));
  EXPECT_EQ(20, steps);
  EXPECT_EQ(20, robot.actuated);
  EXPECT_EQ(0, robot.answered);
}

// Waits of more than half the interval, in a second of ticks. Measured from the clock's start.
int longWaits(Host& host, milliseconds interval) {
  int waits = 0;
  Clock::time_point before = Clock::now();
  for (int i = 0; i < 1000; i++) {
    host.tick();
    const Clock::time_point now = Clock::now();
    waits += now - before > interval / 2 ? 1 : 0;
    before = now;
  }
  return waits;
}

TEST_F(HostRules, TicksOfIdleRobotsRunTogether) {
  constexpr milliseconds kInterval{10};
  use(Pace{});
  robot.is_idle = true;
  host.setIdleInterval(kInterval);
  const Clock::time_point begin = Clock::now();
  EXPECT_GE(longWaits(host, kInterval), 50);  // a machine that stalls skips some of the hundred
  EXPECT_GE(Clock::now() - begin, milliseconds(1000) - kInterval);
  EXPECT_GE(robot.served, 50);
}

TEST_F(HostRules, TicksOfAWorldWithOtherUsersRunOneByOne) {
  use(Pace{});
  robot.is_idle = true;
  int in_time = 0;
  for (int i = 0; i < 200; i++) {
    const Clock::time_point before = Clock::now();
    host.tick();
    in_time += Clock::now() - before < milliseconds(5) ? 1 : 0;
  }
  EXPECT_GE(in_time, 100);
}

TEST_F(HostRules, AClientEndsTheWaitOfIdleRobots) {
  constexpr milliseconds kInterval{2000};
  int ends[2];
  ASSERT_EQ(0, pipe(ends));
  use(Pace{});
  robot.is_idle = true;
  robot.descriptor = ends[0];
  host.setIdleInterval(kInterval);
  host.tick();  // the interval begins
  std::thread client([&] {
    std::this_thread::sleep_for(milliseconds(50));
    robot.is_idle = false;
    ASSERT_EQ(1, write(ends[1], "x", 1));
  });
  const Clock::time_point begin = Clock::now();
  while (robot.is_idle) {
    host.tick();
  }
  client.join();
  const int before = steps;
  for (int i = 0; i < 20; i++) {
    host.tick();  // not delayed by the ticks that ran in advance
  }
  EXPECT_LT(Clock::now() - begin, kInterval);
  EXPECT_EQ(before + 20, steps);
  close(ends[0]);
  close(ends[1]);
}

TEST_F(HostRules, PatientPaceWaitsForEachAnswer) {
  use(waiting(PaceMode::kPatient));
  robot.moving = true;
  robot.delay = milliseconds(5);
  EXPECT_GE(timeOf(20), milliseconds(100));
  EXPECT_EQ(20, robot.answered);
}

TEST_F(HostRules, EveryWaitModeWaitsForQuickAndSlowAnswers) {
  robot.moving = true;
  for (auto wait : {franka_core::WaitMode::kAuto, franka_core::WaitMode::kSpin,
                    franka_core::WaitMode::kBlock}) {
    Pace pace = waiting(PaceMode::kLockStep);
    pace.wait = wait;
    host.setPace(pace);
    if (steps == 0) {
      host.add(robot);
    }
    robot.answered = 0;
    robot.delay = milliseconds(0);
    timeOf(100);
    robot.delay = milliseconds(2);
    EXPECT_GE(timeOf(10), milliseconds(20));
    EXPECT_EQ(110, robot.answered);
  }
}

TEST_F(HostRules, PatientPaceIsNotFasterThanTheClock) {
  const Clock::time_point begin = Clock::now();
  use(waiting(PaceMode::kPatient));
  robot.moving = true;
  timeOf(50);
  EXPECT_GE(Clock::now() - begin, milliseconds(50));
  EXPECT_EQ(50, robot.answered);
  robot.moving = false;
  timeOf(50);
  EXPECT_GE(Clock::now() - begin, milliseconds(100));
  EXPECT_EQ(100, robot.published) << "each millisecond is published";
}

TEST_F(HostRules, PatientPaceGivesUpASilentClientUntilItAnswersAgain) {
  use(waiting(PaceMode::kPatient));
  robot.moving = true;
  robot.answers = false;
  EXPECT_GE(timeOf(1), milliseconds(50));
  EXPECT_LT(timeOf(20), milliseconds(20 * 50)) << "waits only once for the silent client";
  EXPECT_EQ(0, robot.answered);
  robot.answers = true;
  timeOf(2);
  robot.delay = milliseconds(10);
  EXPECT_GE(timeOf(3), milliseconds(30));
}

TEST_F(HostRules, AGivenUpClientDoesNotSlowOthers) {
  CountingRobot other;
  use(waiting(PaceMode::kFreeRunning));
  host.add(other);
  robot.moving = true;
  robot.answers = false;
  timeOf(1);
  other.moving = true;
  other.delay = milliseconds(5);
  timeOf(10);
  EXPECT_EQ(10, other.answered);
}

TEST_F(HostRules, OtherClientsGetStatesWhileOneIsAwaited) {
  // Its client answers when the others have their states, however busy the machine is.
  class Awaited : public CountingRobot {
   public:
    bool receiveCommand() override {
      const bool others_served = answered.repeats >= 2 && resting.repeated >= 100;
      return others_served || Clock::now() - shown_at > std::chrono::seconds(10);
    }
    CountingRobot answered, resting;
  } awaited;
  Pace pace = waiting(PaceMode::kLockStep);
  pace.patience = std::chrono::seconds(100);
  host.setPace(pace);
  host.add(awaited);
  host.add(awaited.answered);
  host.add(awaited.resting);
  awaited.moving = awaited.answered.moving = true;
  timeOf(1);
  EXPECT_GE(awaited.answered.repeats, 2) << "a client gives up after a second without a state";
  EXPECT_EQ(0, awaited.answered.repeated) << "with a new number its clock would go on";
  EXPECT_EQ(1, awaited.published + awaited.repeated) << "it already has the state to answer";
  EXPECT_GE(awaited.resting.repeated, 100);
  EXPECT_EQ(1, steps);
}

TEST_F(HostRules, DelaysOfTheHostDoNotCountAsSilenceOfClients) {
  class Held : public CountingRobot {
   public:
    // Simulates another process that uses the processor while the host waits for an answer.
    bool receiveCommand() override {
      if (hold > 0) {
        hold--;
        std::this_thread::sleep_for(milliseconds(20));
      }
      return CountingRobot::receiveCommand();
    }
    int hold{0};
  } held;
  host.setPace(waiting(PaceMode::kLockStep));  // 50 ms of patience
  host.add(held);
  held.moving = true;
  held.hold = 10;
  held.delay = milliseconds(205);
  timeOf(1);
  EXPECT_EQ(1, held.answered);
}

TEST_F(HostRules, FreeRunningIgnoresTheClockBetweenMotions) {
  use(waiting(PaceMode::kFreeRunning));
  timeOf(5000);
  EXPECT_EQ(5000, steps);
  EXPECT_LT(robot.published, 5000) << "states are published at the wall's pace";
}

TEST_F(HostRules, TickAtOnceIgnoresTheClockButWaitsForTheClient) {
  Pace slow;
  slow.factor = 0.001;
  use(slow);
  const Clock::time_point begin = Clock::now();
  host.tickAtOnce();
  EXPECT_LT(Clock::now() - begin, milliseconds(900));
  robot.moving = true;
  robot.delay = milliseconds(20);
  host.tickAtOnce();
  EXPECT_EQ(1, robot.answered);
  EXPECT_EQ(2, steps);
}

TEST_F(HostRules, InLockStepAnAsynchronousMotionFollowsTheClock) {
  Pace pace = waiting(PaceMode::kLockStep);
  pace.patience = std::chrono::seconds(100);
  const Clock::time_point begin = Clock::now();
  use(pace);
  robot.moving = robot.has_asynchronous_motion = true;
  robot.answers = false;
  timeOf(51);
  EXPECT_GE(Clock::now() - begin, milliseconds(50));
  EXPECT_LT(Clock::now() - begin, pace.patience);
  EXPECT_EQ(51, robot.published) << "its client sees each millisecond";
  robot.moving = robot.has_asynchronous_motion = false;
  robot.never_settles = true;
  timeOf(5000);
  EXPECT_LT(robot.published, 5000) << "and the clock no longer counts";
}

TEST_F(HostRules, AsynchronousMotionStillWaitsForOtherRobotsAnswers) {
  CountingRobot other;
  use(waiting(PaceMode::kLockStep));
  host.add(other);
  robot.moving = robot.has_asynchronous_motion = true;
  robot.answers = false;
  other.moving = true;
  other.delay = milliseconds(5);
  EXPECT_GE(timeOf(10), milliseconds(50));
  EXPECT_EQ(10, other.answered);
}

TEST_F(HostRules, ARobotThatNeverRestsDefersRequestsForALimitedTime) {
  use(waiting(PaceMode::kLockStep));
  robot.never_settles = true;
  timeOf(1);  // the world is still at rest
  const int before = robot.served_all;
  timeOf(9000);
  EXPECT_EQ(before, robot.served_all);
  timeOf(1100);
  EXPECT_EQ(before + 1, robot.served_all);
}

TEST_F(HostRules, StandStillPublishesStatesWithoutATick) {
  use(waiting(PaceMode::kPatient));
  host.standStill();
  EXPECT_EQ(1U, robot.message_ids) << "states of a robot at rest count on";
  robot.moving = true;
  host.standStill();
  EXPECT_EQ(1U, robot.message_ids) << "the clock of a motion stands still";
  EXPECT_EQ(2, robot.repeated);
  EXPECT_EQ(2, robot.served);
  EXPECT_EQ(0, steps);
  EXPECT_EQ(0, robot.observed);
}

TEST_F(HostRules, FirstStatesOfAMotionCountAllEarlierTicks) {
  use(waiting(PaceMode::kLockStep));
  robot.never_settles = true;
  timeOf(500);  // few of them are published
  robot.moves_when_served = true;
  for (int i = 0; i < 100000 && !robot.moving; i++) {
    timeOf(1);
  }
  const std::uint64_t before = robot.message_ids;
  timeOf(1);
  EXPECT_EQ(before + 1, robot.message_ids) << "the motion's clock would jump";
}

TEST_F(HostRules, DoesNotCallRemovedRobots) {
  CountingRobot other;
  use(waiting(PaceMode::kFreeRunning));
  host.add(other);
  timeOf(1);
  host.remove(robot);
  timeOf(1);
  EXPECT_EQ(1, robot.observed);
  EXPECT_EQ(2, other.observed);
  host.remove(other);
  EXPECT_TRUE(host.empty());
  timeOf(1);
  EXPECT_EQ(3, steps);
}

TEST_F(HostRules, InLockStepAPushRunsForItsTimeAndUntilRest) {
  use(waiting(PaceMode::kLockStep));
  host.runFree(50);
  EXPECT_EQ(150, stepsUntilStill(150)) << "50, and 100 until all is at rest";
}

TEST_F(HostRules, AResetCancelsTicksThatWereToRun) {
  use(waiting(PaceMode::kLockStep));
  host.runFree(500);
  timeOf(10);
  host.restartAfterReset();
  EXPECT_EQ(10 + 101, stepsUntilStill(10 + 101));
}

}  // namespace

}  // namespace franka_sim::fci

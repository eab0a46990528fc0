// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// When the host runs a tick, tested with a robot that only counts.
#include <franka_sim/serve/host.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "own_directory.h"
#include "serve/lock_step_turn.h"

namespace franka_sim::fci {

namespace {

using Clock = HostClock::Clock;
using std::chrono::milliseconds;

/// A clock that goes on by 100 ns with each reading, and while the host waits.
class FakeClock {
 public:
  Clock::time_point now() { return time_ += std::chrono::nanoseconds(100); }
  void advance(Clock::duration time) { time_ += time; }
  /// Waits for `limit`, unless a client reports something before its end.
  bool wait(std::vector<pollfd>& fds, Clock::duration limit) {
    waits += limit > Clock::duration::zero() ? 1 : 0;
    on_wait();
    if (client_comes_at < time_ + limit) {
      time_ = std::max(time_, client_comes_at);
      client_comes_at = Clock::time_point::max();
      fds.push_back({-1, POLLIN, POLLIN});
      on_client();
      return true;
    }
    time_ += limit;
    return false;
  }

  int waits{0};  ///< that are longer than nothing
  std::function<void()> on_wait{[] {}}, on_client{[] {}};
  Clock::time_point client_comes_at{Clock::time_point::max()};

 private:
  Clock::time_point time_{std::chrono::hours(1)};
};

/// A robot in a motion whose client answers some time after each state, or never.
class CountingRobot : public HostedRobot {
 public:
  explicit CountingRobot(FakeClock& clock) : clock_(clock) {}

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
  void publish(std::uint64_t ticks, bool same_tick, bool keep_end) override {
    ends_kept += keep_end ? 1 : 0;
    (same_tick ? repeated : published)++;
    message_ids += ticks;
    seen = true;
    if (!same_tick || !begun) {
      shown_at = clock_.now();
    }
  }
  bool repeat() override {
    repeats++;
    return reads.value_or(false);
  }
  std::optional<bool> clientHasReadStates() const override {
    on_look();
    return reads;
  }
  bool hasPendingState() const override { return has_pending_state; }
  bool receiveCommand() override { return answers && seen && clock_.now() - shown_at >= delay; }
  bool expectsCommand() const override { return moving; }
  bool clientIsLocal() const override { return is_local; }
  bool asynchronous() const override { return has_asynchronous_motion; }
  bool motionHasBegun() const override { return begun; }
  bool settling() const override { return never_settles; }
  bool handBusy() const override { return false; }
  void addCommandDescriptor(std::vector<pollfd>& /*fds*/) const override {}
  void addDescriptors(std::vector<pollfd>& /*fds*/) const override {}
  bool idle() const override { return is_idle; }

  void reportSilence(Silence silence) override { silences.push_back(silence); }

  std::vector<Silence> silences;
  bool is_idle{false}, moving{false}, has_asynchronous_motion{false}, never_settles{false};
  bool answers{true}, is_local{false};
  bool moves_when_served{false}, begun{true}, seen{true}, has_pending_state{false};
  std::optional<bool> reads;  ///< all states
  std::function<void()> on_look{[] {}};
  milliseconds delay{0};
  Clock::time_point shown_at;
  std::uint64_t message_ids{0};
  int observed{0}, actuated{0}, answered{0}, served{0}, served_all{0}, published{0}, repeated{0},
      repeats{0}, ends_kept{0};

 private:
  FakeClock& clock_;
};

class HostRules : public ::testing::Test {
 protected:
  void use(const Pace& pace) {
    host.setPace(pace);
    host.add(robot);
  }
  /// The time that these ticks take.
  milliseconds timeOf(int ticks) {
    const Clock::time_point begin = clock.now();
    for (int i = 0; i < ticks; i++) {
      host.tick();
    }
    return std::chrono::round<milliseconds>(clock.now() - begin);
  }

  /// Runs until the world has stood still for 100 waits.
  int stepsUntilStill() {
    std::atomic<bool> stop{false};
    int ran = 0;
    int still = 0;
    clock.on_wait = [&] {
      still = steps == ran ? still + 1 : 0;
      ran = steps;
      stop = still == 100;
    };
    host.run(stop);
    return ran;
  }

  int steps{0};
  const OwnDirectory directory;  ///< of turns that no other process takes
  std::vector<bool> wake_ups;    ///< requested by the host: quick or not
  FakeClock clock;
  CountingRobot robot{clock};
  Host host{
      [this] { steps++; }, Pace{}, [] {},
      HostClock{[this] { return clock.now(); },
                [this](auto& fds, Clock::duration limit) { return clock.wait(fds, limit); },
                [this](bool quick) { wake_ups.push_back(quick); },
                [this] { return std::make_shared<LockStepTurn>(directory.path(), "turn", 1); }}};
};

Pace waiting(PaceMode mode) {
  Pace pace;
  pace.mode = mode;
  pace.patience = milliseconds(50);
  return pace;
}

TEST_F(HostRules, RealTimeDoesNotWaitForAnswers) {
  use(Pace{});
  robot.moving = true;
  robot.answers = false;
  EXPECT_EQ(milliseconds(20), timeOf(20));
  EXPECT_EQ(20, steps);
  EXPECT_EQ(20, robot.actuated);
  EXPECT_EQ(0, robot.answered);
  timeOf(3000);
  EXPECT_EQ(std::vector<Silence>(), robot.silences) << "nobody is awaited";
}

TEST_F(HostRules, TimePassesByTheFactor) {
  for (const PaceMode mode : {PaceMode::kRealTime, PaceMode::kPatient}) {
    for (const double factor : {0.2, 1.0, 2.0}) {
      Pace pace = waiting(mode);
      pace.factor = factor;
      host.setPace(pace);
      EXPECT_EQ(milliseconds(static_cast<int>(100 / factor)), timeOf(100)) << factor;
    }
  }
}

TEST_F(HostRules, RealTimeCatchesUpAfterShortDelaysOnly) {
  use(Pace{});
  timeOf(1);
  clock.advance(milliseconds(40));
  EXPECT_EQ(milliseconds(10), timeOf(50));
  clock.advance(milliseconds(1000));
  EXPECT_GE(timeOf(50), milliseconds(49));
}

TEST_F(HostRules, TicksOfIdleRobotsRunTogether) {
  use(Pace{});
  robot.is_idle = true;
  host.setIdleInterval(milliseconds(10));
  EXPECT_NEAR(1000, timeOf(1000).count(), 10);
  EXPECT_NEAR(100, clock.waits, 1);
  EXPECT_NEAR(100, robot.served, 1);
}

TEST_F(HostRules, TicksOfAWorldWithOtherUsersRunOneByOne) {
  use(Pace{});
  robot.is_idle = true;
  EXPECT_EQ(milliseconds(200), timeOf(200));
  EXPECT_EQ(200, clock.waits);
}

TEST_F(HostRules, AClientEndsTheWaitOfIdleRobots) {
  use(Pace{});
  robot.is_idle = true;
  host.setIdleInterval(milliseconds(2000));
  host.tick();  // the interval begins
  clock.client_comes_at = clock.now() + milliseconds(50);
  clock.on_client = [this] { robot.is_idle = false; };
  const Clock::time_point begin = clock.now();
  while (robot.is_idle) {
    host.tick();
  }
  EXPECT_LE(clock.now() - begin, milliseconds(51));
  EXPECT_EQ(milliseconds(20), timeOf(20)) << "delayed by the ticks that ran in advance";
}

TEST_F(HostRules, EveryWaitModeWaitsForQuickAndSlowAnswers) {
  use(Pace{});
  robot.moving = true;
  for (auto wait : {franka_core::WaitMode::kAuto, franka_core::WaitMode::kSpin,
                    franka_core::WaitMode::kBlock}) {
    Pace pace = waiting(PaceMode::kLockStep);
    pace.wait = wait;
    host.setPace(pace);
    robot.answered = 0;
    robot.delay = milliseconds(0);
    timeOf(100);
    robot.delay = milliseconds(2);
    EXPECT_GE(timeOf(10), milliseconds(20));
    EXPECT_EQ(110, robot.answered);
  }
}

TEST_F(HostRules, RequestsQuickWakeUpsWhileLocalClientsAnswerSoon) {
  use(waiting(PaceMode::kLockStep));
  robot.moving = robot.is_local = true;
  timeOf(100);
  EXPECT_EQ(std::vector<bool>({true}), wake_ups);
  robot.delay = milliseconds(2);
  timeOf(100);
  EXPECT_EQ(std::vector<bool>({true, false}), wake_ups);
  robot.delay = milliseconds(0);
  clock.advance(std::chrono::seconds(10));
  timeOf(100);
  EXPECT_EQ(std::vector<bool>({true, false, true}), wake_ups);
  host.standStill();
  EXPECT_EQ(std::vector<bool>({true, false, true, false}), wake_ups);
  timeOf(100);
  robot.answers = false;  // stopped within a motion
  timeOf(1);
  EXPECT_EQ(std::vector<bool>({true, false, true, false, true, false}), wake_ups);
}

TEST_F(HostRules, RequestsNoQuickWakeUpsForOtherPacesAndClients) {
  host.add(robot);
  robot.moving = robot.is_local = true;
  Pace pace = waiting(PaceMode::kLockStep);
  pace.wait = franka_core::WaitMode::kBlock;
  for (const Pace& other : {Pace{}, waiting(PaceMode::kPatient), pace}) {
    host.setPace(other);
    timeOf(100);
  }
  robot.is_local = false;
  host.setPace(waiting(PaceMode::kLockStep));
  timeOf(100);
  EXPECT_EQ(std::vector<bool>(), wake_ups);
}

TEST_F(HostRules, PatientPaceIsNotFasterThanTheClock) {
  use(waiting(PaceMode::kPatient));
  robot.moving = true;
  EXPECT_EQ(milliseconds(50), timeOf(50));
  EXPECT_EQ(50, robot.answered);
  robot.moving = false;
  EXPECT_EQ(milliseconds(50), timeOf(50));
  EXPECT_EQ(100, robot.published) << "each millisecond is published";
}

TEST_F(HostRules, PatientPaceGivesUpASilentClientUntilItAnswersAgain) {
  use(waiting(PaceMode::kPatient));
  robot.moving = true;
  robot.answers = false;
  EXPECT_GE(timeOf(1), milliseconds(50));
  EXPECT_NEAR(20, timeOf(20).count(), 2) << "waits only once for the silent client";
  EXPECT_EQ(0, robot.answered);
  robot.answers = true;
  timeOf(2);
  robot.delay = milliseconds(10);
  EXPECT_GE(timeOf(3), milliseconds(30));
}

TEST_F(HostRules, ReportsEachSilenceOfAClientOnce) {
  Pace pace = waiting(PaceMode::kLockStep);
  pace.patience = milliseconds(5000);
  use(pace);
  robot.moving = true;
  robot.delay = milliseconds(900);
  timeOf(2);
  EXPECT_EQ(std::vector<Silence>(), robot.silences);
  robot.delay = milliseconds(3000);
  timeOf(1);
  EXPECT_EQ(std::vector<Silence>({Silence::kLong}), robot.silences);
  robot.answers = false;
  timeOf(50);
  EXPECT_EQ(std::vector<Silence>({Silence::kLong, Silence::kLong, Silence::kGivenUp}),
            robot.silences);
}

TEST_F(HostRules, AGivenUpClientDoesNotSlowOthers) {
  CountingRobot other{clock};
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
  CountingRobot answered{clock}, resting{clock};
  Pace pace = waiting(PaceMode::kLockStep);
  pace.patience = std::chrono::seconds(100);
  use(pace);
  host.add(answered);
  host.add(resting);
  robot.moving = answered.moving = true;
  robot.delay = milliseconds(1000);
  EXPECT_NEAR(1000, timeOf(1).count(), 2);
  EXPECT_EQ(3, answered.repeats) << "a client gives up after a second without a state";
  EXPECT_EQ(0, answered.repeated) << "with a new number its clock would go on";
  EXPECT_EQ(1, robot.published + robot.repeated) << "it already has the state to answer";
  EXPECT_NEAR(1000, resting.repeated, 10);
  EXPECT_EQ(1, steps);
}

TEST_F(HostRules, DelaysOfTheHostDoNotCountAsSilenceOfClients) {
  // Another process uses the processor ten times while the host waits for an answer.
  int holds = 10;
  clock.on_wait = [&] { clock.advance(milliseconds(holds-- > 0 ? 20 : 0)); };
  use(waiting(PaceMode::kLockStep));  // 50 ms of patience
  robot.moving = true;
  robot.delay = milliseconds(205);
  timeOf(1);
  EXPECT_EQ(1, robot.answered);
}

TEST_F(HostRules, DelaysOfTheHostDoNotPutTheClockOfAStartingClientAhead) {
  Pace pace = waiting(PaceMode::kLockStep);
  pace.patience = std::chrono::seconds(2);
  use(pace);
  robot.moving = true;
  robot.begun = robot.answers = false;
  clock.on_wait = [&] { clock.advance(milliseconds(20)); };
  const milliseconds time = timeOf(1);
  EXPECT_GT(time, std::chrono::seconds(15));
  EXPECT_EQ(2 + 3, robot.published + robot.repeated) << "two at once, then one each 0.6 s";
  EXPECT_GE(robot.repeats, time / milliseconds(330) - 3) << "a client would give up";
}

// The first call of its callback takes so long.
TEST_F(HostRules, AStartingClientGetsTwoStatesHoweverLateItAnswers) {
  Pace pace = waiting(PaceMode::kLockStep);
  pace.patience = std::chrono::seconds(100);
  use(pace);
  robot.reads = robot.moving = true;
  robot.begun = false;
  robot.delay = std::chrono::seconds(20);
  clock.on_wait = [this] { robot.reads = robot.repeats == 0; };
  EXPECT_NEAR(20000, timeOf(1).count(), 10);
  EXPECT_EQ(1, robot.answered);
  EXPECT_EQ(2U, robot.message_ids) << "with a third one its clock would be ahead";
}

TEST_F(HostRules, AStartingClientIsNotTakenForOneThatWaitsAfterItHasAnswered) {
  Pace pace = waiting(PaceMode::kLockStep);
  pace.patience = std::chrono::seconds(100);
  use(pace);
  robot.reads = robot.moving = true;
  robot.begun = false;
  robot.delay = std::chrono::seconds(100);
  // It answers, and then reads the repeat, while the host looks at its socket.
  robot.on_look = [this] { robot.delay = milliseconds(robot.repeats > 0 ? 0 : 100000); };
  EXPECT_NEAR(600, timeOf(1).count(), 10);
  EXPECT_EQ(1, robot.answered);
  EXPECT_EQ(2U, robot.message_ids);
}

TEST_F(HostRules, AStartingClientGetsTheSecondStateWhenItHasReadTheFirst) {
  Pace pace = waiting(PaceMode::kLockStep);
  pace.patience = milliseconds(550);
  use(pace);
  robot.moving = true;
  robot.reads = robot.begun = robot.answers = false;
  std::vector<std::uint64_t> numbers;
  clock.on_wait = [&] {
    numbers.push_back(robot.message_ids);
    robot.reads = numbers.size() >= 500;
  };
  timeOf(1);
  EXPECT_NEAR(500, std::count(numbers.begin(), numbers.end(), 1), 2);
  EXPECT_EQ(2U, robot.message_ids);
}

TEST_F(HostRules, AStartingClientThatMissedAStateGetsAnotherOne) {
  Pace pace = waiting(PaceMode::kLockStep);
  pace.patience = milliseconds(2500);
  use(pace);
  robot.reads = robot.moving = true;
  robot.begun = robot.answers = false;
  timeOf(1);
  EXPECT_EQ(2U + 4U, robot.message_ids) << "two at once, then one each 0.6 s";
  EXPECT_EQ(4, robot.repeats) << "it reads one before each of them";
}

TEST_F(HostRules, AnswersToRequestsOfAStartingClientDoNotWaitForItsCommand) {
  use(waiting(PaceMode::kLockStep));
  robot.moving = robot.has_pending_state = true;
  robot.reads = robot.begun = robot.answers = false;
  timeOf(1);
  EXPECT_EQ(2U, robot.message_ids);
}

TEST_F(HostRules, FreeRunningIgnoresTheClockBetweenMotions) {
  use(waiting(PaceMode::kFreeRunning));
  const milliseconds passed = timeOf(5000);
  EXPECT_EQ(5000, steps);
  EXPECT_EQ(0, clock.waits);
  EXPECT_NEAR(robot.published, passed.count(), 2) << "states are published at the wall's pace";
}

TEST_F(HostRules, TickAtOnceIgnoresTheClockButWaitsForTheClient) {
  Pace slow;
  slow.factor = 0.001;
  use(slow);
  host.tickAtOnce();
  EXPECT_EQ(0, clock.waits);
  robot.moving = true;
  robot.delay = milliseconds(20);
  host.tickAtOnce();
  EXPECT_EQ(1, robot.answered);
  EXPECT_EQ(2, steps);
}

TEST_F(HostRules, OnlyAMotionWaitsForItsTurn) {
  LockStepTurn of_another_process(directory.path(), "turn", 1);
  ASSERT_TRUE(of_another_process.take(clock.now()));
  CountingRobot idle(clock);
  use(waiting(PaceMode::kLockStep));
  host.add(idle);
  robot.moving = robot.is_local = true;
  EXPECT_NEAR(LockStepTurn::kMaxWait.count(), timeOf(1).count(), LockStepTurn::kMaxRetry.count());
  EXPECT_NEAR(LockStepTurn::kMaxWait.count(), idle.message_ids,
              0.1 * LockStepTurn::kMaxWait.count());
  EXPECT_GT(idle.served, LockStepTurn::kMaxWait / LockStepTurn::kMaxRetry);
  EXPECT_EQ(1U, robot.message_ids);
  EXPECT_GE(robot.repeats, 1) << "on a busy machine its client would give up";
  host.remove(idle);
}

TEST_F(HostRules, InLockStepAnAsynchronousMotionFollowsTheClock) {
  Pace pace = waiting(PaceMode::kLockStep);
  pace.patience = std::chrono::seconds(100);
  use(pace);
  robot.moving = robot.has_asynchronous_motion = true;
  robot.answers = false;
  EXPECT_EQ(milliseconds(51), timeOf(51));
  EXPECT_EQ(51, robot.published) << "its client sees each millisecond";
  robot.moving = robot.has_asynchronous_motion = false;
  robot.never_settles = true;
  timeOf(5000);
  EXPECT_LT(robot.published, 5000) << "and the clock no longer counts";
}

TEST_F(HostRules, AsynchronousMotionStillWaitsForOtherRobotsAnswers) {
  CountingRobot other{clock};
  use(waiting(PaceMode::kLockStep));
  host.add(other);
  robot.moving = robot.has_asynchronous_motion = true;
  robot.answers = false;
  other.moving = true;
  other.delay = milliseconds(5);
  EXPECT_NEAR(50, timeOf(10).count(), 1);
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

TEST_F(HostRules, KeepsTheEndOfAMotionForAClientThatIsLateUnlessTheClockDemandsStates) {
  for (const PaceMode mode : {PaceMode::kLockStep, PaceMode::kPatient, PaceMode::kRealTime}) {
    CountingRobot ended{clock};
    ended.moving = true;
    host.setPace(waiting(mode));
    host.add(ended);
    timeOf(5);
    EXPECT_EQ(0, ended.ends_kept) << "its client needs each state";
    ended.moving = false;
    ended.never_settles = true;  // ticks go on
    const Clock::time_point end = clock.now();
    while (clock.now() - end < milliseconds(599)) {
      timeOf(1);
    }
    const int published = ended.published - 5;
    EXPECT_EQ(mode == PaceMode::kRealTime ? 0 : published, ended.ends_kept);
    timeOf(1000);
    while (clock.now() - end < milliseconds(700)) {
      timeOf(1);
    }
    const int kept = ended.ends_kept;
    timeOf(1000);
    EXPECT_EQ(kept, ended.ends_kept) << "a silent client gets states again";
    host.remove(ended);
  }
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
  CountingRobot other{clock};
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
  EXPECT_EQ(150, stepsUntilStill()) << "50, and 100 until all is at rest";
}

TEST_F(HostRules, AResetCancelsTicksThatWereToRun) {
  use(waiting(PaceMode::kLockStep));
  host.runFree(500);
  timeOf(10);
  host.restartAfterReset();
  EXPECT_EQ(10 + 101, stepsUntilStill());
}

}  // namespace

}  // namespace franka_sim::fci

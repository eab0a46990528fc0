// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Motions: start, lock-step, finish, abort, stop, and a misbehaving robot.
#include <algorithm>
#include <atomic>
#include <cstring>
#include <thread>

#include "robot_fixture.h"

namespace franka_test {
namespace {

using franka::CommandException;
using franka::ControlException;
using franka::Duration;
using franka::NetworkException;
using franka::Robot;
using franka::RobotState;
using franka::Torques;

const std::array<double, 7> kZero{};

/// Torques of zero for a number of cycles.
std::function<Torques(const RobotState&, Duration)> zeroTorques(int cycles) {
  auto left = std::make_shared<int>(cycles);
  return [left](const RobotState&, Duration) {
    Torques torques(kZero);
    return --*left <= 0 ? franka::MotionFinished(torques) : torques;
  };
}

std::function<Torques(const RobotState&, Duration)> endlessTorques() {
  return [](const RobotState&, Duration) { return Torques(kZero); };
}

using Motion = EveryVersion;

TEST_P(Motion, AnswersEachStateOnceAndFinishes) {
  const auto robot = connect(fake);
  std::vector<uint64_t> periods;
  robot->control([&](const RobotState& state, Duration period) {
    periods.push_back(period.toMSec());
    EXPECT_EQ(franka::RobotMode::kMove, state.robot_mode);
    Torques torques(kZero);
    return periods.size() == 100 ? franka::MotionFinished(torques) : torques;
  });
  ASSERT_EQ(100u, periods.size());
  EXPECT_EQ(0u, periods[0]);
  const auto exchanges = fake.exchanges();
  ASSERT_EQ(100u, exchanges.size());
  for (std::size_t i = 1; i < exchanges.size(); i++) {
    EXPECT_EQ(periods[i], exchanges[i].command.message_id - exchanges[i - 1].command.message_id);
    const bool last = i + 1 == exchanges.size();
    EXPECT_EQ(last && GetParam() < 10, exchanges[i].command.motion_generation_finished);
    EXPECT_EQ(last && GetParam() == 10, exchanges[i].command.torque_command_finished);
  }
  const auto move = std::get<franka_core::fci::MoveRequest>(fake.requests().back());
  EXPECT_EQ(franka_core::ControllerMode::kExternalController, move.controller_mode);
  EXPECT_EQ(GetParam() == 10 ? franka_core::MotionGeneratorMode::kNone
                             : franka_core::MotionGeneratorMode::kJointVelocity,
            move.motion_generator_mode);
  EXPECT_EQ(0, fake.count(Command::kStopMove));
  EXPECT_EQ(franka::RobotMode::kIdle, robot->readOnce().robot_mode);
}

/// A status of Move and the end of its text (protocol 3.4).
struct MoveText {
  Status status;
  const char* ending;
  bool aborts;  ///< is possible after the motion has started, too
  std::uint16_t first_version{3};
};
constexpr MoveText kMoveTexts[] = {
    {Status::kCommandNotPossibleRejected,
     " command rejected: command not possible in the current mode (\"Idle\")!", false},
    {Status::kStartAtSingularPoseRejected, " command rejected: cannot start at singular pose!",
     false},
    {Status::kInvalidArgumentRejected, " command rejected: maximum path deviation out of range!",
     false},
    {Status::kPreempted, " command preempted!", true},
    {Status::kReflexAborted, " command aborted: motion aborted by reflex!", false},
    {Status::kEmergencyAborted, " command aborted: User Stop pressed!", true},
    {Status::kInputErrorAborted, " command aborted: invalid input provided!", true},
    {Status::kAborted, " command aborted!", true},
    {Status::kRejectedDueToActivatedSafetyFunctions,
     " command rejected due to activated safety function! Please disable all safety functions.",
     false, 6},
    {Status::kPreemptedDueToActivatedSafetyFunctions,
     " command preempted due to activated safety function! Please disable all safety functions.",
     false, 6},
};

TEST_P(Motion, RefusedBeforeItStarts) {
  const auto robot = connect(fake);
  for (const MoveText& text : kMoveTexts) {
    if (GetParam() < text.first_version) {
      continue;
    }
    fake.script([&text](FakeRobot::Script& s) { s.replies[Command::kMove] = text.status; });
    EXPECT_EQ(std::string("libfranka: Move") + text.ending,
              textOf<CommandException>([&] { robot->control(endlessTorques()); }));
  }
  // Nothing moved, so nothing is stopped; and the next motion runs.
  EXPECT_EQ(0, fake.count(Command::kStopMove));
  fake.script([](FakeRobot::Script& s) { s.replies.clear(); });
  EXPECT_NO_THROW(robot->control(zeroTorques(3)));
  fake.script([](FakeRobot::Script& s) { s.end_at_start = Status::kStartAtSingularPoseRejected; });
  EXPECT_EQ("libfranka: Move command rejected: cannot start at singular pose!",
            textOf<ControlException>([&] { robot->control(endlessTorques()); }));
}

TEST_P(Motion, AbortsWithTheTextOfTheirStatus) {
  const auto robot = connect(fake);
  for (const MoveText& text : kMoveTexts) {
    for (bool reply_first : {false, true}) {
      if (!text.aborts) {
        continue;
      }
      fake.script([&](FakeRobot::Script& s) {
        s.abort_after = 20;
        s.abort_status = text.status;
        s.abort_mode = franka_core::RobotMode::kUserStopped;
        s.abort_replies_first = reply_first;
      });
      fake.change([](auto& s) { s.robot_mode = franka_core::RobotMode::kIdle; });
      const int stops = fake.count(Command::kStopMove);
      EXPECT_EQ(std::string("libfranka: Move") + text.ending,
                textOf<ControlException>([&] { robot->control(endlessTorques()); }));
      EXPECT_EQ(stops + 1, fake.count(Command::kStopMove));  // like the genuine client
    }
  }
}

// Text of an abort by reflex, as in the genuine client (protocol 3.4).
TEST_P(Motion, AbortsByReflexWithErrorsRateAndLog) {
  const auto robot = connect(fake, 5);
  fake.script([](FakeRobot::Script& s) {
    s.abort_after = 20;
    s.abort_errors = {7, 14};
    s.success_rate = 0.96875;  // exact in single precision too
  });
  try {
    robot->control(endlessTorques());
    FAIL() << "no exception";
  } catch (const ControlException& error) {
    EXPECT_TRUE(startsWith(
        error.what(),
        "libfranka: Move command aborted: motion aborted by reflex! [\"cartesian_reflex\", "
        "\"joint_motion_generator_velocity_discontinuity\"]\ncontrol_command_success_rate: "
        "0.96875"))
        << error.what();
    EXPECT_EQ(std::string::npos, std::string(error.what()).find("packets lost"));
    // The causes found in the log follow on separate lines.
    const std::string text = error.what();
    EXPECT_EQ(3, std::count(text.begin(), text.end(), '\n')) << text;
    EXPECT_NE(std::string::npos, text.find("\ncartesian_reflex")) << text;
    ASSERT_EQ(5u, error.log.size());
    for (std::size_t i = 1; i < 5; i++) {
      EXPECT_EQ(error.log[i - 1].state.time.toMSec() + 1, error.log[i].state.time.toMSec());
    }
    EXPECT_EQ(franka::RobotMode::kMove, error.log[3].state.robot_mode);
    EXPECT_EQ(franka::RobotMode::kReflex, error.log[4].state.robot_mode);
    EXPECT_TRUE(error.log[4].state.last_motion_errors.cartesian_reflex);
    EXPECT_FALSE(franka::logToCSV(error.log).empty());
  }
  EXPECT_EQ(1, fake.count(Command::kStopMove));
  robot->automaticErrorRecovery();
}

TEST_P(Motion, CountsPacketsLostBeforeTheAbort) {
  const auto robot = connect(fake);
  fake.script([](FakeRobot::Script& s) {
    s.abort_after = 20;
    s.skip_after = 20;
    s.skip = 5;
    s.success_rate = 0.9375;
  });
  const std::string text = textOf<ControlException>([&] { robot->control(endlessTorques()); });
  EXPECT_TRUE(startsWith(text,
                         "libfranka: Move command aborted: motion aborted by reflex! "
                         "[]\ncontrol_command_success_rate: 0.890625 packets lost in a row in the "
                         "last sample: 5"))
      << text;
}

TEST_P(Motion, FinishedButStillMoving) {
  const auto robot = connect(fake);
  fake.script([](FakeRobot::Script& s) { s.end_at_finish = Status::kReflexAborted; });
  EXPECT_TRUE(startsWith(textOf<ControlException>([&] { robot->control(zeroTorques(5)); }),
                         "Motion finished commanded, but the robot is still moving! []"));
  fake.script([](FakeRobot::Script& s) { s.end_at_finish = Status::kAborted; });
  EXPECT_EQ("libfranka: Move command aborted!",
            textOf<ControlException>([&] { robot->control(zeroTorques(5)); }));
}

TEST_P(Motion, CanBeStoppedFromAnotherThread) {
  const auto robot = connect(fake);
  std::atomic<int> cycles{0};
  std::thread other([&] {
    while (cycles < 50) {
      std::this_thread::yield();
    }
    robot->stop();
  });
  EXPECT_EQ("libfranka: Move command preempted!", textOf<ControlException>([&] {
              robot->control([&](const RobotState&, Duration) {
                cycles++;
                return Torques(kZero);
              });
            }));
  other.join();
  EXPECT_NO_THROW(robot->control(zeroTorques(3)));
}

TEST_P(Motion, CallbackExceptionStopsTheRobotAndPropagates) {
  const auto robot = connect(fake);
  for (bool preempts : {true, false}) {
    fake.script([preempts](FakeRobot::Script& s) { s.preempts = preempts; });
    EXPECT_EQ("enough", textOf<std::logic_error>([&] {
                robot->control([](const RobotState&, Duration) -> Torques {
                  throw std::logic_error("enough");
                });
              }));
    EXPECT_EQ(franka_core::RobotMode::kIdle, fake.state().robot_mode);
  }
  EXPECT_EQ(2, fake.count(Command::kStopMove));
  EXPECT_NO_THROW(robot->control(zeroTorques(3)));
}

INSTANTIATE_TEST_SUITE_P(All, Motion, ::testing::ValuesIn(kVersions), versionName);

TEST(MotionOrder, SecondMotionIsRefusedByTheClient) {
  FakeRobot fake(5);
  const auto robot = connect(fake);
  fake.change([](franka_core::RobotState& s) {
    s.motion_generator_mode = franka_core::MotionGeneratorMode::kJointPosition;
  });
  robot->readOnce();
  robot->readOnce();
  EXPECT_EQ("libfranka robot: Attempted to start multiple motions!",
            textOf<ControlException>([&] { robot->control(endlessTorques()); }));
  EXPECT_EQ(0, fake.count(Command::kMove));
}

TEST(MotionReplies, RepeatedOnesAreIgnored) {
  FakeRobot fake(6);
  const auto robot = connect(fake);
  fake.script([](FakeRobot::Script& s) { s.repeated[Command::kMove] = 1; });
  for (int i = 0; i < 3; i++) {
    EXPECT_NO_THROW(robot->control(zeroTorques(5)));
  }
  fake.script([](FakeRobot::Script& s) { s.abort_after = 5; });
  EXPECT_TRUE(startsWith(textOf<ControlException>([&] { robot->control(endlessTorques()); }),
                         "libfranka: Move command aborted: motion aborted by reflex!"));
}

/// A failure of the robot, and the resulting exception in the program.
struct Fault {
  const char* name;
  std::function<void(FakeRobot::Script&)> script;
  const char* text;
  std::uint16_t version;
};

class MotionFaults : public ::testing::TestWithParam<Fault> {};

TEST_P(MotionFaults, EndInANetworkException) {
  const ShortTimeouts timeouts;
  FakeRobot fake(GetParam().version);
  const auto robot = connect(fake);
  fake.script(GetParam().script);
  const std::string text = textOf<NetworkException>([&] { robot->control(zeroTorques(30)); });
  EXPECT_TRUE(startsWith(text, GetParam().text)) << text;
}

constexpr const char* kNoState = "libfranka: UDP receive: Timeout";
constexpr const char* kNoAnswer = "libfranka: Connection timeout.";

INSTANTIATE_TEST_SUITE_P(
    All, MotionFaults,
    ::testing::Values(
        Fault{"DiesAtMove", [](auto& s) { s.fatal = {Command::kMove}; }, kClosed, 5},
        Fault{"DiesInTheMotion", [](auto& s) { s.close_after = 10; }, kClosed, 10},
        Fault{"DiesAtTheEnd", [](auto& s) { s.closes_at_finish = true; }, kClosed, 5},
        Fault{"DiesAfterTheAbort",
              [](auto& s) {
                s.abort_after = 10;
                s.abort_replies = false;
                s.close_after = 10;
              },
              kClosed, 10},
        Fault{"FallsSilentInTheMotion", [](auto& s) { s.silence_after = 10; }, kNoState, 5},
        Fault{"DoesNotAnswerMove", [](auto& s) { s.unanswered = {Command::kMove}; }, kNoAnswer, 10},
        Fault{"DoesNotShowTheMotion", [](auto& s) { s.shows_motion = false; }, kNoAnswer, 5},
        Fault{"DoesNotEnd", [](auto& s) { s.ends_at_finish = false; }, kNoAnswer, 10},
        Fault{"DoesNotAnswerTheEnd", [](auto& s) { s.answers_finish = false; }, kNoAnswer, 5},
        Fault{"DoesNotSayWhyItAborts",
              [](auto& s) {
                s.abort_after = 10;
                s.abort_replies = false;
              },
              kNoAnswer, 10}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(MotionFaultsAtStop, EndInTheFirstException) {
  const ShortTimeouts timeouts;
  using Script = FakeRobot::Script;
  std::vector<std::function<void(Script&)>> faults{
      [](Script& s) { s.unanswered = {Command::kStopMove}; },
      [](Script& s) { s.fatal = {Command::kStopMove}; }};
  for (Status status : {Status::kCommandNotPossibleRejected, Status::kAborted,
                        Status::kReflexAborted, Status::kEmergencyAborted}) {
    faults.emplace_back([status](Script& s) { s.replies[Command::kStopMove] = status; });
  }
  for (const auto& fault : faults) {
    FakeRobot fake(5);
    const auto robot = connect(fake);
    fake.script(fault);
    fake.script([](Script& s) { s.abort_after = 10; });
    EXPECT_TRUE(startsWith(textOf<ControlException>([&] { robot->control(endlessTorques()); }),
                           "libfranka: Move command aborted: motion aborted by reflex!"));
  }
}

// Timeouts::silence is for robots that have not answered.
TEST(MotionFaultsAtStop, RobotThatHasStoppedNeedsToSendNoMoreStates) {
  franka::Timeouts timeouts;
  timeouts.silence = std::chrono::hours(1);
  const ScopedTimeouts scoped(timeouts);
  FakeRobot fake(5);
  const auto robot = connect(fake);
  std::atomic<bool> silent{false};
  fake.script([&silent](FakeRobot::Script& s) {
    s.transmit = [&silent](const FakeRobot::Datagram& state) {
      return silent ? std::vector<FakeRobot::Datagram>{} : std::vector<FakeRobot::Datagram>{state};
    };
  });
  EXPECT_EQ("enough", textOf<std::logic_error>([&] {
              robot->control([&](const RobotState&, Duration) -> Torques {
                silent = true;
                throw std::logic_error("enough");
              });
            }));
  EXPECT_EQ(1, fake.count(Command::kStopMove));
}

/// Datagrams that the network repeats, delays or loses.
class Datagrams : public ::testing::Test {
 protected:
  using Datagram = FakeRobot::Datagram;
  FakeRobot fake{5};
  std::unique_ptr<Robot> robot{connect(fake)};

  /// Ids of the states that a motion of 100 cycles has received.
  std::vector<uint64_t> runMotion() {
    std::vector<uint64_t> ids;
    robot->control([&](const RobotState& state, Duration) {
      ids.push_back(state.time.toMSec());
      return ids.size() == 100 ? franka::MotionFinished(Torques(kZero)) : Torques(kZero);
    });
    return ids;
  }
  static void expectIncreasing(const std::vector<uint64_t>& ids) {
    for (std::size_t i = 1; i < ids.size(); i++) {
      EXPECT_GT(ids[i], ids[i - 1]);
    }
  }
};

TEST_F(Datagrams, RepeatedAndLateOnesAreDropped) {
  fake.script([](FakeRobot::Script& s) {
    s.transmit = [last = Datagram()](const Datagram& d) mutable {
      std::vector<Datagram> sent{d, d};
      if (!last.empty()) {
        sent.push_back(last);  // sends the previous one again, after its successor
      }
      last = d;
      return sent;
    };
  });
  expectIncreasing(runMotion());
}

TEST_F(Datagrams, LostOnesAreNotWaitedFor) {
  fake.script([](FakeRobot::Script& s) {
    s.answer_timeout = std::chrono::milliseconds(50);
    s.transmit = [n = 0](const Datagram& d) mutable {
      return ++n % 10 == 0 ? std::vector<Datagram>{} : std::vector<Datagram>{d};
    };
  });
  const std::vector<uint64_t> ids = runMotion();
  expectIncreasing(ids);
  EXPECT_GT(ids.back() - ids.front(), 105u);
}

TEST_F(Datagrams, OneThatShowsTheEndIsNotSkippedForLaterOnes) {
  constexpr std::size_t kMode = 2364;  // offset of robot_mode
  constexpr std::uint8_t kIdle = 1, kReflex = 4;
  robot.reset();  // one client at a time
  robot = connect(fake, 50);
  for (const int cycles : {1, 30}) {
    fake.script([&](FakeRobot::Script& s) {
      s.abort_after = cycles;
      s.abort_errors = {7};
      // At once: a state of the motion, the one that shows its end, and those of an arm that has
      // recovered, which a client that runs late finds in its socket.
      s.transmit = [before = Datagram()](const Datagram& d) mutable {
        if (d[kMode] != kReflex || before.empty()) {
          before = d;
          return std::vector<Datagram>{d};
        }
        std::vector<Datagram> sent{before, d, d, d, d};
        for (std::size_t i = 0; i < sent.size(); i++) {
          std::uint64_t id = 0;
          std::memcpy(&id, d.data(), sizeof(id));
          id += i;
          std::memcpy(sent[i].data(), &id, sizeof(id));
          sent[i][kMode] = i > 1 ? kIdle : sent[i][kMode];
        }
        return sent;
      };
    });
    try {
      robot->control([&](const RobotState&, Duration) -> Torques {
        fake.state();  // waits until the robot has sent all
        return {{0, 0, 0, 0, 0, 0, 0}};
      });
      FAIL() << "no exception";
    } catch (const ControlException& error) {
      EXPECT_NE(std::string::npos, std::string(error.what()).find("cartesian_reflex"));
      EXPECT_EQ(franka::RobotMode::kReflex, error.log.back().state.robot_mode);
    }
    robot->automaticErrorRecovery();
  }
}

TEST_F(Datagrams, OfAnotherSizeAreAnError) {
  for (int change : {-1, -2373, -2365, +1, +100, -1000}) {
    FakeRobot mistreated(5);
    const auto client = connect(mistreated);
    mistreated.script([change](FakeRobot::Script& s) {
      s.transmit = [change](Datagram d) {
        d.resize(d.size() + static_cast<std::size_t>(change));
        return std::vector<Datagram>{d};
      };
    });
    const std::string text = textOf<franka::ProtocolException>([&] {
      while (true) {  // some earlier states may still be in transit
        client->readOnce();
      }
    });
    EXPECT_TRUE(startsWith(text, "libfranka: incorrect object size")) << text;
    EXPECT_NE(std::string::npos, text.find("2373")) << text;
  }
}

TEST_F(Datagrams, InvalidOneStopsTheMotion) {
  fake.script([](FakeRobot::Script& s) {
    s.transmit = [n = 0](Datagram d) mutable {
      if (++n == 50) {
        d.pop_back();
      }
      return std::vector<Datagram>{d};
    };
  });
  EXPECT_THROW(robot->control(endlessTorques()), franka::ProtocolException);
  EXPECT_EQ(1, fake.count(Command::kStopMove));
  EXPECT_EQ(franka_core::RobotMode::kIdle, fake.state().robot_mode);
}

TEST_F(Datagrams, InvalidOneStopsAMotionThatStarts) {
  fake.script([this](FakeRobot::Script& s) {
    s.shows_motion = false;
    s.transmit = [this](Datagram d) {
      if (fake.count(Command::kMove) > fake.count(Command::kStopMove)) {
        d.pop_back();
      }
      return std::vector<Datagram>{d};
    };
  });
  EXPECT_THROW(robot->control(endlessTorques()), franka::ProtocolException);
  EXPECT_EQ(1, fake.count(Command::kStopMove));
  const auto reads = [this] {
    try {
      robot->readOnce();
      return true;
    } catch (const franka::ProtocolException&) {
      return false;
    }
  };
  int invalid = 0;  // some may still be in transit
  while (!reads() && invalid < 100) {
    invalid++;
  }
  EXPECT_LT(invalid, 100);
}

}  // namespace
}  // namespace franka_test

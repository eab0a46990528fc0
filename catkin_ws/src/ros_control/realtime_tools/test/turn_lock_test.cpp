// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime_tools/detail/turn_lock.h"

#include <gtest/gtest.h>
#include <ros_test/eventually.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>

using realtime_tools::detail::TurnLock;
using ros_test::eventually;

TEST(TurnLock, IsClosedUntilOpened) {
  TurnLock turn;
  EXPECT_FALSE(turn.tryLock());
  turn.open();
  EXPECT_TRUE(turn.tryLock());
  EXPECT_FALSE(turn.tryLock());
  turn.unlock();
  EXPECT_TRUE(turn.tryLock());
}

TEST(TurnLock, RealTimeSideWaitsForItsTurnOthersOnlyForTheLock) {
  TurnLock turn;
  turn.open();
  ASSERT_TRUE(turn.tryLock());
  turn.unlockAndHandOver();
  EXPECT_FALSE(turn.tryLock());
  turn.lock();
  turn.unlock();
  EXPECT_FALSE(turn.tryLock());
  EXPECT_TRUE(turn.tryTakeTurn());
  EXPECT_FALSE(turn.tryTakeTurn());
  EXPECT_FALSE(turn.tryLock());
  turn.unlockAndReturn();
  EXPECT_TRUE(turn.tryLock());
}

TEST(TurnLock, NoTurnIsTakenAfterStop) {
  TurnLock turn;
  turn.open();
  EXPECT_FALSE(turn.tryTakeTurn());
  ASSERT_TRUE(turn.tryLock());
  turn.unlockAndHandOver();
  turn.stop();
  EXPECT_FALSE(turn.tryTakeTurn());
  EXPECT_FALSE(turn.tryLock());
  turn.open();
  EXPECT_TRUE(turn.tryLock());
}

TEST(TurnLock, UnlockWakesAWaitingThread) {
  TurnLock turn;
  turn.open();
  turn.lock();
  std::atomic<bool> entered{false};
  std::thread other([&] {
    std::lock_guard<TurnLock> guard(turn);
    entered = true;
  });
  std::this_thread::yield();
  EXPECT_FALSE(entered);
  turn.unlock();
  EXPECT_TRUE(eventually([&] { return entered.load(); }));
  other.join();
}

// A real-time side, a publishing thread and a third thread on one lock: it is exclusive, no message
// is lost or taken twice, and all threads finish. On a busy machine each turn takes ten
// milliseconds, for two changes of threads.
TEST(TurnLock, HandsEveryTurnOverOnceUnderContention) {
  constexpr int kTurns = 2000;
  TurnLock turn;
  turn.open();
  int message = 0;  // not atomic: only the lock protects it
  int inside = 0;
  int collisions = 0;
  int taken = 0;
  int wrong = 0;
  std::atomic<bool> done{false};
  // Long enough for a thread that does not wait to be seen.
  const auto occupy = [&] {
    collisions += inside++ != 0 ? 1 : 0;
    for (volatile int i = 0; i < 300; i = i + 1) {
    }
    --inside;
  };

  std::thread publisher([&] {
    while (taken < kTurns) {
      if (!turn.tryTakeTurn()) {
        std::this_thread::yield();
        continue;
      }
      occupy();
      ++taken;
      wrong += message != taken ? 1 : 0;
      turn.unlockAndReturn();
    }
  });
  std::thread bystander([&] {
    while (!done) {
      turn.lock();
      occupy();
      turn.unlock();
    }
  });
  int sent = 0;
  while (sent < kTurns) {
    if (turn.tryLock()) {
      occupy();
      message = ++sent;
      turn.unlockAndHandOver();
    } else {
      std::this_thread::yield();
    }
  }
  publisher.join();
  done = true;
  bystander.join();
  EXPECT_EQ(0, collisions);
  EXPECT_EQ(0, wrong);
  EXPECT_EQ(kTurns, taken);
}

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <realtime_tools/detail/publishing_schedule.h>

namespace {

using namespace std::chrono_literals;
using realtime_tools::detail::PublishingSchedule;
using Time = PublishingSchedule::Clock::time_point;

constexpr Time kStart{100s};

/// Looks of the thread until `end`, which finds the messages of a regular stream.
struct Result {
  int looks{0}, found{0};
  PublishingSchedule::Clock::duration latest{};  ///< from hand-over to look
};

Result follow(PublishingSchedule::Clock::duration interval, Time end) {
  PublishingSchedule schedule(kStart);
  Result result;
  Time due = kStart + 300us;
  for (Time now = kStart; now < end; now = schedule.next(now)) {
    ++result.looks;
    if (due <= now) {
      schedule.found(due);
      ++result.found;
      result.latest = std::max<PublishingSchedule::Clock::duration>(result.latest, now - due);
      while (due <= now) {  // trylock() refused those in between
        due += interval;
      }
    }
  }
  return result;
}

TEST(PublishingScheduleTest, LooksOncePerMessageOfAStream) {
  const Result result = follow(1ms, kStart + 1s);
  EXPECT_LE(999, result.found);
  EXPECT_LE(result.looks, result.found + 5);
  EXPECT_LE(result.latest, 1ms);
}

TEST(PublishingScheduleTest, FindsEachMessageOfSlowStreamsInTime) {
  for (const auto interval : {2500us, 10000us, 33000us}) {
    const Result result = follow(interval, kStart + 1s);
    EXPECT_LE(1s / interval - 1, result.found);  // the last one may be found later
    EXPECT_LE(result.latest, 5ms);
  }
}

TEST(PublishingScheduleTest, NeverLooksMoreOftenThanTwicePerMillisecond) {
  EXPECT_LE(follow(100us, kStart + 1s).looks, 2001);
}

TEST(PublishingScheduleTest, LooksEveryHalfMillisecondForALateMessage) {
  PublishingSchedule schedule(kStart);
  schedule.found(kStart + 1ms);
  schedule.found(kStart + 2ms);
  EXPECT_EQ(kStart + 3060us, schedule.next(kStart + 2100us));
  EXPECT_EQ(kStart + 3560us, schedule.next(kStart + 3060us));
}

TEST(PublishingScheduleTest, LooksEveryFiveMillisecondsAfterAPause) {
  PublishingSchedule schedule(kStart);
  schedule.found(kStart + 1ms);
  EXPECT_EQ(kStart + 51ms, schedule.next(kStart + 46ms));
  EXPECT_EQ(kStart + 10s + 5ms, schedule.next(kStart + 10s));
}

}  // namespace

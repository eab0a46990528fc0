// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_hw/response_times.h>
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace franka_hw {
namespace {

using std::chrono::microseconds;

/// Times on a clock that the test sets.
class Times : public testing::Test {
 protected:
  static ResponseTimes::Clock::time_point at(int us) {
    return ResponseTimes::Clock::time_point(std::chrono::hours(5) + microseconds(us));
  }
  /// A cycle of the robot's millisecond `ms`: its state arrives `delay` late and is answered
  /// `response` later.
  void cycle(unsigned ms, int delay, int response) {
    const int arrival = static_cast<int>(1000 * ms) + delay;
    times_.stateArrived(franka::Duration(ms), at(arrival));
    times_.commandReady(times_.lastArrival(), at(arrival + response));
  }

  ResponseTimes times_;
};

TEST_F(Times, AreZeroWithoutAMotion) {
  const ResponseTimes::Report report = times_.take();
  EXPECT_EQ(0u, report.cycles);
  EXPECT_EQ(0.0, report.mean);
  EXPECT_EQ(0.0, report.longest);
  EXPECT_EQ(0.0, report.spread);
}

TEST_F(Times, AreThoseOfTheCycles) {
  times_.motionBegins();
  cycle(10, 300, 100);
  cycle(11, 200, 150);
  cycle(12, 450, 350);
  cycle(13, 250, 900);  // not complete: another callback may still answer
  const ResponseTimes::Report report = times_.take();
  EXPECT_EQ(3u, report.cycles);
  EXPECT_NEAR(200e-6, report.mean, 1e-12);
  EXPECT_NEAR(350e-6, report.longest, 1e-12);
  EXPECT_NEAR(250e-6, report.spread, 1e-12);
}

TEST_F(Times, OfTheNextReportAreItsOwn) {
  times_.motionBegins();
  cycle(1, 0, 500);
  cycle(2, 900, 500);
  times_.take();
  EXPECT_EQ(0u, times_.take().cycles) << "nothing has happened since";
  cycle(3, 700, 20);  // completes the previous cycle
  cycle(4, 710, 30);
  cycle(5, 705, 40);
  const ResponseTimes::Report report = times_.take();
  EXPECT_EQ(3u, report.cycles);
  EXPECT_NEAR((500e-6 + 20e-6 + 30e-6) / 3.0, report.mean, 1e-12);
  EXPECT_NEAR(10e-6, report.spread, 1e-12) << "against the promptest of this report";
}

TEST_F(Times, OfTwoCallbacksAreThoseOfTheSecond) {
  times_.motionBegins();
  times_.stateArrived(franka::Duration(7), at(7000));
  times_.commandReady(times_.lastArrival(), at(7100));
  times_.stateArrived(franka::Duration(7), at(7100));
  times_.commandReady(times_.lastArrival(), at(7250));
  cycle(8, 0, 10);
  const ResponseTimes::Report report = times_.take();
  EXPECT_EQ(1u, report.cycles);
  EXPECT_NEAR(250e-6, report.longest, 1e-12);
  EXPECT_EQ(0.0, report.spread);
}

TEST_F(Times, OfAnotherMotionAreNotMeasuredAgainstThisOne) {
  times_.motionBegins();
  cycle(1, 100, 10);
  cycle(2, 180, 10);
  times_.motionBegins();  // the robot was restarted, and counts again; the last command is not
                          // counted
  cycle(1, 800000, 10);
  cycle(2, 800030, 10);
  const ResponseTimes::Report report = times_.take();
  EXPECT_EQ(2u, report.cycles);
  EXPECT_NEAR(80e-6, report.spread, 1e-12);
}

TEST_F(Times, LoseNothingBetweenTwoThreads) {
  constexpr unsigned kCycles = 200000;
  std::atomic_bool done{false};
  std::uint64_t counted = 0;
  double longest = 0.0;
  std::thread reads([&] {
    while (!done) {
      const ResponseTimes::Report report = times_.take();
      counted += report.cycles;
      longest = std::max(longest, report.longest);
      EXPECT_NEAR(report.cycles > 0 ? 1e-4 : 0.0, report.mean, 1e-12) << "one whole window";
    }
  });
  times_.motionBegins();
  for (unsigned i = 0; i < kCycles; i++) {
    cycle(i, 0, 100);
  }
  done = true;
  reads.join();
  const ResponseTimes::Report rest = times_.take();  // everything, if the reader started late
  counted += rest.cycles;
  longest = std::max(longest, rest.longest);
  // A cycle that ends while a report is being taken is in no report.
  EXPECT_LE(counted, kCycles);
  EXPECT_GT(counted, 0u);
  EXPECT_NEAR(1e-4, longest, 1e-12);
}

}  // namespace
}  // namespace franka_hw

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Compares one cycle of FrankaHW with a cycle without controllers and limits. Also measures the
// time from a switch to its first command at the robot. Needs a ROS master, for the parameters.
#include <benchmark/benchmark.h>
#include <rt_guard/rt_guard.h>

#include <algorithm>
#include <chrono>

#include "bare_cycle.h"

namespace {

franka_hw_test::BareCycle& robot() {
  static franka_hw_test::BareCycle robot;
  return robot;
}

void frankaHwCycle(benchmark::State& state) {
  robot().cycle();
  const rt_guard::Scope scope;
  for (auto _ : state) {
    benchmark::DoNotOptimize(robot().cycle());
  }
  state.counters["allocations"] = static_cast<double>(scope.allocations());
}

void emptyCycle(benchmark::State& state) {
  robot().emptyCycle();
  for (auto _ : state) {
    benchmark::DoNotOptimize(robot().emptyCycle());
  }
}

BENCHMARK(emptyCycle);
BENCHMARK(frankaHwCycle);

/// From the request of a switch to the command of the new controller at the robot.
void switchToFirstCommand(benchmark::State& state) {
  using Clock = std::chrono::steady_clock;
  franka_hw_test::FakeArm arm("fr3");
  franka_hw::FrankaHW robot;
  if (!robot.init(arm.nh, arm.robot_nh)) {
    state.SkipWithError("no robot");
    return;
  }
  franka_hw_test::Loop loop(robot, arm);
  loop.controller("JV").speed = 0.001;
  loop.controller("JP");
  loop.switchTo({"JP"}, {});
  std::vector<double> milliseconds;
  for (auto _ : state) {
    const auto begin = Clock::now();
    loop.switchTo({"JV"}, {"JP"});
    franka_hw_test::eventually([&] { return arm.robot.state().dq_d[0] == 0.001; },
                               std::chrono::microseconds(200));
    milliseconds.push_back(std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
    state.SetIterationTime(milliseconds.back() * 1e-3);
    loop.switchTo({"JP"}, {"JV"});
  }
  std::sort(milliseconds.begin(), milliseconds.end());
  state.counters["p50_ms"] = milliseconds[milliseconds.size() / 2];
  state.counters["max_ms"] = milliseconds.back();
}

BENCHMARK(switchToFirstCommand)->UseManualTime()->Iterations(200)->Unit(benchmark::kMillisecond);

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  ros::init(argc, argv, "franka_hw_bench");
  ros::NodeHandle keeps_ros_alive;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

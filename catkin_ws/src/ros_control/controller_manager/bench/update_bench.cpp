// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// One cycle of the manager with 1, 10 and 50 running controllers, with and without supervision,
// compared with the same number of bare virtual calls; and the duration of a switch beside a loop
// of 1 kHz. Needs a master for the controllers' parameters; prints the ratios itself.
#include <benchmark/benchmark.h>
#include <controller_manager/controller_manager.h>
#include <ros/ros.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <future>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "dummies.h"

namespace {

/// Does almost nothing, so that the manager's overhead is measured.
class EmptyController
    : public controller_interface::Controller<hardware_interface::EffortJointInterface> {
 public:
  void update(const ros::Time& /*time*/, const ros::Duration& /*period*/) override { ++updates_; }
  int updates_{0};
};

class EmptyLoader : public controller_manager::ControllerLoaderInterface {
 public:
  EmptyLoader() : ControllerLoaderInterface("EmptyController") {}
  controller_interface::ControllerBaseSharedPtr createInstance(const std::string&) override {
    return std::make_shared<EmptyController>();
  }
  std::vector<std::string> getDeclaredClasses() override { return {"bench/Empty"}; }
  void reload() override {}
};

/// A manager with `count` running controllers.
class Setup {
 public:
  explicit Setup(int count, bool watched = false)
      : nh_(std::string(watched ? "watched_" : "update_") + "bench_" + std::to_string(count)),
        manager_(&robot_, describe(nh_, watched)) {
    manager_.registerControllerLoader(std::make_shared<EmptyLoader>());
    std::vector<std::string> names;
    for (int i = 0; i < count; ++i) {
      names.push_back("c" + std::to_string(i));
      nh_.setParam(names.back() + "/type", "bench/Empty");
      if (!manager_.loadController(names.back())) {
        throw std::runtime_error("the benchmark's controllers could not be loaded");
      }
    }
    auto answer =
        std::async(std::launch::async, [&] { return manager_.switchController(names, {}, 2); });
    while (answer.wait_for(std::chrono::microseconds(100)) != std::future_status::ready) {
      manager_.update(time_, period_);
    }
    for (const std::string& name : names) {
      bare_.push_back(manager_.getControllerByName(name));
    }
  }

  controller_manager::ControllerManager& manager() { return manager_; }

  void update() { manager_.update(time_, period_); }
  void callBare() {
    for (controller_interface::ControllerBase* controller : bare_) {
      controller->update(time_, period_);
    }
  }

 private:
  static const ros::NodeHandle& describe(const ros::NodeHandle& nh, bool watched) {
    nh.setParam("controller_manager/abort_faulty_controllers", watched);
    nh.setParam("controller_manager/statistics_rate", watched ? 1.0 : 0.0);
    return nh;
  }

  ros::NodeHandle nh_;
  dummies::DummyRobot robot_;
  controller_manager::ControllerManager manager_;
  std::vector<controller_interface::ControllerBase*> bare_;
  const ros::Time time_{1.0};
  const ros::Duration period_{0.001};
};

Setup& setupOf(int count) {
  static std::map<int, std::unique_ptr<Setup>> setups;
  std::unique_ptr<Setup>& setup = setups[count];
  if (!setup) {
    setup = std::make_unique<Setup>(count);
  }
  return *setup;
}

void virtualCalls(benchmark::State& state) {
  Setup& setup = setupOf(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    setup.callBare();
    benchmark::ClobberMemory();
  }
}

void managerUpdate(benchmark::State& state) {
  Setup& setup = setupOf(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    setup.update();
    benchmark::ClobberMemory();
  }
}

BENCHMARK(virtualCalls)->Arg(1)->Arg(10)->Arg(50);
BENCHMARK(managerUpdate)->Arg(1)->Arg(10)->Arg(50);

/// [ns] of the fastest of a few batches.
template <class Action>
double nanoseconds(Action action) {
  double best = 1e9;
  for (int batch = 0; batch < 20; ++batch) {
    constexpr int kCalls = 20000;
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < kCalls; ++i) {
      action();
      benchmark::ClobberMemory();
    }
    const std::chrono::duration<double, std::nano> elapsed =
        std::chrono::steady_clock::now() - begin;
    best = std::min(best, elapsed.count() / kCalls);
  }
  return best;
}

/// Starts and stops one of two controllers beside a loop of 1 kHz and prints the quantiles.
void measureSwitches() {
  Setup setup(2);
  std::atomic<bool> ended{false};
  std::thread loop([&] {
    auto next = std::chrono::steady_clock::now();
    while (!ended) {
      setup.update();
      next += std::chrono::milliseconds(1);
      std::this_thread::sleep_until(next);
    }
  });
  std::vector<double> milliseconds;
  for (int i = 0; i < 2000; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    const std::vector<std::string> one{"c1"};
    const std::vector<std::string> none;
    if (!setup.manager().switchController(i % 2 == 0 ? none : one, i % 2 == 0 ? one : none, 2)) {
      std::printf("a switch failed\n");
    }
    milliseconds.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
            .count());
  }
  ended = true;
  loop.join();
  std::sort(milliseconds.begin(), milliseconds.end());
  const auto quantile = [&](double q) {
    return milliseconds[static_cast<std::size_t>(q * (milliseconds.size() - 1))];
  };
  std::printf(
      "a switch beside a loop of 1 kHz: median %.2f ms, p99 %.2f ms, most %.2f ms; p99 in periods "
      "of the loop %.2f\n",
      quantile(0.5), quantile(0.99), quantile(1.0), quantile(0.99) / 1.0);
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  ros::init(argc, argv, "controller_manager_update_bench");
  ros::NodeHandle keeps_ros_alive;
  benchmark::RunSpecifiedBenchmarks();
  for (const int count : {1, 10, 50}) {
    Setup& setup = setupOf(count);
    const double bare = nanoseconds([&] { setup.callBare(); });
    const double update = nanoseconds([&] { setup.update(); });
    std::printf(
        "controller_manager update, %d controllers: %.1f ns, virtual calls: %.1f ns, "
        "ratio %.2f\n",
        count, update, bare, update / bare);
    Setup watched(count, true);
    const double watching = nanoseconds([&] { watched.update(); });
    std::printf(
        "controller_manager update under watch, %d controllers: %.1f ns, of that each controller "
        "%.1f ns, ratio %.2f\n",
        count, watching, watching / count, watching / bare);
  }
  measureSwitches();
  return 0;
}

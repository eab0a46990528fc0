// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// RealtimePublisher at 1 kHz on ten topics: nanoseconds of the real-time side per topic, compared
// with an empty virtual call, and the CPU time of the whole process, while nobody subscribes and
// with a program that subscribes to all. Needs a ROS master.
#include <benchmark/benchmark.h>
#include <realtime_tools/realtime_publisher.h>
#include <ros/ros.h>
#include <std_msgs/Float64.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <ctime>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace {

constexpr int kTopics = 10;
constexpr int kTicks = 2000;
constexpr std::chrono::milliseconds kTick(1);

class Callee {
 public:
  virtual ~Callee() = default;
  virtual void call() {}
};

double seconds(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

void virtualCalls(benchmark::State& state) {
  std::unique_ptr<Callee> callee = std::make_unique<Callee>();
  benchmark::DoNotOptimize(callee);
  for (auto _ : state) {
    for (int i = 0; i < kTopics; ++i) {
      callee->call();
      benchmark::ClobberMemory();
    }
  }
}

std::string topic(int i) { return "bench_" + std::to_string(i); }

void drop(const std_msgs::Float64::ConstPtr& /*message*/) {}

/// A child process that subscribes to all topics and drops their messages.
class Subscribers {
 public:
  /// Forks: before this process has threads.
  Subscribers() : child_(fork()) {
    if (child_ != 0) {
      return;
    }
    int argc = 0;
    ros::init(argc, nullptr, "subscribers", ros::init_options::AnonymousName);
    ros::NodeHandle node;
    std::vector<ros::Subscriber> subscribers;
    for (int i = 0; i < kTopics; ++i) {
      subscribers.push_back(node.subscribe("subscribed/" + topic(i), 1, &drop));
    }
    ros::spin();
    _exit(0);
  }
  ~Subscribers() {
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
  }
  Subscribers(const Subscribers&) = delete;
  Subscribers& operator=(const Subscribers&) = delete;

 private:
  pid_t child_;
};

/// Two seconds of a 1 kHz loop; the measured time is that of the publishing calls of one tick.
/// Counters: cpu_percent of all threads of the process, and the share of messages accepted.
void publish(benchmark::State& state, const std::string& name_space) {
  typedef realtime_tools::RealtimePublisher<std_msgs::Float64> Publisher;
  ros::NodeHandle node(name_space);
  std::vector<std::unique_ptr<Publisher>> publishers;
  for (int i = 0; i < kTopics; ++i) {
    publishers.push_back(std::make_unique<Publisher>(node, topic(i), 1));
  }
  std::this_thread::sleep_for(std::chrono::seconds(1));  // until subscribers are connected
  int accepted = 0;
  int asked = 0;
  const double cpu_begin = seconds(CLOCK_PROCESS_CPUTIME_ID);
  const double begin = seconds(CLOCK_MONOTONIC);
  auto tick = std::chrono::steady_clock::now();
  for (auto _ : state) {
    tick += kTick;
    std::this_thread::sleep_until(tick);
    const double before = seconds(CLOCK_MONOTONIC);
    for (const auto& publisher : publishers) {
      ++asked;
      if (publisher->trylock()) {
        publisher->msg_.data += 1.0;
        publisher->unlockAndPublish();
        ++accepted;
      }
    }
    state.SetIterationTime(seconds(CLOCK_MONOTONIC) - before);
  }
  state.counters["cpu_percent"] =
      100.0 * (seconds(CLOCK_PROCESS_CPUTIME_ID) - cpu_begin) / (seconds(CLOCK_MONOTONIC) - begin);
  state.counters["accepted_percent"] = 100.0 * accepted / asked;
}

void publishTick(benchmark::State& state) { publish(state, ""); }
void publishToSubscribers(benchmark::State& state) { publish(state, "subscribed"); }

/// The loop alone, without publishing: cost of a thread that wakes up a thousand times a second.
void bareLoop(benchmark::State& state) {
  const double cpu_begin = seconds(CLOCK_PROCESS_CPUTIME_ID);
  const double begin = seconds(CLOCK_MONOTONIC);
  auto tick = std::chrono::steady_clock::now();
  for (auto _ : state) {
    tick += kTick;
    std::this_thread::sleep_until(tick);
    state.SetIterationTime(1e-9);
  }
  state.counters["cpu_percent"] =
      100.0 * (seconds(CLOCK_PROCESS_CPUTIME_ID) - cpu_begin) / (seconds(CLOCK_MONOTONIC) - begin);
}

BENCHMARK(virtualCalls);
BENCHMARK(bareLoop)->Iterations(kTicks)->UseManualTime();
BENCHMARK(publishTick)->Iterations(kTicks)->UseManualTime();
BENCHMARK(publishToSubscribers)->Iterations(kTicks)->UseManualTime();

}  // namespace

int main(int argc, char** argv) {
  const Subscribers subscribers;
  ros::init(argc, argv, "realtime_publisher_bench", ros::init_options::AnonymousName);
  ros::NodeHandle keeps_ros_alive;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
    return 1;
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Four threads load, unload, switch, restart and list controllers while the loop runs at 1 kHz and
// halts from time to time. tsan.sh builds it with ThreadSanitizer; otherwise only the counts are
// checked.
#include <controller_manager/controller_manager.h>
#include <gtest/gtest.h>
#include <ros/ros.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "dummies.h"

namespace {

constexpr int kThreads = 4;
constexpr int kStrict = 2;
constexpr int kBestEffort = 1;

int operations() {
  const char* const asked = std::getenv("STRESS_OPERATIONS");
  return asked == nullptr ? 10000 : std::stoi(asked);
}

/// One of four users, with its own controller and joint, whose state only it changes, so that every
/// result is predictable. All of them also use one shared controller.
class User {
 public:
  User(controller_manager::ControllerManager& manager, int number)
      : manager_(manager), own_("own" + std::to_string(number)), random_(number) {}

  void act() {
    switch (random_() % 8) {
      case 0:
        expect(!loaded_, manager_.loadController(own_), "load");
        loaded_ = true;
        break;
      case 1:
        expect(loaded_ && !running_, manager_.unloadController(own_), "unload");
        loaded_ = loaded_ && running_;
        break;
      case 2:
        expect(loaded_ && !running_, manager_.switchController({own_}, {}, kStrict), "start");
        running_ = loaded_;
        break;
      case 3:
        expect(running_, manager_.switchController({}, {own_}, kStrict), "stop");
        running_ = false;
        break;
      case 4:
        expect(true, manager_.switchController({own_}, {own_}, kBestEffort, true), "restart");
        running_ = loaded_;
        break;
      case 5:
        manager_.switchController({"shared"}, {}, kBestEffort, false, 0.002);
        break;
      case 6:
        manager_.loadController("shared") || manager_.unloadController("shared");
        break;
      default:
        look();
        break;
    }
  }

  int failures() const { return failures_; }

 private:
  void look() {
    bool loaded = false;
    bool running = false;
    for (const controller_manager::ControllerSpec& spec : manager_.getControllers()) {
      if (spec.info.name == own_) {
        loaded = true;
        running = spec.c->isRunning();
      }
    }
    expect(loaded_, loaded, "look at");
    expect(running_, running, "look whether there runs");
  }
  void expect(bool predicted, bool answer, const char* action) {
    if (predicted != answer) {
      ++failures_;
      ADD_FAILURE() << "to " << action << " " << own_ << " gave " << answer;
    }
  }

  controller_manager::ControllerManager& manager_;
  const std::string own_;
  std::mt19937 random_;
  bool loaded_{false}, running_{false};
  int failures_{0};
};

/// Calls update every millisecond, and pauses for 20 ms every quarter of a second.
void runLoop(controller_manager::ControllerManager& manager, const std::atomic<bool>& ended,
             std::atomic<int>& cycles) {
  const ros::Duration period(0.001);
  ros::Time time(1.0);
  auto next = std::chrono::steady_clock::now();
  while (!ended) {
    time += period;
    manager.update(time, period, cycles % 101 == 0);
    ++cycles;
    next += std::chrono::milliseconds(cycles % 250 == 0 ? 20 : 1);
    std::this_thread::sleep_until(next);  // the loop's period
  }
}

}  // namespace

TEST(Stress, FourThreadsBesideTheLoop) {
  ros::NodeHandle nh("stress");
  for (int i = 0; i < kThreads; ++i) {
    const std::string name = "own" + std::to_string(i);
    nh.setParam(name + "/type", "dummy/Good");
    nh.setParam(name + "/joints", std::vector<std::string>{"j" + std::to_string(i)});
  }
  nh.setParam("shared/type", "dummy/Good");
  nh.setParam("shared/joints", std::vector<std::string>{"j" + std::to_string(kThreads)});
  nh.setParam("controller_manager/abort_faulty_controllers", true);
  nh.setParam("controller_manager/statistics_rate", 10.0);

  dummies::DummyRobot robot(kThreads + 1);
  {
    controller_manager::ControllerManager manager(&robot, nh);
    manager.registerControllerLoader(std::make_shared<dummies::DummyLoader>());

    std::atomic<bool> ended{false};
    std::atomic<int> cycles{0};
    std::thread loop([&] { runLoop(manager, ended, cycles); });
    std::atomic<int> done{0};
    std::atomic<int> failures{0};
    std::vector<std::thread> users;
    const int asked = operations();
    for (int i = 0; i < kThreads; ++i) {
      users.emplace_back([&, i] {
        User user(manager, i);
        while (done++ < asked) {
          user.act();
        }
        failures += user.failures();
      });
    }
    for (std::thread& user : users) {
      user.join();
    }
    ended = true;
    loop.join();
    std::printf("%d operations, %d failures, %d cycles, %d switches\n", asked, failures.load(),
                cycles.load(), robot.switches_.load());
    EXPECT_EQ(0, failures);
    EXPECT_GT(robot.switches_, asked / 20);
    EXPECT_LE(static_cast<std::size_t>(dummies::DummyController::living()),
              manager.getControllers().size());
  }
  EXPECT_EQ(0, dummies::DummyController::living());
}

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "controller_manager_stress");
  // Thousands of refusals are expected; and a mutex inside one of Debian's libraries guards the
  // log's buffer, which ThreadSanitizer cannot see.
  if (ros::console::set_logger_level(ROSCONSOLE_DEFAULT_NAME, ros::console::levels::Fatal)) {
    ros::console::notifyLoggerLevelsChanged();
  }
  ros::NodeHandle keeps_ros_alive;
  return RUN_ALL_TESTS();
}

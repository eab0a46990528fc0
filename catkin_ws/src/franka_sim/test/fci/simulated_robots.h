// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/robot.h>
#include <franka_sim/serve/host.h>
#include <franka_sim/serve/sim_robot.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "../physics/test_support.h"
#include "fci/robot_server.h"

namespace franka_sim::fci {

struct Place {
  std::uint16_t version;  // 3 to 5: a Panda, else an FR3
  double x{0.0};          // [m]
};

/// Runs jobs between two ticks.
class Jobs final : public Service {
 public:
  void serve() override {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (std::packaged_task<void()>& job : due_) {
      job();
    }
    due_.clear();
  }
  void addDescriptors(std::vector<pollfd>& /*fds*/) const override {}
  void run(std::function<void()> job) {
    std::packaged_task<void()> task(std::move(job));
    std::future<void> done = task.get_future();
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      due_.push_back(std::move(task));
    }
    done.get();
  }

 private:
  std::mutex mutex_;
  std::vector<std::packaged_task<void()>> due_;
};

/// Robots in one world, one protocol version each, in lock-step in its own thread.
class SimulatedRobots {
 public:
  explicit SimulatedRobots(const std::vector<Place>& places,
                           std::chrono::milliseconds patience = Pace{}.patience)
      : host_(
            [this] {
              std::this_thread::sleep_for(hold_up_.exchange({}));  // the fault itself
              world_.step();
            },
            lockStep(patience)) {
    for (const Place& place : places) {
      add(place);
    }
    host_.add(jobs_);
    thread_ = std::thread([this] { host_.run(stop_); });
  }
  ~SimulatedRobots() { finish(); }
  void finish() {
    stop_ = true;
    if (thread_.joinable()) {
      thread_.join();
    }
  }

  /// Nothing runs for this time, as on a busy machine.
  void holdUp(std::chrono::milliseconds time) { hold_up_ = time; }
  std::uint16_t port(std::size_t robot = 0) const { return robots_[robot]->server().port(); }
  std::uint16_t gripperPort(std::size_t robot = 0) const { return robots_[robot]->gripperPort(); }
  std::string address(std::size_t robot = 0) const {
    return "127.0.0.1:" + std::to_string(port(robot));
  }
  std::string gripperAddress(std::size_t robot = 0) const {
    return "127.0.0.1:" + std::to_string(gripperPort(robot));
  }
  /// Of the first robot. Call only after finish().
  std::uint64_t hash() const { return robots_[0]->hash(); }

  /// Runs a job with the first robot on the host's thread between two ticks and waits for it.
  void between(const std::function<void(SimRobot&, World&, Host&)>& job) {
    jobs_.run([&] { job(*robots_[0], world_, host_); });
  }

 private:
  static Pace lockStep(std::chrono::milliseconds patience) {
    Pace pace;
    pace.mode = PaceMode::kLockStep;
    pace.patience = patience;
    return pace;
  }

  void add(const Place& place) {
    const std::string name = place.version <= 5 ? "panda" : "fr3";
    ControlUnitParameters unit{franka_core::ArmModel::fromUrdf(test::urdfOf(name), name)};
    RobotDescription description;
    description.name = name;
    description.urdf = test::urdfOf(name);
    description.resolve = [](const std::string&) { return std::string(); };
    description.base.position = {place.x, 0, 0};
    setInitialPositions(kReadyPose, name, description);
    applyPhysics(RobotPhysics{}, name, description);
    unit.end_effector = franka_core::endEffectorFromUrdf(description.urdf, name);
    unit.rules = InterfaceRules::kFci;
    unit.protocol_version = place.version;
    world_.addRobot(description);
    RobotServerParameters server =
        makeServerParameters("127.0.0.1", {place.version, place.version}, unit.model);
    server.port = 0;
    SimRobot::Hand hand{&world_.hand(name, name), {}, 0};
    hand.parameters.gains = {FingerGains{100, 0, 1}, FingerGains{100, 0, 1}};
    robots_.push_back(std::make_unique<SimRobot>(unit, world_.arm(name, name), server, hand));
    host_.add(*robots_.back());
  }

  World world_;
  std::vector<std::unique_ptr<SimRobot>> robots_;
  Host host_;
  Jobs jobs_;
  std::atomic<bool> stop_{false};
  std::atomic<std::chrono::milliseconds> hold_up_{std::chrono::milliseconds(0)};
  std::thread thread_;
};

// From rest to rest within a second: position along a path of length one, and its speed.
constexpr double kDuration = 1.0;  // [s]
inline double way(double t) {
  const double s = std::min(t / kDuration, 1.0);
  return s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
}
inline double speed(double t) {
  const double s = std::min(t / kDuration, 1.0);
  return 30.0 * s * s * (1.0 - s) * (1.0 - s) / kDuration;
}

/// Moves joint 4 by an angle.
inline void swing(
    franka::Robot& robot, double angle, const std::function<void(int)>& in_cycle = [](int) {}) {
  double time = 0.0;
  int cycle = 0;
  std::array<double, 7> begin{};
  robot.control([&](const franka::RobotState& state, franka::Duration period) {
    if (time == 0.0) {
      begin = state.q_d;
    }
    time += period.toSec();
    in_cycle(cycle++);
    franka::JointPositions positions(begin);
    positions.q[3] += angle * way(time);
    return time >= kDuration + 0.2 ? franka::MotionFinished(positions) : positions;
  });
}

}  // namespace franka_sim::fci

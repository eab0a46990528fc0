// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "simulation.h"

#include <franka_sim/physics/world.h>
#include <franka_sim/physics/world_cameras.h>
#include <franka_sim/physics/world_gravity.h>
#include <realtime_tools/realtime_publisher.h>
#include <ros/console.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "resources.h"
#include "service_handlers.h"
#include "shutdown_request.h"

namespace franka_sim_mujoco {

namespace {

constexpr std::uint32_t kTickNanoseconds = 1000000;
constexpr std::chrono::milliseconds kServedIdleSleep{1};  ///< if clients wait
constexpr std::chrono::milliseconds kIdleSleep{20};
/// While time waits for a robot that comes or goes, clients see so often that the others are there
/// (chosen here: they give up after a second, and what an idle one receives in lock-step hardly
/// depends on it).
constexpr std::chrono::milliseconds kHeldSleep{300};
constexpr std::uint32_t kTicksBetweenChecks = 1000;  ///< of bare ticks, whether to go on

/// @param what for example "A step"
void requireAtMost(std::uint32_t most, std::uint32_t ticks, const std::string& what) {
  if (ticks > most) {
    throw std::runtime_error(what + " has at most " + std::to_string(most) + " ticks, not " +
                             std::to_string(ticks) + ": make several.");
  }
}

/// The time for reading a thread's clock, which is a tenth of a tick [us].
double microsecondsOfAReading() noexcept {
  constexpr int kReadings = 1000;
  const std::int64_t start = threadNanoseconds();
  for (int i = 1; i < kReadings; ++i) {
    threadNanoseconds();
  }
  return 1e-3 * static_cast<double>(threadNanoseconds() - start) / kReadings;
}

}  // namespace

Simulation::Simulation(const SimulationOptions& options, ros::NodeHandle& node)
    : world_(options.world_file, resolveUri),
      clock_(node),
      host_([this] { advance(); }, paceOf(options.real_time_factor)),
      pace_(options.real_time_factor, options.clock_rate, host_, world_, clock_),
      robots_(
          requests_, world_, host_, [this] { reset(); },
          [this] { return pace_.factor() > 0.0 && steps_left_ == 0; }),
      paused_(options.paused) {
  reportWarnings(world_);
}

Simulation::~Simulation() { stop(); }

void Simulation::start() {
  thread_ = std::thread([this] { loop(); });
}

void Simulation::stop() {
  stop_ = true;
  if (thread_.joinable()) {
    thread_.join();
  }
  robots_.leaveHost();
  requests_.close();
}

void Simulation::loop() {
  requests_.adopt();
  host_.restartClock();
  try {
    while (!stop_) {
      requests_.serve();
      pace_.review(robots_.isStarting());
      short_sleeps_.sleepIfDue();
      if (robots_.holdsTime()) {
        holdTime();
        continue;
      }
      shown_at_.reset();
      if (paused_ && steps_left_ == 0) {
        standStill();
        continue;
      }
      if (steps_left_ > 0) {
        host_.tickAtOnce();
        finishStepping();
      } else {
        host_.tick();
      }
    }
  } catch (...) {
    ROS_FATAL_NAMED(kLog, "The simulation ends because a tick failed: %s", exceptionText().c_str());
    failed_ = true;
    requestShutdown();
  }
  requests_.close();
  stepped_.reset();
}

void Simulation::publishNow() {
  clock_.standStill(time());
  robots_.publishNow(time());
}

void Simulation::standStill() {
  clock_.standStill(time());
  requests_.waitForWork(host_.empty() ? kIdleSleep : kServedIdleSleep);
  host_.standStill();
}

void Simulation::holdTime() {
  clock_.standStill(time());
  shown_at_ = shown_at_.value_or(Clock::now());
  const auto rest = std::max(Clock::duration::zero(), *shown_at_ + kHeldSleep - Clock::now());
  requests_.waitForWork(std::chrono::ceil<std::chrono::milliseconds>(rest));
  if (Clock::now() >= *shown_at_ + kHeldSleep) {
    host_.standStill();
    shown_at_ = Clock::now();
  }
}

void Simulation::advance() {
  const ros::Time now = time();
  world_.prepareBeside();
  robots_.tick(now, timing_ ? &times_ : nullptr);
  world_.step();
  watchWorld();
  ++tick_count_;
  clock_.tick(time());
  realtime_tools::publishPending();
}

void Simulation::watchWorld() {
  reportWarnings(world_);
  if (!world_.stopped() || paused_by_fault_) {
    return;
  }
  ROS_ERROR_NAMED(kLog, "%s The simulation is paused: call the service %s.", world_.fault().c_str(),
                  ros::names::resolve("~reset").c_str());
  paused_by_fault_ = !paused_;
  paused_ = true;
  robots_.halt();
}

void Simulation::requireRunningWorld() const {
  if (world_.stopped()) {
    throw std::runtime_error(world_.fault());
  }
}

void Simulation::finishStepping() {
  if (world_.stopped()) {
    finishStepping(std::make_exception_ptr(std::runtime_error(world_.fault())));
  } else if (--steps_left_ == 0) {
    publishNow();
    stepped_->set_value(stateNow());
    stepped_.reset();
  }
}

void Simulation::finishStepping(std::exception_ptr error) {
  steps_left_ = 0;
  publishNow();
  stepped_->set_exception(std::move(error));
  stepped_.reset();
}

ros::Time Simulation::time() const {
  ros::Time time;
  return time.fromNSec((tick_count_ + 1) * kTickNanoseconds);
}

SimulationState Simulation::stateNow() const {
  return SimulationState{tick_count_, time(), world_.stateHash()};
}

void Simulation::setPaused(bool paused) {
  ++cancels_;
  requests_.run([&] {
    if (!paused) {
      requireRunningWorld();
    }
    if (steps_left_ > 0) {
      finishStepping(std::make_exception_ptr(std::runtime_error(
          std::string("The simulation was ") + (paused ? "paused" : "unpaused") + " with " +
          std::to_string(steps_left_) + " ticks of this step left.")));
    }
    if (paused && !paused_) {
      publishNow();
    }
    paused_ = paused;
  });
}

void Simulation::setRealTimeFactor(double factor) {
  requests_.run([&] { pace_.setFactor(factor); });
}

SimulationState Simulation::step(std::uint32_t ticks) {
  if (ticks == 0) {
    return state();
  }
  requireAtMost(kMaxSteps, ticks, "A step");
  std::future<SimulationState> done;
  requests_.run([&] {
    if (!paused_) {
      throw std::runtime_error("The simulation runs by itself: pause it before stepping it.");
    }
    if (steps_left_ > 0) {
      throw std::runtime_error(
          "An earlier request is still stepping the simulation: wait for its end.");
    }
    requireRunningWorld();
    stepped_.emplace();
    done = stepped_->get_future();
    steps_left_ = ticks;
  });
  try {
    return done.get();
  } catch (const std::future_error&) {
    throw std::runtime_error("The simulation ended while it was stepped.");
  }
}

SimulationState Simulation::state() {
  SimulationState state;
  requests_.run([&] { state = stateNow(); });
  return state;
}

void Simulation::reset() {
  requests_.run([&] {
    robots_.requireRest();
    world_.reset();
    worldWasReset();
  });
}

void Simulation::worldWasReset() {
  robots_.worldWasReset();
  if (std::exchange(paused_by_fault_, false)) {
    paused_ = false;
  }
}

SimulationInventory Simulation::inventory() {
  SimulationInventory result;
  requests_.run([&] {
    result.robots = world_.robots();
    result.objects = world_.objects();
    result.bodies = world_.bodies();
    result.joints = world_.joints();
    for (const franka_sim::WorldCamera& camera : cameras(world_)) {
      result.cameras.push_back(camera.name);
    }
    result.gravity = gravity(world_);
    result.paused = paused_;
    result.real_time_factor = pace_.factor();
  });
  return result;
}

std::uint64_t Simulation::takeSnapshot(const std::string& name) {
  std::uint64_t hash = 0;
  requests_.run([&] {
    if (snapshots_.count(name) == 0 && snapshots_.size() >= kMaxSnapshots) {
      throw std::runtime_error("There are " + std::to_string(kMaxSnapshots) +
                               " snapshots already: take this one under the name of an older one.");
    }
    snapshots_[name] = world_.snapshot();
    hash = world_.stateHash();
    host_.restartClock();
  });
  return hash;
}

std::uint64_t Simulation::restoreSnapshot(const std::string& name) {
  std::uint64_t hash = 0;
  requests_.run([&] {
    const auto found = snapshots_.find(name);
    if (found == snapshots_.end()) {
      throw std::runtime_error("There is no snapshot named '" + name + "'.");
    }
    robots_.requireRest();
    world_.restore(found->second);
    worldWasReset();
    hash = world_.stateHash();
  });
  return hash;
}

void Simulation::withWorld(const std::function<void(franka_sim::World&)>& work) {
  requests_.run([&] { work(world_); });
}

void Simulation::requireUncancelled() const {
  if (stop_ || cancels_ != benchmark_cancels_) {
    throw std::runtime_error(
        "The benchmark was ended: the simulation is shutting down, or was paused or unpaused.");
  }
}

double Simulation::timeTicks(std::uint32_t ticks) {
  const std::int64_t start = threadNanoseconds();
  for (std::uint32_t i = 0; i < ticks; ++i) {
    requireUncancelled();
    host_.tickAtOnce();
  }
  return 1e-3 * static_cast<double>(threadNanoseconds() - start) / ticks;
}

double Simulation::timeBareTicks(std::uint32_t ticks) {
  double sum = 0.0;
  for (std::uint32_t done = 0; done < ticks; done += kTicksBetweenChecks) {
    requireUncancelled();
    const std::uint32_t part = std::min(kTicksBetweenChecks, ticks - done);
    sum += part * franka_sim::bareTickMicroseconds(world_, part);
  }
  return sum / ticks;
}

Simulation::Benchmark Simulation::benchmark(std::uint32_t ticks) {
  if (ticks == 0) {
    throw std::runtime_error("A benchmark needs at least one tick.");
  }
  requireAtMost(kMaxBenchmarkTicks, ticks, "A benchmark");
  Benchmark result;
  requests_.run([&] {
    benchmark_cancels_ = cancels_;
    try {
      result = measure(ticks);
    } catch (...) {
      timing_ = false;
      host_.restartClock();
      throw;
    }
    host_.restartClock();
  });
  return result;
}

Simulation::Benchmark Simulation::measure(std::uint32_t ticks) {
  Benchmark result;
  result.tick = timeTicks(ticks);
  times_ = TickTimes();
  timing_ = true;
  timeTicks(ticks);
  timing_ = false;
  const double clock = microsecondsOfAReading() * static_cast<double>(robots_.size());
  const auto part = [&](std::int64_t sum) {
    return std::max(0.0, 1e-3 * static_cast<double>(sum) / ticks - clock);
  };
  result.read = part(times_.read);
  result.update = part(times_.update);
  result.write = part(times_.write);
  result.physics = result.tick - result.read - result.update - result.write;
  result.bare = timeBareTicks(ticks);
  return result;
}

}  // namespace franka_sim_mujoco

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim_mujoco/physics/bare_steps.h>
#include <franka_sim_mujoco/ros/simulation.h>
#include <ros/console.h>
#include <ros/init.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace franka_sim_mujoco {

namespace {

constexpr char kLog[] = "franka_sim_mujoco";
constexpr std::uint32_t kTickNanoseconds = 1000000;
constexpr std::chrono::milliseconds kStandStillNap{20};
/// Compiling a world with several robots takes seconds on a slow machine.
constexpr std::chrono::milliseconds kSpawnTimeout{60000};

}  // namespace

Simulation::Simulation(const SimulationOptions& options, ros::NodeHandle& node)
    : loader_("franka_sim_mujoco", "franka_sim_mujoco::RobotHWSim"),
      world_(options.world_file, resolveUri),
      clock_(node),
      paused_(options.paused) {
  if (!pacer_.setFactor(options.real_time_factor)) {
    throw std::runtime_error("The real time factor " + std::to_string(options.real_time_factor) +
                             " is wrong: it must be 0 (as fast as possible) or at least " +
                             std::to_string(Pacer::kSlowest) + ".");
  }
  const std::string unsupported = world_.unsupported();
  if (!unsupported.empty()) {
    ROS_WARN_NAMED(kLog, "%s", unsupported.c_str());
  }
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
  requests_.close();
}

void Simulation::loop() {
  requests_.adopt();
  pacer_.restart();
  try {
    while (!stop_) {
      requests_.serve();
      if (paused_ && steps_left_ == 0) {
        standStill();
        continue;
      }
      tick(nullptr);
      if (steps_left_ > 0) {
        finishStepping();
      } else {
        pacer_.waitForNextTick();
      }
    }
  } catch (const std::exception& error) {
    ROS_FATAL_NAMED(kLog, "The simulation ends because a tick failed: %s", error.what());
    failed_ = true;
    ros::requestShutdown();
  }
  requests_.close();
  stepped_.reset();
}

void Simulation::standStill() {
  clock_.standStill(time());
  requests_.waitForWork(kStandStillNap);
  pacer_.restart();
}

void Simulation::tick(TickTimes* times) {
  const ros::Time now = time();
  for (const auto& robot : robots_) {
    robot->tick(now, times);
  }
  world_.step();
  ++tick_count_;
  clock_.tick(time());
}

void Simulation::finishStepping() {
  if (--steps_left_ == 0) {
    clock_.standStill(time());
    stepped_->set_value(stateNow());
    stepped_.reset();
  }
}

ros::Time Simulation::time() const {
  ros::Time time;
  return time.fromNSec((tick_count_ + 1) * kTickNanoseconds);
}

SimulationState Simulation::stateNow() const {
  return SimulationState{tick_count_, time(), world_.stateHash()};
}

void Simulation::setPaused(bool paused) {
  requests_.run([&] { paused_ = paused; });
}

void Simulation::setRealTimeFactor(double factor) {
  requests_.run([&] {
    if (!pacer_.setFactor(factor)) {
      throw std::runtime_error("The real time factor " + std::to_string(factor) +
                               " is wrong: it must be 0 (as fast as possible) or at least " +
                               std::to_string(Pacer::kSlowest) + "; it stays " +
                               std::to_string(pacer_.factor()) + ".");
    }
  });
}

SimulationState Simulation::step(std::uint32_t ticks) {
  if (ticks == 0) {
    return state();
  }
  std::future<SimulationState> done;
  requests_.run([&] {
    if (!paused_) {
      throw std::runtime_error("The simulation runs by itself: pause it before stepping it.");
    }
    if (steps_left_ > 0) {
      throw std::runtime_error(
          "An earlier request is still stepping the simulation: wait for its end.");
    }
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
    world_.reset();
    for (const auto& robot : robots_) {
      robot->worldWasReset();
    }
  });
}

RobotInstance* Simulation::find(const std::string& name) {
  for (const auto& robot : robots_) {
    if (robot->name() == name) {
      return robot.get();
    }
  }
  return nullptr;
}

void Simulation::spawn(const SpawnOrder& order) {
  const RobotPlan plan = planRobot(order);
  requests_.run(
      [&] {
        if (find(order.name) != nullptr) {
          throw std::runtime_error("There already is a robot named '" + order.name +
                                   "': choose another name or delete that one first.");
        }
        const BetweenTicks between_ticks = [this](const std::function<void()>& work) {
          requests_.run(work);
        };
        robots_.push_back(std::make_unique<RobotInstance>(plan, world_, loader_, between_ticks));
        pacer_.restart();
      },
      kSpawnTimeout);
}

void Simulation::remove(const std::string& name) {
  std::unique_ptr<RobotInstance> removed;
  requests_.run([&] {
    const auto robot = std::find_if(robots_.begin(), robots_.end(), [&](const auto& candidate) {
      return candidate->name() == name;
    });
    if (robot == robots_.end()) {
      throw std::runtime_error("There is no robot named '" + name + "'.");
    }
    removed = std::move(*robot);
    robots_.erase(robot);
    world_.removeRobot(name);
    pacer_.restart();
  });
  // Its action servers and services may wait for their threads: not in the stepping thread.
  removed.reset();
}

std::string Simulation::spawnObject(const std::string& name, const std::string& text,
                                    const Pose& pose) {
  std::string unsupported;
  requests_.run(
      [&] {
        world_.addObject(name, text, pose);
        unsupported = world_.unsupported(name);
        pacer_.restart();
      },
      kSpawnTimeout);
  return unsupported;
}

void Simulation::removeObject(const std::string& name) {
  requests_.run([&] {
    world_.removeObject(name);
    pacer_.restart();
  });
}

SimulationInventory Simulation::inventory() {
  SimulationInventory result;
  requests_.run([&] {
    result.robots = world_.robots();
    result.objects = world_.objects();
    result.bodies = world_.bodies();
    result.joints = world_.joints();
    for (const WorldCamera& camera : world_.cameras()) {
      result.cameras.push_back(camera.name);
    }
    result.gravity = world_.gravity();
    result.paused = paused_;
    result.real_time_factor = pacer_.factor();
  });
  return result;
}

void Simulation::setJoints(const std::vector<std::string>& names,
                           const std::vector<double>& positions,
                           const std::vector<double>& velocities) {
  requests_.run([&] {
    const Snapshot before = world_.snapshot();
    try {
      for (std::size_t i = 0; i < names.size(); ++i) {
        world_.setJointPosition(names[i], positions[i]);
        world_.setJointVelocity(names[i], velocities[i]);
      }
    } catch (...) {
      world_.restore(before);
      throw;
    }
    for (const auto& robot : robots_) {
      if (std::any_of(names.begin(), names.end(),
                      [&](const std::string& name) { return robot->hasJoint(name); })) {
        robot->worldWasReset();
      }
    }
  });
}

std::uint64_t Simulation::takeSnapshot(const std::string& name) {
  std::uint64_t hash = 0;
  requests_.run([&] {
    if (snapshots_.count(name) == 0 && snapshots_.size() >= kMostSnapshots) {
      throw std::runtime_error("There are " + std::to_string(kMostSnapshots) +
                               " snapshots already: take this one under the name of an older one.");
    }
    snapshots_[name] = world_.snapshot();
    hash = world_.stateHash();
    pacer_.restart();
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
    world_.restore(found->second);
    for (const auto& robot : robots_) {
      robot->worldWasReset();
    }
    hash = world_.stateHash();
  });
  return hash;
}

void Simulation::withWorld(const std::function<void(World&)>& work) {
  requests_.run([&] { work(world_); });
}

Simulation::Benchmark Simulation::benchmark(std::uint32_t ticks) {
  if (ticks == 0) {
    throw std::runtime_error("A benchmark needs at least one tick.");
  }
  Benchmark result;
  requests_.run([&] {
    TickTimes times;
    const std::int64_t start = threadNanoseconds();
    for (std::uint32_t i = 0; i < ticks; ++i) {
      tick(&times);
    }
    const double scale = 1e-3 / ticks;
    result.tick = scale * static_cast<double>(threadNanoseconds() - start);
    result.read = scale * static_cast<double>(times.read);
    result.update = scale * static_cast<double>(times.update);
    result.write = scale * static_cast<double>(times.write);
    result.physics = result.tick - result.read - result.update - result.write;
    result.bare = bareTickMicroseconds(world_, ticks);
    pacer_.restart();
  });
  return result;
}

}  // namespace franka_sim_mujoco

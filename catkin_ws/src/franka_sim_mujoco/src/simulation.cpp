// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "simulation.h"

#include <franka_core/numbers.h>
#include <franka_sim/physics/world_properties.h>
#include <ros/console.h>

#include <algorithm>
#include <cmath>
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
/// Compiling a world with several robots takes seconds on a slow machine.
constexpr std::chrono::milliseconds kSpawnTimeout{60000};
/// While time waits for the compiler, clients see so often that the robots are there (chosen here:
/// they give up after a second, and what an idle one receives in lock-step hardly depends on it).
constexpr std::chrono::milliseconds kStandStillPeriod{300};
constexpr double kMaxClockRate = 1000.0;  ///< [Hz] (decision 22)

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
    : loader_("franka_sim_mujoco", "franka_sim_mujoco::RobotHWSim"),
      world_(options.world_file, resolveUri),
      clock_(node),
      host_([this] { advance(); }, paceOf(options.real_time_factor)),
      scene_(world_, [this] { return sceneRobots(); }),
      real_time_factor_(options.real_time_factor),
      clock_rate_(options.clock_rate),
      paused_(options.paused) {
  if (!std::isfinite(clock_rate_) || clock_rate_ < 0.0 || clock_rate_ > kMaxClockRate) {
    throw std::runtime_error("The clock rate " + franka_core::numberText(clock_rate_) +
                             " Hz is wrong: it must be 0 (as fits the real time factor), or above "
                             "it and at most " +
                             std::to_string(static_cast<int>(kMaxClockRate)) + " Hz.");
  }
  applyPace();
  reportWarnings();
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
  for (const auto& robot : robots_) {
    if (robot->served() != nullptr) {
      robot->served()->removeFrom(host_);
    }
  }
  requests_.close();
}

void Simulation::loop() {
  requests_.adopt();
  host_.restartClock();
  try {
    while (!stop_) {
      requests_.serve();
      reviewPace();
      short_sleeps_.sleepIfDue();
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

void Simulation::standStill() {
  clock_.standStill(time());
  requests_.waitForWork(host_.empty() ? kIdleSleep : kServedIdleSleep);
  host_.standStill();
}

void Simulation::advance() {
  const ros::Time now = time();
  world_.prepareBeside();
  for (const auto& robot : robots_) {
    robot->tick(now, timing_ ? &times_ : nullptr);
  }
  world_.step();
  watchWorld();
  ++tick_count_;
  clock_.tick(time());
}

void Simulation::reportWarnings() {
  for (const std::string& warning : world_.takeWarnings()) {
    ROS_WARN_NAMED(kLog, "%s", warning.c_str());
  }
}

void Simulation::watchWorld() {
  reportWarnings();
  if (!world_.stopped() || paused_by_fault_) {
    return;
  }
  ROS_ERROR_NAMED(kLog, "%s The simulation is paused: call the service %s.", world_.fault().c_str(),
                  ros::names::resolve("~reset").c_str());
  paused_by_fault_ = !paused_;
  paused_ = true;
  for (const auto& robot : robots_) {
    robot->halt();
  }
}

void Simulation::requireRunningWorld() const {
  if (world_.stopped()) {
    throw std::runtime_error(world_.fault());
  }
}

void Simulation::reviewPace() {
  const bool starting = std::any_of(robots_.begin(), robots_.end(),
                                    [](const auto& robot) { return robot->isStarting(); });
  if (starting != starting_) {
    starting_ = starting;
    applyPace();
  }
}

void Simulation::applyPace() {
  const bool held = starting_ && (real_time_factor_ == 0.0 || real_time_factor_ > 1.0);
  const double factor = held ? 1.0 : real_time_factor_;
  host_.setPace(paceOf(factor));
  world_.setPreparesBeside(factor == 0.0);
  clock_.setRate(clock_rate_ > 0.0 ? clock_rate_ : clockRateOf(factor));
}

void Simulation::finishStepping() {
  if (world_.stopped()) {
    steps_left_ = 0;
    clock_.standStill(time());
    stepped_->set_exception(std::make_exception_ptr(std::runtime_error(world_.fault())));
    stepped_.reset();
  } else if (--steps_left_ == 0) {
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
  requests_.run([&] {
    if (!paused) {
      requireRunningWorld();
    }
    paused_ = paused;
  });
}

void Simulation::setRealTimeFactor(double factor) {
  requests_.run([&] {
    paceOf(factor);  // throws for an invalid factor
    real_time_factor_ = factor;
    applyPace();
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

void Simulation::requireRest() const {
  if (world_.stopped()) {
    return;  // nothing can move
  }
  for (const auto& robot : robots_) {
    robot->requireRest();
  }
}

void Simulation::reset() {
  requests_.run([&] {
    requireRest();
    world_.reset();
    worldWasReset();
  });
}

void Simulation::worldWasReset() {
  for (const auto& robot : robots_) {
    robot->worldWasReset();
  }
  if (std::exchange(paused_by_fault_, false)) {
    paused_ = false;
  }
}

RobotInstance* Simulation::find(const std::string& name) {
  for (const auto& robot : robots_) {
    if (robot->name() == name) {
      return robot.get();
    }
  }
  return nullptr;
}

OperatorAccess Simulation::operatorAccess() {
  const auto reset_within_a_tick = [this] {
    reset();
    for (const auto& robot : robots_) {
      if (robot->served() != nullptr) {
        robot->served()->robot().observe();  // the tick's measurement is not valid any more
      }
    }
  };
  return {host_, scene_, reset_within_a_tick, requestShutdown};
}

std::vector<franka_sim::SceneRobot> Simulation::sceneRobots() const {
  std::vector<franka_sim::SceneRobot> robots;
  for (const auto& robot : robots_) {
    robots.insert(robots.end(), robot->inScene().begin(), robot->inScene().end());
  }
  return robots;
}

std::string Simulation::spawn(const SpawnOrder& order) {
  if (franka_sim::isUrdfOfObject(order.urdf)) {
    const std::string notes = spawnObject(order.name, order.urdf, order.pose);
    placeJoints(order);
    return notes;
  }
  const RobotPlan plan = planRobot(order);
  std::string notes;
  change(
      [&] {
        if (find(order.name) != nullptr) {
          throw std::runtime_error("There already is a robot named '" + order.name +
                                   "': choose another name or delete that one first.");
        }
        return world_.beginAddRobot(plan.description);
      },
      [&](franka_sim::WorldChange& added) {
        const BetweenTicks between_ticks = [this](const std::function<void()>& work) {
          requests_.run(work);
        };
        auto robot = std::make_unique<RobotInstance>(plan, world_, added, loader_, between_ticks,
                                                     operatorAccess());
        if (robot->served() != nullptr) {
          robot->served()->addTo(host_);
        }
        robots_.push_back(std::move(robot));
        notes = world_.unsupported(order.name);
        reportWarnings();
        const std::string overlaps = describeOverlaps(world_, order.name);
        if (!overlaps.empty()) {
          ROS_WARN_NAMED(kLog, "%s Give it another place (x, y, z) or other joint positions.",
                         overlaps.c_str());
        }
      });
  return notes;
}

void Simulation::change(const std::function<franka_sim::WorldChange()>& begin,
                        const std::function<void(franka_sim::WorldChange&)>& finish) {
  const std::lock_guard<std::mutex> one_at_a_time(change_mutex_);
  std::optional<franka_sim::WorldChange> change;
  bool finished = false;
  const auto finish_it = [&] {
    finish(*change);
    host_.restartClock();
    finished = true;
  };
  requests_.run(
      [&] {
        change.emplace(begin());
        if (real_time_factor_ > 0.0 && steps_left_ == 0) {
          return;
        }
        auto compiled = std::async(std::launch::async, [&] { change->compile(); });
        while (compiled.wait_for(kStandStillPeriod) != std::future_status::ready) {
          host_.standStill();
        }
        compiled.get();
        finish_it();
      },
      kSpawnTimeout);
  if (!finished) {
    change->compile();
    requests_.run(finish_it, kSpawnTimeout);
  }
}

void Simulation::placeJoints(const SpawnOrder& order) {
  requests_.run([&] {
    const std::vector<std::string> joints = world_.joints();
    for (const auto& [name, position] : order.initial_positions) {
      const std::string joint = order.name + "::" + name;
      if (std::find(joints.begin(), joints.end(), joint) != joints.end()) {
        setJointPosition(world_, joint, position);
      } else {
        ROS_WARN_NAMED(kLog, "'%s' has no joint '%s' that moves: its initial position is ignored.",
                       order.name.c_str(), name.c_str());
      }
    }
  });
}

void Simulation::remove(const std::string& name) {
  std::unique_ptr<RobotInstance> removed;
  change(
      [&] {
        const std::vector<std::string> objects = world_.objects();
        if (std::find(objects.begin(), objects.end(), name) != objects.end()) {
          return world_.beginRemoveObject(name);  // its URDF was that of an object
        }
        if (find(name) == nullptr) {
          throw std::runtime_error("There is no robot named '" + name + "'.");
        }
        return world_.beginRemoveRobot(name);
      },
      [&](franka_sim::WorldChange& rest) {
        const auto robot = std::find_if(robots_.begin(), robots_.end(), [&](const auto& candidate) {
          return candidate->name() == name;
        });
        if (robot != robots_.end()) {
          removed = std::move(*robot);
          if (removed->served() != nullptr) {
            removed->served()->removeFrom(host_);
          }
          robots_.erase(robot);
        }
        world_.apply(rest);
      });
  // Destroyed outside of the stepping thread: its action servers and services may wait for their
  // threads.
  removed.reset();
}

std::string Simulation::spawnObject(const std::string& name, const std::string& text,
                                    const franka_sim::Pose& pose) {
  std::string unsupported;
  change([&] { return world_.beginAddObject(name, text, pose); },
         [&](franka_sim::WorldChange& added) {
           const std::vector<std::string> before = world_.bodies();
           world_.apply(added);
           unsupported = world_.unsupported(name);
           reportWarnings();
           for (const std::string& robot : world_.robots()) {
             for (const franka_sim::Overlap& overlap : overlaps(world_, robot)) {
               if (std::find(before.begin(), before.end(), overlap.body) == before.end()) {
                 unsupported += (unsupported.empty() ? "" : " ") + overlap.body +
                                " begins within " + overlap.link + ", which it will push.";
               }
             }
           }
         });
  return unsupported;
}

void Simulation::removeObject(const std::string& name) {
  change([&] { return world_.beginRemoveObject(name); },
         [&](franka_sim::WorldChange& rest) { world_.apply(rest); });
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
    result.real_time_factor = real_time_factor_;
  });
  return result;
}

void Simulation::setJoints(const std::vector<std::string>& names,
                           const std::vector<double>& positions,
                           const std::vector<double>& velocities) {
  requests_.run([&] {
    for (const auto& robot : robots_) {
      if (robot->hasAnyOf(names)) {
        robot->requireRest();
      }
    }
    const franka_sim::Snapshot before = world_.snapshot();
    try {
      for (std::size_t i = 0; i < names.size(); ++i) {
        setJointPosition(world_, names[i], positions[i]);
        setJointVelocity(world_, names[i], velocities[i]);
      }
    } catch (...) {
      world_.restore(before);
      throw;
    }
    for (const auto& robot : robots_) {
      if (robot->hasAnyOf(names)) {
        robot->worldWasReset();
      }
    }
  });
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
    requireRest();
    world_.restore(found->second);
    worldWasReset();
    hash = world_.stateHash();
  });
  return hash;
}

void Simulation::withWorld(const std::function<void(franka_sim::World&)>& work) {
  requests_.run([&] { work(world_); });
}

double Simulation::timeTicks(std::uint32_t ticks) {
  const std::int64_t start = threadNanoseconds();
  for (std::uint32_t i = 0; i < ticks; ++i) {
    host_.tickAtOnce();
  }
  return 1e-3 * static_cast<double>(threadNanoseconds() - start) / ticks;
}

std::vector<std::string> Simulation::conditions() const {
  std::vector<std::string> lines;
  for (const auto& robot : robots_) {
    const std::string line = robot->condition();
    if (!line.empty()) {
      lines.push_back(line);
    }
  }
  return lines;
}

Simulation::Benchmark Simulation::benchmark(std::uint32_t ticks) {
  if (ticks == 0) {
    throw std::runtime_error("A benchmark needs at least one tick.");
  }
  Benchmark result;
  requests_.run([&] {
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
    result.bare = franka_sim::bareTickMicroseconds(world_, ticks);
    host_.restartClock();
  });
  return result;
}

}  // namespace franka_sim_mujoco

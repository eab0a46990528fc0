// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot_set.h"

#include <franka_sim/physics/world.h>
#include <franka_sim/physics/world_contacts.h>
#include <franka_sim/physics/world_joints.h>
#include <realtime_tools/realtime_publisher.h>
#include <ros/console.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "service_handlers.h"
#include "shutdown_request.h"

namespace franka_sim_mujoco {

namespace {

/// Compiling a world with several robots takes seconds on a slow machine.
constexpr std::chrono::milliseconds kSpawnTimeout{60000};

/// A robot that is still being prepared: it is in the world for the time of each piece of work on
/// it only, so that the world goes on without it. Used by the stepping thread, after `stage`.
class StagedRobot {
 public:
  explicit StagedRobot(franka_sim::World& world) : world_(world) {}

  /// @param change adds the robot; compiled
  void stage(const franka_sim::WorldChange& change) { change_ = change; }
  void run(const std::function<void()>& work) {
    if (!change_ || is_visiting_) {
      work();
      return;
    }
    world_.apply(*change_);
    is_visiting_ = true;
    std::exception_ptr error;
    try {
      work();
    } catch (...) {
      error = std::current_exception();
    }
    is_visiting_ = false;
    world_.apply(*change_);  // takes it back
    if (error) {
      std::rethrow_exception(error);
    }
  }
  /// From now on it is in the world.
  void enter() {
    world_.apply(*change_);
    change_.reset();
  }

 private:
  franka_sim::World& world_;
  std::optional<franka_sim::WorldChange> change_;
  bool is_visiting_{false};
};

}  // namespace

void reportWarnings(franka_sim::World& world) {
  for (const std::string& warning : world.takeWarnings()) {
    ROS_WARN_NAMED(kLog, "%s", warning.c_str());
  }
}

RobotSet::RobotSet(RequestQueue& requests, franka_sim::World& world, franka_sim::fci::Host& host,
                   std::function<void()> reset, std::function<bool()> follows_clock)
    : requests_(requests),
      world_(world),
      host_(host),
      reset_(std::move(reset)),
      follows_clock_(std::move(follows_clock)),
      loader_("franka_sim_mujoco", "franka_sim_mujoco::RobotHWSim"),
      scene_(world, [this] { return inScene(); }) {}

void RobotSet::tick(const ros::Time& time, TickTimes* times) {
  for (const auto& robot : robots_) {
    robot->tick(time, times);
  }
}

void RobotSet::publishNow(const ros::Time& time) {
  for (const auto& robot : robots_) {
    robot->publishNow(time);
  }
  realtime_tools::publishPending();
  for (const auto& robot : robots_) {
    robot->waitForTransforms(time);
  }
}

bool RobotSet::isStarting() const {
  return std::any_of(robots_.begin(), robots_.end(),
                     [](const auto& robot) { return robot->isStarting(); });
}

void RobotSet::requireRest() const {
  if (world_.stopped()) {
    return;  // nothing can move
  }
  for (const auto& robot : robots_) {
    robot->requireRest();
  }
}

void RobotSet::worldWasReset() {
  for (const auto& robot : robots_) {
    robot->worldWasReset();
  }
}

void RobotSet::halt() {
  for (const auto& robot : robots_) {
    robot->halt();
  }
}

void RobotSet::leaveHost() noexcept {
  for (const auto& robot : robots_) {
    if (robot->served() != nullptr) {
      robot->served()->removeFrom(host_);
    }
  }
}

RobotInstance* RobotSet::find(const std::string& name) {
  for (const auto& robot : robots_) {
    if (robot->name() == name) {
      return robot.get();
    }
  }
  return nullptr;
}

OperatorAccess RobotSet::operatorAccess() {
  const auto reset_within_a_tick = [this] {
    reset_();
    for (const auto& robot : robots_) {
      if (robot->served() != nullptr) {
        robot->served()->robot().observe();  // the tick's measurement is not valid any more
      }
    }
  };
  return {host_, scene_, reset_within_a_tick, requestShutdown};
}

std::vector<franka_sim::SceneRobot> RobotSet::inScene() const {
  std::vector<franka_sim::SceneRobot> robots;
  for (const auto& robot : robots_) {
    robots.insert(robots.end(), robot->inScene().begin(), robot->inScene().end());
  }
  return robots;
}

std::string RobotSet::spawn(const SpawnOrder& order) {
  if (franka_sim::isUrdfOfObject(order.urdf)) {
    const std::string notes = spawnObject(order.name, order.urdf, order.pose);
    try {
      placeJoints(order);
    } catch (...) {
      removeObject(order.name);
      throw;
    }
    return notes;
  }
  const RobotPlan plan = planRobot(order);
  const auto staged = std::make_shared<StagedRobot>(world_);
  const BetweenTicks between_ticks = [this, staged](const std::function<void()>& work) {
    requests_.run([&] { staged->run(work); });
  };
  std::unique_ptr<RobotInstance> robot;
  std::string notes;
  change(
      [&] {
        if (find(order.name) != nullptr) {
          throw std::runtime_error("There already is a robot named '" + order.name +
                                   "': choose another name or delete that one first.");
        }
        return world_.beginAddRobot(plan.description);
      },
      [&](franka_sim::WorldChange& /*added*/) {
        staged->enter();
        if (robot->served() != nullptr) {
          robot->served()->addTo(host_);
        }
        robots_.push_back(std::move(robot));
        notes = world_.unsupported(order.name);
        reportWarnings(world_);
        const std::string overlaps = describeOverlaps(world_, order.name);
        if (!overlaps.empty()) {
          ROS_WARN_NAMED(kLog, "%s Give it another place (x, y, z) or other joint positions.",
                         overlaps.c_str());
        }
      },
      [&](franka_sim::WorldChange& added) {
        staged->stage(added);
        robot =
            std::make_unique<RobotInstance>(plan, world_, loader_, between_ticks, operatorAccess());
      });
  return notes;
}

void RobotSet::change(const std::function<franka_sim::WorldChange()>& begin,
                      const std::function<void(franka_sim::WorldChange&)>& finish,
                      const std::function<void(franka_sim::WorldChange&)>& prepare) {
  const std::lock_guard<std::mutex> one_at_a_time(change_mutex_);
  std::optional<franka_sim::WorldChange> change;
  requests_.run(
      [&] {
        change.emplace(begin());
        holds_time_ = !follows_clock_();
      },
      kSpawnTimeout);
  const auto end = [this] {
    holds_time_ = false;
    host_.restartClock();
  };
  try {
    change->compile();
    prepare(*change);
    requests_.run(
        [&] {
          finish(*change);
          end();
        },
        kSpawnTimeout);
  } catch (...) {
    const std::exception_ptr error = std::current_exception();
    requests_.run(end, kSpawnTimeout);
    std::rethrow_exception(error);
  }
}

void RobotSet::placeJoints(const SpawnOrder& order) {
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

void RobotSet::remove(const std::string& name) {
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

std::string RobotSet::spawnObject(const std::string& name, const std::string& text,
                                  const franka_sim::Pose& pose) {
  std::string unsupported;
  change([&] { return world_.beginAddObject(name, text, pose); },
         [&](franka_sim::WorldChange& added) {
           const std::vector<std::string> before = world_.bodies();
           world_.apply(added);
           unsupported = world_.unsupported(name);
           reportWarnings(world_);
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

void RobotSet::removeObject(const std::string& name) {
  change([&] { return world_.beginRemoveObject(name); },
         [&](franka_sim::WorldChange& rest) { world_.apply(rest); });
}

void RobotSet::setJoints(const std::vector<std::string>& names,
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
        robot->jointsWereSet(names);
      }
    }
  });
}

std::vector<std::string> RobotSet::conditions() const {
  std::vector<std::string> lines;
  for (const auto& robot : robots_) {
    const std::string line = robot->condition();
    if (!line.empty()) {
      lines.push_back(line);
    }
  }
  return lines;
}

}  // namespace franka_sim_mujoco

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>
#include <franka_sim/serve/host.h>
#include <franka_sim/serve/scene_text.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "request_queue.h"
#include "robot_instance.h"

namespace franka_sim_mujoco {

/// The robots of a simulation: adds and removes them, and objects, while the world is stepped, and
/// runs their controllers.
///
/// The first group of functions is for any thread but the stepping one; they wait until it has done
/// the work and throw std::runtime_error with a sentence. Thread-safe. All others are for the
/// stepping thread.
class RobotSet {
 public:
  /// @param requests, world, host of the simulation; must outlive this
  /// @param reset of the simulation, for operators of served robots
  /// @param follows_clock whether ticks wait for the clock; called by the stepping thread
  RobotSet(RequestQueue& requests, franka_sim::World& world, franka_sim::fci::Host& host,
           std::function<void()> reset, std::function<bool()> follows_clock);

  /// Adds a robot; as an object, if its URDF is that of one (franka_sim::isUrdfOfObject).
  /// @returns World::unsupported of it
  std::string spawn(const SpawnOrder& order);
  void remove(const std::string& robot);  ///< or an object
  /// @returns unsupported elements of the text, as World::unsupported, and robots that overlap the
  /// object
  std::string spawnObject(const std::string& name, const std::string& text,
                          const franka_sim::Pose& pose);
  void removeObject(const std::string& name);
  /// Teleports joints; robots that have one of them restart their controllers.
  /// @param velocities one per name
  void setJoints(const std::vector<std::string>& names, const std::vector<double>& positions,
                 const std::vector<double>& velocities);

  /// Read, controllers, write of all robots. 1 kHz loop. @param times durations are added to it,
  /// unless null
  void tick(const ros::Time& time, TickTimes* times);
  /// Publishes joint states and transforms of a world that stands still.
  void publishNow(const ros::Time& time);
  std::size_t size() const noexcept { return robots_.size(); }
  /// Whether time must stand still until a robot or object has come or gone.
  bool holdsTime() const noexcept { return holds_time_; }
  /// Whether a robot waits for the controllers that its launch file starts (RobotPlan).
  bool isStarting() const;
  /// One line per robot for the user: its mode and errors.
  std::vector<std::string> conditions() const;
  /// @throws std::runtime_error with a sentence while a client moves a robot
  void requireRest() const;
  /// Call after the world was reset or restored.
  void worldWasReset();
  /// The world has stopped: aborts motions of served robots' clients.
  void halt();
  /// Call after the last tick: the host runs none of the robots any more.
  void leaveHost() noexcept;

 private:
  /// Changes the set of robots and objects. Ticks go on while the new model is compiled and its
  /// robot prepared, unless they do not follow the clock (factor 0, step()): then time stands
  /// still. Not in the stepping thread.
  /// @param begin, finish are called in the stepping thread: first step of the change, and last
  /// @param prepare is called in between, in the calling thread
  void change(
      const std::function<franka_sim::WorldChange()>& begin,
      const std::function<void(franka_sim::WorldChange&)>& finish,
      const std::function<void(franka_sim::WorldChange&)>& prepare = [](auto& /*change*/) {});
  /// Of an object that a URDF describes.
  void placeJoints(const SpawnOrder& order);
  RobotInstance* find(const std::string& name);
  OperatorAccess operatorAccess();
  std::vector<franka_sim::SceneRobot> inScene() const;

  RequestQueue& requests_;
  franka_sim::World& world_;
  franka_sim::fci::Host& host_;
  std::function<void()> reset_;
  std::function<bool()> follows_clock_;
  std::mutex change_mutex_;  ///< held during a change: there is one at a time
  bool holds_time_{false};
  HardwareLoader loader_;
  franka_sim::SceneText scene_;
  std::vector<std::unique_ptr<RobotInstance>> robots_;
};

/// Logs the world's warnings (World::takeWarnings). Stepping thread only.
void reportWarnings(franka_sim::World& world);

}  // namespace franka_sim_mujoco

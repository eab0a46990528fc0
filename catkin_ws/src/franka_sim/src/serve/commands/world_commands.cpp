// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/numbers.h>
#include <franka_sim/physics/input_limits.h>
#include <franka_sim/physics/world_bodies.h>
#include <franka_sim/physics/world_pushes.h>

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include "serve/commands/command_groups.h"

namespace franka_sim {

namespace {

using namespace fci;  // NOLINT: the words of the table
using Vector3 = std::array<double, 3>;

constexpr std::uint64_t kFall = 1000;  // [ticks] in lock-step, until a released object rests
constexpr std::uint64_t kMaxOffset = 1000000000000;  // [bytes] of a mesh (chosen here)

Parameter<std::uint64_t> milliseconds() { return integer("MILLISECONDS", 1, sizes::kMaxPushTicks); }

void addBodies(CommandTable& table, Host& host, World& world) {
  table.add(line("push", text("BODY"), numbers<3>("FX FY FZ", "N"),
                 optional(numbers<3>("TX TY TZ", "Nm")), milliseconds()),
            "a force and a torque in world axes at a body's origin; a robot's links are bodies",
            kInput,
            [&](const std::string& body, const Vector3& force, const std::optional<Vector3>& torque,
                std::uint64_t ticks) {
              pushBody(world, body, force, torque.value_or(Vector3{}), ticks);
              host.runFree(ticks);
            });
  table.add(line("place", text("BODY"), numbers<3>("X Y Z", "m"),
                 optional(numbers<4>("QW QX QY QZ", ""))),
            "sets the pose of a free body, at rest", kNotOnPage,
            [&](const std::string& body, const Vector3& position,
                const std::optional<std::array<double, 4>>& orientation) {
              Pose pose;
              pose.position = position;
              pose.orientation = orientation.value_or(pose.orientation);
              setBodyPose(world, body, pose);
              host.runFree(kFall);
            });
  table.add(line("where", text("BODY")), "its position [m]", kNotOnPage,
            [&world](const std::string& body) {
              const Pose pose = bodyPose(world, body);
              return franka_core::numberText(pose.position[0], 9) + " " +
                     franka_core::numberText(pose.position[1], 9) + " " +
                     franka_core::numberText(pose.position[2], 9);
            });
}

void addScene(CommandTable& table, SceneText& scene) {
  table.add(line("scene"), "the world to draw, as JSON ([below](#draw-the-world))", kNotOnPage,
            [&scene] { return scene.describe(); });
  table.add(
      line("mesh", text("NAME"), integer("OFFSET", 0, kMaxOffset)), "a part of a mesh, as JSON",
      kNotOnPage,
      [&scene](const std::string& name, std::uint64_t offset) { return scene.mesh(name, offset); });
  table.add(line("poses"),
            "position [m] and quaternion w, x, y, z of each body, in the order of `scene`: `[[x, "
            "y, z, w, x, y, z], ...]`",
            kNotOnPage, [&scene] { return scene.poses(); });
}

// Another client's `reset` must not stop the time for which this line waits.
Reply advanceTicks(Host& host, std::uint64_t ticks) {
  const std::uint64_t end = host.ticks() + ticks;
  host.advance(ticks);
  return Reply::when([&host, end] {
    const bool passed = host.ticks() >= end;
    host.advance(passed ? 0 : end - host.ticks());
    return passed;
  });
}

// In lock-step the world otherwise moves only when something happens in it.
void addTime(CommandTable& table, Host& host, const World& world) {
  table.add(line("time"), "simulated time since the start or the last `reset` [s]", kNotOnPage,
            [&world] { return franka_core::fixedText(world.time(), 3); });
  table
      .add(line("step", milliseconds()),
           "lets time pass; the answer comes when it has passed. In lock-step it first waits until "
           "the world is at rest, then lets it run for exactly this time (longer only if an arm "
           "moves at its end); within a motion the client makes time pass",
           kNotOnPage,
           [&host, &world](std::uint64_t ticks) {
             if (world.stopped()) {
               throw std::invalid_argument(world.fault());
             }
             return advanceTicks(host, ticks);
           })
      .ready = [&host] { return host.settled() || host.inMotion(); };
  table
      .add(line("wait"),
           "answers when no motion runs, no arm stops or recovers, no hand works, and in lock-step "
           "time stands still; an error if that is not so after 10 s of its time",
           kNotOnPage,
           [&host] {
             if (!host.atRest()) {
               throw std::invalid_argument(
                   "The world has not come to rest within 10 s of its time: something keeps an arm "
                   "moving.");
             }
           })
      .ready = [&host] { return host.atRest() || host.failsToSettle(); };
}

}  // namespace

void addWorldCommands(fci::CommandTable& table, const OperatorContext& context) {
  addBodies(table, context.host, context.world);
  addScene(table, context.scene);
  addTime(table, context.host, context.world);
  table.add(line("reset"),
            "sets the world to its initial state, for all robots; between motions only. `loss` "
            "restarts with its seed, `lose` is canceled. Modes, errors and settings by clients "
            "and lines stay",
            kNotOnPage, [reset = context.reset] { reset(); });
  table.add(line("quit"), "exits the program", kNotOnPage, [quit = context.quit] { quit(); });
}

void addLinkCommands(fci::CommandTable& table, const OperatorContext& context) {
  SimRobot& robot = context.robot;
  table.add(line("loss", number("PROBABILITY", "", 0.0, 1.0),
                 optional(integer("SEED", 0, std::numeric_limits<std::uint64_t>::max()))),
            "loses commands with this probability; the same seed loses the same commands",
            kNotOnPage, [&](double probability, std::optional<std::uint64_t> seed) {
              robot.link().setLoss(probability, seed.value_or(0));
            });
  table.add(line("lose", integer("COMMANDS", 1, sizes::kMaxPushTicks)), "loses the next commands",
            kNotOnPage, [&](std::uint64_t commands) {
              robot.link().loseNext(static_cast<unsigned>(commands));
            });
  table.add(line("delay", integer("TICKS", 0, 20)), "commands arrive so many ticks later",
            kNotOnPage,
            [&](std::uint64_t ticks) { robot.link().setDelay(static_cast<double>(ticks)); });
}

}  // namespace franka_sim

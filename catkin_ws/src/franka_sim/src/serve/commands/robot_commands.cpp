// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/motion_limits.h>
#include <franka_core/transform.h>
#include <franka_sim/physics/input_limits.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

#include "robot/safety/virtual_walls.h"
#include "serve/commands/command_groups.h"
#include "serve/operator_switches.h"

namespace franka_sim {

namespace {

using namespace fci;  // NOLINT: the words of the table
using Vector3 = std::array<double, 3>;
using Quaternion = std::array<double, 4>;  // w, x, y, z

constexpr double kSpeed = 0.3;  // share of the joints' velocity limits (chosen here)

void setWall(ControlUnit& unit, std::uint64_t number,
             const franka_core::fci::CartesianLimit& wall) {
  if (unit.request(SetVirtualWall{static_cast<std::int32_t>(number), wall}) != Status::kSuccess) {
    throw std::invalid_argument(
        "The wall was refused: it has a negative edge, or the robot moves.");
  }
}

franka_core::fci::CartesianLimit makeWall(const Vector3& center, const Vector3& edges,
                                          const std::optional<Quaternion>& orientation) {
  sizes::check(center, sizes::kMaxPosition, "m", "The wall's position");
  sizes::check(edges, sizes::kMaxPosition, "m", "An edge of the wall");
  franka_core::fci::CartesianLimit wall;
  wall.active = true;
  wall.object_world_size = edges;
  wall.object_frame = franka_core::kIdentityTransform;
  Eigen::Map<Eigen::Matrix4d> frame(wall.object_frame.data());
  frame.topRightCorner<3, 1>() = Eigen::Vector3d(center.data());
  if (orientation) {
    const auto& [w, x, y, z] = *orientation;
    const Eigen::Quaterniond rotation(w, x, y, z);
    if (rotation.norm() == 0.0) {
      throw std::invalid_argument("Four zeros are not an orientation; 1 0 0 0 is the identity.");
    }
    frame.topLeftCorner<3, 3>() = rotation.normalized().toRotationMatrix();
  }
  return wall;
}

void addWalls(CommandTable& table, SimRobot& robot) {
  constexpr std::uint64_t kLast = VirtualWalls::kCount - 1;
  table.add(line("wall", integer("NUMBER", 0, kLast), choice({"off"})), "removes a virtual wall",
            kNotOnPage, [&](std::uint64_t number, std::uint64_t /*off*/) {
              franka_core::fci::CartesianLimit none;
              none.object_frame = franka_core::kIdentityTransform;
              none.active = false;
              setWall(robot.unit(), number, none);
            });
  table.add(line("wall", integer("NUMBER", 0, kLast), numbers<3>("X Y Z", "m"),
                 numbers<3>("DX DY DZ", "m"), optional(numbers<4>("QW QX QY QZ", ""))),
            "virtual wall: center, edges and orientation in the robot's base frame; refused within "
            "a motion",
            kNotOnPage,
            [&](std::uint64_t number, const Vector3& center, const Vector3& edges,
                const std::optional<Quaternion>& orientation) {
              setWall(robot.unit(), number, makeWall(center, edges, orientation));
            });
}

Reply startMotion(WholeRobot& robot, const std::array<double, 7>& q, double speed) {
  requireAllowed(robot.safety().allowsOperatorMotion());
  OperatorMotion& motion = robot.operatorMotion();
  const Status answer = motion.start(q, speed);
  if (answer == Status::kInvalidArgumentRejected) {
    const std::optional<std::size_t> joint = motion.jointOutOfReach(q);
    throw std::invalid_argument("The motion was refused: " +
                                (joint
                                     ? "joint " + std::to_string(*joint + 1) + " can be " +
                                           robot.unit().limits().reachText(*joint, q[*joint]) + "."
                                     : "the speed must be above 0 and at most 1."));
  }
  requireAllowed(answer == Status::kMotionStarted ? Refusal::kNone : Refusal::kMotionActive);
  return Reply([&motion]() -> std::optional<std::string> {
    if (motion.active()) {
      return std::nullopt;
    }
    if (!motion.arrived()) {
      throw std::runtime_error("The motion was ended before its target was reached.");
    }
    return "";
  });
}

void addMotion(CommandTable& table, SimRobot& robot, Host& host) {
  const auto move = [&](const std::array<double, 7>& q, double speed) {
    Reply reply = startMotion(robot.whole(), q, speed);
    host.runFree(kReaction);
    return reply;
  };
  table.add(
      line("move", numbers<7>("Q*7", "rad"), optional(number("SPEED", ""))),
      "a motion of Desk to joint positions, at a share of the velocity limits (0.3); needs no "
      "FCI, and with Desk's rules that it is off",
      kControl, [move](const std::array<double, 7>& q, std::optional<double> speed) {
        return move(q, speed.value_or(kSpeed));
      });
  table.add(line("move pack"), "a motion of Desk to the pose for packing", kControl,
            [move] { return move(OperatorMotion::kPackPose, kSpeed); });
  table.add(line("move stop"), "stops a motion of Desk", kUrgentInput, [&] {
    host.runFree(kReaction);
    robot.whole().operatorMotion().stop();
  });
}

}  // namespace

void addRobotCommands(fci::CommandTable& table, const OperatorContext& context) {
  SimRobot& robot = context.robot;
  table.add(
      line("load", number("MASS", "kg"), numbers<3>("X Y Z", "m"),
           optional(numbers<9>("INERTIA*9", "kg m^2"))),
      "the load that the robot assumes: mass, center in the flange's frame, inertia (column "
      "by column; without it 0); refused within a motion, above 10 kg and beyond 1 m",
      kNotOnPage,
      [&](double mass, const Vector3& center, const std::optional<std::array<double, 9>>& inertia) {
        setLoad(robot, {mass, center, inertia.value_or(std::array<double, 9>{})});
      });
  addWalls(table, robot);
  addMotion(table, robot, context.host);
}

}  // namespace franka_sim

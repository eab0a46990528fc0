// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Torques, motions and control laws of a robot of a simulation.
#include <franka_core/limits.h>
#include <franka_core/motion_limits.h>
#include <franka_core/numbers.h>
#include <franka_sim/robot/control_unit_parameters.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "arguments.h"
#include "bindings.h"
#include "simulated_robot_handle.h"

namespace pyfranka {

namespace {

using namespace franka_core::fci;
using franka_core::ControllerMode;
using franka_core::MotionGeneratorMode;
using franka_core::RobotCommand;
using franka_sim::SimulatedRobot;

double durationOf(const py::object& duration) {
  const double seconds = number(duration, "duration");
  if (!(seconds >= 0.0 && seconds <= 1e6)) {
    throw std::invalid_argument("duration must be 0 to 1e6 seconds, not " +
                                franka_core::numberText(seconds) + ".");
  }
  return seconds;
}

MoveRequest motionOf(MotionGeneratorMode generator, const py::object& name) {
  const std::string controller = text(name, "controller");
  MoveRequest motion;
  motion.motion_generator_mode = generator;
  if (controller == "cartesian_impedance") {
    motion.controller_mode = ControllerMode::kCartesianImpedance;
  } else if (controller != "joint_impedance") {
    throw std::invalid_argument("controller is joint_impedance or cartesian_impedance, not " +
                                controller + ".");
  }
  return motion;
}

/// Targets that are farther from the base are wrong units, or in another frame: the flange of both
/// robots reaches 0.86 m from joint 2, which is 0.33 m above the base; the rest is for tools
/// (chosen here).
constexpr double kMaxTargetDistance = 2.0;  // [m]

void checkReach(const std::array<double, 16>& pose) {
  const double distance = std::hypot(pose[12], pose[13], pose[14]);
  if (distance > kMaxTargetDistance) {
    throw std::invalid_argument(
        "target lies " + franka_core::numberText(distance, 4) +
        " m from the robot's base, which no arm reaches: it is a pose in the "
        "frame of the base, in meters, at most " +
        franka_core::numberText(kMaxTargetDistance, 4) + " m away.");
  }
}

franka_sim::TargetMotion motionOf(const py::object& linear) {
  return yesOrNo(linear, "linear") ? franka_sim::TargetMotion::kLinear
                                   : franka_sim::TargetMotion::kSmooth;
}

std::array<double, 7> dampingOf(const py::object& values) {
  const auto damping = finite<7>(values, "damping");
  if (*std::min_element(damping.begin(), damping.end()) < 0.0) {
    throw std::invalid_argument("damping must not be negative.");
  }
  return damping;
}

void commandTorques(SimulatedRobotHandle& self, const py::object& values,
                    const py::object& limit_rate, const py::object& damping) {
  const auto tau = finite<7>(values, "torque");
  franka_sim::TorqueShaping shaping{yesOrNo(limit_rate, "limit_rate"), {}};
  if (!damping.is_none()) {
    shaping.damping = dampingOf(damping);
  }
  self.use([&](SimulatedRobot& robot) { robot.commandTorques(tau, shaping); });
}

void commandJoints(SimulatedRobotHandle& self, const py::object& values,
                   const py::object& controller, MotionGeneratorMode generator) {
  RobotCommand command;
  const bool positions = generator == MotionGeneratorMode::kJointPosition;
  (positions ? command.q_c : command.dq_c) =
      finite<7>(values, positions ? "joint_positions" : "joint_velocities");
  const MoveRequest motion = motionOf(generator, controller);
  self.use([&](SimulatedRobot& robot) { robot.command(motion, command); });
}

void commandCartesian(SimulatedRobotHandle& self, RobotCommand command, const py::object& elbow,
                      const py::object& controller, MotionGeneratorMode generator) {
  if (!elbow.is_none()) {
    command.elbow_c = finite<2>(elbow, "elbow");
    command.valid_elbow = true;
  }
  const MoveRequest motion = motionOf(generator, controller);
  self.use([&](SimulatedRobot& robot) { robot.command(motion, command); });
}

std::array<double, 16> frameOf(const py::object& values, const char* name) {
  const std::array<double, 16> frame = arrayOf<16>(values, name);
  const std::string fault = franka_sim::frameFault(frame);
  if (!fault.empty()) {
    throw std::invalid_argument(std::string(name) + " cannot be used: " + fault + ".");
  }
  return frame;
}

}  // namespace

void bindSimulatedCommands(py::class_<SimulatedRobotHandle>& robot) {
  robot
      .def("command_torques", &commandTorques, py::arg("torques"), py::arg("limit_rate"),
           py::arg("damping"), "7 [Nm], without gravity.")
      .def(
          "command_joint_positions",
          [](SimulatedRobotHandle& self, const py::object& values, const py::object& controller) {
            commandJoints(self, values, controller, MotionGeneratorMode::kJointPosition);
          },
          py::arg("joint_positions"), py::arg("controller"), "7 [rad].")
      .def(
          "command_joint_velocities",
          [](SimulatedRobotHandle& self, const py::object& values, const py::object& controller) {
            commandJoints(self, values, controller, MotionGeneratorMode::kJointVelocity);
          },
          py::arg("joint_velocities"), py::arg("controller"), "7 [rad/s].")
      .def(
          "command_cartesian_pose",
          [](SimulatedRobotHandle& self, const py::object& values, const py::object& elbow,
             const py::object& controller) {
            RobotCommand command;
            command.O_T_EE_c = finite<16>(values, "cartesian_pose");
            commandCartesian(self, command, elbow, controller,
                             MotionGeneratorMode::kCartesianPosition);
          },
          py::arg("cartesian_pose"), py::arg("elbow"), py::arg("controller"), "4x4.")
      .def(
          "command_cartesian_velocities",
          [](SimulatedRobotHandle& self, const py::object& values, const py::object& elbow,
             const py::object& controller) {
            RobotCommand command;
            command.O_dP_EE_c = finite<6>(values, "cartesian_velocities");
            commandCartesian(self, command, elbow, controller,
                             MotionGeneratorMode::kCartesianVelocity);
          },
          py::arg("cartesian_velocities"), py::arg("elbow"), py::arg("controller"),
          "6 [m/s, rad/s].")
      .def(
          "joint_impedance",
          [](SimulatedRobotHandle& self, const py::object& target, const py::object& duration,
             const py::object& stiffness, const py::object& linear) {
            const auto q = finite<7>(target, "target");
            const double seconds = durationOf(duration);
            const franka_sim::TargetMotion motion = motionOf(linear);
            const auto K = stiffness.is_none() ? std::optional<std::array<double, 7>>()
                                               : std::optional(finite<7>(stiffness, "stiffness"));
            if (K && !franka_sim::isJointStiffness(*K)) {
              throw std::invalid_argument("stiffness must lie between 0 and 14250 Nm/rad.");
            }
            self.use([&](SimulatedRobot& robot) {
              franka_sim::Simulation::checkPositions(robot, q);
              franka_sim::JointLaw& law = robot.jointLaw();
              if (K) {
                law.setStiffness(*K);
              }
              law.setTarget(q, seconds, motion);
            });
          },
          py::arg("target"), py::arg("duration"), py::arg("stiffness"), py::arg("linear"), "")
      .def(
          "cartesian_impedance",
          [](SimulatedRobotHandle& self, const py::object& target, const py::object& duration,
             const py::object& stiffness, const py::object& nullspace_stiffness,
             const py::object& linear, const py::object& damping) {
            const auto pose = frameOf(target, "target");
            checkReach(pose);
            const double seconds = durationOf(duration);
            const franka_sim::TargetMotion motion = motionOf(linear);
            const auto K = stiffness.is_none() ? std::optional<std::array<double, 6>>()
                                               : std::optional(finite<6>(stiffness, "stiffness"));
            const auto D = damping.is_none() ? std::optional<std::array<double, 7>>()
                                             : std::optional(dampingOf(damping));
            const auto N = nullspace_stiffness.is_none()
                               ? std::optional<double>()
                               : std::optional(number(nullspace_stiffness, "nullspace_stiffness"));
            if (K && *std::min_element(K->begin(), K->end()) < 0.0) {
              throw std::invalid_argument("stiffness must not be negative.");
            }
            if (N && *N < 0.0) {
              throw std::invalid_argument("nullspace_stiffness must not be negative.");
            }
            self.use([&](SimulatedRobot& robot) {
              franka_sim::CartesianLaw& law = robot.cartesianLaw();
              if (K) {
                law.setStiffness(*K);
              }
              if (N) {
                law.setNullspaceStiffness(*N);
              }
              law.setTarget(pose, seconds, motion);
              if (D) {
                robot.setDamping(*D);
              }
            });
          },
          py::arg("target"), py::arg("duration"), py::arg("stiffness"),
          py::arg("nullspace_stiffness"), py::arg("linear"), py::arg("damping"), "")
      .def(
          "finish",
          [](SimulatedRobotHandle& self) {
            self.use([](SimulatedRobot& robot) { robot.finish(); });
          },
          "Ends the motion: the arm brakes, and is then idle.")
      .def_property_readonly(
          "moving",
          [](SimulatedRobotHandle& self) {
            return self.use([](SimulatedRobot& robot) { return robot.moving(); });
          },
          "Whether a motion runs.");
}

}  // namespace pyfranka

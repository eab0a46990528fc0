// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Motions of a robot: callbacks that Python functions are, and active control.
#include <franka/command_types.h>
#include <franka/robot.h>
#include <pybind11/stl.h>

#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bindings.h"
#include "motion.h"
#include "numbers.h"
#include "other_names.h"
#include "python_types.h"

namespace pyfranka {

namespace {

using namespace franka;
using MoveMode = research_interface::robot::Move::ControllerMode;

/// Calls a Python function (state, period [s]) -> command from the control loop.
template <typename Command>
std::function<Command(const RobotState&, Duration)> callback(py::function function) {
  // Shared, so that the loop may copy and destroy it without holding the interpreter.
  std::shared_ptr<py::function> shared(new py::function(std::move(function)),
                                       [](py::function* kept) {
                                         const py::gil_scoped_acquire acquire;
                                         delete kept;
                                       });
  return [shared](const RobotState& state, Duration period) {
    const py::gil_scoped_acquire acquire;
    const py::object result = (*shared)(state, seconds(period));
    try {
      if (!result.is_none()) {  // which pybind11 would report as a wrong argument of this call
        return result.cast<Command>();
      }
    } catch (const py::cast_error&) {
    }
    throw std::invalid_argument(
        "The callback returned " + std::string(py::str(py::type::of(result))) +
        "; it must return the command of its motion, for example pyfranka.Torques([...]).");
  };
}

template <typename Command>
void runMotion(Robot& robot, const python::Callback<Command>& motion_callback,
               ControllerMode controller_mode, bool limit_rate, double cutoff_frequency) {
  const auto motion = callback<Command>(motion_callback);
  const py::gil_scoped_release release;
  robot.control(motion, controller_mode, limit_rate, cutoff_frequency);
}

template <typename Command>
void runMotionWithTorques(Robot& robot, const python::Callback<Torques>& torque_callback,
                          const python::Callback<Command>& motion_callback, bool limit_rate,
                          double cutoff_frequency) {
  const auto torques = callback<Torques>(torque_callback);
  const auto motion = callback<Command>(motion_callback);
  const py::gil_scoped_release release;
  robot.control(torques, motion, limit_rate, cutoff_frequency);
}

/// @param other_name what panda-python calls the kind of motion, which has other arguments there
/// @param command in Python, for examples: a command that holds the arm where it is
template <typename Command>
void bindGenerator(py::class_<Robot>& robot, const std::string& name, const std::string& other_name,
                   const std::string& type, const std::string& command) {
  const std::string motion =
      ">>> hold = lambda state, period: pyfranka.motion_finished(" + command + ")\n";
  const std::string doc = "callback(state, period) -> " + type +
                          " once a millisecond, until it returns motion_finished(" + type +
                          "). With a torque_callback its torques take the place of the robot's "
                          "controller; cutoff_frequency [Hz].\n\nRaises ControlException when the "
                          "motion is aborted.\n\n" +
                          motion + ">>> robot.control_" + name + "(hold)";
  const std::string with_torques =
      "The same with torques of the first callback in place of the robot's controller.\n\n" +
      motion + ">>> torques = lambda state, period: pyfranka.Torques([0.0] * 7)\n" +
      ">>> robot.control_torque_" + other_name + "(torques, hold)";
  const auto limit_rate = py::arg("limit_rate") = true;
  const auto cutoff_frequency = py::arg("cutoff_frequency") = kDefaultCutoffFrequency;
  const auto controller_mode = py::arg("controller_mode") = ControllerMode::kJointImpedance;
  robot.def(
      ("control_" + name).c_str(),
      [](Robot& self, const python::Callback<Command>& motion_callback,
         const std::optional<python::Callback<Torques>>& torque_callback, ControllerMode mode,
         bool limit, double cutoff) {
        if (torque_callback) {
          runMotionWithTorques<Command>(self, *torque_callback, motion_callback, limit, cutoff);
        } else {
          runMotion<Command>(self, motion_callback, mode, limit, cutoff);
        }
      },
      py::arg("callback"), py::arg("torque_callback") = py::none(), controller_mode, limit_rate,
      cutoff_frequency, doc.c_str());
  robot.def(("control_" + name).c_str(), &runMotion<Command>, py::arg("motion_generator_callback"),
            controller_mode, limit_rate, cutoff_frequency,
            "The same with the arguments of panda-python.");
  robot.attr(("control_" + other_name).c_str()) = robot.attr(("control_" + name).c_str());
  robot.def(("control_torque_" + other_name).c_str(), &runMotionWithTorques<Command>,
            py::arg("control_callback"), py::arg("motion_generator_callback"), limit_rate,
            cutoff_frequency, with_torques.c_str());
}

MoveMode moveMode(ControllerMode mode) {
  return mode == ControllerMode::kJointImpedance ? MoveMode::kJointImpedance
                                                 : MoveMode::kCartesianImpedance;
}

template <std::unique_ptr<ActiveControlBase> (Robot::*start)(const MoveMode&)>
void bindStart(py::class_<Robot>& robot, const char* name, const std::string& command) {
  const std::string doc = std::string("Starts a motion; returns an ActiveControl.\n\n") +
                          ">>> with robot." + name + "() as motion:\n" +
                          "...     state, period = motion.read_once()\n" +
                          "...     motion.write_once(" + command + ")";
  robot.def(
      name, [](Robot& self, ControllerMode mode) { return Motion((self.*start)(moveMode(mode))); },
      py::arg("controller_mode") = ControllerMode::kJointImpedance,
      py::call_guard<py::gil_scoped_release>(), doc.c_str());
}

}  // namespace

void bindControl(py::class_<franka::Robot>& robot) {
  defNamed(
      robot, "control_torques", {{{"callback", "control_callback"}}},
      [](Robot& self, const python::Callback<Torques>& function, bool limit_rate,
         double cutoff_frequency) {
        const auto torques = callback<Torques>(function);
        const py::gil_scoped_release release;
        self.control(torques, limit_rate, cutoff_frequency);
      },
      py::arg("callback"), py::arg("limit_rate") = true,
      py::arg("cutoff_frequency") = kDefaultCutoffFrequency,
      "Controls the torques: callback(state, period) -> Torques once a millisecond, until it "
      "returns motion_finished(Torques).\n\nRaises ControlException when the motion is "
      "aborted.\n\n>>> finished = pyfranka.motion_finished(pyfranka.Torques([0.0] * 7))\n>>> "
      "robot.control_torques(lambda state, period: finished)");
  bindGenerator<JointPositions>(robot, "joint_positions", "joint_position", "JointPositions",
                                "pyfranka.JointPositions(state.q_d)");
  bindGenerator<JointVelocities>(robot, "joint_velocities", "joint_velocity", "JointVelocities",
                                 "pyfranka.JointVelocities([0.0] * 7)");
  bindGenerator<CartesianPose>(robot, "cartesian_pose", "cartesian_pose", "CartesianPose",
                               "pyfranka.CartesianPose(state.O_T_EE_c)");
  bindGenerator<CartesianVelocities>(robot, "cartesian_velocities", "cartesian_velocity",
                                     "CartesianVelocities",
                                     "pyfranka.CartesianVelocities([0.0] * 6)");
  alias(robot, {{"control_torques", "control"}});

  robot.def(
      "start_torque_control", [](Robot& self) { return Motion(self.startTorqueControl()); },
      py::call_guard<py::gil_scoped_release>(),
      "Starts torque control; returns an ActiveControl.\n\n>>> with robot.start_torque_control() "
      "as motion:\n...     state, period = motion.read_once()\n...     "
      "motion.write_once(pyfranka.Torques([0.0] * 7))");
  bindStart<&Robot::startJointPositionControl>(robot, "start_joint_position_control",
                                               "pyfranka.JointPositions(state.q_d)");
  bindStart<&Robot::startJointVelocityControl>(robot, "start_joint_velocity_control",
                                               "pyfranka.JointVelocities([0.0] * 7)");
  bindStart<&Robot::startCartesianPoseControl>(robot, "start_cartesian_pose_control",
                                               "pyfranka.CartesianPose(state.O_T_EE_c)");
  bindStart<&Robot::startCartesianVelocityControl>(robot, "start_cartesian_velocity_control",
                                                   "pyfranka.CartesianVelocities([0.0] * 6)");
  robot.def(
      "start_async_joint_position_control",
      [](Robot& self, const python::Sequence<double>& maximum_velocities, ControllerMode mode) {
        const auto velocities = maximum_velocities.cast<std::vector<double>>();
        const py::gil_scoped_release release;
        return Motion(self.startAsyncJointPositionControl(moveMode(mode), velocities));
      },
      py::arg("maximum_velocities"), py::arg("controller_mode") = ControllerMode::kJointImpedance,
      "Starts a motion whose way to each commanded position the robot plans itself (FR3, protocol "
      "10), no joint faster than allowed, 7 [rad/s]; returns an ActiveControl. Commands need not "
      "come every millisecond.\n\nRaises CommandException where the robot has no such "
      "motion.\n\n>>> motion = fr3.start_async_joint_position_control([1.0] * 7)\n>>> "
      "motion.close()");
}

}  // namespace pyfranka

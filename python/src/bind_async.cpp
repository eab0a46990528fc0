// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/robot.h>
#include <pybind11/stl.h>

#include <franka/async_control/async_position_control_handler.hpp>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "bindings.h"
#include "python_types.h"

namespace pyfranka {

namespace {

using Handler = franka::AsyncPositionControlHandler;

void bindValues(py::class_<Handler, std::shared_ptr<Handler>>& handler) {
  py::class_<Handler::Configuration>(handler, "Configuration", py::module_local(),
                                     "How targets are approached.")
      .def(py::init([](const python::Sequence<double>& velocities, double tolerance) {
             return Handler::Configuration{velocities.cast<std::vector<double>>(), tolerance};
           }),
           py::arg("maximum_joint_velocities"), py::arg("goal_tolerance") = 0.001,
           "Of 7 limits [rad/s] and a norm of joint angles [rad].")
      .def_readwrite("maximum_joint_velocities", &Handler::Configuration::maximum_joint_velocities,
                     "7 limits [rad/s].")
      .def_readwrite("goal_tolerance", &Handler::Configuration::goal_tolerance,
                     "A target is reached within this norm of joint angles [rad].")
      .def("__repr__", shown({"maximum_joint_velocities", "goal_tolerance"}));
  py::class_<Handler::ConfigurationResult>(handler, "ConfigurationResult", py::module_local(),
                                           "A handler, or the reason why there is none.")
      .def_property(
          "handler",
          [](const Handler::ConfigurationResult& self) {
            return python::OptionalObjectOf<Handler>(py::cast(self.handler));
          },
          [](Handler::ConfigurationResult& self, std::shared_ptr<Handler> handler) {
            self.handler = std::move(handler);
          },
          "The handler, or None.")
      .def_readwrite("error_message", &Handler::ConfigurationResult::error_message,
                     "The reason, or None.")
      .def("__repr__", shown({"error_message"}));
  py::class_<Handler::JointPositionTarget>(handler, "JointPositionTarget", py::module_local(),
                                           "Where to go.")
      .def(py::init([](const python::Sequence<double>& positions) {
             return Handler::JointPositionTarget{positions.cast<std::vector<double>>()};
           }),
           py::arg("joint_positions"), "Of 7 joint positions [rad].")
      .def_readwrite("joint_positions", &Handler::JointPositionTarget::joint_positions,
                     "7 joint positions [rad].")
      .def("__repr__", shown({"joint_positions"}));
  py::class_<Handler::CommandResult>(handler, "CommandResult", py::module_local(),
                                     "Whether a target was sent.")
      .def_readwrite("motion_uuid", &Handler::CommandResult::motion_uuid,
                     "Identifies the target in logs; empty on failure.")
      .def_readwrite("was_successful", &Handler::CommandResult::was_successful,
                     "Whether it was sent.")
      .def_readwrite("error_message", &Handler::CommandResult::error_message,
                     "Why it was not, or None.")
      .def("__repr__", shown({"was_successful", "error_message"}));
  py::class_<Handler::TargetFeedback>(handler, "TargetFeedback", py::module_local(),
                                      "Progress towards a target.")
      .def_readwrite("status", &Handler::TargetFeedback::status, "How far the robot is.")
      .def_readwrite("error_message", &Handler::TargetFeedback::error_message,
                     "Why the motion was aborted, or None.")
      .def("__repr__", shown({"status", "error_message"}));
}

}  // namespace

void bindAsync(py::module_& module) {
  using release = py::gil_scoped_release;
  using franka::TargetStatus;
  py::enum_<TargetStatus>(module, "TargetStatus", py::module_local(), "Progress towards a target.")
      .value("kIdle", TargetStatus::kIdle)
      .value("kExecuting", TargetStatus::kExecuting)
      .value("kTargetReached", TargetStatus::kTargetReached)
      .value("kAborted", TargetStatus::kAborted);
  py::class_<Handler, std::shared_ptr<Handler>> handler(
      module, "AsyncPositionControlHandler", py::module_local(),
      "Joint targets to which the robot plans its own motion (FR3, protocol 10); a new one may be "
      "set at any time. Failures are returned, not raised. Use from one thread.\n\n>>> Handler = "
      "pyfranka.AsyncPositionControlHandler\n>>> handler = Handler.configure(fr3, "
      "Handler.Configuration([1.0] * 7)).handler\n>>> "
      "handler.set_joint_position_target(Handler.JointPositionTarget(fr3_q)).was_"
      "successful\nTrue\n>>> handler.stop_control()");
  bindValues(handler);
  handler.def("__repr__", shown({}))
      .def_static(
          "configure",
          [](franka::Robot& robot, const Handler::Configuration& configuration) {
            // Python owns the robot; only this call uses it.
            const std::shared_ptr<franka::Robot> borrowed(&robot, [](franka::Robot*) {});
            return Handler::configure(borrowed, configuration);
          },
          py::call_guard<release>(), py::arg("robot"), py::arg("configuration"),
          "Starts the motion; the robot is busy until the handler is stopped or collected. Returns "
          "a ConfigurationResult.\n\n>>> Handler = pyfranka.AsyncPositionControlHandler\n>>> "
          "handler = Handler.configure(fr3, Handler.Configuration([1.0] * 7)).handler\n>>> "
          "handler.stop_control()")
      .def("set_joint_position_target", &Handler::setJointPositionTarget, py::call_guard<release>(),
           py::arg("target"),
           "Sends a target in answer to the next state. Returns a CommandResult.\n\n>>> Handler = "
           "pyfranka.AsyncPositionControlHandler\n>>> handler = Handler.configure(fr3, "
           "Handler.Configuration([1.0] * 7)).handler\n>>> "
           "handler.set_joint_position_target(Handler.JointPositionTarget(fr3_q)).was_"
           "successful\nTrue\n>>> handler.stop_control()")
      .def("get_target_feedback", &Handler::getTargetFeedback, py::call_guard<release>(),
           py::arg("robot_state") = py::none(),
           "Returns a TargetFeedback from the newest state; without one the next is "
           "awaited.\n\n>>> Handler = pyfranka.AsyncPositionControlHandler\n>>> handler = "
           "Handler.configure(fr3, Handler.Configuration([1.0] * 7)).handler\n>>> "
           "handler.get_target_feedback().error_message\n>>> handler.stop_control()")
      .def("stop_control", &Handler::stopControl, py::call_guard<release>(),
           "Stops the robot and ends the motion.\n\n>>> Handler = "
           "pyfranka.AsyncPositionControlHandler\n>>> handler = Handler.configure(fr3, "
           "Handler.Configuration([1.0] * 7)).handler\n>>> handler.stop_control()");
}

}  // namespace pyfranka

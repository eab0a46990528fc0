// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Commands, and motions under active control.
#include <franka/control_types.h>
#include <pybind11/stl.h>

#include <optional>
#include <tuple>
#include <type_traits>
#include <utility>

#include "bindings.h"
#include "motion.h"

namespace pyfranka {

namespace {

/// The elbow's two numbers, or none.
template <typename Command, std::size_t size>
Command cartesian(const py::object& values, const py::object& elbow, const char* name) {
  const std::array<double, size> command = arrayOf<size>(values, name);
  return elbow.is_none() ? Command(command) : Command(command, arrayOf<2>(elbow, "elbow"));
}

template <typename Command, typename Member>
void bindCommand(py::module_& module, const char* name, const char* field, Member member,
                 Shape shape, const char* doc) {
  auto type = py::class_<Command>(module, name, doc);
  type.def_property_readonly(
          field,
          [member, shape](const py::object& self) {
            return view(self.cast<const Command&>().*member, shape, self);
          },
          doc)
      .def_readwrite("motion_finished", &Command::motion_finished,
                     "Whether this is the last command of its motion.")
      .def("__copy__", [](const Command& self) { return Command(self); }, "Another one, equal.");
  constexpr std::size_t kSize =
      std::tuple_size<std::remove_reference_t<decltype(std::declval<Command>().*member)>>::value;
  if constexpr (std::is_constructible_v<Command, std::array<double, kSize>,
                                        std::array<double, 2>>) {
    type.def(py::init([name](const py::object& values, const py::object& elbow) {
               return cartesian<Command, kSize>(values, elbow, name);
             }),
             py::arg("values"), py::arg("elbow") = py::none(), doc)
        .def_property_readonly(
            "elbow",
            [](const py::object& self) {
              return view(self.cast<const Command&>().elbow, Shape::kVector, self);
            },
            "Joint 3 [rad], sign of joint 4; zeros when not commanded.");
  } else {
    type.def(py::init([name](const py::object& values) {
               return Command(arrayOf<kSize>(values, name));
             }),
             py::arg("values"), doc);
  }
}

template <typename Command>
void bindWrite(py::class_<Motion>& type) {
  type.def(
      "write_once",
      [](Motion& self, const Command& command, const std::optional<franka::Torques>& torques) {
        if (torques) {
          self.get().writeOnce(command, std::optional<const franka::Torques>(*torques));
        } else {
          self.get().writeOnce(command);
        }
      },
      py::call_guard<py::gil_scoped_release>(), py::arg("command"), py::arg("torques") = py::none(),
      "The same with a motion, which torques may go along with, 7 [Nm].");
}

}  // namespace

void bindMotion(py::module_& module) {
  using namespace franka;
  py::enum_<ControllerMode>(module, "ControllerMode", "The robot's own controller under a motion.")
      .value("JointImpedance", ControllerMode::kJointImpedance)
      .value("CartesianImpedance", ControllerMode::kCartesianImpedance);
  bindCommand<Torques>(module, "Torques", "tau_J", &Torques::tau_J, Shape::kVector,
                       "Torques without gravity, 7 [Nm].");
  bindCommand<JointPositions>(module, "JointPositions", "q", &JointPositions::q, Shape::kVector,
                              "Joint positions, 7 [rad].");
  bindCommand<JointVelocities>(module, "JointVelocities", "dq", &JointVelocities::dq,
                               Shape::kVector, "Joint velocities, 7 [rad/s].");
  bindCommand<CartesianPose>(module, "CartesianPose", "O_T_EE", &CartesianPose::O_T_EE,
                             Shape::kMatrix4,
                             "Pose of EE in O: 4x4, or 16 numbers column by column; with an elbow "
                             "(joint 3 [rad], sign of joint 4) if given.");
  bindCommand<CartesianVelocities>(module, "CartesianVelocities", "O_dP_EE",
                                   &CartesianVelocities::O_dP_EE, Shape::kVector,
                                   "Twist of EE in O, 6 [m/s, rad/s]; with an elbow if given.");

  module.def(
      "motion_finished",
      [](const py::object& command) {
        py::object copied = py::module_::import("copy").attr("copy")(command);
        copied.attr("motion_finished") = true;
        return copied;
      },
      py::arg("command"), "The same command, marked as the last one of its motion.");

  py::class_<Motion> motion(
      module, "ActiveControl",
      "A motion that the program drives itself: read_once, then write_once, once a millisecond. "
      "It ends when it is closed, leaves its `with` block or is collected.");
  motion
      .def(
          "read_once",
          [](Motion& self) {
            std::pair<RobotState, Duration> read;
            {
              const py::gil_scoped_release release;
              read = self.get().readOnce();
            }
            return py::make_tuple(read.first, read.second.toSec());
          },
          "Waits for the next state. Returns it and the time since the one before [s].\n\n"
          "Raises ControlException when the motion was aborted.")
      .def("close", &Motion::close, py::call_guard<py::gil_scoped_release>(),
           "Ends the motion; the robot brakes if it still moves. Never raises.")
      .def(
          "__enter__", [](const py::object& self) { return self; }, "The motion itself.")
      .def(
          "__exit__",
          [](Motion& self, const py::args&) {
            const py::gil_scoped_release release;
            self.close();
          },
          "Ends the motion.");
  motion.def(
      "write_once", [](Motion& self, const Torques& torques) { self.get().writeOnce(torques); },
      py::call_guard<py::gil_scoped_release>(), py::arg("command"),
      "Answers the last state. Raises ControlException after an abort.");
  bindWrite<JointPositions>(motion);
  bindWrite<JointVelocities>(motion);
  bindWrite<CartesianPose>(motion);
  bindWrite<CartesianVelocities>(motion);
}

}  // namespace pyfranka

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Commands, functions that check them, and motions under active control.
#include <franka/control_tools.h>
#include <franka/control_types.h>
#include <franka/rate_limiting.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

#include "arguments.h"
#include "bindings.h"
#include "motion.h"
#include "numbers.h"
#include "other_names.h"
#include "python_types.h"

namespace pyfranka {

namespace {

/// The elbow's two numbers, or none.
template <typename Command, std::size_t size>
Command cartesian(const py::object& values, const py::object& elbow, const char* name) {
  const std::array<double, size> command = arrayOf<size>(values, name);
  return elbow.is_none() ? Command(command) : Command(command, arrayOf<2>(elbow, "elbow"));
}

/// @param other_name what panda-python calls the constructor's argument
/// @param example in Python
template <typename Command, typename Member>
void bindCommand(py::module_& module, const char* name, const char* field, const char* other_name,
                 Member member, Shape shape, const char* doc, const char* example) {
  const std::string with_example = std::string(doc) + "\n\n" + example;
  auto type = py::class_<Command>(module, name, py::module_local(), with_example.c_str());
  constexpr std::size_t kSize =
      std::tuple_size<std::remove_reference_t<decltype(std::declval<Command>().*member)>>::value;
  type.def_property(
          field,
          [member, shape](const py::object& self) {
            return view(self.cast<const Command&>().*member, shape, self);
          },
          [member, field](Command& self, const python::ArrayLike& values) {
            self.*member = arrayOf<kSize>(values, field);
          },
          doc)
      .def_readwrite("motion_finished", &Command::motion_finished,
                     "Whether this is the last command of its motion.")
      .def(py::init<const Command&>(), py::arg("command"), "Another one, equal.")
      .def(
          "__copy__", [](const Command& self) { return Command(self); }, "Another one, equal.")
      .def("__repr__", [name, member](const Command& self) {
        return name + ("(" + shortText(self.*member)) +
               (self.motion_finished ? "), the last one of its motion" : ")");
      });
  const std::vector<Names> others = {{{"values", other_name}}};
  if constexpr (std::is_constructible_v<Command, std::array<double, kSize>,
                                        std::array<double, 2>>) {
    withNames(
        others,
        [&](const auto&... extra) {
          type.def(py::init([name](const python::ArrayLike& values,
                                   const python::OptionalArrayLike& elbow) {
                     return cartesian<Command, kSize>(values, elbow, name);
                   }),
                   extra...);
        },
        py::arg("values"), py::arg("elbow") = py::none(), doc);
    type.def_property(
        "elbow",
        [](const py::object& self) {
          return view(self.cast<const Command&>().elbow, Shape::kVector, self);
        },
        [](Command& self, const python::ArrayLike& values) {
          self.elbow = arrayOf<2>(values, "elbow");
        },
        "Joint 3 [rad], sign of joint 4; zeros when not commanded.");
  } else {
    withNames(
        others,
        [&](const auto&... extra) {
          type.def(py::init([name](const python::ArrayLike& values) {
                     return Command(arrayOf<kSize>(values, name));
                   }),
                   extra...);
        },
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

/// A copy, which has the class of the command, also one that is derived in Python.
template <typename Command>
void bindFinished(py::module_& module) {
  module.def(
      "motion_finished",
      [](const python::Exactly<Command>& command) {
        python::Exactly<Command> copied = py::module_::import("copy").attr("copy")(command);
        copied.attr("motion_finished") = true;
        return copied;
      },
      py::arg("command"),
      "The same command, marked as the last one of its motion. Raises TypeError for anything "
      "else.\n\n>>> "
      "pyfranka.motion_finished(pyfranka.Torques([0.0] * 7))\nTorques([0, 0, 0, 0, 0, 0, 0]), the "
      "last one of its motion");
}

void bindTools(py::module_& module) {
  module.attr("MAX_TORQUE_RATE") = py::cast(franka::kMaxTorqueRate);
  module.def(
      "limit_rate",
      [](const python::ArrayLike& max_derivatives, const python::ArrayLike& commanded,
         const python::ArrayLike& last) {
        const auto derivatives = arrayOf<7>(max_derivatives, "max_derivatives");
        if (!std::all_of(derivatives.begin(), derivatives.end(),
                         [](double value) { return value >= 0.0; })) {  // not NaN either
          throw std::invalid_argument("max_derivatives must be 7 numbers from 0.");
        }
        return copy(franka::limitRate(derivatives, finite<7>(commanded, "commanded_values"),
                                      finite<7>(last, "last_commanded_values")),
                    Shape::kVector);
      },
      py::arg("max_derivatives"), py::arg("commanded_values"), py::arg("last_commanded_values"),
      "The 7 commanded values, at most as far from the last ones as max_derivatives allow in a "
      "millisecond: torques with MAX_TORQUE_RATE [Nm/s]. Raises ValueError if a value is not "
      "finite, or one of max_derivatives is NaN or negative.\n\n>>> "
      "pyfranka.limit_rate(pyfranka.MAX_TORQUE_RATE, [5.0] * 7, [0.0] * "
      "7).round(3).tolist()\n[1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0]");
  module.def(
      "is_valid_elbow",
      [](const python::ArrayLike& elbow) {
        return franka::isValidElbow(arrayOf<2>(elbow, "elbow"));
      },
      py::arg("elbow"),
      "Whether the sign of joint 4, the second number, is exactly +1 or -1. Raises ValueError for "
      "another number of values.\n\n>>> "
      "pyfranka.is_valid_elbow([0.3, -1.0])\nTrue");
  module.def(
      "is_homogeneous_transformation",
      [](const python::ArrayLike& transform) {
        return franka::isHomogeneousTransformation(arrayOf<16>(transform, "transform"));
      },
      py::arg("transform"),
      "Whether a 4x4 matrix is one: last row (0, 0, 0, 1); rows, columns of length 1 within "
      "1e-5. Raises ValueError for another shape.\n\n>>> "
      "pyfranka.is_homogeneous_transformation(numpy.eye(4))\nTrue");
  module.def("has_realtime_kernel", &franka::hasRealtimeKernel,
             "Whether the kernel is one for real time (PREEMPT_RT).\n\n>>> if not "
             "pyfranka.has_realtime_kernel():\n...     config = pyfranka.RealtimeConfig.Ignore");
  module.def(
      "set_current_thread_to_highest_scheduler_priority",
      [](const std::string& /* error_message */) {
        return franka::setCurrentThreadToHighestSchedulerPriority(nullptr);
      },
      py::arg("error_message") = "",
      "Gives this thread the highest real-time priority. Returns whether the system allowed it. "
      "The argument has no effect. Raises nothing.");
}

}  // namespace

void bindMotion(py::module_& module) {
  using namespace franka;
  aliasAsInCpp(py::enum_<ControllerMode>(module, "ControllerMode", py::module_local(),
                                         "The robot's own controller under a motion.")
                   .value("JointImpedance", ControllerMode::kJointImpedance)
                   .value("CartesianImpedance", ControllerMode::kCartesianImpedance));
  bindCommand<Torques>(module, "Torques", "tau_J", "torques", &Torques::tau_J, Shape::kVector,
                       "Torques without gravity, 7 [Nm].",
                       ">>> pyfranka.Torques([0.0] * 7).tau_J.shape\n(7,)");
  bindCommand<JointPositions>(module, "JointPositions", "q", "joint_positions", &JointPositions::q,
                              Shape::kVector, "Joint positions, 7 [rad].",
                              ">>> pyfranka.JointPositions(robot.read_once().q_d).q.shape\n(7,)");
  bindCommand<JointVelocities>(module, "JointVelocities", "dq", "joint_velocities",
                               &JointVelocities::dq, Shape::kVector, "Joint velocities, 7 [rad/s].",
                               ">>> pyfranka.JointVelocities([0.1] * 7)\n"
                               "JointVelocities([0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1])");
  bindCommand<CartesianPose>(module, "CartesianPose", "O_T_EE", "cartesian_pose",
                             &CartesianPose::O_T_EE, Shape::kMatrix4,
                             "Pose of EE in O: 4x4, or 16 numbers column by column; with an elbow "
                             "(joint 3 [rad], sign of joint 4) if given.",
                             ">>> pyfranka.CartesianPose(numpy.eye(4), elbow=[0.0, -1.0])"
                             ".O_T_EE.shape\n(4, 4)");
  bindCommand<CartesianVelocities>(module, "CartesianVelocities", "O_dP_EE", "cartesian_velocities",
                                   &CartesianVelocities::O_dP_EE, Shape::kVector,
                                   "Twist of EE in O, 6 [m/s, rad/s]; with an elbow if given.",
                                   ">>> pyfranka.CartesianVelocities([0.0] * 6).O_dP_EE.shape\n"
                                   "(6,)");

  bindFinished<Torques>(module);
  bindFinished<JointPositions>(module);
  bindFinished<JointVelocities>(module);
  bindFinished<CartesianPose>(module);
  bindFinished<CartesianVelocities>(module);

  py::class_<Motion> motion(
      module, "ActiveControl", py::module_local(),
      "A motion that the program drives itself: read_once, then write_once, once a millisecond. "
      "It ends when it is closed, leaves its `with` block or is collected.\n\n>>> with "
      "robot.start_joint_position_control() as motion:\n...     state, period = "
      "motion.read_once()\n...     motion.write_once(pyfranka.JointPositions(state.q_d))");
  refuseCopies(motion,
               "An ActiveControl can be neither pickled nor copied: it is a motion of a connection "
               "of this process.");
  motion
      .def(
          "read_once",
          [](Motion& self) {
            std::pair<RobotState, Duration> read;
            {
              const py::gil_scoped_release release;
              read = self.get().readOnce();
            }
            return python::StateAndPeriod(py::make_tuple(read.first, seconds(read.second)));
          },
          "Waits for the next state. Returns it and the time since the one before, a Duration "
          "[s].\n\n"
          "Raises ControlException when the motion was aborted.\n\n>>> with "
          "robot.start_torque_control() as motion:\n...     state, period = motion.read_once()")
      .def("close", &Motion::close, py::call_guard<py::gil_scoped_release>(),
           "Ends the motion; the robot brakes if it still moves. Never raises.\n\n>>> motion = "
           "robot.start_torque_control()\n>>> motion.close()")
      .def(
          "__enter__", [](const python::Exactly<Motion>& self) { return self; },
          "The motion itself.")
      .def(
          "__exit__",
          [](Motion& self, const py::args&) {
            const py::gil_scoped_release release;
            self.close();
          },
          "Ends the motion.")
      .def("__repr__", [](const Motion& self) {
        return self.closed() ? "<ActiveControl: closed>" : "<ActiveControl: a motion>";
      });
  motion.def(
      "write_once", [](Motion& self, const Torques& torques) { self.get().writeOnce(torques); },
      py::call_guard<py::gil_scoped_release>(), py::arg("command"),
      "Answers the last state. Raises ControlException after an abort.\n\n>>> with "
      "robot.start_torque_control() as motion:\n...     state, period = motion.read_once()\n...    "
      " motion.write_once(pyfranka.Torques([0.0] * 7))");
  bindWrite<JointPositions>(motion);
  bindWrite<JointVelocities>(motion);
  bindWrite<CartesianPose>(motion);
  bindWrite<CartesianVelocities>(motion);
  alias(motion, {{"read_once", "readOnce"}, {"write_once", "writeOnce"}});
  alias(module, {{"ActiveControl", "ActiveControlBase"}});
  bindTools(module);
}

}  // namespace pyfranka

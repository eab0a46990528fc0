// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/command_types.h>
#include <franka/extensions.h>
#include <franka/model.h>
#include <franka/robot.h>
#include <franka_core/typed_transform.h>
#include <pybind11/functional.h>
#include <pybind11/stl.h>

#include <array>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "arguments.h"
#include "bindings.h"
#include "motion.h"
#include "numbers.h"
#include "other_names.h"
#include "python_types.h"

namespace pyfranka {

namespace {

using namespace franka;

/// The thresholds of contact and collision; in pylibfranka and panda-python "threshold" is a part
/// of their names.
const Names kThresholds = {{"lower_torque", "lower_torque_thresholds"},
                           {"upper_torque", "upper_torque_thresholds"},
                           {"lower_force", "lower_force_thresholds"},
                           {"upper_force", "upper_force_thresholds"},
                           {"lower_torque_acceleration", "lower_torque_thresholds_acceleration"},
                           {"upper_torque_acceleration", "upper_torque_thresholds_acceleration"},
                           {"lower_torque_nominal", "lower_torque_thresholds_nominal"},
                           {"upper_torque_nominal", "upper_torque_thresholds_nominal"},
                           {"lower_force_acceleration", "lower_force_thresholds_acceleration"},
                           {"upper_force_acceleration", "upper_force_thresholds_acceleration"},
                           {"lower_force_nominal", "lower_force_thresholds_nominal"},
                           {"upper_force_nominal", "upper_force_thresholds_nominal"}};

/// The numbers of a frame; libfranka makes typed ones exact, with a warning, and refuses others.
std::array<double, 16> numbersOfFrame(const py::object& values, const char* name) {
  const std::array<double, 16> numbers = arrayOf<16>(values, name);
  const std::string fault = franka_core::readTypedTransform(numbers).fault;
  if (!fault.empty()) {
    throw std::invalid_argument(std::string(name) + " cannot be used: " + fault + ".");
  }
  return numbers;
}

void bindSetters(py::class_<Robot>& robot) {
  using release = py::gil_scoped_release;
  defNamed(
      robot, "set_collision_behavior", {kThresholds},
      [](Robot& self, const python::ArrayLike& lower_torque, const python::ArrayLike& upper_torque,
         const python::ArrayLike& lower_force, const python::ArrayLike& upper_force) {
        const auto a = finite<7>(lower_torque, "lower_torque");
        const auto b = finite<7>(upper_torque, "upper_torque");
        const auto c = finite<6>(lower_force, "lower_force");
        const auto d = finite<6>(upper_force, "upper_force");
        const release free;
        self.setCollisionBehavior(a, b, c, d);
      },
      py::arg("lower_torque"), py::arg("upper_torque"), py::arg("lower_force"),
      py::arg("upper_force"),
      "Thresholds of contact (lower) and collision (upper): 7 [Nm] and 6 [N, Nm].\n\n>>> "
      "robot.set_collision_behavior([20.0] * 7, [40.0] * 7, [20.0] * 6, [40.0] * 6)");
  defNamed(
      robot, "set_collision_behavior", {kThresholds},
      [](Robot& self, const python::ArrayLike& lower_torque_acceleration,
         const python::ArrayLike& upper_torque_acceleration,
         const python::ArrayLike& lower_torque_nominal,
         const python::ArrayLike& upper_torque_nominal,
         const python::ArrayLike& lower_force_acceleration,
         const python::ArrayLike& upper_force_acceleration,
         const python::ArrayLike& lower_force_nominal,
         const python::ArrayLike& upper_force_nominal) {
        const auto a = finite<7>(lower_torque_acceleration, "lower_torque_acceleration");
        const auto b = finite<7>(upper_torque_acceleration, "upper_torque_acceleration");
        const auto c = finite<7>(lower_torque_nominal, "lower_torque_nominal");
        const auto d = finite<7>(upper_torque_nominal, "upper_torque_nominal");
        const auto e = finite<6>(lower_force_acceleration, "lower_force_acceleration");
        const auto f = finite<6>(upper_force_acceleration, "upper_force_acceleration");
        const auto g = finite<6>(lower_force_nominal, "lower_force_nominal");
        const auto h = finite<6>(upper_force_nominal, "upper_force_nominal");
        const release free;
        self.setCollisionBehavior(a, b, c, d, e, f, g, h);
      },
      py::arg("lower_torque_acceleration"), py::arg("upper_torque_acceleration"),
      py::arg("lower_torque_nominal"), py::arg("upper_torque_nominal"),
      py::arg("lower_force_acceleration"), py::arg("upper_force_acceleration"),
      py::arg("lower_force_nominal"), py::arg("upper_force_nominal"),
      "The same, apart for phases of acceleration and for all others (nominal).");
  robot
      .def(
          "set_joint_impedance",
          [](Robot& self, const python::ArrayLike& K_theta) {
            const auto stiffness = finite<7>(K_theta, "K_theta");
            const release free;
            self.setJointImpedance(stiffness);
          },
          py::arg("K_theta"),
          "Stiffness of the robot's joint controller, 7 [Nm/rad].\n\n>>> "
          "robot.set_joint_impedance([3000.0] * 4 + [2500.0, 2000.0, 2000.0])")
      .def(
          "set_cartesian_impedance",
          [](Robot& self, const python::ArrayLike& K_x) {
            const auto stiffness = finite<6>(K_x, "K_x");
            const release free;
            self.setCartesianImpedance(stiffness);
          },
          py::arg("K_x"),
          "Stiffness of the robot's Cartesian controller, 6 [N/m, Nm/rad].\n\n>>> "
          "robot.set_cartesian_impedance([3000.0] * 3 + [300.0] * 3)")
      .def(
          "set_guiding_mode",
          [](Robot& self, const python::BoolSequence& guiding_mode, const python::Bool& elbow) {
            const auto axes = switches<6>(guiding_mode, "guiding_mode");
            const bool free_elbow = yesOrNo(elbow, "elbow");
            const release free;
            self.setGuidingMode(axes, free_elbow);
          },
          py::arg("guiding_mode"), py::arg("elbow"),
          "Which directions (6) and whether the elbow can be guided by hand.\n\n>>> "
          "robot.set_guiding_mode([True, True, True, False, False, False], False)")
      .def(
          "set_K",
          [](Robot& self, const python::ArrayLike& EE_T_K) {
            const auto pose = numbersOfFrame(EE_T_K, "EE_T_K");
            const release free;
            self.setK(pose);
          },
          py::arg("EE_T_K"),
          "Pose of the stiffness frame in EE, 4x4.\n\n>>> robot.set_K(numpy.eye(4))")
      .def(
          "set_EE",
          [](Robot& self, const python::ArrayLike& NE_T_EE) {
            const auto pose = numbersOfFrame(NE_T_EE, "NE_T_EE");
            const release free;
            self.setEE(pose);
          },
          py::arg("NE_T_EE"),
          "Pose of the end effector in NE, 4x4.\n\n>>> robot.set_EE(numpy.eye(4))");
  defNamed(
      robot, "set_load", {{{"mass", "load_mass"}}},
      [](Robot& self, const python::Float& load_mass, const python::ArrayLike& F_x_Cload,
         const python::ArrayLike& inertia) {
        const double mass = number(load_mass, "mass");
        const auto com = finite<3>(F_x_Cload, "F_x_Cload");
        const auto load_inertia = finite<9>(inertia, "load_inertia");
        const release free;
        self.setLoad(mass, com, load_inertia);
      },
      py::arg("mass"), py::arg("F_x_Cload") = py::make_tuple(0.0, 0.0, 0.0),
      py::arg("load_inertia") = py::tuple(py::cast(std::array<double, 9>{})),
      "Mass [kg], center of mass in F, 3 [m], and inertia, 3x3 [kg m^2], of the load.\n\n>>> "
      "robot.set_load(0.5, [0.0, 0.0, 0.05], 0.001 * numpy.eye(3))");
  robot.def("set_filters", &Robot::setFilters, py::call_guard<release>(),
            py::arg("joint_position_filter_frequency"), py::arg("joint_velocity_filter_frequency"),
            py::arg("cartesian_position_filter_frequency"),
            py::arg("cartesian_velocity_filter_frequency"), py::arg("controller_filter_frequency"),
            "The robot's own filters of commands, each 1 to 1000 [Hz], where 1000 means none "
            "(Panda only).\n\n>>> robot.set_filters(100.0, 100.0, 100.0, 100.0, 100.0)");
  alias(robot, {{"set_EE", "set_ee"}, {"set_K", "set_k"}});
}

void bindControlOptions(py::module_& module, py::class_<Robot>& robot) {
  aliasAsInCpp(py::enum_<CallbackOrder>(
                   module, "CallbackOrder", py::module_local(),
                   "Which callback of a motion with torques is called first in a cycle.")
                   .value("MotionFirst", CallbackOrder::kMotionFirst)
                   .value("ControlFirst", CallbackOrder::kControlFirst));
  aliasAsInCpp(py::enum_<FirstCycleReference>(
                   module, "FirstCycleReference", py::module_local(),
                   "What the first position or pose of a motion is filtered and limited against.")
                   .value("RobotState", FirstCycleReference::kRobotState)
                   .value("Command", FirstCycleReference::kCommand));
  robot.def(
      "set_control_options",
      [](Robot& self, CallbackOrder order, FirstCycleReference reference) {
        self.setControlOptions({order, reference});
      },
      py::arg("callback_order") = CallbackOrder::kMotionFirst,
      py::arg("first_cycle_reference") = FirstCycleReference::kRobotState,
      "Chooses the behavior of another version of libfranka for the motions started from now "
      "on; without arguments that of 0.9.\n\n>>> "
      "robot.set_control_options(pyfranka.CallbackOrder.ControlFirst)\n>>> "
      "robot.set_control_options()");
}

void bindReading(py::module_& module, py::class_<Robot>& robot) {
  py::class_<VirtualWallCuboid>(module, "VirtualWallCuboid", py::module_local(),
                                "A box that the end effector must not leave.\n\n>>> "
                                "robot.get_virtual_wall(0).p_frame.shape\n(4, 4)")
      .def_readonly("id", &VirtualWallCuboid::id, "Number of the wall.")
      .def_property_readonly(
          "object_world_size",
          [](const py::object& self) {
            return view(self.cast<const VirtualWallCuboid&>().object_world_size, Shape::kVector,
                        self);
          },
          "Edges, 3 [m].")
      .def_property_readonly(
          "p_frame",
          [](const py::object& self) {
            return view(self.cast<const VirtualWallCuboid&>().p_frame, Shape::kMatrix4, self);
          },
          "Pose of the box in O, 4x4.")
      .def_readonly("active", &VirtualWallCuboid::active, "Whether the robot enforces it.")
      .def("__repr__", shown({"id", "object_world_size", "active"}));
  robot
      .def("get_virtual_wall", &Robot::getVirtualWall, py::call_guard<py::gil_scoped_release>(),
           py::arg("id"),
           "A virtual wall by its number (Panda only).\n\n>>> "
           "robot.get_virtual_wall(0).active\nFalse")
      .def(
          "get_upper_joint_velocity_limits",
          [](const Robot& self, const python::ArrayLike& q) {
            return copy(self.getUpperJointVelocityLimits(finite<7>(q, "q")), Shape::kVector);
          },
          py::arg("q"),
          "Highest velocities that the rate limiter allows at q [rad], 7 [rad/s].\n\n>>> "
          "robot.get_upper_joint_velocity_limits(robot.read_once().q).shape\n(7,)")
      .def(
          "get_lower_joint_velocity_limits",
          [](const Robot& self, const python::ArrayLike& q) {
            return copy(self.getLowerJointVelocityLimits(finite<7>(q, "q")), Shape::kVector);
          },
          py::arg("q"),
          "Lowest velocities, likewise.\n\n>>> "
          "robot.get_lower_joint_velocity_limits(robot.read_once().q).shape\n(7,)");
}

}  // namespace

void bindRobot(py::module_& module) {
  using release = py::gil_scoped_release;
  aliasAsInCpp(py::enum_<RealtimeConfig>(
                   module, "RealtimeConfig", py::module_local(),
                   "Whether a program without real-time priority may control the robot.")
                   .value("Enforce", RealtimeConfig::kEnforce)
                   .value("Ignore", RealtimeConfig::kIgnore));

  py::class_<Robot> robot(module, "Robot", py::module_local(),
                          "A connection to a robot. Waiting calls let other Python threads run; "
                          "one operation at a time, but stop() from any thread.\n\nAll calls raise "
                          "NetworkException when the connection is lost, "
                          "InvalidOperationException if they need states while another call reads "
                          "them, "
                          "CommandException with the robot's reason when it refuses, ValueError or "
                          "TypeError for an argument that cannot be.\n\n>>> robot = "
                          "pyfranka.Robot(\"172.16.0.2\", pyfranka.RealtimeConfig.Ignore)\n>>> "
                          "robot.read_once().q.shape\n(7,)");
  refuseCopies(robot,
               "A Robot can be neither pickled nor copied: it is a connection of this process. "
               "Connect to its address where it is used; states can be pickled.");
  withNames(
      {{{"address", "franka_address"}}, {{"address", "robot_ip_address"}}},
      [&](const auto&... extra) {
        robot.def(py::init([](const python::Str& address,
                              const python::ObjectOf<RealtimeConfig>& realtime_config,
                              const python::Int& log_size) {
                    const std::string where = text(address, "address");
                    const auto config = objectOf<RealtimeConfig>(realtime_config, "realtime_config",
                                                                 "a RealtimeConfig");
                    const std::int64_t size = wholeNumber(log_size, "log_size");
                    if (size < 0) {
                      throw std::invalid_argument("log_size must be 0 or more, not " +
                                                  std::to_string(size) + ".");
                    }
                    // Arrays of states need it; in a motion its import would delay the first
                    // command.
                    py::module_::import("numpy");
                    const release free;
                    return std::make_unique<Robot>(where, config, static_cast<std::size_t>(size));
                  }),
                  extra...);
      },
      py::arg("address"), py::arg("realtime_config") = RealtimeConfig::kEnforce,
      py::arg("log_size") = 50, "Connects. Raises NetworkException, IncompatibleVersionException.");
  robot
      .def_property_readonly(
          "server_version", [](const Robot& self) { return version(self.serverVersion()); },
          "Version of the protocol that the robot speaks, an int.")
      .def("__repr__",
           [](const Robot& self) {
             return "<Robot: a connection, protocol version " +
                    std::to_string(self.serverVersion()) + ">";
           })
      .def_property_readonly(
          "state",
          [](Robot& self) {
            const release free;  // call_guard has no effect on properties
            return self.readOnce();
          },
          "read_once(), as programs for simulations write it.\n\n>>> robot.state.q.shape\n(7,)")
      .def("read_once", &Robot::readOnce, py::call_guard<release>(),
           "Waits for the next RobotState.\n\n>>> robot.read_once().robot_mode == "
           "pyfranka.RobotMode.Idle\nTrue")
      .def(
          "read",
          [](Robot& self, const python::Reader& function) {
            const py::gil_scoped_release free;
            self.read([&function](const RobotState& state) {
              const py::gil_scoped_acquire acquire;
              return py::bool_(function(state)).cast<bool>();
            });
          },
          py::arg("callback"),
          "Calls callback(state) with every state until it returns False.\n\n>>> times = []\n>>> "
          "robot.read(lambda state: times.append(state.time) or len(times) < 3)")
      .def("automatic_error_recovery", &Robot::automaticErrorRecovery, py::call_guard<release>(),
           "Recovers from a reflex. Raises CommandException when the user has to act.\n\n>>> if "
           "robot.read_once().robot_mode == pyfranka.RobotMode.Reflex:\n...     "
           "robot.automatic_error_recovery()")
      .def("stop", &Robot::stop, py::call_guard<release>(),
           "Ends the motion under way.\n\n>>> robot.stop()")
      .def("load_model", &Robot::loadModel, py::call_guard<release>(),
           "The robot's Model.\n\n>>> robot.load_model().mass(robot.read_once()).shape\n(7, 7)")
      .def("get_robot_model", &Robot::getRobotModel, py::call_guard<release>(),
           "The robot's URDF (FR3 from system 5.7 on).\n\n>>> \"<robot\" in "
           "fr3.get_robot_model()\nTrue");
  bindReading(module, robot);
  bindSetters(robot);
  bindControlOptions(module, robot);
  bindControl(robot);
}

}  // namespace pyfranka

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Robots of simulations; pyfranka/sim gives them their Python interface.
#include <franka_core/limits.h>
#include <franka_core/motion_limits.h>
#include <franka_core/typed_transform.h>
#include <franka_sim/robot/control_unit_parameters.h>
#include <pybind11/stl.h>

#include <array>
#include <memory>
#include <stdexcept>
#include <string>

#include "arguments.h"
#include "bindings.h"
#include "sim_model.h"
#include "simulated_robot_handle.h"

namespace pyfranka {

namespace {

using namespace franka_core::fci;
using franka_sim::SimulatedRobot;

/// The frame of a matrix that a user typed; warns of its correction.
std::array<double, 16> typedFrameOf(const py::object& values, const char* name) {
  constexpr int kCallerOfSetter = 2;
  const franka_core::TypedTransform typed =
      franka_core::readTypedTransform(arrayOf<16>(values, name));
  const std::string fault =
      typed.fault.empty() ? franka_sim::frameFault(typed.matrix) : typed.fault;
  if (!fault.empty()) {
    throw std::invalid_argument(std::string(name) + " cannot be used: " + fault + ".");
  }
  if (!typed.warning.empty()) {
    const std::string warning = std::string(name) + ": " + typed.warning + ".";
    if (PyErr_WarnEx(PyExc_RuntimeWarning, warning.c_str(), kCallerOfSetter) != 0) {
      throw py::error_already_set();
    }
  }
  return typed.matrix;
}

void bindRequests(py::class_<SimulatedRobotHandle>& robot) {
  robot
      .def(
          "recover",
          [](SimulatedRobotHandle& self) {
            self.use([](SimulatedRobot& robot) { robot.recover(); });
          },
          "Starts the recovery from errors, which takes some ticks.")
      .def(
          "set_user_stop",
          [](SimulatedRobotHandle& self, const py::object& pressed) {
            self.request(franka_sim::UserStop{yesOrNo(pressed, "pressed")}, "The user stop");
          },
          py::arg("pressed"), "Presses or releases the user stop.")
      .def(
          "set_brakes",
          [](SimulatedRobotHandle& self, const py::object& closed) {
            self.request(franka_sim::Brakes{yesOrNo(closed, "closed")}, "The brakes");
          },
          py::arg("closed"), "Closes or opens the brakes.")
      .def(
          "set_guiding",
          [](SimulatedRobotHandle& self, const py::object& active) {
            self.request(franka_sim::Guiding{yesOrNo(active, "active")}, "Guiding");
          },
          py::arg("active"), "Whether the user guides the arm by hand.")
      .def(
          "set_joint_impedance",
          [](SimulatedRobotHandle& self, const py::object& K_theta) {
            self.request(SetJointImpedanceRequest{finite<7>(K_theta, "K_theta")},
                         "The joint stiffness");
          },
          py::arg("K_theta"), "Stiffness of the robot's joint controller, 7 [Nm/rad].")
      .def(
          "set_cartesian_impedance",
          [](SimulatedRobotHandle& self, const py::object& K_x) {
            self.request(SetCartesianImpedanceRequest{finite<6>(K_x, "K_x")},
                         "The Cartesian stiffness");
          },
          py::arg("K_x"), "Stiffness of the robot's Cartesian controller, 6 [N/m, Nm/rad].")
      .def(
          "set_collision_behavior",
          [](SimulatedRobotHandle& self, const py::object& lower_torque,
             const py::object& upper_torque, const py::object& lower_force,
             const py::object& upper_force) {
            const auto a = finite<7>(lower_torque, "lower_torque");
            const auto b = finite<7>(upper_torque, "upper_torque");
            const auto c = finite<6>(lower_force, "lower_force");
            const auto d = finite<6>(upper_force, "upper_force");
            self.request(SetCollisionBehaviorRequest{a, b, a, b, c, d, c, d},
                         "The collision behavior");
          },
          py::arg("lower_torque"), py::arg("upper_torque"), py::arg("lower_force"),
          py::arg("upper_force"),
          "Thresholds of contact (lower) and collision (upper): 7 [Nm] and 6 [N, Nm].")
      .def(
          "set_EE",
          [](SimulatedRobotHandle& self, const py::object& NE_T_EE) {
            self.request(SetNEToEERequest{typedFrameOf(NE_T_EE, "NE_T_EE")}, "The end effector");
          },
          py::arg("NE_T_EE"), "Pose of the end effector in NE, 4x4.")
      .def(
          "set_K",
          [](SimulatedRobotHandle& self, const py::object& EE_T_K) {
            self.request(SetEEToKRequest{typedFrameOf(EE_T_K, "EE_T_K")}, "The stiffness frame");
          },
          py::arg("EE_T_K"), "Pose of the stiffness frame in EE, 4x4.")
      .def(
          "set_load",
          [](SimulatedRobotHandle& self, const py::object& mass, const py::object& F_x_Cload,
             const py::object& inertia) {
            const franka_core::Payload load{number(mass, "mass"), finite<3>(F_x_Cload, "F_x_Cload"),
                                            finite<9>(inertia, "load_inertia")};
            const std::string fault = franka_sim::payloadFault(load);
            if (!fault.empty()) {
              throw std::invalid_argument(fault);
            }
            self.request(franka_sim::loadRequest(load), "The load");
          },
          py::arg("mass"), py::arg("F_x_Cload"), py::arg("load_inertia"),
          "The configured load: mass [kg], center of mass in F, 3 [m], and inertia, "
          "3x3 [kg m^2].");
}

}  // namespace

void bindSimulatedRobot(py::module_& module,
                        py::class_<Shared, std::shared_ptr<Shared>>& simulation) {
  py::class_<SimulatedRobotHandle> robot(module, "SimulatedRobot", py::module_local(),
                                         "A robot of a simulation.");
  robot
      .def(
          "require_open", [](const SimulatedRobotHandle& self) { self.simulated(); },
          "Raises RuntimeError once the simulation is closed.")
      .def_property_readonly("state", &SimulatedRobotHandle::state,
                             "The present state, a RobotState.")
      .def_property_readonly("live_state", &SimulatedRobotHandle::liveState,
                             py::return_value_policy::reference_internal, "A LiveState.")
      .def_property_readonly(
          "model",
          [](const SimulatedRobotHandle& self) {
            return SimModel(self.simulated().units().unit().configuration().model);
          },
          "The ArmModel of the robot's own control.")
      .def_property_readonly(
          "limits",
          [](SimulatedRobotHandle& self) {
            std::array<double, 7> lowest, highest;
            self.use([&](SimulatedRobot& robot) {
              for (std::size_t i = 0; i < lowest.size(); i++) {
                const franka_core::JointRange range = robot.units().unit().limits().reach(i);
                lowest[i] = range.lowest;
                highest[i] = range.highest;
              }
            });
            return py::make_tuple(copy(lowest, Shape::kVector), copy(highest, Shape::kVector));
          },
          "Lowest and highest joint positions, 7 [rad] each.")
      .def_property_readonly(
          "brakes_closed",
          [](SimulatedRobotHandle& self) {
            return self.use(
                [](SimulatedRobot& robot) { return robot.units().unit().status().brakes_closed; });
          },
          "Whether the brakes are closed.")
      .def(
          "hash",
          [](SimulatedRobotHandle& self) {
            return self.use([](SimulatedRobot& robot) { return robot.units().hash(); });
          },
          "Hash of all states since the first command: equal hashes mean equal runs.")
      .def(
          "check_positions",
          [](SimulatedRobotHandle& self, const py::object& q) {
            const auto positions = finite<7>(q, "q");
            self.use([&](SimulatedRobot& robot) {
              franka_sim::Simulation::checkPositions(robot, positions);
            });
          },
          py::arg("q"), "Raises ValueError if the arm cannot be at joint positions, 7 [rad].")
      .def(
          "place",
          [](SimulatedRobotHandle& self, const py::object& q) { self.place(finite<7>(q, "q")); },
          py::arg("q"), "Puts the arm at joint positions, 7 [rad], at rest.");
  bindSimulatedCommands(robot);
  bindRequests(robot);
  bindSimulatedHand(module, robot);
  simulation.def("robot", [](const std::shared_ptr<Shared>& self, const std::string& name) {
    return SimulatedRobotHandle(
        self, *self->use([&](franka_sim::Simulation& s) { return &s.robot(name); }));
  });
}

}  // namespace pyfranka

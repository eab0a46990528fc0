// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/gripper.h>
#include <franka/vacuum_gripper.h>
#include <pybind11/chrono.h>

#include <chrono>
#include <string>

#include "bindings.h"

namespace pyfranka {

namespace {

using release = pybind11::gil_scoped_release;

void bindHand(py::module_& module) {
  using namespace franka;
  py::class_<GripperState>(module, "GripperState")
      .def_readonly("width", &GripperState::width, "Between the fingers [m].")
      .def_readonly("max_width", &GripperState::max_width, "As found by homing [m].")
      .def_readonly("is_grasped", &GripperState::is_grasped)
      .def_readonly("temperature", &GripperState::temperature, "[C]")
      .def_property_readonly(
          "time", [](const GripperState& state) { return state.time.toSec(); }, "[s]");
  py::class_<Gripper>(module, "Gripper",
                      "The Franka Hand. Commands wait for their end; stop() from another thread "
                      "interrupts them, which raises CommandException in the one that waits.")
      .def(py::init<const std::string&>(), py::call_guard<release>(), py::arg("address"))
      .def_property_readonly("server_version", &Gripper::serverVersion)
      .def("homing", &Gripper::homing, py::call_guard<release>(),
           "Finds out how far the fingers open. Returns whether it succeeded.")
      .def("grasp", &Gripper::grasp, py::call_guard<release>(), py::arg("width"), py::arg("speed"),
           py::arg("force"), py::arg("epsilon_inner") = 0.005, py::arg("epsilon_outer") = 0.005,
           "Closes [m, m/s] and holds with a force [N]. Returns whether what is held is as wide as "
           "asked, within the epsilons [m].")
      .def("move", &Gripper::move, py::call_guard<release>(), py::arg("width"), py::arg("speed"),
           "Moves the fingers [m, m/s]. Returns whether they arrived.")
      .def("stop", &Gripper::stop, py::call_guard<release>(), "Ends what the hand is doing.")
      .def("read_once", &Gripper::readOnce, py::call_guard<release>(),
           "Waits for the next GripperState.");
}

void bindVacuum(py::module_& module) {
  using namespace franka;
  py::enum_<VacuumGripperDeviceStatus>(module, "VacuumGripperDeviceStatus")
      .value("Green", VacuumGripperDeviceStatus::kGreen)
      .value("Yellow", VacuumGripperDeviceStatus::kYellow)
      .value("Orange", VacuumGripperDeviceStatus::kOrange)
      .value("Red", VacuumGripperDeviceStatus::kRed);
  py::class_<VacuumGripperState>(module, "VacuumGripperState")
      .def_readonly("in_control_range", &VacuumGripperState::in_control_range)
      .def_readonly("part_detached", &VacuumGripperState::part_detached)
      .def_readonly("part_present", &VacuumGripperState::part_present)
      .def_readonly("device_status", &VacuumGripperState::device_status)
      .def_readonly("actual_power", &VacuumGripperState::actual_power, "[%]")
      .def_readonly("vacuum", &VacuumGripperState::vacuum, "[mbar]")
      .def_property_readonly(
          "time", [](const VacuumGripperState& state) { return state.time.toSec(); }, "[s]");

  py::class_<VacuumGripper> gripper(module, "VacuumGripper", "The vacuum gripper.");
  py::enum_<VacuumGripper::ProductionSetupProfile>(gripper, "ProductionSetupProfile")
      .value("P0", VacuumGripper::ProductionSetupProfile::kP0)
      .value("P1", VacuumGripper::ProductionSetupProfile::kP1)
      .value("P2", VacuumGripper::ProductionSetupProfile::kP2)
      .value("P3", VacuumGripper::ProductionSetupProfile::kP3);
  gripper.def(py::init<const std::string&>(), py::call_guard<release>(), py::arg("address"))
      .def_property_readonly("server_version", &VacuumGripper::serverVersion)
      .def("vacuum", &VacuumGripper::vacuum, py::call_guard<release>(), py::arg("vacuum"),
           py::arg("timeout"), py::arg("profile") = VacuumGripper::ProductionSetupProfile::kP0,
           "Vacuums an object [10 mbar] within a time (timedelta).")
      .def("drop_off", &VacuumGripper::dropOff, py::call_guard<release>(), py::arg("timeout"),
           "Drops what is held within a time (timedelta).")
      .def("stop", &VacuumGripper::stop, py::call_guard<release>())
      .def("read_once", &VacuumGripper::readOnce, py::call_guard<release>());
}

}  // namespace

void bindGripper(py::module_& module) {
  bindHand(module);
  bindVacuum(module);
}

}  // namespace pyfranka

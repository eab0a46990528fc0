// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/gripper.h>
#include <franka/vacuum_gripper.h>
#include <pybind11/chrono.h>

#include <chrono>
#include <memory>
#include <string>
#include <tuple>

#include "arguments.h"
#include "bindings.h"
#include "numbers.h"
#include "other_names.h"
#include "python_types.h"

namespace pyfranka {

namespace {

using release = pybind11::gil_scoped_release;

template <typename Type>
void bindConnection(py::class_<Type>& type) {
  withNames(
      {{{"address", "franka_address"}}},
      [&](const auto&... extra) {
        type.def(py::init([](const python::Str& address) {
                   const std::string where = text(address, "address");
                   const release free;
                   return std::make_unique<Type>(where);
                 }),
                 extra...);
      },
      py::arg("address"), "Connects. Raises NetworkException, IncompatibleVersionException.");
  type.def("__repr__", [](const py::object& self) {
    return "<" + py::str(py::type::of(self).attr("__name__")).template cast<std::string>() +
           ": a connection, protocol version " +
           std::to_string(self.cast<const Type&>().serverVersion()) + ">";
  });
  refuseCopies(type,
               "A hand or gripper can be neither pickled nor copied: it is a connection of this "
               "process. Connect to its address where it is used.");
  type.def_property_readonly(
      "server_version", [](const Type& self) { return version(self.serverVersion()); },
      "Version of the protocol that the hand or gripper speaks, an int.");
}

python::AnyDict valuesOf(const franka::GripperState& state) {
  py::dict values;
  values["time"] = state.time.toSec();
  values["width"] = state.width;
  values["max_width"] = state.max_width;
  values["is_grasped"] = state.is_grasped;
  values["temperature"] = state.temperature;
  return values;
}

bool isEqual(const franka::GripperState& a, const franka::GripperState& b) {
  return a.width == b.width && a.max_width == b.max_width && a.is_grasped == b.is_grasped &&
         a.temperature == b.temperature && a.time == b.time;
}

franka::GripperState stateOf(const franka::Gripper& hand) {
  const release free;  // call_guard has no effect on properties
  return hand.readOnce();
}

using GripperValues = std::tuple<double, double, bool, std::uint16_t, std::uint64_t>;

void bindHand(py::module_& module) {
  using namespace franka;
  py::class_<GripperState>(module, "GripperState", py::module_local(),
                           "State of the Franka Hand.\n\n>>> hand.read_once().is_grasped\nFalse")
      .def_readwrite("width", &GripperState::width, "Between the fingers [m].")
      .def_readwrite("max_width", &GripperState::max_width, "As found by homing [m].")
      .def_readwrite("is_grasped", &GripperState::is_grasped,
                     "Whether an object of the requested width is held.")
      .def_readwrite("temperature", &GripperState::temperature, "Of the hand [deg C].")
      .def_property(
          "time", [](const GripperState& state) { return seconds(state.time); },
          [](GripperState& state, double time) { state.time = durationOf(time); },
          "Since the hand started [s].")
      .def(
          "copy", [](const GripperState& self) { return self; },
          "The same values again.\n\n>>> hand.read_once().copy().is_grasped\nFalse")
      .def("__copy__", [](const GripperState& self) { return self; })
      .def(
          "__deepcopy__",
          [](const GripperState& self, const py::object& /* memo */) { return self; },
          py::arg("memo"))
      .def(
          "__eq__",
          [](const GripperState& self, const py::object& other) {
            return py::isinstance<GripperState>(other)
                       ? py::cast(isEqual(self, other.cast<const GripperState&>()))
                       : notImplemented();
          },
          py::arg("other"))
      .def(py::pickle(
          [](const GripperState& self) {
            return GripperValues(self.width, self.max_width, self.is_grasped, self.temperature,
                                 self.time.toMSec());
          },
          [](const GripperValues& kept) {
            const auto& [width, max_width, is_grasped, temperature, time] = kept;
            return GripperState{width, max_width, is_grasped, temperature, Duration(time)};
          }))
      .def("to_dict", &valuesOf,
           "The values by the names of the fields; the time in seconds.\n\n>>> "
           "hand.read_once().to_dict()[\"is_grasped\"]\nFalse")
      .def("__repr__", [](const GripperState& state) {
        using franka_core::numberText;
        return "<GripperState: width " + numberText(state.width, 4) + " of " +
               numberText(state.max_width, 4) + " m, " +
               (state.is_grasped ? "grasped, " : "not grasped, ") +
               numberText(state.temperature, 4) + " deg C>";
      });
  py::class_<Gripper> hand(
      module, "Gripper", py::module_local(),
      "The Franka Hand. Commands wait for their end; stop() from another thread interrupts them, "
      "which raises CommandException in the one that waits.\n\n>>> hand = "
      "pyfranka.Gripper(\"172.16.0.2\")\n>>> hand.move(width=0.04, speed=0.1)\nTrue");
  bindConnection(hand);
  hand.def("homing", &Gripper::homing, py::call_guard<release>(),
           "Finds out how far the fingers open. Returns whether it succeeded.\n\nRaises "
           "CommandException when it is refused or ended by another command, "
           "NetworkException.\n\n>>> hand.homing()\nTrue")
      .def(
          "grasp",
          [](const Gripper& self, const python::Float& width, const python::Float& speed,
             const python::Float& force, const python::Float& inner, const python::Float& outer) {
            const double w = number(width, "width");
            const double v = number(speed, "speed");
            const double f = number(force, "force");
            const double in = number(inner, "epsilon_inner");
            const double out = number(outer, "epsilon_outer");
            const release free;
            return self.grasp(w, v, f, in, out);
          },
          py::arg("width"), py::arg("speed"), py::arg("force"), py::arg("epsilon_inner") = 0.005,
          py::arg("epsilon_outer") = 0.005,
          "Closes [m, m/s] and holds with a force [N]. Returns whether what is held is as wide as "
          "asked, within the epsilons [m].\n\nRaises CommandException when it is refused or ended "
          "by another command, NetworkException.\n\n>>> hand.grasp(width=0.03, speed=0.1, "
          "force=10.0)  # there is nothing to hold\nFalse")
      .def(
          "move",
          [](const Gripper& self, const python::Float& width, const python::Float& speed) {
            const double w = number(width, "width");
            const double v = number(speed, "speed");
            const release free;
            return self.move(w, v);
          },
          py::arg("width"), py::arg("speed") = 0.1,
          "Moves the fingers [m, m/s]. Returns whether they arrived.\n\nRaises CommandException "
          "when "
          "it is refused or ended by another command, NetworkException.\n\n>>> "
          "hand.move(width=0.05, speed=0.1)\nTrue")
      .def("stop", &Gripper::stop, py::call_guard<release>(),
           "Ends what the hand is doing and the force of a grasp. Returns whether it did.\n\n>>> "
           "hand.stop()\nTrue")
      .def("read_once", &Gripper::readOnce, py::call_guard<release>(),
           "Waits for the next GripperState. Raises NetworkException when none comes.\n\n>>> state "
           "= hand.read_once()\n>>> 0.0 <= state.width <= state.max_width\nTrue")
      .def_property_readonly(
          "width", [](const Gripper& self) { return stateOf(self).width; },
          "read_once().width: between the fingers [m].")
      .def_property_readonly(
          "max_width", [](const Gripper& self) { return stateOf(self).max_width; },
          "read_once().max_width: as found by homing [m].")
      .def_property_readonly(
          "is_grasped", [](const Gripper& self) { return stateOf(self).is_grasped; },
          "read_once().is_grasped: whether an object of the requested width is held.")
      .def_property_readonly(
          "temperature", [](const Gripper& self) { return stateOf(self).temperature; },
          "read_once().temperature: of the hand [deg C].");
}

void bindVacuum(py::module_& module) {
  using namespace franka;
  aliasAsInCpp(py::enum_<VacuumGripperDeviceStatus>(module, "VacuumGripperDeviceStatus",
                                                    py::module_local(), "How well the gripper is.")
                   .value("Green", VacuumGripperDeviceStatus::kGreen)
                   .value("Yellow", VacuumGripperDeviceStatus::kYellow)
                   .value("Orange", VacuumGripperDeviceStatus::kOrange)
                   .value("Red", VacuumGripperDeviceStatus::kRed));
  py::class_<VacuumGripperState>(
      module, "VacuumGripperState", py::module_local(),
      "State of the vacuum gripper.\n\n>>> gripper.read_once().part_present\nFalse")
      .def_readonly("in_control_range", &VacuumGripperState::in_control_range,
                    "Whether the vacuum is within its bounds.")
      .def_readonly("part_detached", &VacuumGripperState::part_detached,
                    "Whether the object has been dropped off.")
      .def_readonly("part_present", &VacuumGripperState::part_present,
                    "Whether there is vacuum enough to hold an object.")
      .def_readonly("device_status", &VacuumGripperState::device_status, "How well the gripper is.")
      .def_readonly("actual_power", &VacuumGripperState::actual_power, "Of the pump [%].")
      .def_readonly("vacuum", &VacuumGripperState::vacuum, "At the cups [mbar].")
      .def_property_readonly(
          "time", [](const VacuumGripperState& state) { return seconds(state.time); },
          "Since the gripper started [s].")
      .def("__repr__", shown({"vacuum", "actual_power", "part_present", "device_status"}));

  py::class_<VacuumGripper> gripper(
      module, "VacuumGripper", py::module_local(),
      "The vacuum gripper.\n\n>>> gripper = pyfranka.VacuumGripper(\"172.16.0.3\")\n>>> "
      "gripper.read_once().device_status == pyfranka.VacuumGripperDeviceStatus.Green\nTrue");
  aliasAsInCpp(py::enum_<VacuumGripper::ProductionSetupProfile>(
                   gripper, "ProductionSetupProfile", py::module_local(),
                   "One of four sets of bounds of the gripper.")
                   .value("P0", VacuumGripper::ProductionSetupProfile::kP0)
                   .value("P1", VacuumGripper::ProductionSetupProfile::kP1)
                   .value("P2", VacuumGripper::ProductionSetupProfile::kP2)
                   .value("P3", VacuumGripper::ProductionSetupProfile::kP3));
  module.attr("VacuumGripperProductionSetupProfile") = gripper.attr("ProductionSetupProfile");
  bindConnection(gripper);
  gripper
      .def("vacuum", &VacuumGripper::vacuum, py::call_guard<release>(), py::arg("vacuum"),
           py::arg("timeout"), py::arg("profile") = VacuumGripper::ProductionSetupProfile::kP0,
           "Vacuums an object [10 mbar] within a time (timedelta). Returns whether it is held.\n\n"
           "Raises CommandException, NetworkException.\n\n>>> gripper.vacuum(5, "
           "datetime.timedelta(seconds=1))  # there is nothing to hold\nFalse")
      .def("drop_off", &VacuumGripper::dropOff, py::call_guard<release>(), py::arg("timeout"),
           "Drops the part within a time (timedelta). Returns whether it did.\n\nRaises "
           "CommandException, NetworkException.\n\n>>> "
           "gripper.drop_off(datetime.timedelta(seconds=1))\nTrue")
      .def("stop", &VacuumGripper::stop, py::call_guard<release>(),
           "Ends what the gripper is doing. Returns whether it did.\n\nRaises CommandException, "
           "NetworkException.\n\n>>> gripper.stop()\nTrue")
      .def("read_once", &VacuumGripper::readOnce, py::call_guard<release>(),
           "Waits for the next VacuumGripperState. Raises NetworkException when none comes.\n\n>>> "
           "gripper.read_once().vacuum >= 0\nTrue");
}

}  // namespace

void bindGripper(py::module_& module) {
  bindHand(module);
  bindVacuum(module);
}

}  // namespace pyfranka

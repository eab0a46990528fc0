// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/log.h>
#include <franka/robot_state.h>
#include <franka_core/robot_error.h>
#include <franka_core/to_franka.h>
#include <pybind11/operators.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <string>
#include <type_traits>

#include "arguments.h"
#include "bindings.h"
#include "numbers.h"
#include "other_names.h"
#include "python_types.h"

namespace pyfranka {

namespace {

using franka::RobotState;

/// An attribute that is a view of the state's field; a RobotState's can be assigned.
template <typename State, std::size_t size>
void field(py::class_<State>& type, const char* name, std::array<double, size> State::* member,
           const char* doc, Shape shape = Shape::kVector) {
  const auto get = [member, shape](const py::object& self) {
    return view(self.cast<const State&>().*member, shape, self);
  };
  if constexpr (std::is_same_v<State, RobotState>) {
    type.def_property(
        name, get,
        [member, name](State& self, const python::ArrayLike& values) {
          self.*member = arrayOf<size>(values, name);
        },
        doc);
  } else {
    type.def_property_readonly(name, get, doc);
  }
}

/// The same for a single value.
template <typename State, typename Value>
void field(py::class_<State>& type, const char* name, Value State::* member, const char* doc) {
  if constexpr (std::is_same_v<State, RobotState>) {
    type.def_readwrite(name, member, doc);
  } else {
    type.def_readonly(name, member, doc);
  }
}

using ErrorFlags = std::array<bool, franka_core::kErrorCount>;

ErrorFlags flagsOf(const franka::Errors& errors) {
  ErrorFlags flags;
  std::copy_n(&errors.joint_position_limits_violation, flags.size(), flags.begin());
  return flags;
}

template <typename Value>
bool isSame(const Value& one, const Value& other) {
  return one == other;
}

bool isSame(const franka::Errors& one, const franka::Errors& other) {
  return flagsOf(one) == flagsOf(other);
}

/// Whether two states have the same values.
struct Comparison {
  const RobotState& one;
  const RobotState& other;
  bool equal{true};
};

template <typename Value>
void field(Comparison& states, const char* /* name */, Value RobotState::* member,
           const char* /* doc */, Shape /* shape */ = Shape::kVector) {
  states.equal = states.equal && isSame(states.one.*member, states.other.*member);
}

/// The values of a state by the names of its fields.
struct ValueDict {
  const RobotState& state;
  py::dict values;
};

template <std::size_t size>
void field(ValueDict& dict, const char* name, std::array<double, size> RobotState::* member,
           const char* /* doc */, Shape shape = Shape::kVector) {
  dict.values[name] = view(dict.state.*member, shape, py::none()).attr("copy")();
}

void field(ValueDict& dict, const char* name, double RobotState::* member, const char* /* doc */) {
  dict.values[name] = dict.state.*member;
}

void field(ValueDict& dict, const char* name, franka::Errors RobotState::* member,
           const char* /* doc */) {
  const ErrorFlags flags = flagsOf(dict.state.*member);
  py::list names;
  for (std::size_t i = 0; i < flags.size(); i++) {
    if (flags.at(i)) {
      names.append(franka_core::kErrorNames.at(i));
    }
  }
  dict.values[name] = names;
}

void field(ValueDict& dict, const char* name, franka::RobotMode RobotState::* member,
           const char* /* doc */) {
  dict.values[name] = py::cast(dict.state.*member).attr("name");
}

/// The name of a flag of franka::Errors, which differs from that in logs in two cases.
std::string flagOf(const std::string& error) {
  if (error == "cartesian_position_motion_generator_invalid_frame_flag") {
    return "cartesian_position_motion_generator_invalid_frame";
  }
  return error == "tau_J_range_violation" ? "tau_j_range_violation" : error;
}

void bindErrors(py::module_& module) {
  py::class_<franka::Errors> errors(
      module, "Errors", py::module_local(),
      "Errors of the robot; true if there is one.\n\n>>> bool(pyfranka.Errors())\nFalse");
  errors.def(py::init<>(), "No error.")
      .def("__bool__", [](const franka::Errors& self) { return static_cast<bool>(self); })
      .def("__str__", [](const franka::Errors& self) { return static_cast<std::string>(self); })
      .def("__repr__", [](const franka::Errors& self) { return static_cast<std::string>(self); })
      .def(py::pickle(
          [](const franka::Errors& self) { return py::make_tuple(flagsOf(self)); },
          [](const py::tuple& kept) { return franka::Errors(kept[0].cast<ErrorFlags>()); }))
      .def(
          "__eq__",
          [](const franka::Errors& self, const py::object& other) {
            return py::isinstance<franka::Errors>(other)
                       ? py::cast(isSame(self, other.cast<const franka::Errors&>()))
                       : notImplemented();
          },
          py::arg("other"))
      .def("__hash__",
           [](const franka::Errors& self) { return py::hash(py::tuple(py::cast(flagsOf(self)))); });
  for (std::size_t i = 0; i < franka_core::kErrorCount; i++) {
    // C++ has no pointers to members that are references, as these are: to items of one array.
    errors.def_property_readonly(
        flagOf(franka_core::kErrorNames.at(i)).c_str(),
        [i](const franka::Errors& self) { return *(&self.joint_position_limits_violation + i); },
        "Whether there is this error.");
  }
}

void bindModes(py::module_& module) {
  aliasAsInCpp(py::enum_<franka::RobotMode>(module, "RobotMode", py::module_local(),
                                            "What the robot is doing.")
                   .value("Other", franka::RobotMode::kOther)
                   .value("Idle", franka::RobotMode::kIdle)
                   .value("Move", franka::RobotMode::kMove)
                   .value("Guiding", franka::RobotMode::kGuiding)
                   .value("Reflex", franka::RobotMode::kReflex)
                   .value("UserStopped", franka::RobotMode::kUserStopped)
                   .value("AutomaticErrorRecovery", franka::RobotMode::kAutomaticErrorRecovery));
}

template <typename State, typename Fields>
void listFrames(Fields& fields) {
  field(fields, "O_T_EE", &State::O_T_EE, "Pose of EE in O, 4x4.", Shape::kMatrix4);
  field(fields, "O_T_EE_d", &State::O_T_EE_d, "Desired pose of EE in O, 4x4.", Shape::kMatrix4);
  field(fields, "O_T_EE_c", &State::O_T_EE_c, "Last commanded pose of EE in O, 4x4.",
        Shape::kMatrix4);
  field(fields, "F_T_EE", &State::F_T_EE, "Pose of EE in F, 4x4.", Shape::kMatrix4);
  field(fields, "F_T_NE", &State::F_T_NE, "Pose of NE in F, 4x4.", Shape::kMatrix4);
  field(fields, "NE_T_EE", &State::NE_T_EE, "Pose of EE in NE, 4x4.", Shape::kMatrix4);
  field(fields, "EE_T_K", &State::EE_T_K, "Pose of K in EE, 4x4.", Shape::kMatrix4);
  field(fields, "elbow", &State::elbow, "Joint 3 [rad], sign of joint 4.");
  field(fields, "elbow_d", &State::elbow_d, "Desired elbow.");
  field(fields, "elbow_c", &State::elbow_c, "Commanded elbow.");
  field(fields, "delbow_c", &State::delbow_c, "Its velocity [rad/s].");
  field(fields, "ddelbow_c", &State::ddelbow_c, "Its acceleration [rad/s^2].");
  field(fields, "O_dP_EE_d", &State::O_dP_EE_d, "Desired twist of EE in O [m/s, rad/s].");
  field(fields, "O_dP_EE_c", &State::O_dP_EE_c, "Commanded twist of EE in O [m/s, rad/s].");
  field(fields, "O_ddP_EE_c", &State::O_ddP_EE_c,
        "Commanded acceleration of EE in O [m/s^2, rad/s^2].");
}

template <typename State, typename Fields>
void listLoads(Fields& fields) {
  field(fields, "m_ee", &State::m_ee, "Mass of the end effector [kg].");
  field(fields, "m_load", &State::m_load, "Mass of the load [kg].");
  field(fields, "m_total", &State::m_total, "Mass of both [kg].");
  field(fields, "I_ee", &State::I_ee, "Inertia of the end effector, 3x3 [kg m^2].",
        Shape::kMatrix3);
  field(fields, "I_load", &State::I_load, "Inertia of the load, 3x3 [kg m^2].", Shape::kMatrix3);
  field(fields, "I_total", &State::I_total, "Inertia of both, 3x3 [kg m^2].", Shape::kMatrix3);
  field(fields, "F_x_Cee", &State::F_x_Cee, "Center of mass of the end effector in F [m].");
  field(fields, "F_x_Cload", &State::F_x_Cload, "Center of mass of the load in F [m].");
  field(fields, "F_x_Ctotal", &State::F_x_Ctotal, "Center of mass of both in F [m].");
}

template <typename State, typename Fields>
void listJoints(Fields& fields) {
  field(fields, "q", &State::q, "Joint positions [rad].");
  field(fields, "q_d", &State::q_d, "Desired joint positions [rad].");
  field(fields, "dq", &State::dq, "Joint velocities [rad/s].");
  field(fields, "dq_d", &State::dq_d, "Desired joint velocities [rad/s].");
  field(fields, "ddq_d", &State::ddq_d, "Desired joint accelerations [rad/s^2].");
  field(fields, "theta", &State::theta, "Motor positions [rad].");
  field(fields, "dtheta", &State::dtheta, "Motor velocities [rad/s].");
  field(fields, "tau_J", &State::tau_J, "Measured torques, gravity included [Nm].");
  field(fields, "tau_J_d", &State::tau_J_d, "Desired torques, without gravity [Nm].");
  field(fields, "dtau_J", &State::dtau_J, "Derivative of the measured torques [Nm/s].");
}

template <typename State, typename Fields>
void listContacts(Fields& fields) {
  field(fields, "joint_contact", &State::joint_contact, "1 where a joint feels a contact.");
  field(fields, "joint_collision", &State::joint_collision, "1 where a joint collided.");
  field(fields, "cartesian_contact", &State::cartesian_contact,
        "1 along axes with a contact (x, y, z, R, P, Y).");
  field(fields, "cartesian_collision", &State::cartesian_collision,
        "1 along axes with a collision (x, y, z, R, P, Y).");
  field(fields, "tau_ext_hat_filtered", &State::tau_ext_hat_filtered,
        "Estimated external torques [Nm].");
  field(fields, "O_F_ext_hat_K", &State::O_F_ext_hat_K,
        "Estimated external wrench at K, in O [N, Nm]; what the robot exerts is positive.");
  field(fields, "K_F_ext_hat_K", &State::K_F_ext_hat_K, "The same in K.");
  field(fields, "O_ddP_O", &State::O_ddP_O, "Acceleration of the base in O [m/s^2].");
}

/// The fields that all states have.
template <typename State, typename Fields>
void listFields(Fields& fields) {
  listFrames<State>(fields);
  listLoads<State>(fields);
  listJoints<State>(fields);
  listContacts<State>(fields);
  field(fields, "control_command_success_rate", &State::control_command_success_rate,
        "Share of the last 100 commands that arrived; 0 when no motion runs.");
}

/// Those of a RobotState, without its time.
template <typename Fields>
void listAllFields(Fields& fields) {
  field(fields, "robot_mode", &RobotState::robot_mode, "What the robot is doing.");
  field(fields, "current_errors", &RobotState::current_errors, "Errors now.");
  field(fields, "last_motion_errors", &RobotState::last_motion_errors,
        "Errors that ended the last motion.");
  listFields<RobotState>(fields);
}

bool isEqual(const RobotState& one, const RobotState& other) {
  Comparison states{one, other, one.time == other.time};
  listAllFields(states);
  return states.equal;
}

python::AnyDict valuesOf(const RobotState& state) {
  ValueDict dict{state, {}};
  dict.values["time"] = state.time.toSec();
  listAllFields(dict);
  return dict.values;
}

/// Of a state's own class, which may be derived in Python.
python::Exactly<RobotState> copyOf(const python::Exactly<RobotState>& state) {
  return py::type::of(state)(state);
}

RobotState snapshotOf(const franka_core::RobotState& state) {
  RobotState snapshot;
  franka_core::toFranka(state, snapshot);
  return snapshot;
}

/// What can be assigned of a state, by name, for pickle.
py::dict attributesOf(const py::object& self) {
  py::dict values;
  for (const auto& [name, member] : py::dict(py::type::of<RobotState>().attr("__dict__"))) {
    if (py::hasattr(member, "fset") && !member.attr("fset").is_none()) {
      values[name] = self.attr(name);
    }
  }
  return values;
}

constexpr const char* kDictDoc =
    "The values by the names of the fields: the time [s], the name of the mode, the names of the "
    "errors, numbers, and arrays of their own, which may be written.\n\n>>> values = "
    "state.to_dict()\n>>> values[\"robot_mode\"], values[\"q\"].shape, values[\"O_T_EE\"].shape"
    "\n('Idle', (7,), (4, 4))";

}  // namespace

void bindState(py::module_& module) {
  bindErrors(module);
  bindModes(module);
  py::class_<RobotState> state(
      module, "RobotState", py::module_local(),
      "State of a robot. Arrays are numpy views of it that cannot be written, but attributes can "
      "be "
      "assigned, which earlier views show, too; matrices have two dimensions.\n\n>>> state = "
      "pyfranka.RobotState()\n>>> state.q.shape, state.O_T_EE.shape\n((7,), (4, 4))");
  state.def(py::init<>(), "All zero, poses the identity; for models without a robot.")
      .def(py::init<const RobotState&>(), py::arg("state"), "A copy.");
  listAllFields(state);
  state
      .def_property(
          "time", [](const RobotState& self) { return seconds(self.time); },
          [](RobotState& self, double time) { self.time = durationOf(time); },
          "Since the robot started, a Duration [s].")
      .def("__repr__",
           [](const RobotState& self) {
             std::ostringstream text;
             text << self;
             return text.str();
           })
      .def(py::pickle(&attributesOf,
                      [](const py::dict& values) {
                        RobotState kept;
                        const py::object self = py::cast(&kept, py::return_value_policy::reference);
                        for (const auto& [name, value] : values) {
                          py::setattr(self, name, value);
                        }
                        return kept;
                      }))
      .def("copy", &copyOf,
           "A state that stays when this one is assigned to.\n\n>>> state.copy() == state\nTrue")
      .def("__copy__", &copyOf)
      .def(
          "__deepcopy__",
          [](const python::Exactly<RobotState>& self, const py::object& /* memo */) {
            return copyOf(self);
          },
          py::arg("memo"))
      .def(
          "__eq__",
          [](const RobotState& self, const py::object& other) {
            return py::isinstance<RobotState>(other)
                       ? py::cast(isEqual(self, other.cast<const RobotState&>()))
                       : notImplemented();
          },
          py::arg("other"))
      .def("to_dict", &valuesOf, kDictDoc);

  py::class_<franka::Record>(
      module, "Record", py::module_local(),
      "A state, and the command sent just before it.\n\n>>> [float(record.tau_J_d[0]) for record "
      "in error.log[-2:]]  # of a ControlException\n[0.0, 0.0]")
      .def_readonly("state", &franka::Record::state, "The state received.")
      .def_property_readonly(
          "q_c",
          [](const franka::Record& record) {
            return copy(record.command.joint_positions.q, Shape::kVector);
          },
          "Joint positions, 7 [rad].")
      .def_property_readonly(
          "dq_c",
          [](const franka::Record& record) {
            return copy(record.command.joint_velocities.dq, Shape::kVector);
          },
          "Joint velocities, 7 [rad/s].")
      .def_property_readonly(
          "O_T_EE_c",
          [](const franka::Record& record) {
            return copy(record.command.cartesian_pose.O_T_EE, Shape::kMatrix4);
          },
          "Pose of EE in O, 4x4.")
      .def_property_readonly(
          "O_dP_EE_c",
          [](const franka::Record& record) {
            return copy(record.command.cartesian_velocities.O_dP_EE, Shape::kVector);
          },
          "Twist of EE in O, 6 [m/s, rad/s].")
      .def_property_readonly(
          "tau_J_d",
          [](const franka::Record& record) {
            return copy(record.command.torques.tau_J, Shape::kVector);
          },
          "Torques, 7 [Nm].")
      .def("__repr__", [](const franka::Record& self) {
        return "<Record of the state at " + franka_core::numberText(self.state.time.toSec(), 9) +
               " s>";
      });
  module.def(
      "log_to_csv",
      [](const python::Sequence<franka::Record>& log) {
        return franka::logToCSV(log.cast<std::vector<franka::Record>>());
      },
      py::arg("log"),
      "The records of a ControlException as comma separated values. Raises TypeError for "
      "anything else.\n\n>>> "
      "len(pyfranka.log_to_csv(error.log).splitlines()) > len(error.log)\nTrue");
}

void bindSimState(py::module_& module) {
  using State = franka_core::RobotState;
  py::class_<State> state(module, "LiveState", py::module_local(),
                          "Present state of a simulated robot, with the attributes of RobotState. "
                          "Its values and arrays, which are numpy views that cannot be written, "
                          "change with each step; copy() stays.\n\n>>> live = "
                          "sim[\"panda\"].live_state\n>>> live == sim[\"panda\"].state\nTrue");
  listFields<State>(state);
  state
      .def_property_readonly(
          "current_errors", [](const State& self) { return franka::Errors(self.errors); },
          "Errors now.")
      .def_property_readonly(
          "last_motion_errors",
          [](const State& self) { return franka::Errors(self.reflex_reason); },
          "Errors that ended the last motion.")
      .def_property_readonly(
          "robot_mode", [](const State& self) { return franka_core::toFranka(self.robot_mode); },
          "What the robot is doing.")
      .def_property_readonly(
          "time", [](const State& self) { return seconds(franka::Duration(self.message_id)); },
          "Since the robot started, a Duration [s].")
      .def("copy", &snapshotOf,
           "A RobotState that stays as it is.\n\n>>> type(sim[\"panda\"].live_state.copy())\n"
           "<class 'pyfranka.RobotState'>")
      .def(
          "__eq__",
          [](const State& self, const py::object& other) {
            if (py::isinstance<State>(other)) {
              return py::object(
                  py::cast(isEqual(snapshotOf(self), snapshotOf(other.cast<const State&>()))));
            }
            return py::isinstance<RobotState>(other)
                       ? py::cast(isEqual(snapshotOf(self), other.cast<const RobotState&>()))
                       : notImplemented();
          },
          py::arg("other"))
      .def(
          "to_dict", [](const State& self) { return valuesOf(snapshotOf(self)); }, kDictDoc)
      .def(
          "__reduce__",
          [](const py::object& self) {
            return py::make_tuple(py::type::of<RobotState>(), py::make_tuple(self.attr("copy")()));
          },
          "Pickled or copied, it is a RobotState.")
      .def("__repr__", [](const py::object& self) {
        const State& state = self.cast<const State&>();
        const std::string errors = py::str(self.attr("current_errors"));
        return "<LiveState at " + franka_core::numberText(1e-3 * double(state.message_id), 9) +
               " s: " + py::str(self.attr("robot_mode").attr("name")).cast<std::string>() + ", q " +
               shortText(state.q) + (errors == "[]" ? "" : ", errors " + errors) + ">";
      });
}

}  // namespace pyfranka

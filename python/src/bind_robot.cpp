// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/command_types.h>
#include <franka/extensions.h>
#include <franka/model.h>
#include <franka/robot.h>
#include <pybind11/functional.h>
#include <pybind11/stl.h>

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
      return result.cast<Command>();
    } catch (const py::cast_error&) {
      throw std::invalid_argument(
          "The callback returned " + std::string(py::str(py::type::of(result))) +
          "; it must return the command of its motion, for example pyfranka.Torques([...]).");
    }
  };
}

template <typename Command>
void runMotion(Robot& robot, const py::function& motion_callback, ControllerMode controller_mode,
               bool limit_rate, double cutoff_frequency) {
  const auto motion = callback<Command>(motion_callback);
  const py::gil_scoped_release release;
  robot.control(motion, controller_mode, limit_rate, cutoff_frequency);
}

template <typename Command>
void runMotionWithTorques(Robot& robot, const py::function& torque_callback,
                          const py::function& motion_callback, bool limit_rate,
                          double cutoff_frequency) {
  const auto torques = callback<Torques>(torque_callback);
  const auto motion = callback<Command>(motion_callback);
  const py::gil_scoped_release release;
  robot.control(torques, motion, limit_rate, cutoff_frequency);
}

/// @param other_name what panda-python calls the kind of motion, which has other arguments there
template <typename Command>
void bindGenerator(py::class_<Robot>& robot, const std::string& name, const std::string& other_name,
                   const char* doc) {
  const auto limit_rate = py::arg("limit_rate") = true;
  const auto cutoff_frequency = py::arg("cutoff_frequency") = kDefaultCutoffFrequency;
  const auto controller_mode = py::arg("controller_mode") = ControllerMode::kJointImpedance;
  robot.def(
      ("control_" + name).c_str(),
      [](Robot& self, const py::function& motion_callback,
         const std::optional<py::function>& torque_callback, ControllerMode mode, bool limit,
         double cutoff) {
        if (torque_callback) {
          runMotionWithTorques<Command>(self, *torque_callback, motion_callback, limit, cutoff);
        } else {
          runMotion<Command>(self, motion_callback, mode, limit, cutoff);
        }
      },
      py::arg("callback"), py::arg("torque_callback") = py::none(), controller_mode, limit_rate,
      cutoff_frequency, doc);
  robot.def(("control_" + name).c_str(), &runMotion<Command>, py::arg("motion_generator_callback"),
            controller_mode, limit_rate, cutoff_frequency,
            "The same with the arguments of panda-python.");
  robot.attr(("control_" + other_name).c_str()) = robot.attr(("control_" + name).c_str());
  robot.def(("control_torque_" + other_name).c_str(), &runMotionWithTorques<Command>,
            py::arg("control_callback"), py::arg("motion_generator_callback"), limit_rate,
            cutoff_frequency,
            "The same with torques of the first callback in place of the robot's controller.");
}

MoveMode moveMode(ControllerMode mode) {
  return mode == ControllerMode::kJointImpedance ? MoveMode::kJointImpedance
                                                 : MoveMode::kCartesianImpedance;
}

template <std::unique_ptr<ActiveControlBase> (Robot::*start)(const MoveMode&)>
void bindStart(py::class_<Robot>& robot, const char* name) {
  robot.def(
      name, [](Robot& self, ControllerMode mode) { return Motion((self.*start)(moveMode(mode))); },
      py::arg("controller_mode") = ControllerMode::kJointImpedance,
      py::call_guard<py::gil_scoped_release>(), "Starts a motion; returns an ActiveControl.");
}

void bindControl(py::class_<Robot>& robot) {
  defNamed(
      robot, "control_torques", {{{"callback", "control_callback"}}},
      [](Robot& self, const py::function& function, bool limit_rate, double cutoff_frequency) {
        const auto torques = callback<Torques>(function);
        const py::gil_scoped_release release;
        self.control(torques, limit_rate, cutoff_frequency);
      },
      py::arg("callback"), py::arg("limit_rate") = true,
      py::arg("cutoff_frequency") = kDefaultCutoffFrequency,
      "Controls the torques: callback(state, period) -> Torques once a millisecond, until it "
      "returns motion_finished(Torques).\n\nRaises ControlException when the motion is aborted.");
  bindGenerator<JointPositions>(robot, "joint_positions", "joint_position",
                                "callback(state, period) -> JointPositions once a millisecond.");
  bindGenerator<JointVelocities>(robot, "joint_velocities", "joint_velocity",
                                 "callback(state, period) -> JointVelocities once a millisecond.");
  bindGenerator<CartesianPose>(robot, "cartesian_pose", "cartesian_pose",
                               "callback(state, period) -> CartesianPose once a millisecond.");
  bindGenerator<CartesianVelocities>(
      robot, "cartesian_velocities", "cartesian_velocity",
      "callback(state, period) -> CartesianVelocities once a millisecond.");
  alias(robot, {{"control_torques", "control"}});

  robot.def(
      "start_torque_control", [](Robot& self) { return Motion(self.startTorqueControl()); },
      py::call_guard<py::gil_scoped_release>(), "Starts torque control; returns an ActiveControl.");
  bindStart<&Robot::startJointPositionControl>(robot, "start_joint_position_control");
  bindStart<&Robot::startJointVelocityControl>(robot, "start_joint_velocity_control");
  bindStart<&Robot::startCartesianPoseControl>(robot, "start_cartesian_pose_control");
  bindStart<&Robot::startCartesianVelocityControl>(robot, "start_cartesian_velocity_control");
  robot.def(
      "start_async_joint_position_control",
      [](Robot& self, const std::vector<double>& maximum_velocities, ControllerMode mode) {
        return Motion(self.startAsyncJointPositionControl(moveMode(mode), maximum_velocities));
      },
      py::arg("maximum_velocities"), py::arg("controller_mode") = ControllerMode::kJointImpedance,
      py::call_guard<py::gil_scoped_release>(),
      "Starts a motion whose way to each commanded position the robot plans itself (FR3, protocol "
      "10), no joint faster than allowed, 7 [rad/s]; returns an ActiveControl. Commands need not "
      "come every millisecond.\n\nRaises CommandException where the robot has no such motion.");
}

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

void bindSetters(py::class_<Robot>& robot) {
  using release = py::gil_scoped_release;
  defNamed(
      robot, "set_collision_behavior", {kThresholds},
      [](Robot& self, const py::object& lower_torque, const py::object& upper_torque,
         const py::object& lower_force, const py::object& upper_force) {
        const auto a = arrayOf<7>(lower_torque, "lower_torque");
        const auto b = arrayOf<7>(upper_torque, "upper_torque");
        const auto c = arrayOf<6>(lower_force, "lower_force");
        const auto d = arrayOf<6>(upper_force, "upper_force");
        const release free;
        self.setCollisionBehavior(a, b, c, d);
      },
      py::arg("lower_torque"), py::arg("upper_torque"), py::arg("lower_force"),
      py::arg("upper_force"),
      "Thresholds of contact (lower) and collision (upper): 7 [Nm] and 6 [N, Nm].");
  defNamed(
      robot, "set_collision_behavior", {kThresholds},
      [](Robot& self, const py::object& lower_torque_acceleration,
         const py::object& upper_torque_acceleration, const py::object& lower_torque_nominal,
         const py::object& upper_torque_nominal, const py::object& lower_force_acceleration,
         const py::object& upper_force_acceleration, const py::object& lower_force_nominal,
         const py::object& upper_force_nominal) {
        const auto a = arrayOf<7>(lower_torque_acceleration, "lower_torque_acceleration");
        const auto b = arrayOf<7>(upper_torque_acceleration, "upper_torque_acceleration");
        const auto c = arrayOf<7>(lower_torque_nominal, "lower_torque_nominal");
        const auto d = arrayOf<7>(upper_torque_nominal, "upper_torque_nominal");
        const auto e = arrayOf<6>(lower_force_acceleration, "lower_force_acceleration");
        const auto f = arrayOf<6>(upper_force_acceleration, "upper_force_acceleration");
        const auto g = arrayOf<6>(lower_force_nominal, "lower_force_nominal");
        const auto h = arrayOf<6>(upper_force_nominal, "upper_force_nominal");
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
          [](Robot& self, const py::object& K_theta) {
            const auto stiffness = arrayOf<7>(K_theta, "K_theta");
            const release free;
            self.setJointImpedance(stiffness);
          },
          py::arg("K_theta"), "Stiffness of the robot's joint controller, 7 [Nm/rad].")
      .def(
          "set_cartesian_impedance",
          [](Robot& self, const py::object& K_x) {
            const auto stiffness = arrayOf<6>(K_x, "K_x");
            const release free;
            self.setCartesianImpedance(stiffness);
          },
          py::arg("K_x"), "Stiffness of the robot's Cartesian controller, 6 [N/m, Nm/rad].")
      .def(
          "set_guiding_mode",
          [](Robot& self, const py::object& guiding_mode, const py::object& elbow) {
            const auto axes = switches<6>(guiding_mode, "guiding_mode");
            const bool free_elbow = yesOrNo(elbow, "elbow");
            const release free;
            self.setGuidingMode(axes, free_elbow);
          },
          py::arg("guiding_mode"), py::arg("elbow"),
          "Which directions (6) and whether the elbow can be guided by hand.")
      .def(
          "set_K",
          [](Robot& self, const py::object& EE_T_K) {
            const auto pose = arrayOf<16>(EE_T_K, "EE_T_K");
            const release free;
            self.setK(pose);
          },
          py::arg("EE_T_K"), "Pose of the stiffness frame in EE, 4x4.")
      .def(
          "set_EE",
          [](Robot& self, const py::object& NE_T_EE) {
            const auto pose = arrayOf<16>(NE_T_EE, "NE_T_EE");
            const release free;
            self.setEE(pose);
          },
          py::arg("NE_T_EE"), "Pose of the end effector in NE, 4x4.");
  defNamed(
      robot, "set_load", {{{"mass", "load_mass"}}},
      [](Robot& self, const py::object& load_mass, const py::object& F_x_Cload,
         const py::object& inertia) {
        const double mass = anyNumber(load_mass, "mass");
        const auto com = arrayOf<3>(F_x_Cload, "F_x_Cload");
        const auto load_inertia = arrayOf<9>(inertia, "load_inertia");
        const release free;
        self.setLoad(mass, com, load_inertia);
      },
      py::arg("mass"), py::arg("F_x_Cload"), py::arg("load_inertia"),
      "Mass [kg], center of mass in F, 3 [m], and inertia, 3x3 [kg m^2], of the load.");
  robot.def("set_filters", &Robot::setFilters, py::call_guard<release>(),
            py::arg("joint_position_filter_frequency"), py::arg("joint_velocity_filter_frequency"),
            py::arg("cartesian_position_filter_frequency"),
            py::arg("cartesian_velocity_filter_frequency"), py::arg("controller_filter_frequency"),
            "The robot's own filters of commands, each 1 to 1000 [Hz], where 1000 means none "
            "(Panda only).");
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
      "on; without arguments that of 0.9.");
}

void bindReading(py::module_& module, py::class_<Robot>& robot) {
  py::class_<VirtualWallCuboid>(module, "VirtualWallCuboid", py::module_local(),
                                "A box that the end effector must not leave.")
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
      .def_readonly("active", &VirtualWallCuboid::active, "Whether the robot enforces it.");
  robot
      .def("get_virtual_wall", &Robot::getVirtualWall, py::call_guard<py::gil_scoped_release>(),
           py::arg("id"), "A virtual wall by its number (Panda only).")
      .def(
          "get_upper_joint_velocity_limits",
          [](const Robot& self, const py::object& q) {
            return copy(self.getUpperJointVelocityLimits(arrayOf<7>(q, "q")), Shape::kVector);
          },
          py::arg("q"), "Highest velocities that the rate limiter allows at q [rad], 7 [rad/s].")
      .def(
          "get_lower_joint_velocity_limits",
          [](const Robot& self, const py::object& q) {
            return copy(self.getLowerJointVelocityLimits(arrayOf<7>(q, "q")), Shape::kVector);
          },
          py::arg("q"), "Lowest velocities, likewise.");
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
                          "one operation at a time, but stop() from any thread.");
  withNames(
      {{{"address", "franka_address"}}, {{"address", "robot_ip_address"}}},
      [&](const auto&... extra) {
        robot.def(py::init([](const py::object& address, const py::object& realtime_config,
                              const py::object& log_size) {
                    const std::string where = text(address, "address");
                    const auto config = objectOf<RealtimeConfig>(realtime_config, "realtime_config",
                                                                 "a RealtimeConfig");
                    const std::int64_t size = wholeNumber(log_size, "log_size");
                    if (size < 0) {
                      throw std::invalid_argument("log_size must be 0 or more, not " +
                                                  std::to_string(size) + ".");
                    }
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
      .def("read_once", &Robot::readOnce, py::call_guard<release>(),
           "Waits for the next RobotState.")
      .def(
          "read",
          [](Robot& self, py::function function) {
            const py::gil_scoped_release free;
            self.read([&function](const RobotState& state) {
              const py::gil_scoped_acquire acquire;
              return py::bool_(function(state)).cast<bool>();
            });
          },
          py::arg("callback"), "Calls callback(state) with every state until it returns False.")
      .def("automatic_error_recovery", &Robot::automaticErrorRecovery, py::call_guard<release>(),
           "Recovers from a reflex. Raises CommandException when the user has to act.")
      .def("stop", &Robot::stop, py::call_guard<release>(), "Ends the motion under way.")
      .def("load_model", &Robot::loadModel, py::call_guard<release>(), "The robot's Model.")
      .def("get_robot_model", &Robot::getRobotModel, py::call_guard<release>(),
           "The robot's URDF (FR3 from system 5.7 on).");
  bindReading(module, robot);
  bindSetters(robot);
  bindControlOptions(module, robot);
  bindControl(robot);
}

}  // namespace pyfranka

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/model.h>
#include <franka/robot.h>
#include <pybind11/functional.h>
#include <pybind11/stl.h>

#include <string>
#include <utility>
#include <vector>

#include "bindings.h"
#include "motion.h"

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
    const py::object result = (*shared)(state, period.toSec());
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
void bindGenerator(py::class_<Robot>& robot, const char* name, const char* doc) {
  robot.def(
      name,
      [](Robot& self, const py::function& motion_callback, const py::object& torque_callback,
         ControllerMode controller_mode, bool limit_rate, double cutoff_frequency) {
        const auto motion = callback<Command>(motion_callback);
        if (torque_callback.is_none()) {
          const py::gil_scoped_release release;
          self.control(motion, controller_mode, limit_rate, cutoff_frequency);
        } else {
          const auto torques = callback<Torques>(py::function(torque_callback));
          const py::gil_scoped_release release;
          self.control(torques, motion, limit_rate, cutoff_frequency);
        }
      },
      py::arg("callback"), py::arg("torque_callback") = py::none(),
      py::arg("controller_mode") = ControllerMode::kJointImpedance, py::arg("limit_rate") = true,
      py::arg("cutoff_frequency") = kDefaultCutoffFrequency, doc);
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
  robot.def(
      "control_torques",
      [](Robot& self, const py::function& function, bool limit_rate, double cutoff_frequency) {
        const auto torques = callback<Torques>(function);
        const py::gil_scoped_release release;
        self.control(torques, limit_rate, cutoff_frequency);
      },
      py::arg("callback"), py::arg("limit_rate") = true,
      py::arg("cutoff_frequency") = kDefaultCutoffFrequency,
      "Controls the torques: callback(state, period) -> Torques once a millisecond, until it "
      "returns motion_finished(Torques).\n\nRaises ControlException when the motion is aborted.");
  bindGenerator<JointPositions>(robot, "control_joint_positions",
                                "callback(state, period) -> JointPositions once a millisecond.");
  bindGenerator<JointVelocities>(robot, "control_joint_velocities",
                                 "callback(state, period) -> JointVelocities once a millisecond.");
  bindGenerator<CartesianPose>(robot, "control_cartesian_pose",
                               "callback(state, period) -> CartesianPose once a millisecond.");
  bindGenerator<CartesianVelocities>(
      robot, "control_cartesian_velocities",
      "callback(state, period) -> CartesianVelocities once a millisecond.");

  robot.def(
      "start_torque_control", [](Robot& self) { return Motion(self.startTorqueControl()); },
      py::call_guard<py::gil_scoped_release>(), "Starts torque control; returns an ActiveControl.");
  bindStart<&Robot::startJointPositionControl>(robot, "start_joint_position_control");
  bindStart<&Robot::startJointVelocityControl>(robot, "start_joint_velocity_control");
  bindStart<&Robot::startCartesianPoseControl>(robot, "start_cartesian_pose_control");
  bindStart<&Robot::startCartesianVelocityControl>(robot, "start_cartesian_velocity_control");
}

void bindSetters(py::class_<Robot>& robot) {
  using release = py::gil_scoped_release;
  robot
      .def(
          "set_collision_behavior",
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
          "Thresholds of contact (lower) and collision (upper): 7 [Nm] and 6 [N, Nm].")
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
      .def("set_guiding_mode", &Robot::setGuidingMode, py::call_guard<release>(),
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
          py::arg("NE_T_EE"), "Pose of the end effector in NE, 4x4.")
      .def(
          "set_load",
          [](Robot& self, double mass, const py::object& F_x_Cload, const py::object& inertia) {
            const auto com = arrayOf<3>(F_x_Cload, "F_x_Cload");
            const auto load_inertia = arrayOf<9>(inertia, "load_inertia");
            const release free;
            self.setLoad(mass, com, load_inertia);
          },
          py::arg("mass"), py::arg("F_x_Cload"), py::arg("load_inertia"),
          "Mass [kg], centre of mass in F, 3 [m], and inertia, 3x3 [kg m^2], of the load.");
}

}  // namespace

void bindRobot(py::module_& module) {
  using release = py::gil_scoped_release;
  py::enum_<RealtimeConfig>(module, "RealtimeConfig",
                            "Whether a program without real-time priority may control the robot.")
      .value("Enforce", RealtimeConfig::kEnforce)
      .value("Ignore", RealtimeConfig::kIgnore);

  py::class_<Robot> robot(module, "Robot",
                          "A connection to a robot. Waiting calls let other Python threads run; "
                          "one operation at a time, but stop() from any thread.");
  robot
      .def(py::init<const std::string&, RealtimeConfig, size_t>(), py::call_guard<release>(),
           py::arg("address"), py::arg("realtime_config") = RealtimeConfig::kEnforce,
           py::arg("log_size") = 50,
           "Connects. Raises NetworkException, IncompatibleVersionException.")
      .def_property_readonly("server_version", &Robot::serverVersion,
                             "Version of the protocol that the robot speaks.")
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
           "Recovers from a reflex. Raises CommandException when a person has to act.")
      .def("stop", &Robot::stop, py::call_guard<release>(), "Ends the motion under way.")
      .def("load_model", &Robot::loadModel, py::call_guard<release>(), "The robot's Model.")
      .def("get_robot_model", &Robot::getRobotModel, py::call_guard<release>(),
           "The robot's URDF (FR3 from system 5.7 on).");
  bindSetters(robot);
  bindControl(robot);
}

}  // namespace pyfranka

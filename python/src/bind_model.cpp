// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The robot's own model and ModelKDL, with the same functions.
#include <franka/model.h>
#include <franka/robot_state.h>
#include <franka_core/robot_state.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "arguments.h"
#include "bindings.h"
#include "other_names.h"
#include "python_types.h"
#include "sim_model.h"
#ifdef PYFRANKA_IN_ROS
#include <franka_hw/model_kdl.h>
#include <urdf/model.h>
#endif

namespace pyfranka {

namespace {

using franka::Frame;
using franka::RobotState;

/// panda-python's name of the argument.
const std::vector<Names> kOfState = {{{"state", "robot_state"}}};

constexpr const char* kOfPositions =
    "The same for joint positions, 7 [rad], and the poses of EE in F and K in EE, 4x4.";
constexpr const char* kOfLoad =
    "The same for joint positions, 7 [rad], and the payload at the flange: inertia about its "
    "center "
    "of mass, 3x3 [kg m^2], mass [kg], center of mass in F, 3 [m].";

/// Functions of a state, which has all that they need.
template <typename State, typename Model>
void bindForState(py::class_<Model>& type) {
  defNamed(
      type, "pose", kOfState,
      [](const Model& self, Frame frame, const State& state) {
        return copy(self.pose(frame, state), Shape::kMatrix4);
      },
      py::arg("frame"), py::arg("state"),
      "Pose of a frame in O, 4x4.\n\n>>> model.pose(pyfranka.Frame.EndEffector, state).shape\n(4, "
      "4)");
  defNamed(
      type, "zero_jacobian", kOfState,
      [](const Model& self, Frame frame, const State& state) {
        return copy(self.zeroJacobian(frame, state), Shape::kJacobian);
      },
      py::arg("frame"), py::arg("state"),
      "Jacobian of a frame in O, 6x7, linear rows first.\n\n>>> "
      "model.zero_jacobian(pyfranka.Frame.EndEffector, state).shape\n(6, 7)");
  defNamed(
      type, "zero_jacobian", kOfState,
      [](const Model& self, const State& state) {
        return copy(self.zeroJacobian(Frame::kEndEffector, state), Shape::kJacobian);
      },
      py::arg("state"), "The same of the end effector.");
  defNamed(
      type, "body_jacobian", kOfState,
      [](const Model& self, Frame frame, const State& state) {
        return copy(self.bodyJacobian(frame, state), Shape::kJacobian);
      },
      py::arg("frame"), py::arg("state"),
      "Jacobian of a frame in its own axes, 6x7.\n\n>>> "
      "model.body_jacobian(pyfranka.Frame.EndEffector, state).shape\n(6, 7)");
  defNamed(
      type, "mass", kOfState,
      [](const Model& self, const State& state) { return copy(self.mass(state), Shape::kMass); },
      py::arg("state"), "Mass matrix, 7x7 [kg m^2].\n\n>>> model.mass(state).shape\n(7, 7)");
  defNamed(
      type, "coriolis", kOfState,
      [](const Model& self, const State& state) {
        return copy(self.coriolis(state), Shape::kVector);
      },
      py::arg("state"),
      "Coriolis torques C(q, dq) dq, 7 [Nm].\n\n>>> model.coriolis(state).shape\n(7,)");
  defNamed(
      type, "gravity", kOfState,
      [](const Model& self, const State& state) {
        return copy(self.gravity(state), Shape::kVector);
      },
      py::arg("state"), "Gravity torques, 7 [Nm].\n\n>>> model.gravity(state).shape\n(7,)");
  defNamed(
      type, "gravity", kOfState,
      [](const Model& self, const State& state, const python::ArrayLike& gravity_earth) {
        return copy(self.gravity(state, finite<3>(gravity_earth, "gravity_earth")), Shape::kVector);
      },
      py::arg("state"), py::arg("gravity_earth"), "The same with another gravity in O, 3 [m/s^2].");
}

template <typename Model>
void bindForArrays(py::class_<Model>& type) {
  type.def(
      "pose",
      [](const Model& self, Frame frame, const python::ArrayLike& q,
         const python::ArrayLike& F_T_EE, const python::ArrayLike& EE_T_K) {
        return copy(self.pose(frame, finite<7>(q, "q"), finite<16>(F_T_EE, "F_T_EE"),
                              finite<16>(EE_T_K, "EE_T_K")),
                    Shape::kMatrix4);
      },
      py::arg("frame"), py::arg("q"), py::arg("F_T_EE"), py::arg("EE_T_K"), kOfPositions);
  type.def(
      "zero_jacobian",
      [](const Model& self, Frame frame, const python::ArrayLike& q,
         const python::ArrayLike& F_T_EE, const python::ArrayLike& EE_T_K) {
        return copy(self.zeroJacobian(frame, finite<7>(q, "q"), finite<16>(F_T_EE, "F_T_EE"),
                                      finite<16>(EE_T_K, "EE_T_K")),
                    Shape::kJacobian);
      },
      py::arg("frame"), py::arg("q"), py::arg("F_T_EE"), py::arg("EE_T_K"), kOfPositions);
  type.def(
      "body_jacobian",
      [](const Model& self, Frame frame, const python::ArrayLike& q,
         const python::ArrayLike& F_T_EE, const python::ArrayLike& EE_T_K) {
        return copy(self.bodyJacobian(frame, finite<7>(q, "q"), finite<16>(F_T_EE, "F_T_EE"),
                                      finite<16>(EE_T_K, "EE_T_K")),
                    Shape::kJacobian);
      },
      py::arg("frame"), py::arg("q"), py::arg("F_T_EE"), py::arg("EE_T_K"), kOfPositions);
  type.def(
      "mass",
      [](const Model& self, const python::ArrayLike& q, const python::ArrayLike& I_total,
         const python::Float& m_total, const python::ArrayLike& F_x_Ctotal) {
        return copy(self.mass(finite<7>(q, "q"), finite<9>(I_total, "I_total"),
                              number(m_total, "m_total"), finite<3>(F_x_Ctotal, "F_x_Ctotal")),
                    Shape::kMass);
      },
      py::arg("q"), py::arg("I_total"), py::arg("m_total"), py::arg("F_x_Ctotal"), kOfLoad);
  type.def(
      "coriolis",
      [](const Model& self, const python::ArrayLike& q, const python::ArrayLike& dq,
         const python::ArrayLike& I_total, const python::Float& m_total,
         const python::ArrayLike& F_x_Ctotal) {
        return copy(
            self.coriolis(finite<7>(q, "q"), finite<7>(dq, "dq"), finite<9>(I_total, "I_total"),
                          number(m_total, "m_total"), finite<3>(F_x_Ctotal, "F_x_Ctotal")),
            Shape::kVector);
      },
      py::arg("q"), py::arg("dq"), py::arg("I_total"), py::arg("m_total"), py::arg("F_x_Ctotal"),
      "The same for joint positions, 7 [rad], joint velocities, 7 [rad/s], and a load as for "
      "mass.");
  type.def(
      "gravity",
      [](const Model& self, const python::ArrayLike& q, const python::Float& m_total,
         const python::ArrayLike& F_x_Ctotal, const python::ArrayLike& gravity_earth) {
        return copy(self.gravity(finite<7>(q, "q"), number(m_total, "m_total"),
                                 finite<3>(F_x_Ctotal, "F_x_Ctotal"),
                                 finite<3>(gravity_earth, "gravity_earth")),
                    Shape::kVector);
      },
      py::arg("q"), py::arg("m_total"), py::arg("F_x_Ctotal"),
      py::arg("gravity_earth") = py::make_tuple(0.0, 0.0, -9.81),
      "The same for joint positions, 7 [rad], and the payload at the flange: mass [kg], center "
      "of mass in F, 3 [m].");
}

#ifdef PYFRANKA_IN_ROS

std::unique_ptr<franka_hw::ModelKDL> modelFromUrdf(const python::Str& description,
                                                   const python::Str& root_link,
                                                   const python::Str& tip_link) {
  const std::string root = text(root_link, "root");
  const std::string tip = text(tip_link, "tip");
  urdf::Model model;
  if (!model.initString(text(description, "urdf"))) {
    throw std::invalid_argument("The text is not a URDF; see the messages above.");
  }
  return std::make_unique<franka_hw::ModelKDL>(model, root, tip);
}

void bindModelKdl(py::module_& module) {
  py::class_<franka_hw::ModelKDL> kdl(
      module, "ModelKDL", py::module_local(),
      "The arm's model on KDL, from a URDF; no robot needed. Its functions raise ValueError for an "
      "array of another shape or with a NaN, and TypeError for what is neither a state nor an "
      "array.\n\n>>> kdl "
      "= pyfranka.ModelKDL(urdf, "
      "\"panda_link0\", \"panda_link8\")\n>>> kdl.gravity(pyfranka.RobotState()).shape\n(7,)");
  kdl.def(py::init(&modelFromUrdf), py::arg("urdf"), py::arg("root"), py::arg("tip"),
          "Chain from link `root` to link `tip` of a URDF text. Raises ValueError for a text that "
          "is not a URDF, RuntimeError for a chain that is not an arm.");
  kdl.def("__repr__", [](const franka_hw::ModelKDL&) {
    return "<ModelKDL of a URDF: pose, Jacobians, mass, coriolis, gravity>";
  });
  bindForState<RobotState>(kdl);
  bindForArrays(kdl);
}

#else

/// The name in builds without ROS, so that a program that needs it gets a reason.
struct ModelKDL {
  ModelKDL(const py::args& /*args*/, const py::kwargs& /*kwargs*/) {
    throw std::runtime_error(
        "ModelKDL needs ROS, and this pyfranka was built without it. Take the robot's own model "
        "(Robot.load_model, or robot.model in pyfranka.sim), or the pyfranka of the ROS "
        "workspace.");
  }
};

void bindModelKdl(py::module_& module) {
  py::class_<ModelKDL>(module, "ModelKDL", py::module_local(),
                       "The arm's model on KDL: only in builds with ROS; raises "
                       "RuntimeError.\n\n>>> kdl = pyfranka.ModelKDL(urdf, \"panda_link0\", "
                       "\"panda_link8\")\nTraceback (most recent call last):\nRuntimeError: ...")
      .def(py::init<const py::args&, const py::kwargs&>(), "Raises RuntimeError.");
}

#endif

}  // namespace

void bindModel(py::module_& module) {
  aliasAsInCpp(py::enum_<Frame>(module, "Frame", py::module_local(),
                                "Frames of the arm, from the base to the tip.")
                   .value("Joint1", Frame::kJoint1)
                   .value("Joint2", Frame::kJoint2)
                   .value("Joint3", Frame::kJoint3)
                   .value("Joint4", Frame::kJoint4)
                   .value("Joint5", Frame::kJoint5)
                   .value("Joint6", Frame::kJoint6)
                   .value("Joint7", Frame::kJoint7)
                   .value("Flange", Frame::kFlange)
                   .value("EndEffector", Frame::kEndEffector)
                   .value("Stiffness", Frame::kStiffness));

  py::class_<franka::Model> model(
      module, "Model", py::module_local(),
      "The model that the robot provides. Its functions raise ValueError for an array of another "
      "shape, and TypeError for what is neither a state nor an array.\n\n>>> model, state = "
      "robot.load_model(), "
      "robot.read_once()\n>>> numpy.allclose(model.pose(pyfranka.Frame.EndEffector, state), "
      "state.O_T_EE, atol=1e-3)\nTrue");
  model.def("__repr__", [](const franka::Model&) {
    return "<Model of a connected robot: pose, Jacobians, mass, coriolis, gravity>";
  });
  bindForState<RobotState>(model);
  bindForArrays(model);
  refuseCopies(model,
               "A Model can be neither pickled nor copied: it is loaded from the robot in this "
               "process. Call load_model() where it is used.");

  bindModelKdl(module);
}

void bindSimModel(py::module_& module) {
  py::class_<SimModel> model(
      module, "ArmModel", py::module_local(),
      "The model of a simulated robot's own control. Its functions raise ValueError for an array "
      "of another shape or with a NaN, and TypeError for what is neither a state nor an "
      "array.\n\n>>> arm = "
      "sim[\"panda\"]\n>>> "
      "arm.command(torque=arm.model.coriolis(arm.state))");
  model.def("__repr__", [](const SimModel&) {
    return "<ArmModel of a simulated robot: pose, Jacobians, mass, coriolis, gravity>";
  });
  bindForState<franka_core::RobotState>(model);
  bindForState<RobotState>(model);
  bindForArrays(model);
  refuseCopies(model,
               "An ArmModel can be neither pickled nor copied: it is part of a simulation of this "
               "process. Make a Simulation where it is used.");
}

}  // namespace pyfranka

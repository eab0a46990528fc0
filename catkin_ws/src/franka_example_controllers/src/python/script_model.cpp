// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "script_model.h"

#include <franka/model.h>
#include <pyfranka/arrays.h>

#include <stdexcept>
#include <utility>

namespace franka_example_controllers {

namespace {

namespace py = pybind11;
using franka::Frame;
using franka_hw::FrankaModelHandle;
using pyfranka::arrayOf;
using pyfranka::copy;
using pyfranka::Shape;

constexpr std::array<double, 3> kGravity{{0.0, 0.0, -9.81}};  // [m/s^2]

class ScriptModel {
 public:
  ScriptModel(const FrankaModelHandle& handle, std::shared_ptr<ModelGate> gate)
      : handle_(handle), gate_(std::move(gate)) {}

  /// Result of `compute` for the handle, as an array of a shape.
  template <typename Compute>
  py::array_t<double> evaluate(Shape shape, Compute compute) const {
    if (!gate_->enter()) {
      throw std::runtime_error(
          "The model may be used only within starting() and update(), by the thread that runs "
          "them.");
    }
    // Functions of the model do not throw.
    const auto values = compute(handle_);
    gate_->leave();
    return copy(values, shape);
  }

 private:
  FrankaModelHandle handle_;
  std::shared_ptr<ModelGate> gate_;
};

void bindDynamics(py::class_<ScriptModel>& type) {
  type.def(
          "mass",
          [](const ScriptModel& self) {
            return self.evaluate(Shape::kMass, [](const auto& model) { return model.getMass(); });
          },
          "Mass matrix, 7x7 [kg m^2].")
      .def(
          "mass",
          [](const ScriptModel& self, const py::object& q, const py::object& total_inertia,
             double total_mass, const py::object& F_x_Ctotal) {
            const auto q_values = arrayOf<7>(q, "q");
            const auto inertia = arrayOf<9>(total_inertia, "total_inertia");
            const auto center = arrayOf<3>(F_x_Ctotal, "F_x_Ctotal");
            return self.evaluate(Shape::kMass, [&](const auto& model) {
              return model.getMass(q_values, inertia, total_mass, center);
            });
          },
          py::arg("q"), py::arg("total_inertia"), py::arg("total_mass"), py::arg("F_x_Ctotal"),
          "The same for joint positions, 7 [rad], and a load: 3x3 [kg m^2], [kg], 3 [m].")
      .def(
          "coriolis",
          [](const ScriptModel& self) {
            return self.evaluate(Shape::kVector,
                                 [](const auto& model) { return model.getCoriolis(); });
          },
          "Coriolis torques C(q, dq) dq, 7 [Nm].")
      .def(
          "coriolis",
          [](const ScriptModel& self, const py::object& q, const py::object& dq,
             const py::object& total_inertia, double total_mass, const py::object& F_x_Ctotal) {
            const auto q_values = arrayOf<7>(q, "q");
            const auto dq_values = arrayOf<7>(dq, "dq");
            const auto inertia = arrayOf<9>(total_inertia, "total_inertia");
            const auto center = arrayOf<3>(F_x_Ctotal, "F_x_Ctotal");
            return self.evaluate(Shape::kVector, [&](const auto& model) {
              return model.getCoriolis(q_values, dq_values, inertia, total_mass, center);
            });
          },
          py::arg("q"), py::arg("dq"), py::arg("total_inertia"), py::arg("total_mass"),
          py::arg("F_x_Ctotal"), "The same for another state.")
      .def(
          "gravity",
          [](const ScriptModel& self, const py::object& gravity_earth) {
            const auto gravity =
                gravity_earth.is_none() ? kGravity : arrayOf<3>(gravity_earth, "gravity_earth");
            return self.evaluate(Shape::kVector,
                                 [&](const auto& model) { return model.getGravity(gravity); });
          },
          py::arg("gravity_earth") = py::none(),
          "Gravity torques, 7 [Nm], for gravity in O, 3 [m/s^2], by default (0, 0, -9.81).")
      .def(
          "gravity",
          [](const ScriptModel& self, const py::object& q, double total_mass,
             const py::object& F_x_Ctotal, const py::object& gravity_earth) {
            const auto q_values = arrayOf<7>(q, "q");
            const auto center = arrayOf<3>(F_x_Ctotal, "F_x_Ctotal");
            const auto gravity =
                gravity_earth.is_none() ? kGravity : arrayOf<3>(gravity_earth, "gravity_earth");
            return self.evaluate(Shape::kVector, [&](const auto& model) {
              return model.getGravity(q_values, total_mass, center, gravity);
            });
          },
          py::arg("q"), py::arg("total_mass"), py::arg("F_x_Ctotal"),
          py::arg("gravity_earth") = py::none(), "The same for another state.");
}

/// A function of a frame, at the cycle's state and at another one.
template <typename Get>
void bindFrame(py::class_<ScriptModel>& type, const char* name, Shape shape, Get get,
               const char* doc) {
  type.def(
          name,
          [=](const ScriptModel& self, Frame frame) {
            return self.evaluate(shape, [&](const auto& model) { return get(model, frame); });
          },
          py::arg("frame"), doc)
      .def(
          name,
          [=](const ScriptModel& self, Frame frame, const py::object& q, const py::object& F_T_EE,
              const py::object& EE_T_K) {
            const auto q_values = arrayOf<7>(q, "q");
            const auto ee = arrayOf<16>(F_T_EE, "F_T_EE");
            const auto k = arrayOf<16>(EE_T_K, "EE_T_K");
            return self.evaluate(
                shape, [&](const auto& model) { return get(model, frame, q_values, ee, k); });
          },
          py::arg("frame"), py::arg("q"), py::arg("F_T_EE"), py::arg("EE_T_K"),
          "The same for joint positions, 7 [rad], and the poses of EE and K, 4x4.");
}

void bindKinematics(py::class_<ScriptModel>& type) {
  const auto pose = [](const FrankaModelHandle& model, const auto&... given) {
    return model.getPose(given...);
  };
  bindFrame(type, "pose", Shape::kMatrix4, pose, "Pose of a frame in O, 4x4.");
  const auto body = [](const FrankaModelHandle& model, const auto&... given) {
    return model.getBodyJacobian(given...);
  };
  bindFrame(type, "body_jacobian", Shape::kJacobian, body,
            "Jacobian of a frame in its own axes, 6x7, linear rows first.");
  const auto zero = [](const FrankaModelHandle& model, const auto&... given) {
    return model.getZeroJacobian(given...);
  };
  bindFrame(type, "zero_jacobian", Shape::kJacobian, zero,
            "Jacobian of a frame in O, 6x7, linear rows first.");
}

/// Registers the type with Python, once per process.
void ensureType() {
  static bool done = false;  // guarded by the interpreter's lock
  if (done) {
    return;
  }
  // Python keeps it for ever.
  auto* const definition = new PyModuleDef();
  auto module =
      py::module_::create_extension_module("franka_python_controller", nullptr, definition);
  py::class_<ScriptModel> type(module, "Model",
                               "The arm's model at the state of this cycle; to be used within "
                               "starting() and update().");
  bindDynamics(type);
  bindKinematics(type);
  module.release();
  done = true;
}

}  // namespace

py::object makeScriptModel(const FrankaModelHandle& handle, std::shared_ptr<ModelGate> gate) {
  ensureType();
  return py::cast(ScriptModel(handle, std::move(gate)));
}

}  // namespace franka_example_controllers

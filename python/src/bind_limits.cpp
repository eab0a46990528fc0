// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/motion_limits.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "bindings.h"

namespace pyfranka {

namespace {

using franka_core::DerivativeLimits;
using franka_core::MotionLimits;

using Positions = py::array_t<double, py::array::c_style | py::array::forcecast>;

py::tuple velocityRanges(const MotionLimits& limits, const Positions& q) {
  if (q.ndim() < 1 || q.ndim() > 2 || q.shape(q.ndim() - 1) != 7) {
    throw std::invalid_argument("q must be 7 joint positions, or rows of 7.");
  }
  py::array_t<double> lower(q.request().shape), upper(q.request().shape);
  for (py::ssize_t i = 0; i < q.size(); i++) {
    const auto joint = static_cast<std::size_t>(i % 7);
    lower.mutable_data()[i] = limits.lowestVelocity(joint, q.data()[i]);
    upper.mutable_data()[i] = limits.highestVelocity(joint, q.data()[i]);
  }
  return py::make_tuple(lower, upper);
}

std::array<double, 3> derivatives(const DerivativeLimits& limits) {
  return {limits.velocity, limits.acceleration, limits.jerk};
}

template <typename Type>
void vector(py::class_<MotionLimits>& type, const char* name, Type franka_core::ArmLimits::* member,
            const char* doc) {
  type.def_property_readonly(
      name, [member](const MotionLimits& self) { return copy(self.arm.*member, Shape::kVector); },
      doc);
}

}  // namespace

void bindLimits(py::module_& module) {
  using franka_core::ArmLimits;
  py::class_<MotionLimits> type(module, "ArmLimits", py::module_local(),
                                "The limits of an arm's motions.");
  type.def(py::init([](unsigned version) { return franka_core::motionLimitsOfProtocol(version); }),
           py::arg("version"),
           "Of robots with this protocol version, Robot.server_version: up to 5 a Panda, then an "
           "FR3, from 10 on one with system 5.9 or later.");
  vector(type, "q_min", &ArmLimits::q_min, "Lowest joint positions [rad].");
  vector(type, "q_max", &ArmLimits::q_max, "Highest joint positions [rad].");
  vector(type, "dq", &ArmLimits::dq, "Joint velocities [rad/s].");
  vector(type, "ddq", &ArmLimits::ddq, "Joint accelerations [rad/s^2].");
  vector(type, "dddq", &ArmLimits::dddq, "Joint jerks [rad/s^3].");
  vector(type, "tau", &ArmLimits::tau, "Torques [Nm].");
  vector(type, "dtau", &ArmLimits::dtau, "Torque rates [Nm/s].");
  type.def_property_readonly(
          "translation", [](const MotionLimits& self) { return derivatives(self.arm.translation); },
          "Velocity, acceleration and jerk of EE [m/s and so on].")
      .def_property_readonly(
          "rotation", [](const MotionLimits& self) { return derivatives(self.arm.rotation); },
          "The same of its rotation [rad/s and so on].")
      .def("velocity_range", &velocityRanges, py::arg("q"),
           "Lowest and highest joint velocities [rad/s] at joint positions, 7 or rows of 7 [rad]: "
           "those of an FR3 shrink towards the ends of its joints.");
}

}  // namespace pyfranka

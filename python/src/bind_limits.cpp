// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/fci/protocol.h>
#include <franka_core/motion_limits.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cstdint>
#include <stdexcept>
#include <string>

#include "arguments.h"
#include "bindings.h"
#include "python_types.h"

namespace pyfranka {

namespace {

using franka_core::DerivativeLimits;
using franka_core::MotionLimits;

using Positions = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Positions of one or more moments.
struct PositionsType : python::ArrayLikeType {
  static bool accepts(PyObject* object) {
    return py::detail::make_caster<Positions>().load(object, true);
  }
};

MotionLimits limitsOf(const python::Int& version) {
  using namespace franka_core::fci;
  const std::int64_t number = wholeNumber(version, "version");
  if (number < kOldestRobotVersion || number > kNewestRobotVersion) {
    throw std::invalid_argument("version must be " + std::to_string(kOldestRobotVersion) + " to " +
                                std::to_string(kNewestRobotVersion) + ", not " +
                                std::to_string(number) + ".");
  }
  return franka_core::motionLimitsOfProtocol(static_cast<unsigned>(number));
}

python::ArrayPair velocityRanges(const MotionLimits& limits,
                                 const python::Object<PositionsType>& positions) {
  const auto q = positions.cast<Positions>();
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
                                "The limits of an arm's motions.\n\n>>> "
                                "pyfranka.ArmLimits(robot.server_version).tau.tolist()\n[87.0, "
                                "87.0, 87.0, 87.0, 12.0, 12.0, 12.0]");
  type.def(py::init(&limitsOf), py::arg("version"),
           "Of robots with this protocol version, Robot.server_version: 3 to 5 a Panda, then an "
           "FR3, 10 one with system 5.9 or later. Raises ValueError for another version.");
  type.def("__repr__", [](const MotionLimits& self) {
    return "<ArmLimits of " + std::string(self.position_velocity ? "an FR3" : "a Panda") + ": dq " +
           shortText(self.arm.dq) + " rad/s, tau " + shortText(self.arm.tau) + " Nm>";
  });
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
           "those of an FR3 shrink towards the ends of its joints. Raises ValueError for "
           "another shape.\n\n>>> lowest, highest = "
           "pyfranka.ArmLimits(10).velocity_range(fr3.read_once().q)\n>>> lowest.shape\n(7,)");
}

}  // namespace pyfranka

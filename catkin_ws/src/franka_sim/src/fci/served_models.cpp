// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "fci/served_models.h"

#include <franka_core/limits.h>
#include <franka_core/numbers.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "fci/model_library/parameters.h"

// The library of this build, as linked.
asm(R"(
  .section .rodata
  .balign 16
  .global franka_sim_model_library_begin
  .global franka_sim_model_library_end
franka_sim_model_library_begin:
  .incbin ")" FRANKA_SIM_MODEL_LIBRARY R"("
franka_sim_model_library_end:
  .byte 0
  .previous
)");
extern "C" const std::uint8_t franka_sim_model_library_begin[];
extern "C" const std::uint8_t franka_sim_model_library_end[];

namespace franka_sim::fci {

namespace {

using franka_core::ArmLimits;
using franka_core::ArmModel;
using franka_core::PositionVelocityLimits;

std::string number(double value) { return franka_core::numberText(value, 17); }

std::string triple(double x, double y, double z) {
  return number(x) + " " + number(y) + " " + number(z);
}

// Roll, pitch, yaw of a column-major transform: R = Rz(yaw) Ry(pitch) Rx(roll).
std::string origin(const std::array<double, 16>& t) {
  const double pitch = std::atan2(-t[2], std::hypot(t[0], t[1]));
  double roll = 0.0, yaw = 0.0;
  if (std::hypot(t[0], t[1]) > 1e-9) {
    roll = std::atan2(t[6], t[10]);
    yaw = std::atan2(t[1], t[0]);
  } else {
    roll = std::atan2(-t[9], t[5]);
  }
  return "    <origin xyz=\"" + triple(t[12], t[13], t[14]) + "\" rpy=\"" +
         triple(roll, pitch, yaw) + "\"/>\n";
}

std::string linkText(const std::string& name, const ArmModel::Link& link) {
  const auto& I = link.inertia;
  return "  <link name=\"" + name + "\">\n    <inertial>\n      <origin xyz=\"" +
         triple(link.com[0], link.com[1], link.com[2]) +
         "\" rpy=\"0 0 0\"/>\n      <mass value=\"" + number(link.mass) +
         "\"/>\n      <inertia ixx=\"" + number(I[0]) + "\" ixy=\"" + number(I[1]) + "\" ixz=\"" +
         number(I[2]) + "\" iyy=\"" + number(I[4]) + "\" iyz=\"" + number(I[5]) + "\" izz=\"" +
         number(I[8]) + "\"/>\n    </inertial>\n  </link>\n";
}

std::string jointText(std::size_t index, const ArmModel::Link& link, const ArmLimits& limits,
                      const PositionVelocityLimits& velocities) {
  const std::string id = std::to_string(index + 1);
  return "  <joint name=\"joint" + id + "\" type=\"revolute\">\n" + origin(link.origin) +
         "    <parent link=\"link" + std::to_string(index) + "\"/>\n    <child link=\"link" + id +
         "\"/>\n    <axis xyz=\"0 0 1\"/>\n    <limit lower=\"" + number(limits.q_min[index]) +
         "\" upper=\"" + number(limits.q_max[index]) + "\" velocity=\"" + number(limits.dq[index]) +
         "\" effort=\"" + number(limits.tau[index]) +
         "\"/>\n    <position_based_velocity_limits velocity_offset=\"" +
         number(velocities.offset[index]) + "\" deceleration_limit=\"" +
         number(velocities.deceleration[index] / 2.0) + "\"/>\n  </joint>\n";
}

}  // namespace

std::vector<std::uint8_t> servedLibrary(const ArmModel& arm) {
  std::vector<std::uint8_t> library(franka_sim_model_library_begin, franka_sim_model_library_end);
  const auto& mark = model_library::kMark;
  const auto place = std::search(library.begin(), library.end(), mark.begin(), mark.end());
  if (place == library.end()) {
    throw std::logic_error("The model library of this build has no block for parameters.");
  }
  std::uint8_t* next = &*place + offsetof(model_library::Parameters, numbers);
  const auto put = [&next](double value) {
    std::memcpy(next, &value, sizeof(value));
    next += sizeof(value);
  };
  for (const ArmModel::Link& link : arm.links()) {
    model_library::visitLink(link, put);
  }
  for (const double value : arm.flange()) {
    put(value);
  }
  return library;
}

std::string servedUrdf(const ArmModel& arm, unsigned protocol_version) {
  const ArmLimits& limits = franka_core::limitsOfProtocol(protocol_version);
  const PositionVelocityLimits& velocities =
      franka_core::fr3VelocityLimitsOfProtocol(protocol_version);
  std::string text = "<?xml version=\"1.0\"?>\n<robot name=\"fr3\">\n  <link name=\"link0\"/>\n";
  for (std::size_t i = 0; i < 7; i++) {
    text += linkText("link" + std::to_string(i + 1), arm.links()[i]);
    text += jointText(i, arm.links()[i], limits, velocities);
  }
  return text + "  <link name=\"link8\"/>\n  <joint name=\"joint8\" type=\"fixed\">\n" +
         origin(arm.flange()) +
         "    <parent link=\"link7\"/>\n    <child link=\"link8\"/>\n  </joint>\n</robot>\n";
}

}  // namespace franka_sim::fci

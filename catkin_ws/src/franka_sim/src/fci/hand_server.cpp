// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "fci/hand_server.h"

#include <cmath>

namespace franka_sim::fci {

namespace gripper_codec = franka_core::fci::gripper;

GripperUnit::Ticket GripperDevice::start(GripperUnit& unit, const Request& request) noexcept {
  if (const auto* grasp = std::get_if<gripper_codec::GraspRequest>(&request)) {
    return unit.grasp(grasp->width, grasp->epsilon_inner, grasp->epsilon_outer, grasp->speed,
                      grasp->force);
  }
  if (const auto* move = std::get_if<gripper_codec::MoveRequest>(&request)) {
    return unit.move(move->width, move->speed);
  }
  return std::holds_alternative<gripper_codec::HomingRequest>(request) ? unit.homing()
                                                                       : unit.stop();
}

gripper_codec::StateBuffer GripperDevice::encode(const GripperUnit& unit,
                                                 std::uint32_t message_id) noexcept {
  gripper_codec::State state;
  state.message_id = message_id;
  state.width = unit.width();
  state.max_width = unit.maxWidth();
  state.is_grasped = unit.isGrasped();
  state.temperature = static_cast<std::uint16_t>(std::lround(unit.temperature()));
  gripper_codec::StateBuffer buffer{};
  gripper_codec::encodeState(state, buffer);
  return buffer;
}

template class HandServer<GripperDevice>;

}  // namespace franka_sim::fci

namespace franka_sim::fci {

namespace vacuum_codec = franka_core::fci::vacuum;

namespace {
constexpr double kVacuumUnit = 10.0;  // [mbar] of a request's set point (protocol 7.2)
}  // namespace

VacuumGripperUnit::Ticket VacuumDevice::start(VacuumGripperUnit& unit,
                                              const Request& request) noexcept {
  if (const auto* vacuum = std::get_if<vacuum_codec::VacuumRequest>(&request)) {
    return unit.vacuum(kVacuumUnit * vacuum->vacuum, vacuum->timeout_ms);
  }
  if (const auto* drop = std::get_if<vacuum_codec::DropOffRequest>(&request)) {
    return unit.dropOff(drop->timeout_ms);
  }
  return unit.stop();
}

vacuum_codec::StateBuffer VacuumDevice::encode(const VacuumGripperUnit& unit,
                                               std::uint32_t message_id) noexcept {
  vacuum_codec::State state;
  state.message_id = message_id;
  state.in_control_range = unit.inControlRange();
  state.part_detached = unit.partDetached();
  state.part_present = unit.partPresent();
  state.device_status = static_cast<vacuum_codec::DeviceStatus>(unit.health());
  state.actual_power = static_cast<std::int32_t>(std::lround(unit.power()));
  state.vacuum = static_cast<std::int32_t>(std::lround(unit.vacuum()));
  vacuum_codec::StateBuffer buffer{};
  vacuum_codec::encodeState(state, buffer);
  return buffer;
}

template class HandServer<VacuumDevice>;

}  // namespace franka_sim::fci

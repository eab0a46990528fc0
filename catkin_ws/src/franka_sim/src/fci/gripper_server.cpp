// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/fci/gripper_server.h>

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

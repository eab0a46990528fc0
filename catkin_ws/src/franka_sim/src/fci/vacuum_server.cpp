// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/fci/vacuum_server.h>

#include <cmath>

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

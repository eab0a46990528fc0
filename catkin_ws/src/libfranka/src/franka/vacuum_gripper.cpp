// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/vacuum_gripper.h>
#include <franka_core/fci/vacuum_codec.h>

#include <algorithm>
#include <limits>

#include "franka/gripper_connection.h"

namespace franka {

namespace fci = franka_core::fci;
namespace vacuum_codec = franka_core::fci::vacuum;

struct VacuumProtocol {
  using Request = vacuum_codec::Request;
  using State = vacuum_codec::State;
  using RequestMessage = vacuum_codec::RequestMessage;
  using StateBuffer = vacuum_codec::StateBuffer;
  static constexpr std::uint16_t kPort = fci::kVacuumGripperPort;
  static constexpr std::uint16_t kOldest = fci::kVacuumGripperVersion;
  static constexpr std::uint16_t kNewest = fci::kVacuumGripperVersion;
  static constexpr const char* kTextPrefix = fci::kVacuumGripper;
};

std::uint16_t unsigned16(std::int32_t value) {
  return static_cast<std::uint16_t>(
      std::clamp(value, 0, static_cast<std::int32_t>(std::numeric_limits<std::uint16_t>::max())));
}

class VacuumGripper::Impl : public GripperConnection<VacuumProtocol> {
 public:
  using GripperConnection::GripperConnection;
};

VacuumGripper::VacuumGripper(const std::string& franka_address)
    : impl_(std::make_unique<Impl>(franka_address)) {}
VacuumGripper::VacuumGripper(VacuumGripper&& vacuum_gripper) noexcept = default;
VacuumGripper& VacuumGripper::operator=(VacuumGripper&& vacuum_gripper) noexcept = default;
VacuumGripper::~VacuumGripper() noexcept = default;

bool VacuumGripper::vacuum(uint8_t vacuum, std::chrono::milliseconds timeout,
                           ProductionSetupProfile profile) const {
  vacuum_codec::VacuumRequest request;
  request.vacuum = vacuum;
  request.profile = static_cast<vacuum_codec::Profile>(profile);
  request.timeout_ms = timeout.count();
  return impl_->execute(request, timeout + impl_->longBound());
}

bool VacuumGripper::dropOff(std::chrono::milliseconds timeout) const {
  return impl_->execute(vacuum_codec::DropOffRequest{timeout.count()},
                        timeout + impl_->longBound());
}

bool VacuumGripper::stop() const {
  return impl_->execute(vacuum_codec::StopRequest{}, impl_->longBound());
}

VacuumGripperState VacuumGripper::readOnce() const {
  const vacuum_codec::State received = impl_->readOnce();
  VacuumGripperState state;
  state.in_control_range = received.in_control_range;
  state.part_detached = received.part_detached;
  state.part_present = received.part_present;
  state.device_status = static_cast<VacuumGripperDeviceStatus>(received.device_status);
  state.actual_power = unsigned16(received.actual_power);
  state.vacuum = unsigned16(received.vacuum);
  state.time = Duration(received.message_id);
  return state;
}

VacuumGripper::ServerVersion VacuumGripper::serverVersion() const noexcept {
  return impl_->version();
}

}  // namespace franka

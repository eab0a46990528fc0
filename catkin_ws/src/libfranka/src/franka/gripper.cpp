// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/gripper.h>

#include "franka/gripper_connection.h"

namespace franka {

namespace fci = franka_core::fci;
namespace gripper_codec = franka_core::fci::gripper;

struct HandProtocol {
  using Request = gripper_codec::Request;
  using State = gripper_codec::State;
  using RequestMessage = gripper_codec::RequestMessage;
  using StateBuffer = gripper_codec::StateBuffer;
  static constexpr std::uint16_t kPort = fci::kGripperPort;
  static constexpr std::uint16_t kOldest = fci::kOldestGripperVersion;
  static constexpr std::uint16_t kNewest = fci::kNewestGripperVersion;
  static constexpr const char* kTextPrefix = fci::kGripper;
};

class Gripper::Impl : public GripperConnection<HandProtocol> {
 public:
  using GripperConnection::GripperConnection;
};

Gripper::Gripper(const std::string& franka_address)
    : impl_(std::make_unique<Impl>(franka_address)) {}
Gripper::Gripper(Gripper&& gripper) noexcept = default;
Gripper& Gripper::operator=(Gripper&& gripper) noexcept = default;
Gripper::~Gripper() noexcept = default;

bool Gripper::homing() const {
  return impl_->execute(gripper_codec::HomingRequest{}, impl_->longBound());
}

bool Gripper::grasp(double width, double speed, double force, double epsilon_inner,
                    double epsilon_outer) const {
  gripper_codec::GraspRequest request;
  request.width = width;
  request.epsilon_inner = epsilon_inner;
  request.epsilon_outer = epsilon_outer;
  request.speed = speed;
  request.force = force;
  return impl_->execute(request, impl_->longBound());
}

bool Gripper::move(double width, double speed) const {
  return impl_->execute(gripper_codec::MoveRequest{width, speed}, impl_->longBound());
}

bool Gripper::stop() const {
  return impl_->execute(gripper_codec::StopRequest{}, impl_->longBound());
}

GripperState Gripper::readOnce() const {
  const gripper_codec::State received = impl_->readOnce();
  GripperState state;
  state.width = received.width;
  state.max_width = received.max_width;
  state.is_grasped = received.is_grasped;
  state.temperature = received.temperature;
  state.time = Duration(received.message_id);
  return state;
}

Gripper::ServerVersion Gripper::serverVersion() const noexcept { return impl_->version(); }

}  // namespace franka

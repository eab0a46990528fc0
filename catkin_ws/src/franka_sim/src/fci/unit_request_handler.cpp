// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/fci/unit_request_handler.h>

namespace franka_sim::fci {

namespace codec = franka_core::fci;
using codec::Status;
using franka_core::RobotMode;

namespace {

Status toStatus(RequestStatus status) noexcept {
  switch (status) {
    case RequestStatus::kSuccess:
      return Status::kSuccess;
    case RequestStatus::kInvalidArgument:
      return Status::kInvalidArgumentRejected;
    case RequestStatus::kNotPossible:
      break;
  }
  return Status::kCommandNotPossibleRejected;
}

// One overload for each setter; what is no setter is answered elsewhere.
struct Setter {
  ControlUnit& unit;

  RequestStatus operator()(const codec::SetCollisionBehaviorRequest& r) const noexcept {
    return unit.setCollisionBehavior({r.lower_torques_acceleration, r.upper_torques_acceleration,
                                      r.lower_forces_acceleration, r.upper_forces_acceleration},
                                     {r.lower_torques_nominal, r.upper_torques_nominal,
                                      r.lower_forces_nominal, r.upper_forces_nominal});
  }
  RequestStatus operator()(const codec::SetJointImpedanceRequest& r) const noexcept {
    return unit.setJointImpedance(r.K_theta);
  }
  RequestStatus operator()(const codec::SetCartesianImpedanceRequest& r) const noexcept {
    return unit.setCartesianImpedance(r.K_x);
  }
  RequestStatus operator()(const codec::SetGuidingModeRequest& r) const noexcept {
    return unit.setGuidingMode(r.guiding_mode, r.nullspace);
  }
  RequestStatus operator()(const codec::SetEEToKRequest& r) const noexcept {
    return unit.setK(r.EE_T_K);
  }
  RequestStatus operator()(const codec::SetNEToEERequest& r) const noexcept {
    return unit.setEE(r.NE_T_EE);
  }
  RequestStatus operator()(const codec::SetLoadRequest& r) const noexcept {
    return unit.setLoad({r.mass, r.F_x_Cload, r.inertia});
  }
  RequestStatus operator()(const codec::SetFiltersRequest& r) const noexcept {
    return unit.setFilters(r);
  }
  template <typename Other>
  RequestStatus operator()(const Other& /*request*/) const noexcept {
    return RequestStatus::kNotPossible;
  }
};

}  // namespace

void UnitRequestHandler::connected(std::uint16_t version) noexcept {
  version_ = version;
  applyVersion();
}

// A motion keeps the limits it began with, also where its client has died and another one is here.
void UnitRequestHandler::applyVersion() noexcept {
  if (version_ != 0 && unit_.setProtocolVersion(version_) != RequestStatus::kNotPossible) {
    version_ = 0;
  }
}

std::optional<Status> UnitRequestHandler::handle(const codec::Request& request) noexcept {
  if (const auto* move = std::get_if<codec::MoveRequest>(&request)) {
    // Requests that wait for the arm to come to rest are answered before the next motion begins.
    return unit_.owesAnswers() ? Status::kCommandNotPossibleRejected : unit_.startMotion(*move);
  }
  if (std::holds_alternative<codec::StopMoveRequest>(request)) {
    // Clients stop after every failed motion, whatever the mode, and wait for the answer.
    const std::optional<Status> status = unit_.stopMove();
    return status ? Status::kSuccess : status;
  }
  if (std::holds_alternative<codec::AutomaticErrorRecoveryRequest>(request)) {
    return unit_.startErrorRecovery();
  }
  return toStatus(std::visit(Setter{unit_}, request));
}

std::optional<codec::CartesianLimit> UnitRequestHandler::wall(std::int32_t id) const noexcept {
  const codec::CartesianLimit* wall = unit_.virtualWall(id);
  return wall == nullptr ? std::nullopt : std::optional<codec::CartesianLimit>(*wall);
}

std::optional<Status> UnitRequestHandler::motionEnd() noexcept {
  applyVersion();
  return unit_.takeMotionEnd();
}

std::optional<Status> UnitRequestHandler::stopEnd() noexcept { return unit_.takeStopEnd(); }

std::optional<Status> UnitRequestHandler::recoveryEnd() noexcept { return unit_.takeRecoveryEnd(); }

}  // namespace franka_sim::fci

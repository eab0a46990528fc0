// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/fci/unit_request_handler.h>

#include <type_traits>

namespace franka_sim::fci {

namespace codec = franka_core::fci;
using codec::Status;

namespace {

/// The requests that a control unit handles; the server answers the others.
template <typename Request>
constexpr bool kIsUnitRequest = std::is_constructible_v<UnitRequest, const Request&>;

}  // namespace

void UnitRequestHandler::connected(std::uint16_t version) noexcept {
  version_ = version;
  applyVersion();
}

// A motion keeps its limits, even if its client has disconnected and another one has connected.
void UnitRequestHandler::applyVersion() noexcept {
  if (version_ != 0 &&
      unit_.request(SetProtocolVersion{version_}) != Status::kCommandNotPossibleRejected) {
    version_ = 0;
  }
}

std::optional<Status> UnitRequestHandler::handle(const codec::Request& request) noexcept {
  // Requests that wait for the arm to come to rest are answered before the next motion begins.
  if (std::holds_alternative<codec::MoveRequest>(request) && unit_.status().answers_at_rest) {
    return Status::kCommandNotPossibleRejected;
  }
  const std::optional<Status> status = std::visit(
      [this](const auto& what) -> std::optional<Status> {
        if constexpr (kIsUnitRequest<std::decay_t<decltype(what)>>) {
          return unit_.request(what);
        }
        return Status::kCommandNotPossibleRejected;
      },
      request);
  // Clients send StopMove after every failed motion, in any mode, and wait for the answer.
  return std::holds_alternative<codec::StopMoveRequest>(request) && status ? Status::kSuccess
                                                                           : status;
}

std::optional<codec::CartesianLimit> UnitRequestHandler::wall(std::int32_t id) const noexcept {
  const codec::CartesianLimit* wall = unit_.virtualWall(id);
  return wall == nullptr ? std::nullopt : std::optional<codec::CartesianLimit>(*wall);
}

std::optional<Status> UnitRequestHandler::takeAnswer(PendingAnswer which) noexcept {
  applyVersion();
  return unit_.takeAnswer(which);
}

}  // namespace franka_sim::fci

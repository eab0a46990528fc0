// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <arpa/inet.h>
#include <franka_sim_mujoco/fci/vacuum_server.h>

#include <cmath>

namespace franka_sim_mujoco::fci {

namespace codec = franka_core::fci::vacuum;
using codec::Command;
using codec::Status;
using franka_core::fci::CodecError;

namespace {

constexpr std::chrono::milliseconds kStatePeriod{33};
constexpr double kVacuumUnit = 10.0;  // [mbar] of a request's set point (fci.md 2)

Status toStatus(GripperOutcome outcome) noexcept {
  switch (outcome) {
    case GripperOutcome::kSucceeded:
      return Status::kSuccess;
    case GripperOutcome::kInterrupted:
      return Status::kAborted;
    default:
      return Status::kUnsuccessful;
  }
}

}  // namespace

VacuumServer::VacuumServer(const std::string& address, std::uint16_t port, VacuumGripperUnit& unit)
    : unit_(unit), slot_(address, port), datagrams_(address) {}

void VacuumServer::serve(bool stops_only) {
  slot_.serve(
      [this, stops_only](Connection& client, bool& progressed) {
        return serveOne(client, stops_only, progressed);
      },
      // What is held stays held when a program ends.
      [this] { running_.reset(); });
}

bool VacuumServer::serveOne(Connection& client, bool stops_only, bool& progressed) {
  Header header;
  const Bytes stream = client.received();
  const CodecError framing =
      franka_core::fci::gripper::nextMessage(stream, codec::kMaxRequestSize, header);
  if (framing != CodecError::kNone) {
    return framing == CodecError::kIncomplete;
  }
  codec::Request request;
  if (codec::decodeRequest({stream.data, header.size}, header, request) != CodecError::kNone) {
    return false;
  }
  if (stops_only && slot_.confirmed() && codec::commandOf(request) != Command::kStop) {
    return true;
  }
  client.consume(header.size);
  progressed = true;
  if (const auto* connection = std::get_if<codec::ConnectRequest>(&request)) {
    return connect(header, *connection);
  }
  return slot_.confirmed() && start(header, request);
}

bool VacuumServer::connect(const Header& header, const codec::ConnectRequest& request) {
  const bool fits = franka_core::fci::isVacuumGripperVersion(request.version);
  if (!reply(Command::kConnect, header.command_id, fits ? Status::kSuccess : Status::kFail,
             franka_core::fci::kVacuumGripperVersion)) {
    return false;
  }
  if (fits) {
    slot_.confirm();
    sockaddr_in peer = slot_.peer();
    peer.sin_port = htons(request.udp_port);
    datagrams_.setPeer(peer);
    state_sent_at_ = {};
  }
  return true;
}

bool VacuumServer::start(const Header& header, const codec::Request& request) {
  VacuumGripperUnit::Ticket ticket = 0;
  const Command command = codec::commandOf(request);
  if (const auto* vacuum = std::get_if<codec::VacuumRequest>(&request)) {
    ticket = unit_.vacuum(kVacuumUnit * vacuum->vacuum, vacuum->timeout_ms);
  } else if (const auto* drop = std::get_if<codec::DropOffRequest>(&request)) {
    ticket = unit_.dropOff(drop->timeout_ms);
  } else {
    ticket = unit_.stop();
  }
  if (ticket == 0) {
    return reply(command, header.command_id, Status::kFail);
  }
  // The unit has ended what ran before; its reply goes first.
  if (!replyToEnded()) {
    return false;
  }
  running_ = Running{command, header.command_id, ticket};
  return replyToEnded();
}

bool VacuumServer::replyToEnded() {
  if (!running_ || unit_.outcome(running_->ticket) == GripperOutcome::kRunning) {
    return true;
  }
  const Running ended = *running_;
  running_.reset();
  return reply(ended.command, ended.id, toStatus(unit_.outcome(ended.ticket)));
}

bool VacuumServer::reply(Command command, std::uint32_t id, Status status, std::uint16_t version) {
  codec::Reply reply;
  reply.status = status;
  reply.server_version = version;
  codec::ReplyMessage message;
  return codec::encodeReply(command, id, reply, message) == CodecError::kNone &&
         slot_.client()->send(message.bytes());
}

void VacuumServer::publish(std::uint64_t milliseconds) {
  message_id_ += milliseconds;
  if (!slot_.confirmed()) {
    return;
  }
  const auto now = std::chrono::steady_clock::now();
  const bool ended = running_ && unit_.outcome(running_->ticket) != GripperOutcome::kRunning;
  if (ended || now - state_sent_at_ >= kStatePeriod) {
    state_sent_at_ = now;
    sendState();
  }
  if (!replyToEnded()) {
    slot_.drop();
    running_.reset();
  }
}

void VacuumServer::sendState() {
  codec::State state;
  state.message_id = static_cast<std::uint32_t>(message_id_);
  state.in_control_range = unit_.inControlRange();
  state.part_detached = unit_.partDetached();
  state.part_present = unit_.partPresent();
  state.device_status = static_cast<codec::DeviceStatus>(unit_.health());
  state.actual_power = static_cast<std::int32_t>(std::lround(unit_.power()));
  state.vacuum = static_cast<std::int32_t>(std::lround(unit_.vacuum()));
  codec::StateBuffer buffer{};
  codec::encodeState(state, buffer);
  datagrams_.send({buffer.data(), buffer.size()});
}

}  // namespace franka_sim_mujoco::fci

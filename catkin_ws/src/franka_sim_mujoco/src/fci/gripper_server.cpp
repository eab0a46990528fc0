// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <arpa/inet.h>
#include <franka_sim_mujoco/fci/gripper_server.h>

#include <cmath>

namespace franka_sim_mujoco::fci {

namespace codec = franka_core::fci::gripper;
using codec::Command;
using codec::Status;
using franka_core::fci::CodecError;

namespace {

constexpr std::chrono::milliseconds kStatePeriod{33};

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

GripperServer::GripperServer(const std::string& address, std::uint16_t port, GripperUnit& unit)
    : unit_(unit), slot_(address, port), datagrams_(address) {}

GripperServer::~GripperServer() = default;

void GripperServer::serve(bool stops_only) {
  slot_.serve(
      [this, stops_only](Connection& client, bool& progressed) {
        return serveOne(client, stops_only, progressed);
      },
      [this] { forgetClient(); });
}

// What runs goes on: a hand does not drop what it holds because a program ends.
void GripperServer::forgetClient() noexcept { running_.reset(); }

bool GripperServer::serveOne(Connection& client, bool stops_only, bool& progressed) {
  Header header;
  const Bytes stream = client.received();
  const CodecError framing = codec::nextMessage(stream, codec::kMaxRequestSize, header);
  if (framing != CodecError::kNone) {
    return framing == CodecError::kIncomplete;
  }
  codec::Request request;
  if (codec::decodeRequest({stream.data, header.size}, header, request) != CodecError::kNone) {
    return false;
  }
  const Command command = codec::commandOf(request);
  if (stops_only && slot_.confirmed() && command != Command::kStop) {
    return true;
  }
  client.consume(header.size);
  progressed = true;
  if (const auto* connection = std::get_if<codec::ConnectRequest>(&request)) {
    return connect(header, *connection);
  }
  return slot_.confirmed() && start(header, request);
}

bool GripperServer::connect(const Header& header, const codec::ConnectRequest& request) {
  const bool fits = franka_core::fci::isGripperVersion(request.version);
  if (!reply(Command::kConnect, header.command_id, fits ? Status::kSuccess : Status::kFail,
             fits ? request.version : franka_core::fci::kNewestGripperVersion)) {
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

bool GripperServer::start(const Header& header, const codec::Request& request) {
  GripperUnit::Ticket ticket = 0;
  const Command command = codec::commandOf(request);
  if (const auto* grasp = std::get_if<codec::GraspRequest>(&request)) {
    ticket = unit_.grasp(grasp->width, grasp->epsilon_inner, grasp->epsilon_outer, grasp->speed,
                         grasp->force);
  } else if (const auto* move = std::get_if<codec::MoveRequest>(&request)) {
    ticket = unit_.move(move->width, move->speed);
  } else if (command == Command::kHoming) {
    ticket = unit_.homing();
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

bool GripperServer::replyToEnded() {
  if (!running_ || unit_.outcome(running_->ticket) == GripperOutcome::kRunning) {
    return true;
  }
  const Running ended = *running_;
  running_.reset();
  return reply(ended.command, ended.id, toStatus(unit_.outcome(ended.ticket)));
}

bool GripperServer::reply(Command command, std::uint32_t id, Status status, std::uint16_t version) {
  codec::Reply reply;
  reply.status = status;
  reply.server_version = version;
  codec::ReplyMessage message;
  return codec::encodeReply(command, id, reply, message) == CodecError::kNone &&
         slot_.client()->send(message.bytes());
}

void GripperServer::publish(std::uint64_t milliseconds) {
  message_id_ += milliseconds;
  if (!slot_.confirmed()) {
    return;
  }
  const auto now = std::chrono::steady_clock::now();
  const bool ended = running_ && unit_.outcome(running_->ticket) != GripperOutcome::kRunning;
  if (ended || now - state_sent_at_ >= kStatePeriod) {
    state_sent_at_ = now;
    codec::State state;
    state.message_id = static_cast<std::uint32_t>(message_id_);
    state.width = unit_.width();
    state.max_width = unit_.maxWidth();
    state.is_grasped = unit_.isGrasped();
    state.temperature = static_cast<std::uint16_t>(std::lround(unit_.temperature()));
    codec::StateBuffer buffer{};
    codec::encodeState(state, buffer);
    datagrams_.send({buffer.data(), buffer.size()});
  }
  if (!replyToEnded()) {
    slot_.drop();
    forgetClient();
  }
}

void GripperServer::addDescriptors(std::vector<pollfd>& fds) const { slot_.addDescriptors(fds); }

}  // namespace franka_sim_mujoco::fci

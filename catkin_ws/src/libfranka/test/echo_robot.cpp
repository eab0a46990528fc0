// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "echo_robot.h"

#include <franka_core/fci/reply_codec.h>

namespace franka_bench {

namespace {

namespace fci = franka_core::fci;

std::vector<std::uint8_t> stateDatagram(std::uint16_t version, bool moving) {
  franka_core::RobotState state;
  state.robot_mode = moving ? franka_core::RobotMode::kMove : franka_core::RobotMode::kIdle;
  if (moving) {
    state.controller_mode = franka_core::ControllerMode::kExternalController;
    state.motion_generator_mode = version >= 10 ? franka_core::MotionGeneratorMode::kNone
                                                : franka_core::MotionGeneratorMode::kJointVelocity;
  }
  fci::StateBuffer buffer{};
  fci::encodeState(version, state, buffer);
  return {buffer.data(), buffer.data() + fci::stateSize(version)};
}

}  // namespace

EchoRobot::EchoRobot(std::uint16_t version) : version_(version) {
  listen(listener_.get(), 1);
  thread_ = std::thread([this] { serve(); });
}

EchoRobot::~EchoRobot() {
  stopping_ = true;
  thread_.join();
}

void EchoRobot::serve() {
  while (!stopping_) {
    const int client = accept(listener_.get(), nullptr, nullptr);
    if (client >= 0) {
      Socket::setTimeout(client, 1);
      stream_.clear();
      serveClient(client);
      close(client);
    }
  }
}

void EchoRobot::serveClient(int client) {
  std::vector<std::uint8_t> idle = stateDatagram(version_, false);
  std::vector<std::uint8_t> moving = stateDatagram(version_, true);
  Phase phase = Phase::kIdle;
  while (!stopping_ && phase != Phase::kClosed) {
    if (phase == Phase::kMoving && echo_.hasDatagram()) {
      while (echo_.answerOne(moving)) {
      }
    }
    phase = handleRequests(client, phase);
    echo_.send(phase == Phase::kMoving ? moving : idle);
  }
}

EchoRobot::Phase EchoRobot::handleRequests(int client, Phase phase) {
  std::uint8_t buffer[1024];
  const ssize_t size = recv(client, buffer, sizeof(buffer), 0);
  stream_.insert(stream_.end(), buffer, buffer + (size > 0 ? size : 0));
  fci::Header header;
  while (fci::nextMessage({stream_.data(), stream_.size()}, fci::kMaxRequestSize, header) ==
         fci::CodecError::kNone) {
    fci::Request request;
    fci::decodeRequest(version_, {stream_.data(), header.size}, header, request);
    stream_.erase(stream_.begin(), stream_.begin() + header.size);
    fci::Reply reply;
    reply.server_version = version_;
    if (const auto* connect = std::get_if<fci::ConnectRequest>(&request)) {
      sockaddr_in peer = listener_.address();
      peer.sin_port = htons(connect->udp_port);
      echo_.setPeer(peer);
      if (connect->version != version_) {
        reply.status = fci::Status::kIncompatibleLibraryVersion;
      }
    } else if (fci::commandOf(request) == fci::Command::kMove) {
      reply.status = fci::Status::kMotionStarted;
      phase = Phase::kMoving;
    } else if (fci::commandOf(request) == fci::Command::kStopMove) {
      phase = Phase::kIdle;
    }
    fci::ReplyMessage message;
    fci::encodeReply(version_, fci::commandOf(request), header.command_id, reply, message);
    send(client, message.data, message.size, MSG_NOSIGNAL);
    if (reply.status == fci::Status::kIncompatibleLibraryVersion) {
      return Phase::kClosed;
    }
  }
  return size == 0 ? Phase::kClosed : phase;
}

}  // namespace franka_bench

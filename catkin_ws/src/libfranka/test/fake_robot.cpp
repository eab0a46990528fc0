// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "fake_robot.h"

#include <franka_core/fci/command_codec.h>
#include <franka_core/fci/reply_codec.h>
#include <netinet/tcp.h>
#include <poll.h>

#include <algorithm>

namespace franka_test {

namespace {

namespace fci = franka_core::fci;
using franka_core::MotionGeneratorMode;
using franka_core::RobotMode;

constexpr double kDeltaT = 1e-3;
constexpr std::chrono::milliseconds kPace{1};
constexpr std::chrono::milliseconds kAnswerTimeoutAfterAbort{2000};
// A client that never ends its motion loses the connection, before the record of it fills the
// memory.
constexpr int kMaxExchanges = 100'000;

template <std::size_t kSize>
void follow(const std::array<double, kSize>& target, std::array<double, kSize>& value,
            std::array<double, kSize>& derivative) {
  for (std::size_t i = 0; i < kSize; i++) {
    derivative[i] = (target[i] - value[i]) / kDeltaT;
    value[i] = target[i];
  }
}

}  // namespace

FakeRobot::FakeRobot(std::uint16_t version) : version_(version) {
  listen(listener_.get(), 1);
  state_.robot_mode = RobotMode::kIdle;
  state_.q = state_.q_d = {0.0, -0.8, 0.0, -2.4, 0.0, 1.6, 0.8};
  state_.elbow = state_.elbow_d = state_.elbow_c = {0.0, -1.0};
  state_.O_ddP_O = {0.0, 0.0, -9.81};
  for (auto* pose : {&state_.O_T_EE, &state_.O_T_EE_d, &state_.O_T_EE_c, &state_.F_T_EE,
                     &state_.F_T_NE, &state_.NE_T_EE, &state_.EE_T_K}) {
    *pose = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  }
  thread_ = std::thread([this] { serve(); });
}

FakeRobot::~FakeRobot() {
  {
    const std::lock_guard<std::recursive_mutex> lock(mutex_);
    stopping_ = true;
  }
  thread_.join();
  closeClient();
}

std::string FakeRobot::address() const { return "127.0.0.1:" + std::to_string(listener_.port()); }

void FakeRobot::script(const std::function<void(Script&)>& change) {
  const std::lock_guard<std::recursive_mutex> lock(mutex_);
  change(script_);
}

void FakeRobot::change(const std::function<void(franka_core::RobotState&)>& change) {
  const std::lock_guard<std::recursive_mutex> lock(mutex_);
  change(state_);
}

franka_core::RobotState FakeRobot::state() const {
  const std::lock_guard<std::recursive_mutex> lock(mutex_);
  return state_;
}

std::vector<fci::Request> FakeRobot::requests() const {
  const std::lock_guard<std::recursive_mutex> lock(mutex_);
  return requests_;
}

int FakeRobot::count(Command command) const {
  const std::lock_guard<std::recursive_mutex> lock(mutex_);
  return static_cast<int>(
      std::count_if(requests_.begin(), requests_.end(),
                    [command](const auto& r) { return fci::commandOf(r) == command; }));
}

std::vector<FakeRobot::Exchange> FakeRobot::exchanges() const {
  const std::lock_guard<std::recursive_mutex> lock(mutex_);
  return exchanges_;
}

int FakeRobot::connections() const {
  const std::lock_guard<std::recursive_mutex> lock(mutex_);
  return connections_;
}

void FakeRobot::serve() {
  while (true) {
    pollfd sources[3];
    {
      const std::lock_guard<std::recursive_mutex> lock(mutex_);
      if (stopping_) {
        return;
      }
      if (client_ < 0) {
        acceptClient();
      }
      if (client_ >= 0) {
        readRequests();
        readCommands();
      }
      if (client_ >= 0 && isTimeForState()) {
        sendState();
      }
      sources[0] = {client_ < 0 ? listener_.get() : client_, POLLIN, 0};
      sources[1] = {udp_.get(), POLLIN, 0};
    }
    poll(sources, 2, 1);
  }
}

void FakeRobot::acceptClient() {
  client_ = accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
  if (client_ >= 0) {
    // Two replies in a row must not wait for each other's acknowledgment.
    const int at_once = 1;
    setsockopt(client_, IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof(at_once));
    connections_++;
    stream_.clear();
    client_udp_port_ = 0;
    silent_ = awaits_request_ = false;
  }
}

void FakeRobot::closeClient() {
  if (client_ >= 0) {
    close(client_);
    client_ = -1;
    if (move_id_) {
      endMotion(RobotMode::kIdle);
    }
  }
}

void FakeRobot::readRequests() {
  std::uint8_t buffer[1024];
  ssize_t size = 0;
  while ((size = recv(client_, buffer, sizeof(buffer), 0)) > 0) {
    stream_.insert(stream_.end(), buffer, buffer + size);
  }
  const bool closed = size == 0 || (errno != EAGAIN && errno != EINTR);
  fci::Header header;
  while (client_ >= 0 && fci::nextMessage({stream_.data(), stream_.size()}, fci::kMaxRequestSize,
                                          header) == fci::CodecError::kNone) {
    fci::Request request;
    const fci::CodecError error =
        fci::decodeRequest(version_, {stream_.data(), header.size}, header, request);
    stream_.erase(stream_.begin(), stream_.begin() + header.size);
    if (error != fci::CodecError::kNone) {
      closeClient();  // a test whose client sends invalid data sees a lost connection
      return;
    }
    requests_.push_back(request);
    handle(header, request);
  }
  if (closed) {
    closeClient();
  }
}

void FakeRobot::handle(const fci::Header& header, const fci::Request& request) {
  awaits_request_ = false;
  const Command command = fci::commandOf(request);
  if (script_.fatal.count(command) != 0) {
    closeClient();
    return;
  }
  if (script_.unanswered.count(command) != 0) {
    return;
  }
  const auto scripted = script_.replies.find(command);
  Status status = scripted == script_.replies.end() ? Status::kSuccess : scripted->second;
  switch (command) {
    case Command::kConnect: {
      const auto& connect = std::get<fci::ConnectRequest>(request);
      if (connect.version != version_) {
        status = Status::kIncompatibleLibraryVersion;
      }
      reply(command, header.command_id, status);
      if (status == Status::kSuccess) {
        client_udp_port_ = connect.udp_port;
        last_state_at_ = Clock::time_point{};
      }
      return;
    }
    case Command::kMove:
      if (scripted == script_.replies.end()) {
        handleMove(header.command_id, std::get<fci::MoveRequest>(request));
        return;
      }
      break;
    case Command::kStopMove:
      reply(command, header.command_id, status);
      if (status == Status::kSuccess) {
        handleStop(header.command_id);
      }
      return;
    case Command::kLoadModelLibrary:
    case Command::kGetRobotModel:
      if (status == Status::kSuccess) {
        const auto& model = command == Command::kGetRobotModel ? script_.urdf : script_.library;
        std::vector<std::uint8_t> message;
        fci::encodeModelReply(version_, command, header.command_id, {model.data(), model.size()},
                              message);
        sendTcp(message.data(), message.size());
        return;
      }
      break;
    default:
      break;
  }
  reply(command, header.command_id, status);
}

void FakeRobot::handleMove(std::uint32_t id, const fci::MoveRequest& request) {
  reply(Command::kMove, id, Status::kMotionStarted);
  if (script_.end_at_start) {
    reply(Command::kMove, id, *script_.end_at_start);
    return;
  }
  move_id_ = id;
  answered_id_ = state_.message_id;
  exchanges_.clear();
  was_answered_ = false;
  if (script_.shows_motion) {
    state_.motion_generator_mode = request.motion_generator_mode;
    state_.controller_mode = request.controller_mode;
    state_.robot_mode = RobotMode::kMove;
    state_.reflex_reason = {};
    state_.control_command_success_rate = script_.success_rate;
  }
}

void FakeRobot::handleStop(std::uint32_t) {
  if (move_id_ && script_.preempts) {
    reply(Command::kMove, *move_id_, Status::kPreempted);
  }
  if (state_.robot_mode == RobotMode::kMove) {
    endMotion(RobotMode::kIdle);
  }
}

void FakeRobot::reply(Command command, std::uint32_t id, Status status) {
  fci::Reply reply;
  reply.status = status;
  reply.server_version = script_.reported_version.value_or(version_);
  reply.cartesian_limit = {{1.0, 2.0, 3.0}, state_.O_T_EE, true};
  fci::ReplyMessage message;
  if (fci::encodeReply(version_, command, id, reply, message) != fci::CodecError::kNone) {
    closeClient();
    return;
  }
  std::vector<std::uint8_t> bytes(message.data, message.data + message.size);
  if (script_.garbled.count(command) != 0) {
    bytes[8]--;  // the header's size
    bytes.pop_back();
  }
  const auto repeated = script_.repeated.find(command);
  for (int i = 0; i < 1 + (repeated == script_.repeated.end() ? 0 : repeated->second); i++) {
    sendTcp(bytes.data(), bytes.size());
  }
}

void FakeRobot::sendTcp(const std::uint8_t* data, std::size_t size) {
  // Models are larger than the socket's buffer.
  while (size > 0 && client_ >= 0) {
    const ssize_t sent = send(client_, data, size, MSG_NOSIGNAL);
    if (sent > 0) {
      data += sent;
      size -= static_cast<std::size_t>(sent);
    } else if (errno == EAGAIN) {
      pollfd writable{client_, POLLOUT, 0};
      poll(&writable, 1, 100);
    } else {
      return;
    }
  }
}

void FakeRobot::readCommands() {
  std::uint8_t buffer[1024];
  ssize_t size = 0;
  while ((size = recv(udp_.get(), buffer, sizeof(buffer), 0)) >= 0) {
    franka_core::RobotCommand command;
    const bool valid = fci::decodeCommand(version_, {buffer, static_cast<std::size_t>(size)},
                                          command) == fci::CodecError::kNone;
    // However late: a pause of the machine is not the client's fault.
    if (valid && move_id_ && command.message_id <= state_.message_id &&
        command.message_id > answered_id_) {
      obey(command);
    }
  }
}

void FakeRobot::obey(const franka_core::RobotCommand& command) {
  was_answered_ = true;
  answered_id_ = command.message_id;
  exchanges_.push_back({state_, command});
  exchanges_.back().state.message_id = command.message_id;
  switch (state_.motion_generator_mode) {
    case MotionGeneratorMode::kJointPosition: {
      std::array<double, 7> velocity = state_.dq_d;
      follow(command.q_c, state_.q_d, velocity);
      follow(velocity, state_.dq_d, state_.ddq_d);
      break;
    }
    case MotionGeneratorMode::kJointVelocity:
      follow(command.dq_c, state_.dq_d, state_.ddq_d);
      for (std::size_t i = 0; i < 7; i++) {
        state_.q_d[i] += command.dq_c[i] * kDeltaT;
      }
      break;
    case MotionGeneratorMode::kCartesianPosition: {
      std::array<double, 6> twist{};
      for (std::size_t i = 0; i < 3; i++) {
        twist[i] = (command.O_T_EE_c[12 + i] - state_.O_T_EE_c[12 + i]) / kDeltaT;
      }
      state_.O_T_EE_c = command.O_T_EE_c;
      follow(twist, state_.O_dP_EE_c, state_.O_ddP_EE_c);
      break;
    }
    case MotionGeneratorMode::kCartesianVelocity:
      follow(command.O_dP_EE_c, state_.O_dP_EE_c, state_.O_ddP_EE_c);
      break;
    default:
      break;
  }
  if (command.valid_elbow) {
    state_.elbow_c = command.elbow_c;
  }
  if (state_.controller_mode == franka_core::ControllerMode::kExternalController) {
    state_.tau_J_d = command.tau_J_d;
  }
  if ((command.motion_generation_finished || command.torque_command_finished) &&
      script_.ends_at_finish) {
    const std::uint32_t id = *move_id_;
    endMotion(RobotMode::kIdle);
    if (script_.closes_at_finish) {
      closeClient();
    } else if (script_.answers_finish) {
      reply(Command::kMove, id, script_.end_at_finish.value_or(Status::kSuccess));
    }
    return;
  }
  applyScriptToMotion();
}

void FakeRobot::applyScriptToMotion() {
  const int count = static_cast<int>(exchanges_.size());
  if (count == script_.close_after || count == kMaxExchanges) {
    closeClient();
  }
  if (count == script_.silence_after) {
    silent_ = true;
  }
  if (count == script_.skip_after) {
    state_.message_id += script_.skip;
  }
  if (count == script_.abort_after) {
    const std::uint32_t id = *move_id_;
    if (script_.abort_replies_first) {
      reply(Command::kMove, id, script_.abort_status);
      shown_abort_at_ = state_.message_id + 5;
      return;
    }
    endMotion(script_.abort_mode);
    for (std::size_t index : script_.abort_errors) {
      state_.reflex_reason[index] = state_.errors[index] = true;
    }
    if (script_.abort_replies) {
      sendState();
      awaits_request_ = true;
      reply(Command::kMove, id, script_.abort_status);
    }
  }
}

void FakeRobot::endMotion(RobotMode mode) {
  state_.motion_generator_mode = MotionGeneratorMode::kIdle;
  state_.controller_mode = franka_core::ControllerMode::kOther;
  state_.robot_mode = mode;
  state_.control_command_success_rate = 0.0;
  state_.dq_d = state_.ddq_d = state_.tau_J_d = {};
  state_.O_dP_EE_c = state_.O_ddP_EE_c = {};
  move_id_.reset();
  was_answered_ = false;
  shown_abort_at_.reset();
}

bool FakeRobot::isTimeForState() const {
  if (client_udp_port_ == 0 || silent_ || !script_.sends_states) {
    return false;
  }
  const bool answered = was_answered_ && answered_id_ >= state_.message_id;
  const auto timeout = awaits_request_ ? kAnswerTimeoutAfterAbort : script_.answer_timeout;
  const auto wait = awaits_request_ || (move_id_ && was_answered_) ? timeout : kPace;
  return (move_id_ && answered) || Clock::now() - last_state_at_ >= wait;
}

void FakeRobot::sendState() {
  state_.message_id++;
  if (shown_abort_at_ && state_.message_id >= *shown_abort_at_) {
    endMotion(script_.abort_mode);
    for (std::size_t index : script_.abort_errors) {
      state_.reflex_reason[index] = state_.errors[index] = true;
    }
  }
  fci::StateBuffer buffer;
  fci::encodeState(version_, state_, buffer);
  const Datagram datagram(buffer.data(), buffer.data() + fci::stateSize(version_));
  const sockaddr_in client = loopback(client_udp_port_);
  for (const Datagram& d :
       script_.transmit ? script_.transmit(datagram) : std::vector<Datagram>{datagram}) {
    sendto(udp_.get(), d.data(), d.size(), 0, reinterpret_cast<const sockaddr*>(&client),
           sizeof(client));
  }
  last_state_at_ = Clock::now();
}

}  // namespace franka_test

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "fci/robot_server.h"

#include <arpa/inet.h>
#include <franka_sim/robot/control_unit_parameters.h>

#include <array>
#include <iterator>
#include <type_traits>
#include <utility>

namespace franka_sim::fci {

namespace codec = franka_core::fci;
using codec::CodecError;
using codec::Command;
using codec::Status;
using franka_core::RobotMode;

namespace {

#if defined(__x86_64__)
constexpr std::optional<codec::Architecture> kOwnArchitecture = codec::Architecture::kX64;
#elif defined(__aarch64__)
constexpr std::optional<codec::Architecture> kOwnArchitecture = codec::Architecture::kArm64;
#elif defined(__i386__)
constexpr std::optional<codec::Architecture> kOwnArchitecture = codec::Architecture::kX86;
#elif defined(__arm__)
constexpr std::optional<codec::Architecture> kOwnArchitecture = codec::Architecture::kArm;
#else
constexpr std::optional<codec::Architecture> kOwnArchitecture;
#endif

bool isForThisMachine(const codec::LoadModelLibraryRequest& request) noexcept {
  return kOwnArchitecture == request.architecture &&
         request.system == codec::OperatingSystem::kLinux;
}

}  // namespace

RobotServer::RobotServer(RobotServerParameters parameters, ArmRequestHandler& handler)
    : parameters_(std::move(parameters)),
      model_library_(
          std::make_shared<const std::vector<std::uint8_t>>(std::move(parameters_.model_library))),
      handler_(handler),
      slot_(parameters_.address, parameters_.port),
      datagrams_(parameters_.address) {
  for (const auto& [version, text] : parameters_.urdfs) {
    urdfs_[version] = std::make_shared<const std::vector<std::uint8_t>>(text.begin(), text.end());
  }
  parameters_.urdfs.clear();
}

RobotServer::~RobotServer() = default;

void RobotServer::serve(bool stops_only) {
  collectEnds();
  datagrams_left_ = kDatagramsAtOnce;
  targets_left_ = kTargetsAtOnce;
  slot_.setOpen(handler_.active());
  if (!handler_.active() && version_ == 0) {
    slot_.drop();  // not connected yet; a client first gets the end of its motion (publish)
  }
  slot_.serve([this, stops_only](Connection& client) { return serveOne(client, stops_only); },
              [this] { clearClient(); });
}

void RobotServer::dropClient() noexcept {
  slot_.drop();
  clearClient();
}

void RobotServer::clearClient() noexcept {
  if (version_ != 0) {
    handler_.disconnected();
  }
  version_ = 0;
  begun_ = false;
  answered_ = false;
  motion_shown_ = false;
  end_unread_ = false;
  move_.reset();
  stop_.reset();
  recovery_.reset();
  answered_setter_count_ = 0;
}

Served RobotServer::serveOne(Connection& client, bool stops_only) {
  codec::Header header;
  const Bytes stream = client.received();
  const CodecError framing = codec::nextMessage(stream, codec::kMaxRequestSize, header);
  if (framing == CodecError::kIncomplete) {
    return Served::kIncomplete;
  }
  if (framing != CodecError::kNone) {
    return Served::kBroken;  // the start of the next request is unknown
  }
  end_unread_ = false;
  // Connect is the same in every version.
  const std::uint16_t version = version_ == 0 ? parameters_.newest_version : version_;
  codec::Request request;
  const CodecError error =
      codec::decodeRequest(version, {stream.data, header.size}, header, request);
  const RobotMode mode = handler_.state().robot_mode;
  const auto is = [&request, error](Command command) {
    return error == CodecError::kNone && codec::commandOf(request) == command;
  };
  // Clients send StopMove after an abort as well, when there is nothing to stop.
  const bool stop = is(Command::kStopMove) && mode == RobotMode::kMove;
  // In a world that is paused from its start on, a motion waits as any motion in a paused world.
  const bool early = is(Command::kMove) && mode == RobotMode::kIdle && !handler_.measured();
  const bool later = stops_only || early || answered_setter_count_ == kMaxAnswered;
  if (later && version_ != 0 && !stop) {
    return Served::kHeldBack;
  }
  client.consume(header.size);
  bool connection_valid = false;
  if (error != CodecError::kNone) {
    connection_valid = refuse(header, error);
  } else if (const auto* connection = std::get_if<codec::ConnectRequest>(&request)) {
    connection_valid = connect(header, *connection);
  } else {
    connection_valid = version_ != 0 && answer(header, request);
  }
  return connection_valid ? Served::kDone : Served::kBroken;
}

bool RobotServer::connect(const codec::Header& header, const codec::ConnectRequest& request) {
  const bool busy = move_ || stop_ || recovery_ || answered_setter_count_ > 0;
  const bool fits = !busy && request.version >= parameters_.oldest_version &&
                    request.version <= parameters_.newest_version;
  codec::Reply connect_reply;
  connect_reply.status = fits ? Status::kSuccess : Status::kIncompatibleLibraryVersion;
  connect_reply.server_version = fits   ? request.version
                                 : busy ? version_
                                        : parameters_.newest_version;
  codec::ReplyMessage message;
  if (codec::encodeReply(parameters_.newest_version, Command::kConnect, header.command_id,
                         connect_reply, message) != CodecError::kNone ||
      !slot_.client()->send(message.bytes())) {
    return false;
  }
  if (fits) {
    version_ = request.version;
    slot_.confirm();
    sockaddr_in peer = slot_.peer();
    peer.sin_port = htons(request.udp_port);
    datagrams_.setPeer(peer);
    client_is_local_ = ntohl(peer.sin_addr.s_addr) >> 24 == IN_LOOPBACKNET;
    begun_ = false;
    answered_ = false;
    handler_.connected(version_);
  }
  return true;
}

bool RobotServer::answer(const codec::Header& header, const codec::Request& request) {
  const Pending pending{codec::commandOf(request), header.command_id};
  switch (pending.command) {
    case Command::kLoadModelLibrary: {
      const bool served = isForThisMachine(std::get<codec::LoadModelLibraryRequest>(request)) &&
                          !model_library_->empty();
      return served ? replyWithModel(pending, model_library_) : reply(pending, Status::kError);
    }
    case Command::kGetRobotModel: {
      const Blob* text = urdf();
      return text == nullptr ? reply(pending, Status::kCommandNotPossibleRejected)
                             : replyWithModel(pending, *text);
    }
    case Command::kGetCartesianLimit:
      return replyWithWall(pending, std::get<codec::GetCartesianLimitRequest>(request).id);
    default:
      break;
  }
  const std::optional<Status> status = handler_.handle(request);
  if (status == Status::kInvalidArgumentRejected) {
    reportFault(request);
  }
  if (pending.command == Command::kMove && status == Status::kMotionStarted) {
    move_ = pending;
    motion_end_.reset();
    asynchronous_ = std::get<codec::MoveRequest>(request).use_async_motion_generator;
    first_of_motion_ = message_id_ + 1;
    begun_ = false;
    answered_ = false;
  }
  if (!status) {
    (pending.command == Command::kStopMove ? stop_ : recovery_) = pending;
    return true;
  }
  if (pending.command != Command::kMove && answered_setter_count_ < kMaxAnswered) {
    answered_setters_[answered_setter_count_++] = {pending, *status};
    return true;
  }
  return reply(pending, *status);
}

void RobotServer::reportFault(const codec::Request& request) {
  const std::string fault = handler_.faultOf(request);
  if (!fault.empty()) {
    slot_.reportRequest(fault);
  }
}

bool RobotServer::replyToSetters() {
  bool sent = true;
  for (std::size_t i = 0; i < answered_setter_count_ && sent; i++) {
    sent = reply(answered_setters_[i].request, answered_setters_[i].status);
  }
  answered_setter_count_ = 0;
  return sent;
}

// Answers a request whose header is valid, but not its content.
bool RobotServer::refuse(const codec::Header& header, CodecError error) {
  const std::optional<Command> command = codec::commandFromNumber(version_, header.command);
  if (version_ == 0 || !command || error == CodecError::kWrongSize) {
    return false;
  }
  const Status status =
      *command == Command::kLoadModelLibrary ? Status::kError : Status::kInvalidArgumentRejected;
  return reply({*command, header.command_id}, status);
}

bool RobotServer::reply(const Pending& to, Status status) {
  codec::Reply plain;
  plain.status = status;
  codec::ReplyMessage message;
  return codec::encodeReply(version_, to.command, to.id, plain, message) == CodecError::kNone &&
         slot_.client()->send(message.bytes());
}

// The description for the connected version: its limits are those that the client expects.
const Blob* RobotServer::urdf() const noexcept {
  const auto next = urdfs_.upper_bound(version_);
  return next == urdfs_.begin() ? nullptr : &std::prev(next)->second;
}

bool RobotServer::replyWithModel(const Pending& to, const Blob& model) {
  codec::ReplyMessage head;
  return codec::encodeModelReplyHead(version_, to.command, to.id, model->size(), head) ==
             CodecError::kNone &&
         slot_.client()->send(head.bytes()) && slot_.client()->send(model);
}

bool RobotServer::replyWithWall(const Pending& to, std::int32_t id) {
  const std::optional<codec::CartesianLimit> wall = handler_.wall(id);
  codec::Reply reply;
  reply.status = wall ? Status::kSuccess : Status::kInvalidArgumentRejected;
  reply.cartesian_limit = wall.value_or(codec::CartesianLimit{});
  codec::ReplyMessage message;
  return codec::encodeReply(version_, to.command, to.id, reply, message) == CodecError::kNone &&
         slot_.client()->send(message.bytes());
}

void RobotServer::collectEnds() noexcept {
  const auto collect = [this](std::optional<Status>& status, PendingAnswer which) {
    if (const std::optional<Status> answer = handler_.takeAnswer(which)) {
      status = answer;
    }
  };
  collect(motion_end_, PendingAnswer::kMotion);
  collect(stop_end_, PendingAnswer::kStop);
  collect(recovery_end_, PendingAnswer::kRecovery);
}

void RobotServer::replyTo(std::optional<Pending>& pending, std::optional<Status>& status) {
  if (!status) {
    return;
  }
  if (pending && slot_.client() != nullptr && !reply(*pending, *status)) {
    dropClient();
  }
  pending.reset();
  status.reset();
}

void RobotServer::sendState() noexcept {
  shown_ = handler_.state();
  shown_.message_id = message_id_;
  if (codec::encodeState(version_, shown_, state_bytes_) == CodecError::kNone) {
    datagrams_.send({state_bytes_.data(), codec::stateSize(version_)});
  }
  const bool before = std::exchange(motion_shown_, expectsCommands());
  end_unread_ = before && !motion_shown_;
}

void RobotServer::publish(std::uint64_t ticks, bool same_tick, bool keep_end) {
  collectEnds();
  message_id_ += ticks;
  if (!same_tick) {
    oldest_of_tick_ = message_id_;
    answered_ = false;
  }
  if (version_ == 0) {
    motion_end_.reset();
    stop_end_.reset();
    recovery_end_.reset();
    return;
  }
  if (keep_end && end_unread_) {
    repeat();
  } else {
    sendState();
  }
  if ((move_ && motion_end_ == Status::kSuccess) || stop_end_) {
    end_unread_ = false;  // an end that the client has requested
  }
  // The state must show the reason of an end before the client gets the reply.
  if (!replyToSetters()) {
    dropClient();
  }
  replyTo(move_, motion_end_);
  replyTo(stop_, stop_end_);
  replyTo(recovery_, recovery_end_);
  if (!handler_.active()) {
    dropClient();
  }
}

void RobotServer::repeat() noexcept {
  if (version_ != 0) {
    datagrams_.send({state_bytes_.data(), codec::stateSize(version_)});
  }
}

// In a cycle only the command that answers its state is accepted; with the asynchronous generator,
// any command that does not belong to an earlier motion.
bool RobotServer::answersAState(std::uint64_t message_id) const noexcept {
  return message_id >= (asynchronous() ? first_of_motion_ : oldest_of_tick_) &&
         message_id <= message_id_;
}

bool RobotServer::receiveCommand() noexcept {
  if (version_ == 0) {
    return false;
  }
  codec::CommandBuffer buffer;
  while (readsCommands()) {
    const std::ptrdiff_t size = datagrams_.receive(buffer.data(), buffer.size());
    if (size < 0) {
      break;
    }
    franka_core::RobotCommand command;
    const CodecError error =
        static_cast<std::size_t>(size) > buffer.size()
            ? CodecError::kWrongSize
            : codec::decodeCommand(version_, {buffer.data(), static_cast<std::size_t>(size)},
                                   command);
    const bool read = error == CodecError::kNone || error == CodecError::kNotFinite;
    if (read && answersAState(command.message_id)) {
      keep(command);
      answered_ = true;
    } else if (!asynchronous()) {
      datagrams_left_--;
    }
    targets_left_ -= asynchronous() ? 1 : 0;
  }
  return answered_;
}

// Whether another datagram may still change the command of this tick.
bool RobotServer::readsCommands() const noexcept {
  return asynchronous() ? targets_left_ > 0 : !answered_ && datagrams_left_ > 0;
}

// Of several targets the newest one counts. Nothing comes after the end of a motion.
void RobotServer::keep(const franka_core::RobotCommand& command) noexcept {
  const bool outdated = answered_ && (command_.motion_generation_finished ||
                                      command.message_id < command_.message_id);
  if (!outdated) {
    command_ = command;
  }
}

const franka_core::RobotCommand* RobotServer::takeCommand() noexcept {
  if (!answered_) {
    return nullptr;
  }
  answered_ = false;
  if (!expectsCommands()) {
    return nullptr;
  }
  begun_ = true;
  return &command_;
}

bool RobotServer::expectsCommands() const noexcept {
  return version_ != 0 && move_ && handler_.state().robot_mode == RobotMode::kMove;
}

void RobotServer::addDescriptors(std::vector<pollfd>& fds) const { slot_.addDescriptors(fds); }

void RobotServer::addCommandDescriptor(std::vector<pollfd>& fds) const {
  if (version_ != 0 && readsCommands()) {
    fds.push_back({datagrams_.descriptor(), POLLIN, 0});
  }
}

}  // namespace franka_sim::fci

namespace franka_sim::fci {

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

std::string UnitRequestHandler::faultOf(const codec::Request& request) const {
  const auto of_frame = [](const std::string& name, const std::array<double, 16>& frame) {
    const std::string fault = frameFault(frame);
    return fault.empty()
               ? ""
               : name + " is not a column-major 4x4 transform to a frame on the arm: " + fault +
                     ".";
  };
  if (const auto* end_effector = std::get_if<codec::SetNEToEERequest>(&request)) {
    return of_frame("NE_T_EE", end_effector->NE_T_EE);
  }
  if (const auto* stiffness = std::get_if<codec::SetEEToKRequest>(&request)) {
    return of_frame("EE_T_K", stiffness->EE_T_K);
  }
  if (const auto* load = std::get_if<codec::SetLoadRequest>(&request)) {
    return payloadFault({load->mass, load->F_x_Cload, load->inertia});
  }
  return "";
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

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "franka/robot_impl.h"

#include <franka/control_tools.h>
#include <franka/mobile_model.h>
#include <franka_core/fci/command_codec.h>
#include <franka_core/fci/reply_codec.h>
#include <franka_core/fci/texts.h>
#include <franka_core/numbers.h>
#include <franka_core/realtime_rule.h>
#include <franka_core/spin_rule.h>
#include <franka_core/to_franka.h>

#include <algorithm>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "franka/realtime_setup.h"
#include "franka/warning.h"

namespace franka {

namespace {

namespace fci = franka_core::fci;
using franka_core::MotionGeneratorMode;

// Period at which a wait for a state checks the connection.
constexpr std::chrono::milliseconds kSlice{50};

// Tolerance between a robot's clock and this machine's. Chosen here: a starved client may read a
// state this much later than it arrived.
constexpr std::chrono::milliseconds kSameTime{50};

// How long a read waits for a state newer than those that have arrived. A running robot sends one
// each millisecond (protocol 4.1). Chosen here: fifty of these periods, for a loaded computer.
constexpr std::chrono::milliseconds kFreshStateWait{50};

// More datagrams than this are left for the next call (a real robot never sends so many).
constexpr int kDatagramsAtOnce = 4096;

fci::CodecError findMessage(fci::Bytes stream, std::uint32_t& id, std::size_t& size) {
  fci::Header header;
  const fci::CodecError error = fci::nextMessage(stream, fci::kMaxReplySize, header);
  id = header.command_id;
  size = header.size;
  return error;
}

std::string inSeconds(std::chrono::milliseconds time) {
  const std::string text = franka_core::numberText(std::chrono::duration<double>(time).count());
  return text + (text.find('.') == std::string::npos ? ".0 s" : " s");
}

franka_core::WaitMode waitMode() {
  try {
    return franka_core::waitModeOfEnvironment();
  } catch (const std::invalid_argument& error) {
    throw InvalidOperationException(std::string("libfranka: ") + error.what());
  }
}

std::mutex timeouts_mutex;
Timeouts process_timeouts;

}  // namespace

void setTimeouts(const Timeouts& timeouts) {
  for (auto time : {timeouts.connect, timeouts.state, timeouts.command, timeouts.long_command,
                    timeouts.silence}) {
    if (time <= std::chrono::milliseconds(0)) {
      throw std::invalid_argument("libfranka: A timeout must be positive.");
    }
  }
  const std::lock_guard<std::mutex> lock(timeouts_mutex);
  process_timeouts = timeouts;
}

Timeouts timeouts() {
  const std::lock_guard<std::mutex> lock(timeouts_mutex);
  return process_timeouts;
}

Robot::Impl::Operation::Operation(Impl& robot) : robot_(robot) {
  robot_.channel_->checkProcess();
  if (robot_.busy_.test_and_set(std::memory_order_acquire)) {
    throw InvalidOperationException(fci::kOtherOperationRunning);
  }
  // A thread that waits for a reply may hold the states for a short time. Sleeping lets it continue
  // even if this thread has realtime priority on the same core.
  while (robot_.states_in_use_.test_and_set(std::memory_order_acquire)) {
    std::this_thread::sleep_for(std::chrono::microseconds(50));
  }
}

Robot::Impl::Operation::~Operation() {
  robot_.states_in_use_.clear(std::memory_order_release);
  robot_.busy_.clear(std::memory_order_release);
}

Robot::Impl::Impl(const std::string& address, RealtimeConfig realtime_config, std::size_t log_size)
    : realtime_config_(realtime_config),
      log_size_(log_size),
      timeouts_(timeouts()),
      datagrams_(std::min(timeouts_.state, kSlice)) {
  connect(address);
  // Robots elsewhere may be real: they answer no sooner than in their next cycle.
  if (channel_->serverIsLoopback()) {
    datagrams_.setWaitMode(waitMode());
  }
  limits_ = rateLimitsOfProtocol(version_);
  {
    const Operation operation(*this);
    receiveState();
  }
  if (version_ >= 10) {
    readDescription();
  }
}

void Robot::Impl::prepareThreadForMotion() {
  bool enforce = false;
  try {
    const franka_core::RealtimeRule rule =
        franka_core::realtimeRule(realtime_config_ == RealtimeConfig::kEnforce,
                                  channel_->serverIsLoopback(), hasRealtimeKernel());
    if (!rule.warning.empty() && !warned_of_realtime_.test_and_set()) {
      logging::warn("libfranka: " + rule.warning);
    }
    enforce = rule.enforce;
  } catch (const std::invalid_argument& error) {
    throw RealtimeException(std::string("libfranka: ") + error.what());
  }
  const std::string warning =
      prepareControlThread(enforce ? RealtimeConfig::kEnforce : RealtimeConfig::kIgnore);
  if (!warning.empty() && !warned_of_memory_.test_and_set()) {
    logging::warn(warning);
  }
}

void Robot::Impl::connect(const std::string& address) {
  const network::Endpoint endpoint = network::parseEndpoint(address, fci::kRobotPort);
  const Clock::time_point deadline = Clock::now() + timeouts_.connect;
  const std::optional<std::uint16_t> required = offer(endpoint, fci::kNewestRobotVersion, deadline);
  if (!required) {
    return;
  }
  // A robot accepts only its own version and replies with it (protocol 2.2).
  if (!fci::isRobotVersion(*required) || *required == fci::kNewestRobotVersion ||
      offer(endpoint, *required, deadline)) {
    throw IncompatibleVersionException(*required, fci::kNewestRobotVersion);
  }
}

std::optional<std::uint16_t> Robot::Impl::offer(const network::Endpoint& endpoint,
                                                std::uint16_t version, Clock::time_point deadline) {
  channel_.reset();
  channel_ = std::make_unique<network::CommandChannel>(endpoint, findMessage, deadline);
  version_ = version;
  const std::uint32_t id = send(fci::ConnectRequest{version, datagrams_.port()});
  const auto message = channel_->receive(id, deadline);
  channel_->discardReplies(id);
  if (!message) {
    throw NetworkException(std::string(fci::kConnectionTimeout) + " " + endpoint.host +
                           " accepted the connection but "
                           "did not answer within " +
                           inSeconds(timeouts_.connect) +
                           ". Please check that no other program is connected to the robot.");
  }
  fci::Bytes model;
  const Reply reply = decode(Command::kConnect, *message, model);
  if (reply.status != fci::Status::kSuccess) {
    return reply.server_version;
  }
  // The version in the reply determines the states that the robot sends.
  if (fci::isRobotVersion(reply.server_version)) {
    version_ = reply.server_version;
  }
  return std::nullopt;
}

void Robot::Impl::readDescription() {
  try {
    const std::vector<std::uint8_t> text = download(fci::GetRobotModelRequest{}, timeouts_.connect);
    const std::string urdf(text.begin(), text.end());
    is_mobile_ = isMobileRobotUrdf(urdf);
    const auto limits = velocityLimitsFromUrdf(urdf);
    // Without limits in the description those of the published table stay.
    if (limits) {
      limits_.position_velocity = limits;
    }
  } catch (const CommandException&) {
    // The same without a description.
  }
}

namespace {

// Replies to a request are kept only while a caller waits for them.
struct ReplyEraser {
  Robot::Impl& robot;
  std::uint32_t id;
  ~ReplyEraser() { robot.discardReplies(id); }
};

}  // namespace

Robot::Impl::Reply Robot::Impl::execute(const Request& request) {
  const Command command = fci::commandOf(request);
  const bool takes_long =
      command == Command::kAutomaticErrorRecovery || command == Command::kStopMove;
  const std::uint32_t id = send(request);
  const ReplyEraser eraser{*this, id};
  const Reply reply =
      receive(command, id, takes_long ? timeouts_.long_command : timeouts_.command, false);
  if (reply.status != fci::Status::kSuccess) {
    throw CommandException(fci::statusText(command, reply.status, mode()));
  }
  return reply;
}

std::vector<std::uint8_t> Robot::Impl::download(const Request& request,
                                                std::chrono::milliseconds bound) {
  const Command command = fci::commandOf(request);
  const std::uint32_t id = send(request);
  const ReplyEraser eraser{*this, id};
  const auto message = receiveMessage(command, id, bound, false);
  fci::Bytes model;
  const Reply reply = decode(command, message, model);
  if (reply.status == fci::Status::kError) {
    throw ModelException("libfranka: The robot cannot give its model library.");
  }
  if (reply.status != fci::Status::kSuccess) {
    throw CommandException(fci::statusText(command, reply.status, mode()));
  }
  return {model.data, model.data + model.size};
}

std::uint32_t Robot::Impl::send(const Request& request) {
  const Command command = fci::commandOf(request);
  const std::uint32_t id = channel_->expect();
  fci::RequestMessage message;
  const fci::CodecError error = fci::encodeRequest(version_, id, request, message);
  if (error != fci::CodecError::kNone) {
    channel_->discardReplies(id);
    throw CommandException(std::string("libfranka: ") + fci::commandName(command) +
                           " command rejected: this robot speaks protocol version " +
                           std::to_string(version_) + ", which has no such command or mode.");
  }
  channel_->send(message.bytes());
  return id;
}

std::optional<Robot::Impl::Reply> Robot::Impl::tryReceive(Command command, std::uint32_t id) {
  const auto message = channel_->tryReceive(id);
  fci::Bytes model;
  return message ? std::make_optional(decode(command, *message, model)) : std::nullopt;
}

Robot::Impl::Reply Robot::Impl::receive(Command command, std::uint32_t id,
                                        std::chrono::milliseconds bound, bool owns_states) {
  fci::Bytes model;
  return decode(command, receiveMessage(command, id, bound, owns_states), model);
}

std::vector<std::uint8_t> Robot::Impl::receiveMessage(Command command, std::uint32_t id,
                                                      std::chrono::milliseconds bound,
                                                      bool owns_states) {
  Clock::time_point last_state = Clock::now();
  const auto watch = [&] {
    const bool news = owns_states ? takesStatesIn() : takeStatesUnlessInUse();
    const Clock::time_point now = Clock::now();
    if (news) {
      last_state = now;
    }
    if (now - last_state > timeouts_.silence) {
      throw NetworkException(std::string(fci::kStateTimeout) + ". No state has arrived for " +
                             inSeconds(timeouts_.silence) + " while the answer to " +
                             fci::commandName(command) + " was awaited.");
    }
  };
  auto message = channel_->receive(id, Clock::now() + bound, watch);
  if (!message) {
    throw NetworkException(std::string(fci::kConnectionTimeout) +
                           " The robot has not answered the command " + fci::commandName(command) +
                           " within " + inSeconds(bound) + ".");
  }
  return std::move(*message);
}

Robot::Impl::Reply Robot::Impl::decode(Command command, const std::vector<std::uint8_t>& message,
                                       fci::Bytes& model) const {
  fci::Header header;
  Reply reply;
  const fci::CodecError error =
      fci::decodeReply(version_, command, {message.data(), message.size()}, header, reply, model);
  if (error != fci::CodecError::kNone) {
    throw ProtocolException(fci::unexpectedResponse(command) + " " +
                            fci::sentence(error,
                                          "reply to " + std::string(fci::commandName(command)) +
                                              " of protocol version " + std::to_string(version_),
                                          message.size(), fci::replySize(version_, command)));
  }
  return reply;
}

void Robot::Impl::read(const std::function<bool(const RobotState&)>& callback) {
  const Operation operation(*this);
  RobotState state;
  franka_core::toFranka(receiveFreshState(), state);
  while (callback(state)) {
    franka_core::toFranka(receiveState(), state);
  }
}

RobotState Robot::Impl::readOnce() {
  const Operation operation(*this);
  RobotState state;
  franka_core::toFranka(receiveFreshState(), state);
  return state;
}

const franka_core::RobotState& Robot::Impl::receiveFreshState() {
  takeStates();
  if (!unread_) {
    return receiveState();
  }
  waitForState(kFreshStateWait);
  unread_ = false;
  return state();
}

const franka_core::RobotState& Robot::Impl::receiveState() {
  if (!waitForState(stateBound())) {
    throw NetworkException(fci::kStateTimeout);
  }
  unread_ = false;
  return state();
}

bool Robot::Impl::waitForState(std::chrono::milliseconds bound) {
  if (channel_->closedByServer()) {
    throw NetworkException(fci::kServerClosed);
  }
  Clock::duration waited{};
  Clock::time_point looked_at = Clock::now();
  bool news = takeStates();
  while (!news) {
    repeated_ = false;
    const Datagram datagram = datagrams_.receive(buffer_.data(), buffer_.size());
    news = datagram.any && accept(datagram);
    // Datagrams that arrived meanwhile are newer.
    news = (!(news && mustBeSeen()) && takeStates()) || news;
    const Clock::time_point now = Clock::now();
    waited = repeated_ ? Clock::duration{}
                       : waited + std::min<Clock::duration>(now - looked_at, 2 * kSlice);
    looked_at = now;
    if (!news && channel_->closedByServer()) {
      throw NetworkException(fci::kServerClosed);
    }
    if (!news && waited >= bound) {
      return false;
    }
  }
  return true;
}

std::chrono::milliseconds Robot::Impl::stateBound() const noexcept {
  return serverMayBeDelayed() ? std::max(timeouts_.state, timeouts_.silence) : timeouts_.state;
}

bool Robot::Impl::serverMayBeDelayed() const noexcept {
  return channel_->serverIsLoopback() || keepsOtherTime();
}

void Robot::Impl::beginMotion() noexcept {
  motion_began_ = Moment{received_at_, state().message_id};
}

bool Robot::Impl::keepsOtherTime() const noexcept {
  if (!motion_began_) {
    return false;
  }
  const auto here = received_at_ - motion_began_->here;
  const std::chrono::milliseconds at_robot(state().message_id - motion_began_->at_robot);
  return std::chrono::abs(here - at_robot) > kSameTime;
}

bool Robot::Impl::takeStates() {
  bool news = false;
  for (int i = 0; i < kDatagramsAtOnce; i++) {
    const Datagram datagram = datagrams_.tryReceive(buffer_.data(), buffer_.size());
    if (!datagram.any) {
      break;
    }
    if (accept(datagram)) {
      news = true;
      if (mustBeSeen()) {
        break;
      }
    }
  }
  return news;
}

bool Robot::Impl::mustBeSeen() const noexcept { return keeps_mode_changes_ && modes_changed_; }

bool Robot::Impl::takeStatesUnlessInUse() {
  if (states_in_use_.test_and_set(std::memory_order_acquire)) {
    return true;  // the current holder has a timeout of its own
  }
  struct Release {
    std::atomic_flag& flag;
    ~Release() { flag.clear(std::memory_order_release); }
  } release{states_in_use_};
  return takesStatesIn();
}

// A repeated state also counts: the robot is there.
bool Robot::Impl::takesStatesIn() {
  repeated_ = false;
  return takeStates() || repeated_;
}

bool Robot::Impl::accept(const Datagram& datagram) {
  franka_core::RobotState& next = states_[1 - newest_];
  const fci::CodecError error =
      datagram.size > buffer_.size()
          ? fci::CodecError::kWrongSize
          : fci::decodeState(version_, {buffer_.data(), datagram.size}, next);
  if (error != fci::CodecError::kNone) {
    throw ProtocolException(
        (error == fci::CodecError::kWrongSize ? std::string(fci::kWrongObjectSize) + ". "
                                              : std::string("libfranka: ")) +
        fci::sentence(error, "robot state of protocol version " + std::to_string(version_),
                      datagram.size, fci::stateSize(version_)));
  }
  datagrams_.accept();
  if (next.message_id <= state().message_id) {
    repeated_ = repeated_ || next.message_id == state().message_id;
    return false;
  }
  modes_changed_ = next.robot_mode != state().robot_mode ||
                   next.motion_generator_mode != state().motion_generator_mode ||
                   next.controller_mode != state().controller_mode;
  newest_ = 1 - newest_;
  unread_ = true;
  received_at_ = Clock::now();
  mode_.store(next.robot_mode, std::memory_order_relaxed);
  return true;
}

void Robot::Impl::sendCommand(franka_core::RobotCommand& command) {
  command.message_id = state().message_id;
  fci::CommandBuffer buffer;
  fci::encodeCommand(version_, command, buffer);
  const int error = datagrams_.answer({buffer.data(), fci::commandSize(version_)});
  if (error != 0) {
    throw NetworkException(network::systemError("UDP send", error));
  }
}

bool Robot::Impl::isMoving() const noexcept {
  return (state().motion_generator_mode != MotionGeneratorMode::kIdle &&
          state().motion_generator_mode != MotionGeneratorMode::kNone) ||
         state().controller_mode == franka_core::ControllerMode::kExternalController;
}

}  // namespace franka

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/command_codec.h>
#include <franka_core/fci/commands.h>
#include <franka_core/fci/reply_codec.h>
#include <franka_core/fci/state_codec.h>
#include <franka_core/robot_state.h>
#include <franka_sim/robot/control_unit.h>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fci/client_slot.h"

namespace franka_sim::fci {

/// Handles the requests that a robot server receives from its client, and reports their results.
/// The control unit implements it; tests use a simpler implementation. Called by one thread;
/// nothing throws.
class ArmRequestHandler {
 public:
  using Status = franka_core::fci::Status;

  virtual ~ArmRequestHandler() = default;

  /// The present state; modes and configuration include the last request.
  virtual const franka_core::RobotState& state() const noexcept = 0;
  /// A client has connected with this protocol version.
  virtual void connected(std::uint16_t version) noexcept = 0;
  /// The client has disconnected; its motion may still run.
  virtual void disconnected() noexcept = 0;
  /// Whether clients may connect. When it becomes false, a connected client is dropped.
  virtual bool active() const noexcept = 0;
  /// Whether the arm has had a tick since its start or reset; motions wait for it.
  virtual bool measured() const noexcept = 0;

  /// The answer to any request except Connect and those for models. Move returns kMotionStarted, or
  /// the reason for its refusal. StopMove and AutomaticErrorRecovery may return nothing now and the
  /// answer later through takeAnswer.
  virtual std::optional<Status> handle(const franka_core::fci::Request& request) noexcept = 0;
  /// Why the arguments of a setter are invalid: a sentence for the robot's own log, because the
  /// answer has only a status. Empty if the reason is not known.
  virtual std::string faultOf(const franka_core::fci::Request& /*request*/) const { return ""; }
  /// The virtual wall with that number; nothing if there is no such number.
  virtual std::optional<franka_core::fci::CartesianLimit> wall(std::int32_t id) const noexcept = 0;

  /// The result of the motion, the stop or the recovery; each answer is returned once.
  virtual std::optional<Status> takeAnswer(PendingAnswer which) noexcept = 0;
};

struct RobotServerParameters {
  std::string address{"127.0.0.1"};                  ///< used by this robot only
  std::uint16_t port{franka_core::fci::kRobotPort};  ///< 0: the system chooses
  std::uint16_t oldest_version{3};                   ///< the oldest version that is accepted
  std::uint16_t newest_version{5};          ///< the newest; sent to clients outside the range
  std::vector<std::uint8_t> model_library;  ///< for versions up to 9; empty: there is none
  /// For versions from 8 on; each is used from its version up to the next key. Empty: there is
  /// none.
  std::map<std::uint16_t, std::string> urdfs;
};

/// The network interface of one robot: the TCP channel of requests and the UDP exchange of states
/// and commands. Passes requests to an ArmRequestHandler. Has no clock: the owner decides when a
/// state is sent and how long to wait for the answer.
///
/// One client at a time: the connection of a second client is reset, so that it fails at once
/// instead of waiting. No client can use more than a small part of a millisecond (ClientSlot). A
/// Connect within a motion, or while another answer is due, is refused: a client keeps its first
/// version. If a client vanishes, its motion gets no more commands; the control unit handles this
/// as lost commands. When the interface is switched off (see ArmRequestHandler::active), the client
/// is dropped after its pending answers, and no client can connect.
///
/// Called by one thread. serve allocates only when connections begin or end, when a client reads
/// more slowly than its answers arrive, or when it reports an invalid argument; publish only in the
/// second case.
class RobotServer {
 public:
  /// @throws std::runtime_error if the port cannot be opened.
  RobotServer(RobotServerParameters parameters, ArmRequestHandler& handler);
  ~RobotServer();

  std::uint16_t port() const noexcept { return slot_.port(); }
  /// Whether clients can connect, since the last serve().
  bool isOpen() const noexcept { return slot_.isOpen(); }
  bool hasClient() const noexcept { return version_ != 0; }
  /// Whether its client, if it has one, is connected by a loopback address.
  bool clientIsLocal() const noexcept { return client_is_local_; }
  /// Whether that client has read every state that was sent to it; nothing if it is not local, or
  /// the system does not show its socket. Not real-time safe.
  std::optional<bool> clientHasReadStates() const {
    return client_is_local_ ? datagrams_.peerHasRead() : std::nullopt;
  }
  bool idle() const noexcept { return slot_.idle(); }
  /// See ClientSlot::onRefusal.
  void onRefusal(ClientSlot::Report report) { slot_.onRefusal(std::move(report)); }
  /// The bytes that the client has not read yet; models are not copied for this purpose.
  std::size_t unsentBytes() noexcept {
    return slot_.client() == nullptr ? 0 : slot_.client()->unsentBytes();
  }
  /// The range of versions that are accepted.
  std::uint16_t oldestVersion() const noexcept { return parameters_.oldest_version; }
  std::uint16_t newestVersion() const noexcept { return parameters_.newest_version; }
  /// The version of the connected client; 0 without one.
  std::uint16_t version() const noexcept { return version_; }

  /// Accepts, reads and answers the requests that have arrived.
  /// @param stops_only leaves every request but Connect and StopMove for a later call.
  void serve(bool stops_only = false);

  /// Sends the handler's state, `ticks` after the last one, then the replies that had to wait until
  /// this state was sent. Real-time safe.
  /// @param same_tick time has not advanced since the last state: an answer to any state of this
  /// moment is accepted. @param keep_end sends the last state again if it showed the end of a
  /// motion that the client has not requested, and the client has sent no request since: however
  /// late it reads, it finds that state. Replies are sent, and ticks count.
  void publish(std::uint64_t ticks = 1, bool same_tick = false, bool keep_end = false);
  /// Sends the last state once more, byte for byte. Clients drop it, because it is not newer than
  /// their last state, but detect that the robot is connected.
  void repeat() noexcept;
  /// Whether a reply waits until the next state is sent, or a motion has ended and no state has
  /// shown that yet.
  bool hasPendingState() const noexcept {
    return motion_end_ || stop_end_ || recovery_end_ || answered_setter_count_ > 0 ||
           (motion_shown_ && !expectsCommands());
  }

  /// Reads datagrams and keeps the command that answers the last state; in an asynchronous motion
  /// the newest target, or its end. @returns whether one has arrived. Real-time safe.
  bool receiveCommand() noexcept;
  /// The answer to the last state, returned once; nothing if there is none. Real-time safe.
  const franka_core::RobotCommand* takeCommand() noexcept;
  /// Whether a motion runs that this client commands.
  bool expectsCommands() const noexcept;
  /// Whether that motion uses the asynchronous generator: the client may send a target at any time,
  /// and its last state may be any state of the motion. Otherwise a command is due each tick.
  bool asynchronous() const noexcept { return asynchronous_ && expectsCommands(); }
  /// Whether the motion has had its first command.
  bool motionHasBegun() const noexcept { return begun_; }

  /// The TCP sockets to poll, and the UDP socket if there is a client.
  void addDescriptors(std::vector<pollfd>& fds) const;
  void addCommandDescriptor(std::vector<pollfd>& fds) const;

 private:
  struct Pending {
    franka_core::fci::Command command;
    std::uint32_t id;
  };
  // A setter's answer; it follows the first state that contains the new setting.
  struct Answered {
    Pending request;
    franka_core::fci::Status status;
  };
  static constexpr std::size_t kMaxAnswered = 8;  // genuine clients have one pending
  static constexpr int kDatagramsAtOnce = 64;     // that are not an answer, between calls of serve
  // The same for targets of an asynchronous motion. Chosen here: more than a socket's buffer holds.
  static constexpr int kTargetsAtOnce = 512;

  void clearClient() noexcept;
  void dropClient() noexcept;
  Served serveOne(Connection& client, bool stops_only);
  bool connect(const franka_core::fci::Header& header,
               const franka_core::fci::ConnectRequest& request);
  bool answer(const franka_core::fci::Header& header, const franka_core::fci::Request& request);
  bool refuse(const franka_core::fci::Header& header, franka_core::fci::CodecError error);
  bool reply(const Pending& to, franka_core::fci::Status status);
  void sendState() noexcept;
  const Blob* urdf() const noexcept;
  bool replyWithModel(const Pending& to, const Blob& model);
  bool replyWithWall(const Pending& to, std::int32_t id);
  bool answersAState(std::uint64_t message_id) const noexcept;
  bool readsCommands() const noexcept;
  void keep(const franka_core::RobotCommand& command) noexcept;
  void reportFault(const franka_core::fci::Request& request);
  void collectEnds() noexcept;
  bool replyToSetters();
  void replyTo(std::optional<Pending>& pending, std::optional<franka_core::fci::Status>& status);

  RobotServerParameters parameters_;  // without the models
  Blob model_library_;
  std::map<std::uint16_t, Blob> urdfs_;
  ArmRequestHandler& handler_;
  ClientSlot slot_;
  Datagrams datagrams_;
  std::uint16_t version_{0};
  bool client_is_local_{false};

  std::optional<Pending> move_, stop_, recovery_;
  std::array<Answered, kMaxAnswered> answered_setters_{};
  std::size_t answered_setter_count_{0};
  std::optional<franka_core::fci::Status> motion_end_, stop_end_, recovery_end_;

  std::uint64_t message_id_{0};
  std::uint64_t oldest_of_tick_{0};
  std::uint64_t first_of_motion_{0};  // the first state after its start
  bool asynchronous_{false};
  bool begun_{false};
  bool answered_{false};
  bool motion_shown_{false};  // by the last state sent
  bool end_unread_{false};    // see publish
  int datagrams_left_{kDatagramsAtOnce};
  int targets_left_{kTargetsAtOnce};
  franka_core::fci::StateBuffer state_bytes_{};
  franka_core::RobotState shown_;
  franka_core::RobotCommand command_;
};

/// Translates requests of the protocol for a control unit, and translates the unit's results back.
class UnitRequestHandler final : public ArmRequestHandler {
 public:
  /// @param unit outlives the handler.
  explicit UnitRequestHandler(ControlUnit& unit) noexcept : unit_(unit) {}

  const franka_core::RobotState& state() const noexcept override { return unit_.state(); }
  void connected(std::uint16_t version) noexcept override;
  void disconnected() noexcept override { unit_.request(ClientLost{}); }
  bool active() const noexcept override { return unit_.status().fci_active; }
  bool measured() const noexcept override { return unit_.status().measured; }
  std::optional<Status> handle(const franka_core::fci::Request& request) noexcept override;
  std::string faultOf(const franka_core::fci::Request& request) const override;
  std::optional<franka_core::fci::CartesianLimit> wall(std::int32_t id) const noexcept override;
  std::optional<Status> takeAnswer(PendingAnswer which) noexcept override;

 private:
  void applyVersion() noexcept;

  ControlUnit& unit_;
  std::uint16_t version_{0};  // of a client that connected during another one's motion; otherwise 0
};

}  // namespace franka_sim::fci

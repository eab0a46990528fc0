// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/command_codec.h>
#include <franka_core/fci/reply_codec.h>
#include <franka_core/fci/state_codec.h>
#include <franka_core/robot_state.h>
#include <franka_sim/fci/arm_request_handler.h>
#include <franka_sim/fci/client_slot.h>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace franka_sim::fci {

struct RobotServerParameters {
  std::string address{"127.0.0.1"};                  ///< of this robot alone
  std::uint16_t port{franka_core::fci::kRobotPort};  ///< 0: the system chooses
  std::uint16_t oldest_version{3};                   ///< of the range that is answered
  std::uint16_t newest_version{5};                   ///< told to clients outside the range
  std::vector<std::uint8_t> model_library;           ///< for versions up to 9; empty: there is none
  /// For versions from 8 on; each from its version up to the next one's. Empty: there is none.
  std::map<std::uint16_t, std::string> urdfs;
};

/// The network face of one robot: the TCP channel of requests and the UDP exchange of states and
/// commands. Speaks for an ArmRequestHandler; knows nothing of time: the owner says when a state
/// goes out and how long it waits for the answer.
///
/// One client at a time; a second one is turned away (its connection is reset, so that it fails at
/// once instead of waiting), and none can take more than a little of a millisecond (ClientSlot). A
/// Connect within a motion, or while another answer is due, is refused: a client keeps the version
/// that it has begun with. A client that vanishes leaves its motion without commands; the control
/// unit then does what it does when commands stay away. With the interface switched off (see
/// ArmRequestHandler::active) the client is dropped, after what it is due, and nobody can connect.
///
/// One thread. publish, receiveCommand and takeCommand are real-time safe where the client takes
/// its answers; serve allocates only when connections come and go, or are slower than their
/// answers.
class RobotServer {
 public:
  /// @throws std::runtime_error with a sentence when the port cannot be opened.
  RobotServer(RobotServerParameters parameters, ArmRequestHandler& handler);
  ~RobotServer();

  std::uint16_t port() const noexcept { return slot_.port(); }
  bool hasClient() const noexcept { return version_ != 0; }
  /// See ClientSlot::onRefusal.
  void onRefusal(ClientSlot::Tell tell) { slot_.onRefusal(std::move(tell)); }
  /// What the client has not taken yet [bytes]; models are not copied for it.
  std::size_t unsentBytes() noexcept {
    return slot_.client() == nullptr ? 0 : slot_.client()->unsentBytes();
  }
  /// Of the connected client; 0 without one.
  std::uint16_t version() const noexcept { return version_; }

  /// Accepts, reads and answers what has arrived.
  /// @param stops_only leaves every request but Connect and StopMove for a later call.
  void serve(bool stops_only = false);

  /// Sends the handler's state, `ticks` after the last one, then the replies that were waiting for
  /// the client to see it.
  /// @param same_moment time stands still since the last one: an answer to any state of this moment
  /// counts.
  void publish(std::uint64_t ticks = 1, bool same_moment = false);
  /// Sends the last state once more, byte for byte. Clients drop what is no newer than what they
  /// have, but see that the robot is there.
  void repeat() noexcept;
  /// A reply waits until the next state is out.
  bool hasNews() const noexcept {
    return motion_end_ || stop_end_ || recovery_end_ || answered_setter_count_ > 0;
  }

  /// Reads datagrams; keeps the command that answers the last state. @returns whether it is there.
  bool receiveCommand() noexcept;
  /// The answer to the last state, once; nothing if there is none.
  const franka_core::RobotCommand* takeCommand() noexcept;
  /// A motion runs for this client, which commands it.
  bool expectsCommands() const noexcept;
  /// That motion is one of the asynchronous generator: the client sends a target when it has one,
  /// and any state of the motion may be the last it has read. Otherwise a command is due each tick.
  bool asynchronous() const noexcept { return asynchronous_ && expectsCommands(); }
  /// The motion has had its first command.
  bool motionHasBegun() const noexcept { return begun_; }

  /// The TCP sockets to poll, and the UDP socket where there is a client.
  void addDescriptors(std::vector<pollfd>& fds) const;
  void addCommandDescriptor(std::vector<pollfd>& fds) const;

 private:
  struct Pending {
    franka_core::fci::Command command;
    std::uint32_t id;
  };
  // A setter's answer; it follows the first state that shows what was set.
  struct Answered {
    Pending request;
    franka_core::fci::Status status;
  };
  static constexpr std::size_t kMostAnswered = 8;  // genuine clients have one at a time
  static constexpr int kDatagramsAtOnce = 64;      // that are no answer, between calls of serve

  void forgetClient() noexcept;
  void dropClient() noexcept;
  Served serveOne(Connection& client, bool stops_only);
  bool connect(const franka_core::fci::Header& header,
               const franka_core::fci::ConnectRequest& request);
  bool answer(const franka_core::fci::Header& header, const franka_core::fci::Request& request);
  bool refuse(const franka_core::fci::Header& header, franka_core::fci::CodecError error);
  bool reply(const Pending& to, franka_core::fci::Status status);
  const Blob* urdf() const noexcept;
  bool replyWithModel(const Pending& to, const Blob& model);
  bool replyWithWall(const Pending& to, std::int32_t id);
  bool answersAState(std::uint64_t message_id) const noexcept;
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

  std::optional<Pending> move_, stop_, recovery_;
  std::array<Answered, kMostAnswered> answered_setters_{};
  std::size_t answered_setter_count_{0};
  std::optional<franka_core::fci::Status> motion_end_, stop_end_, recovery_end_;

  std::uint64_t message_id_{0};
  std::uint64_t oldest_of_moment_{0};
  std::uint64_t first_of_motion_{0};  // the first state after its start
  bool asynchronous_{false};
  bool begun_{false};
  bool answered_{false};
  int datagrams_left_{kDatagramsAtOnce};
  franka_core::fci::StateBuffer state_bytes_{};
  franka_core::RobotState shown_;
  franka_core::RobotCommand command_;
};

}  // namespace franka_sim::fci

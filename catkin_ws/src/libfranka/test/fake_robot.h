// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/commands.h>
#include <franka_core/fci/protocol.h>
#include <franka_core/fci/request_codec.h>
#include <franka_core/fci/state_codec.h>
#include <franka_core/robot_state.h>

#include <chrono>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "loopback_socket.h"

namespace franka_test {

/// A robot for tests: real sockets on 127.0.0.1, port 0, any protocol version, and scripted
/// misbehavior.
///
/// A motion runs in lock-step: from the first answered state on, the next one is sent once the
/// answer has arrived (or Script::answer_timeout has passed); otherwise states are sent every
/// millisecond. Late answers count. After an abort that it replies to, the state that shows it is
/// the last one until the client's next request (or for two seconds), so that a slow client finds
/// it. It executes
/// commands at once and exactly: q_d, dq_d, ddq_d, O_T_EE_c, ... are the commands and their
/// backward differences. Serves one client after another.
class FakeRobot {
 public:
  using Command = franka_core::fci::Command;
  using Status = franka_core::fci::Status;
  using Datagram = std::vector<std::uint8_t>;

  /// Deviations from a well-behaved robot. `*_after` count commands of a motion; -1: never.
  struct Script {
    std::map<Command, Status> replies;  ///< instead of success (Move: of MotionStarted)
    std::set<Command> unanswered;       ///< requests that get no reply
    std::set<Command> fatal;            ///< requests that make it close the connection
    std::set<Command> garbled;          ///< requests with a reply that is one byte too short
    std::map<Command, int> repeated;    ///< number of repetitions of the (first) reply
    std::vector<std::uint8_t> urdf, library;
    std::optional<std::uint16_t> reported_version;  ///< in the reply to Connect

    bool shows_motion{true};              ///< states change when a motion starts
    std::optional<Status> end_at_start;   ///< second reply to Move, right after the first
    std::optional<Status> end_at_finish;  ///< second reply instead of success
    bool answers_finish{true};            ///< sends the second reply when a motion is finished
    bool ends_at_finish{true};            ///< stops moving when a motion is finished
    bool closes_at_finish{false};         ///< closes the connection instead of replying
    int abort_after{-1};                  ///< ends the motion ...
    Status abort_status{Status::kReflexAborted};
    franka_core::RobotMode abort_mode{franka_core::RobotMode::kReflex};
    std::vector<std::size_t> abort_errors;  ///< ... with these flags
    bool abort_replies{true};
    bool abort_replies_first{false};  ///< reply some states before the state that shows it
    bool preempts{true};              ///< StopMove makes it send the second reply to Move
    int close_after{-1};              ///< closes the connection
    int silence_after{-1};            ///< sends no more states
    int skip_after{-1};               ///< loses `skip` states
    std::uint64_t skip{0};
    bool sends_states{true};
    std::chrono::milliseconds answer_timeout{400};
    double success_rate{1.0};
    /// Datagrams sent instead of a state's datagram.
    std::function<std::vector<Datagram>(const Datagram&)> transmit;
  };

  explicit FakeRobot(std::uint16_t version);
  ~FakeRobot();
  FakeRobot(const FakeRobot&) = delete;
  FakeRobot& operator=(const FakeRobot&) = delete;

  std::string address() const;
  std::uint16_t version() const { return version_; }

  /// Changes the script between two actions.
  void script(const std::function<void(Script&)>& change);
  /// Changes the next state.
  void change(const std::function<void(franka_core::RobotState&)>& change);
  franka_core::RobotState state() const;

  /// Requests of all connections so far, in order.
  std::vector<franka_core::fci::Request> requests() const;
  int count(Command command) const;
  /// Commands of the motion that started last, each once, with the state they answer.
  struct Exchange {
    franka_core::RobotState state;
    franka_core::RobotCommand command;
  };
  std::vector<Exchange> exchanges() const;
  int connections() const;

 private:
  using Clock = std::chrono::steady_clock;

  void serve();
  void acceptClient();
  void readRequests();
  void handle(const franka_core::fci::Header& header, const franka_core::fci::Request& request);
  void handleMove(std::uint32_t id, const franka_core::fci::MoveRequest& request);
  void handleStop(std::uint32_t id);
  void reply(Command command, std::uint32_t id, Status status);
  void sendTcp(const std::uint8_t* data, std::size_t size);
  void readCommands();
  void obey(const franka_core::RobotCommand& command);
  void applyScriptToMotion();
  void endMotion(franka_core::RobotMode mode);
  void sendState();
  bool isTimeForState() const;
  void closeClient();

  const std::uint16_t version_;
  Socket listener_{SOCK_STREAM | SOCK_NONBLOCK};
  Socket udp_{SOCK_DGRAM | SOCK_NONBLOCK};

  mutable std::recursive_mutex mutex_;
  Script script_;
  std::vector<franka_core::fci::Request> requests_;
  std::vector<Exchange> exchanges_;
  int connections_{0};

  int client_{-1};
  std::vector<std::uint8_t> stream_;
  std::uint16_t client_udp_port_{0};
  franka_core::RobotState state_;
  Clock::time_point last_state_at_;
  bool was_answered_{false};
  std::uint64_t answered_id_{0};  // of the newest answered state, or of the last before the motion
  bool awaits_request_{false};
  bool silent_{false};
  std::optional<std::uint32_t> move_id_;
  std::optional<std::uint64_t> shown_abort_at_;  // message id
  bool stopping_{false};
  std::thread thread_;
};

}  // namespace franka_test

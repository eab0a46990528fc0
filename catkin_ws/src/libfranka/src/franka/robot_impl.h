// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/exception.h>
#include <franka/robot.h>
#include <franka_core/fci/commands.h>
#include <franka_core/fci/state_codec.h>
#include <franka_core/robot_state.h>

#include <array>
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "franka/arm_rate_limits.h"
#include "network/command_channel.h"
#include "network/datagram_socket.h"

namespace franka {

/// The connection itself: requests and replies over TCP, states and commands over UDP, in the
/// robot's protocol version.
///
/// Functions for requests are called by any thread, functions for states only by the holder of an
/// Operation.
class Robot::Impl {
 public:
  using Clock = network::Clock;
  using Request = franka_core::fci::Request;
  using Command = franka_core::fci::Command;
  using Reply = franka_core::fci::Reply;

  Impl(const std::string& address, RealtimeConfig realtime_config, std::size_t log_size);

  std::uint16_t version() const noexcept { return version_; }
  /// Prepares the calling thread for a motion (prepareControlThread): as constructed, unless
  /// franka_core::realtimeRule lifts the requirement for a simulated robot. What is lifted or not
  /// permitted is logged once. Not real-time safe. Thread-safe. @throws RealtimeException as
  /// prepareControlThread, or if the environment variable FRANKA_REALTIME is invalid.
  void prepareThreadForMotion();
  std::size_t logSize() const noexcept { return log_size_; }
  const ArmRateLimits& limits() const noexcept { return limits_; }
  bool isMobile() const noexcept { return is_mobile_; }
  const Timeouts& bounds() const noexcept { return timeouts_; }
  std::atomic<ControlOptions>& options() noexcept { return options_; }

  /// The exclusive right to receive states: one motion or read at a time.
  class Operation {
   public:
    /// @throws InvalidOperationException if another one exists, or as checkProcess.
    explicit Operation(Impl& robot);
    ~Operation();
    Operation(const Operation&) = delete;
    Operation& operator=(const Operation&) = delete;

   private:
    Impl& robot_;
  };

  /// As Robot::read and Robot::readOnce.
  void read(const std::function<bool(const RobotState&)>& callback);
  RobotState readOnce();

  /// @name Requests. Thread-safe. Not real-time safe.
  /// @{

  /// Sends a request and waits for its reply.
  /// @throws CommandException if the robot refuses, or does not have the command.
  Reply execute(const Request& request);
  /// For requests whose reply carries a model. @throws CommandException likewise; for
  /// LoadModelLibrary ModelException.
  std::vector<std::uint8_t> download(const Request& request) {
    return download(request, timeouts_.long_command);
  }

  /// Sends a request; its replies are kept until forget. @throws CommandException if this version
  /// of the protocol has no such request.
  std::uint32_t send(const Request& request);
  void discardReplies(std::uint32_t id) noexcept { channel_->discardReplies(id); }
  /// The next reply if it has arrived.
  std::optional<Reply> tryReceive(Command command, std::uint32_t id);
  /// Waits for the next reply. @param owns_states whether the caller holds an Operation.
  /// @throws NetworkException after `bound`, or Timeouts::silence without a state.
  Reply receive(Command command, std::uint32_t id, std::chrono::milliseconds bound,
                bool owns_states);
  /// The newest mode known.
  franka_core::RobotMode mode() const noexcept { return mode_.load(std::memory_order_relaxed); }
  /// @}

  /// @name States, for the holder of an Operation. Real-time safe.
  /// @{

  /// The newest state.
  const franka_core::RobotState& state() const noexcept { return states_[newest_]; }
  /// Waits for a newer state. Older and repeated ones are dropped; but a robot that repeats its
  /// last state waits for another client (a simulated one in lock-step), so the wait is extended.
  /// Time in which this process itself does not run does not count.
  /// @throws NetworkException after Timeouts::state, or Timeouts::silence if serverMayBeDelayed; at
  /// once if the connection is closed.
  /// @throws ProtocolException for an invalid datagram.
  const franka_core::RobotState& receiveState();
  /// Waits for a state newer than this call. If none arrives as soon as from a running robot, the
  /// newest one that no caller has received yet, if any. @throws as receiveState.
  const franka_core::RobotState& receiveFreshState();
  /// Waits for the next state for at most this time, which counts as in receiveState.
  /// @returns whether there is one. @throws as receiveState, but not for a timeout.
  bool waitForState(std::chrono::milliseconds bound);
  /// Reads datagrams that have arrived, without waiting. @returns whether there was a newer state.
  bool takeStates();
  /// Sends a command in answer to the newest state. @throws NetworkException if it cannot be sent.
  void sendCommand(franka_core::RobotCommand& command);

  /// From now on until endMotion(), the newest state does not skip one that shows other modes than
  /// the state before it: which states show the beginning and the end of a motion then does not
  /// depend on how late this program reads them.
  void keepModeChanges() noexcept { keeps_mode_changes_ = true; }
  /// A motion starts (or ends): from now on its clock is compared with this machine's.
  void beginMotion() noexcept;
  void endMotion() noexcept {
    motion_began_.reset();
    keeps_mode_changes_ = false;
  }
  /// Whether the robot's clock differs from this machine's in this motion. Real robots keep time; a
  /// simulated one that waits for its client's answers does not, and load may delay it.
  bool keepsOtherTime() const noexcept;
  /// Whether the robot is a simulated one, which load may stop for a while: one on this machine, or
  /// one that keepsOtherTime.
  bool serverMayBeDelayed() const noexcept;

  /// Whether the newest state shows an active motion generator or external controller.
  bool isMoving() const noexcept;
  /// @}

 private:
  using Datagram = network::DatagramSocket::Received;
  struct Moment {
    Clock::time_point here;
    std::uint64_t at_robot;  // [ms]
  };

  void connect(const std::string& address);
  /// Offers a version. @returns the version that the robot requires instead, or nothing if it
  /// agrees.
  std::optional<std::uint16_t> offer(const network::Endpoint& endpoint, std::uint16_t version,
                                     Clock::time_point deadline);
  /// Reads the kind of robot and its velocity limits from its description.
  void readDescription();
  std::vector<std::uint8_t> download(const Request& request, std::chrono::milliseconds bound);
  std::vector<std::uint8_t> receiveMessage(Command command, std::uint32_t id,
                                           std::chrono::milliseconds bound, bool owns_states);
  Reply decode(Command command, const std::vector<std::uint8_t>& message,
               franka_core::fci::Bytes& model) const;
  bool takeStatesUnlessInUse();
  bool takesStatesIn();
  bool accept(const Datagram& datagram);
  bool mustBeSeen() const noexcept;
  std::chrono::milliseconds stateBound() const noexcept;

  const RealtimeConfig realtime_config_;
  std::atomic_flag warned_of_realtime_ = ATOMIC_FLAG_INIT;
  std::atomic_flag warned_of_memory_ = ATOMIC_FLAG_INIT;
  const std::size_t log_size_;
  const Timeouts timeouts_;
  std::atomic<ControlOptions> options_{ControlOptions{}};

  std::uint16_t version_{franka_core::fci::kNewestRobotVersion};
  ArmRateLimits limits_;
  bool is_mobile_{false};
  std::unique_ptr<network::CommandChannel> channel_;

  std::atomic_flag busy_ = ATOMIC_FLAG_INIT;           // an Operation exists
  std::atomic_flag states_in_use_ = ATOMIC_FLAG_INIT;  // guards the members below
  network::DatagramSocket datagrams_;
  franka_core::fci::StateBuffer buffer_{};
  std::array<franka_core::RobotState, 2> states_;  // the newest, and a buffer for the next
  std::size_t newest_{0};
  bool unread_{false};               // no receive function has returned the newest state
  Clock::time_point received_at_{};  // the newest state
  bool repeated_{false};             // it has been repeated since
  std::optional<Moment> motion_began_;
  bool keeps_mode_changes_{false};
  bool modes_changed_{false};  // with the newest state
  std::atomic<franka_core::RobotMode> mode_{franka_core::RobotMode::kOther};
};

}  // namespace franka

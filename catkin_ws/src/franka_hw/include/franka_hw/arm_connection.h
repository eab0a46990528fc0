// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/log.h>
#include <franka/robot.h>
#include <franka/robot_state.h>
#include <franka_hw/arm_state.h>
#include <franka_hw/robot_mutex.h>
#include <ros/node_handle.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace franka_hw {

class Reconnection;

/// The connection to one robot: the robot, its mutex, the state of the connection (arm_state.h),
/// recovery, reconnection, and reports of aborts and losses.
///
/// After offer(), the connection is available in ROS: the setters (services.h) and the action
/// error_recovery while it is connected; the services `connect` and `disconnect` and the latched
/// topics `has_error` and `abort` always.
///
/// Threads: one thread, the robot's, reads the robot, moves it and reconnects. Services, actions
/// and the owner's other threads call the rest.
class ArmConnection {
 public:
  /// The hardware interface that owns the connection. Called from several threads.
  class Owner {
   public:
    virtual ~Owner() = default;
    /// @returns a robot that is completely set up @throws franka::Exception
    virtual std::unique_ptr<franka::Robot> openRobot() = 0;
    /// Implements the service `connect`. @throws franka::Exception
    virtual void connect() = 0;
    /// Implements the service `disconnect`. @returns false while a controller commands the robot
    virtual bool disconnect() = 0;
    /// The mode in the last state.
    virtual franka::RobotMode robotMode() const = 0;
    /// Whether a loss of the robot now requires a recovery.
    virtual bool lossIsError() const = 0;
    /// Called before a recovery ends an error. The robot is then Idle.
    virtual void errorEnds() = 0;
  };

  /// @param owner outlives this
  explicit ArmConnection(Owner& owner);
  ~ArmConnection();
  ArmConnection(const ArmConnection&) = delete;
  ArmConnection& operator=(const ArmConnection&) = delete;

  /// @name The connection. Thread-safe. Not real-time safe.
  /// @{
  /// Connects, and offers the services that need a robot; does nothing when connected.
  /// @throws franka::Exception of Owner::openRobot()
  void connect();
  /// Ends the connection and its error. @returns false while a motion holds the robot
  bool disconnect();
  /// @}

  /// Real-time safe. Thread-safe.
  ArmState state() const noexcept { return state_.state(); }
  /// Real-time safe. Thread-safe.
  bool connected() const noexcept { return isConnected(state()); }
  /// Null without a connection. Only for the holder of the mutex.
  const std::unique_ptr<franka::Robot>& robot() const noexcept { return robot_; }
  /// For the holder of the connection to the robot.
  RobotMutex& mutex() noexcept { return mutex_; }

  /// @name Errors
  /// @{
  /// Reports an error that is not the robot's: a motion under way ends. Real-time safe.
  /// Thread-safe.
  void fail() noexcept { state_.handle(ArmEvent::kFailed); }
  /// Reports that the robot is Idle without a recovery by this object: its own error has ended.
  /// Real-time safe. Thread-safe.
  void recoveredElsewhere() noexcept { state_.handle(ArmEvent::kRecoveredElsewhere); }
  /// Whether this robot needs a recovery. Real-time safe. Thread-safe.
  bool hasOwnError() const noexcept { return isInError(state()); }
  /// As hasOwnError(), or this arm waits for another one. Real-time safe. Thread-safe.
  bool hasError() const noexcept { return hasOwnError() || waits_for_others_; }
  /// Sets whether this arm must not move because another one has an error, whatever its own state.
  /// @returns whether that has changed. Real-time safe. Thread-safe.
  bool waitForOthers(bool waits) noexcept { return waits_for_others_.exchange(waits) != waits; }
  /// Whether there is an own error, or the robot stopped while no controller moved it.
  /// Real-time safe. Thread-safe.
  bool needsRecovery() const noexcept;
  /// Why commands of controllers have no effect now, and what ends that: a sentence with the arm,
  /// its mode and the action; empty if they have one. Thread-safe. Not real-time safe.
  std::string reasonWithoutEffect() const;
  /// Clears the robot's error and ends the own one. A robot that is Idle has no error. If there is
  /// nothing to recover, only a warning is logged. Thread-safe. Not real-time safe.
  /// @throws franka::Exception if the robot refuses or is not connected; nothing has changed then
  void recover();
  /// Sets what a recovery does between the end of the robot's error and that of the own one, while
  /// no motion can begin. Not called if the robot refuses. Call it before the first recovery.
  void beforeRecovery(std::function<void()> task) { before_recovery_ = std::move(task); }
  /// @}

  /// @name For the robot's thread. Not real-time safe.
  /// @{

  /// Holds the mutex for a motion. False if no motion may begin: the robot is not connected, or has
  /// an error.
  class Motion {
   public:
    explicit Motion(ArmConnection& arm);
    ~Motion() { state_.handle(ArmEvent::kMotionEnded); }
    Motion(const Motion&) = delete;
    Motion& operator=(const Motion&) = delete;
    explicit operator bool() const noexcept { return begun_; }

   private:
    std::lock_guard<std::mutex> lock_;
    ArmStateMachine& state_;
    bool begun_;
  };
  /// Runs `motion`, which holds a Motion, and reports what ended it. After offer().
  /// @returns whether it ended without an error
  bool move(const std::function<void()>& motion);
  /// Reads the next state of a robot at rest. @returns false if it is not connected, or if the
  /// connection has just been lost, which is reported
  bool readAtRest(franka::RobotState& state);
  /// As readAtRest(), for the holder of the mutex. Waits three seconds for a silent robot, or
  /// longer if libfranka does (as for simulated robots on this computer).
  /// @throws franka::NetworkException if the connection is lost
  /// @param read reads a state @param now the clock; tests have their own
  static franka::RobotState readPatiently(
      const std::function<franka::RobotState()>& read,
      const std::function<std::chrono::steady_clock::time_point()>& now =
          std::chrono::steady_clock::now);
  /// Connects to a robot that was lost, if the parameter `reconnect` is true and the next attempt
  /// is due.
  void reconnect();
  /// Publishes `has_error` if it has changed. Called outside of motions.
  void publishError();
  /// @}

  /// @name Set-up, in this order
  /// @{
  /// Reads the parameter `reconnect`. @returns false, after logging the reason, if it is wrong
  bool init(const ros::NodeHandle& nh);
  /// Offers services, action and topics in this namespace. `arm_id` is for messages.
  void offer(const ros::NodeHandle& nh, const std::string& arm_id);
  /// Withdraws what was offered, and waits for calls under way. Called after the robot's thread has
  /// ended.
  void close() noexcept;
  /// @}

 private:
  struct Offer;  // services, action and topics in ROS

  void abort(ArmEvent event, const std::string& what, const std::vector<franka::Record>& log);
  void lose(const std::string& what);
  void offerRobot();
  void withdrawRobot() noexcept;
  void dropRobot();
  void awaitDrop();
  void handleRecovery();

  Owner& owner_;
  ArmStateMachine state_;
  RobotMutex mutex_{state_};
  std::unique_ptr<franka::Robot> robot_;
  std::atomic_bool waits_for_others_{false};
  std::mutex connection_mutex_;  // held to connect, disconnect or lose; locked before mutex_
  std::thread drop_thread_;      // drops a lost robot; guarded by connection_mutex_
  std::atomic_bool dropping_{false};
  std::unique_ptr<Offer> offer_;
  std::function<void()> before_recovery_;
  std::unique_ptr<Reconnection> reconnection_;
};

}  // namespace franka_hw

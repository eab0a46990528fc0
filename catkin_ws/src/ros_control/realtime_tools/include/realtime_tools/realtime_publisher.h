// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost_bind_compat/global_placeholders.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <cstdint>
#include <memory>
#include <string>

#include "realtime_tools/detail/publishing_thread.h"
#include "realtime_tools/detail/turn_lock.h"

namespace realtime_tools {

/// Publishes messages of a real-time thread through another thread, shared by all publishers of the
/// process.
///
/// The real-time thread fills `msg_` between trylock() and unlockAndPublish(). Until the publishing
/// thread has copied the message, about 0.1 ms later in a regular stream, trylock() returns false
/// and the caller skips this cycle: messages are dropped, never queued. The first message after a
/// pause waits at most as long as the pause, and never above 5 ms. While nobody subscribes to a
/// topic that is not latched, messages are taken, and dropped, every 5 ms only.
///
/// Threads: one real-time thread; any thread may lock() and unlock(). init(), stop() and the
/// destructor are for one non-real-time thread.
///
/// @tparam Msg a ROS message type.
template <class Msg>
class RealtimePublisher : private detail::PublishingThread::Sender {
 public:
  /// The message. Access it only while holding the lock.
  Msg msg_;

  /// Advertises at once, like init().
  RealtimePublisher(const ros::NodeHandle& node, const std::string& topic, int queue_size,
                    bool latched = false) {
    init(node, topic, queue_size, latched);
  }

  /// Needs init() before use; trylock() returns false until then.
  RealtimePublisher() = default;

  RealtimePublisher(const RealtimePublisher&) = delete;
  RealtimePublisher& operator=(const RealtimePublisher&) = delete;

  /// Withdraws the topic. A pending message is dropped.
  ~RealtimePublisher() {
    stop();
    detail::PublishingThread::instance().remove(this);
    publisher_.shutdown();
  }

  /// Advertises and starts publishing; afterwards trylock() succeeds at once. A second call ends
  /// the earlier topic first.
  ///
  /// @param node namespace of the topic.
  /// @param topic name, resolved by `node`.
  /// @param queue_size for the subscribers [messages].
  /// @param latched whether late subscribers get the last message.
  /// @throw ros::InvalidNameException if the topic's name is not valid.
  void init(const ros::NodeHandle& node, const std::string& topic, int queue_size,
            bool latched = false) {
    stop();
    detail::PublishingThread::instance().remove(this);
    ros::NodeHandle handle(node);
    publisher_ = handle.advertise<Msg>(topic, static_cast<uint32_t>(queue_size), latched);
    latched_ = latched;
    turn_.open();
    detail::PublishingThread::instance().add(this);
  }

  /// Stops sending. Does not wait for a message being sent.
  void stop() { turn_.stop(); }

  /// Takes the lock if it is free and the publishing thread has taken the previous message. @return
  /// whether msg_ may be filled now. Real-time safe.
  bool trylock() noexcept { return turn_.tryLock(); }

  /// Releases the lock and publishes msg_. Real-time safe.
  void unlockAndPublish() noexcept {
    handed_over_ = Clock::now();  // not a system call where the system maps its clock
    turn_.unlockAndHandOver();
    detail::PublishingThread::instance().noteHandOver();
  }

  /// Waits for the lock, whether or not the previous message has been taken. Not real-time safe.
  void lock() noexcept { turn_.lock(); }

  /// Releases the lock without publishing. Real-time safe.
  void unlock() noexcept { turn_.unlock(); }

 private:
  using Clock = detail::PublishingSchedule::Clock;

  bool sendHandedOver(Clock::time_point& handed_over) override {
    if (!turn_.tryTakeTurn()) {
      return false;
    }
    if (!latched_ && publisher_.getNumSubscribers() == 0) {
      turn_.unlockAndReturn();
      return false;
    }
    outgoing_ = msg_;
    handed_over = handed_over_;
    turn_.unlockAndReturn();
    publisher_.publish(outgoing_);
    return true;
  }

  ros::Publisher publisher_;
  bool latched_{false};
  detail::TurnLock turn_;
  Clock::time_point handed_over_{};  ///< guarded by turn_
  Msg outgoing_;                     ///< used by the publishing thread; kept to reuse its memory
};

/// Sends what real-time publishers of this process have handed over, in the calling thread. For a
/// loop that owns its time, as a simulation's: called after each cycle, no message of the next one
/// is skipped because the last one has not been sent. Costs an atomic load if nothing is pending.
/// Not real-time safe.
inline void publishPending() {
  detail::PublishingThread& thread = detail::PublishingThread::instance();
  if (thread.hasPending()) {
    thread.sendPending();
  }
}

template <class Msg>
using RealtimePublisherSharedPtr = std::shared_ptr<RealtimePublisher<Msg>>;

}  // namespace realtime_tools

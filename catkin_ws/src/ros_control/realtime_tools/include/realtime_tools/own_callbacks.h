// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

namespace realtime_tools {

/// A queue and a thread for the callbacks of one object. The destructor of roscpp's timers,
/// subscribers and services does not wait for their callback that runs in another thread
/// (since 1.15), so an object that a node destroys while it goes on calls stop() first.
///
/// Declare it before what uses its handle. Not real-time safe.
class OwnCallbacks {
 public:
  /// A copy of the handle, whose callbacks, and those of the handles made from it, are called here.
  ros::NodeHandle of(ros::NodeHandle node) {
    node.setCallbackQueue(&queue_);
    return node;
  }
  /// Begins to call them.
  void start() { spinner_.start(); }
  /// Waits for the callback that runs; no other one begins. Must not be called by a callback.
  void stop() { spinner_.stop(); }

 private:
  ros::CallbackQueue queue_;
  ros::AsyncSpinner spinner_{1, &queue_};
};

}  // namespace realtime_tools

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_manager/controller_spec.h>
#include <controller_manager/internal/loop_gate.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace controller_manager {
namespace internal {

/// The loaded controllers, in the order of loading. Immutable.
class ControllerList {
 public:
  explicit ControllerList(std::vector<ControllerSpec> specs);

  const std::vector<ControllerSpec>& specs() const { return specs_; }
  /// The same controllers in one array, for the loop.
  const std::vector<controller_interface::ControllerBase*>& controllers() const {
    return controllers_;
  }
  /// nullptr if there is no such controller.
  const ControllerSpec* find(const std::string& name) const;

 private:
  std::vector<ControllerSpec> specs_;
  std::vector<controller_interface::ControllerBase*> controllers_;
};

typedef std::shared_ptr<const ControllerList> ControllerListPtr;

/// Passes the list of controllers to the loop and to other threads, and destroys controllers
/// outside the loop once it cannot read them any more.
class ControllerRegistry {
 public:
  /// @param gate that the loop passes; must outlive the registry
  explicit ControllerRegistry(LoopGate& gate);

  /// The list for this cycle, valid during the visit of the gate. Real-time safe.
  const ControllerList& forLoop() const { return *for_loop_.load(std::memory_order_seq_cst); }

  /// The present list; never waits for the loop. Thread-safe. Not real-time safe.
  ControllerListPtr snapshot() const;

  /// Replaces the list and destroys lists that the loop no longer reads. Waits for the running
  /// cycle, at most one second. Called by one thread at a time. Not real-time safe.
  void replace(std::vector<ControllerSpec> specs);

 private:
  LoopGate& gate_;
  mutable std::mutex mutex_;
  ControllerListPtr current_;
  std::vector<ControllerListPtr> outdated_;  ///< may still be read by the loop
  std::atomic<const ControllerList*> for_loop_;
};

}  // namespace internal
}  // namespace controller_manager

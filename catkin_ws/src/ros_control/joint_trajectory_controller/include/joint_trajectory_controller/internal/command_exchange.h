// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>

namespace joint_trajectory_controller {
namespace internal {

/// Passes commands into the control loop and used ones out of it, so that the loop neither waits
/// for a command nor destroys one.
///
/// A new command replaces one that was not taken yet. Wait-free for the loop, except that a
/// simultaneous collect() costs one more iteration. take() and giveBack() are for the loop; put()
/// and collect() for other threads, one at a time.
/// @tparam Command has a member `Command* next`
template <class Command>
class CommandExchange {
 public:
  CommandExchange() = default;
  CommandExchange(const CommandExchange&) = delete;
  CommandExchange& operator=(const CommandExchange&) = delete;
  ~CommandExchange() {
    delete inbox_.exchange(nullptr);
    collect([](std::unique_ptr<Command> /*command*/) {});
  }

  void put(std::unique_ptr<Command> command) {
    delete inbox_.exchange(command.release(), std::memory_order_acq_rel);
  }

  /// A new command, or null. The loop owns it until giveBack().
  Command* take() noexcept {
    if (inbox_.load(std::memory_order_relaxed) == nullptr) {
      return nullptr;
    }
    return inbox_.exchange(nullptr, std::memory_order_acq_rel);
  }

  void giveBack(Command* command) noexcept {
    if (command == nullptr) {
      return;
    }
    command->next = returned_.load(std::memory_order_relaxed);
    while (!returned_.compare_exchange_weak(command->next, command, std::memory_order_release,
                                            std::memory_order_relaxed)) {
    }
  }

  /// Passes returned commands to `use(std::unique_ptr<Command>)`, newest first.
  template <class Use>
  void collect(Use use) {
    Command* command = returned_.exchange(nullptr, std::memory_order_acquire);
    while (command != nullptr) {
      Command* const next = command->next;
      use(std::unique_ptr<Command>(command));
      command = next;
    }
  }

 private:
  std::atomic<Command*> inbox_{nullptr};
  std::atomic<Command*> returned_{nullptr};
};

}  // namespace internal
}  // namespace joint_trajectory_controller

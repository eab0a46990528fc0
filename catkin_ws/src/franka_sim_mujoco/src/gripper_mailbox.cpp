// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim_mujoco/gripper_mailbox.h>

#include <algorithm>

namespace franka_sim_mujoco {

namespace {

using Fate = GripperCommand::Fate;

void setFate(GripperCommand& command, Fate fate) noexcept {
  command.fate.store(fate, std::memory_order_release);
}

franka_sim::GripperUnit::Ticket give(franka_sim::GripperUnit& unit,
                                     const GripperCommand& command) noexcept {
  switch (command.kind) {
    case GripperCommand::Kind::kHoming:
      return unit.homing();
    case GripperCommand::Kind::kMove:
      return unit.move(command.width, command.speed);
    case GripperCommand::Kind::kGrasp:
      return unit.grasp(command.width, command.epsilon_inner, command.epsilon_outer, command.speed,
                        command.force);
    case GripperCommand::Kind::kStop:
      return unit.stop();
  }
  return 0;
}

Fate toFate(franka_sim::GripperOutcome outcome) noexcept {
  switch (outcome) {
    case franka_sim::GripperOutcome::kRunning:
      return Fate::kRunning;
    case franka_sim::GripperOutcome::kSucceeded:
      return Fate::kSucceeded;
    case franka_sim::GripperOutcome::kFailed:
      return Fate::kFailed;
    case franka_sim::GripperOutcome::kInterrupted:
      return Fate::kInterrupted;
  }
  return Fate::kInterrupted;
}

}  // namespace

void GripperMailbox::post(const std::shared_ptr<GripperCommand>& command) {
  std::lock_guard<std::mutex> lock(mutex_);
  kept_.erase(std::remove_if(kept_.begin(), kept_.end(),
                             [](const auto& kept) { return kept->isSettled(); }),
              kept_.end());
  kept_.push_back(command);
  GripperCommand* replaced = slot_.exchange(command.get(), std::memory_order_acq_rel);
  if (replaced != nullptr) {
    setFate(*replaced, Fate::kInterrupted);
  }
}

void GripperMailbox::serve(franka_sim::GripperUnit& unit) noexcept {
  if (slot_.load(std::memory_order_relaxed) == nullptr) {
    return;
  }
  GripperCommand* command = slot_.exchange(nullptr, std::memory_order_acq_rel);
  if (command == nullptr) {
    return;
  }
  const franka_sim::GripperUnit::Ticket ticket = give(unit, *command);
  if (ticket == 0) {
    // Refused commands do not interrupt the running one.
    setFate(*command, Fate::kRefused);
    return;
  }
  if (running_ != nullptr) {
    const Fate fate = toFate(unit.outcome(ticket_));
    setFate(*running_, fate == Fate::kRunning ? Fate::kInterrupted : fate);
  }
  running_ = command;
  ticket_ = ticket;
  setFate(*running_, Fate::kRunning);
}

void GripperMailbox::settle(const franka_sim::GripperUnit& unit) noexcept {
  if (running_ == nullptr) {
    return;
  }
  const Fate fate = toFate(unit.outcome(ticket_));
  if (fate != Fate::kRunning) {
    setFate(*running_, fate);
    running_ = nullptr;
  }
}

void GripperMailbox::interruptAll() noexcept {
  GripperCommand* waiting = slot_.exchange(nullptr, std::memory_order_acq_rel);
  for (GripperCommand* command : {waiting, running_}) {
    if (command != nullptr) {
      setFate(*command, Fate::kInterrupted);
    }
  }
  running_ = nullptr;
}

}  // namespace franka_sim_mujoco

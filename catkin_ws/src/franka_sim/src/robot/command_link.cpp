// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/numbers.h>
#include <franka_sim/robot/command_link.h>

#include <stdexcept>
#include <string>

namespace franka_sim {

void CommandLink::setLoss(double probability, std::uint64_t seed) {
  if (!(probability >= 0.0 && probability <= 1.0)) {
    throw std::invalid_argument("The probability of a loss is a number from 0 to 1.");
  }
  loss_ = probability;
  seed_ = seed;
  engine_.seed(seed);
}

void CommandLink::setDelay(double ticks) {
  const auto whole = franka_core::wholeNumber(ticks, 0, kMaxDelay);
  if (!whole) {
    throw std::invalid_argument("Commands are delayed by a whole number of ticks from 0 to " +
                                std::to_string(kMaxDelay) + ".");
  }
  delay_ = static_cast<unsigned>(*whole);
  clear();
}

void CommandLink::clear() noexcept {
  for (Slot& slot : slots_) {
    slot.full = false;
  }
}

void CommandLink::restart() noexcept {
  clear();
  lose_next_ = 0;
  engine_.seed(seed_);
}

bool CommandLink::loses() noexcept {
  if (lose_next_ > 0) {
    lose_next_--;
    return true;
  }
  constexpr double kSteps = 9007199254740992.0;  // 2^53
  return loss_ > 0.0 && static_cast<double>(engine_() >> 11U) < loss_ * kSteps;
}

const franka_core::RobotCommand* CommandLink::pass(
    const franka_core::RobotCommand* command) noexcept {
  now_ = (now_ + 1) % slots_.size();
  slots_[now_].full = command != nullptr && !loses();
  if (slots_[now_].full) {
    slots_[now_].command = *command;
  }
  const Slot& out = slots_[(now_ + slots_.size() - delay_) % slots_.size()];
  return out.full ? &out.command : nullptr;
}

}  // namespace franka_sim

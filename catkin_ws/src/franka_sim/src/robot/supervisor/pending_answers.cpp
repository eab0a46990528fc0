// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/supervisor/pending_answers.h"

#include <utility>

namespace franka_sim {

std::optional<Status> PendingAnswers::take(PendingAnswer which) noexcept {
  switch (which) {
    case PendingAnswer::kMotion:
      return std::exchange(motion_, std::nullopt);
    case PendingAnswer::kStop:
      return std::exchange(stop_, std::nullopt);
    case PendingAnswer::kRecovery:
      return std::exchange(recovery_, std::nullopt);
  }
  return std::nullopt;
}

void PendingAnswers::stopBegins() noexcept {
  stop_.reset();
  stopping_ = true;
}

void PendingAnswers::interruptMotion(Status status) noexcept {
  if (motion_at_rest_) {
    motion_ = motion_at_rest_ == Status::kSuccess ? status : motion_at_rest_;
    motion_at_rest_.reset();
  }
}

void PendingAnswers::interruptStop(Status status) noexcept {
  if (std::exchange(stopping_, false)) {
    stop_ = status;
  }
}

void PendingAnswers::atRest() noexcept {
  if (motion_at_rest_) {
    motion_ = std::exchange(motion_at_rest_, std::nullopt);
  }
  interruptStop(Status::kSuccess);
}

}  // namespace franka_sim

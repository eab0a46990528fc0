// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/serve/host.h>
#include <sys/types.h>

#include <chrono>

#include "fci/sockets.h"
#include "options.h"

namespace franka_sim {

/// The program franka_desk, which serves Desk for the robots of this process: started by the
/// constructor, ended by the destructor. It learns the robots' states from their control
/// interfaces.
class DeskProcess : public fci::Service {
 public:
  /// @throws std::runtime_error if the program is not found or cannot be started.
  explicit DeskProcess(const Options& options);
  ~DeskProcess() override;
  DeskProcess(const DeskProcess&) = delete;
  DeskProcess& operator=(const DeskProcess&) = delete;

  /// Reports on standard error if the program has ended by itself.
  void serve() override;
  void addDescriptors(std::vector<pollfd>& /*fds*/) const override {}

 private:
  using Clock = std::chrono::steady_clock;

  bool hasEnded(int& status) noexcept;

  pid_t process_{-1};
  fci::Descriptor input_;  // its standard input; closing it ends the program
  Clock::time_point checked_at_{};
};

}  // namespace franka_sim

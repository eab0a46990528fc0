// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/serve/host.h>
#include <sys/types.h>

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "fci/sockets.h"
#include "options.h"

namespace franka_sim {

/// The program franka_desk, which serves Desk for the robots of this process: started by the
/// constructor, ended by the destructor. It learns the robots' states from their control
/// interfaces.
class DeskProcess : public fci::Service {
 public:
  /// Is called once, when Desk listens at these addresses: one for each robot, as https://....
  using Ready = std::function<void(const std::vector<std::string>& addresses)>;

  /// @throws std::runtime_error if the program is not found or cannot be started.
  DeskProcess(const Options& options, Ready ready);
  ~DeskProcess() override;
  DeskProcess(const DeskProcess&) = delete;
  DeskProcess& operator=(const DeskProcess&) = delete;

  /// Reports on standard error if the program has ended by itself.
  /// @throws std::runtime_error if it has failed before it was ready.
  void serve() override;
  void addDescriptors(std::vector<pollfd>& /*fds*/) const override {}

 private:
  using Clock = std::chrono::steady_clock;

  bool hasEnded(int& status) noexcept;
  void readAddresses();

  pid_t process_{-1};
  fci::Descriptor input_;   // its standard input; closing it ends the program
  fci::Descriptor output_;  // its addresses, one a line; closed when all are there
  std::string addresses_;
  Ready ready_;  // empty after the call
  Clock::time_point checked_at_{};
};

}  // namespace franka_sim

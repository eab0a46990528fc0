// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/serve/host.h>
#include <franka_sim/serve/sim_robot.h>

#include <atomic>
#include <chrono>
#include <optional>
#include <utility>
#include <vector>

namespace franka_sim {

/// Delays the end of the program until its clients have disconnected. roslaunch ends a robot and
/// its clients at the same time; without the delay the clients would report a lost robot.
class Shutdown : public fci::Service {
 public:
  /// @param requested true once the end was requested
  /// @param ended is set when no client is left, or `patience` after the request
  Shutdown(const std::atomic<bool>& requested, std::atomic<bool>& ended,
           std::chrono::duration<double> patience, std::vector<fci::SimRobot*> robots)
      : requested_(requested), ended_(ended), patience_(patience), robots_(std::move(robots)) {}

  void serve() override;
  bool idle() const override { return !requested_; }
  void addDescriptors(std::vector<pollfd>& /*fds*/) const override {}

 private:
  using Clock = std::chrono::steady_clock;

  bool hasClients() const;

  const std::atomic<bool>& requested_;
  std::atomic<bool>& ended_;
  std::chrono::duration<double> patience_;
  std::vector<fci::SimRobot*> robots_;
  std::optional<Clock::time_point> requested_at_;
};

}  // namespace franka_sim

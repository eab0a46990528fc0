// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim_mujoco/fci/client_slot.h>
#include <franka_sim_mujoco/fci/host.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace franka_sim_mujoco::fci {

/// What stands in for a person beside the robot: commands of one line each over TCP, answered by
/// one line, "ok", "ok <value>" or "error: <sentence>". `nc` suffices to talk to it. One client at
/// a time; commands are carried out between two ticks, by the thread that runs the host.
class LineServer final : public Service {
 public:
  using Words = std::vector<std::string>;
  /// Gets the words behind the command's name; returns the value to tell, or nothing.
  /// @throws std::exception whose text becomes the error.
  using Handler = std::function<std::string(const Words&)>;

  /// @throws std::runtime_error with a sentence when the port cannot be opened.
  LineServer(const std::string& address, std::uint16_t port) : slot_(address, port) {}

  std::uint16_t port() const noexcept { return slot_.port(); }
  /// @param usage the command as a person writes it, for example "user_stop on|off"; its first word
  /// is the name.
  void add(const std::string& usage, Handler handler);
  /// The answer to one line.
  std::string answer(const std::string& line) const;

  void serve() override;
  void addDescriptors(std::vector<pollfd>& fds) const override { slot_.addDescriptors(fds); }

 private:
  struct Entry {
    std::string usage;
    Handler handler;
  };

  Served serveOne(Connection& client);
  std::string help() const;

  ClientSlot slot_;
  std::map<std::string, Entry> entries_;
};

/// A word as a number. @throws std::invalid_argument with a sentence.
double toNumber(const std::string& word);
/// A word as a whole number from 0 to 18446744073709551615, the largest of 64 bits.
/// @throws std::invalid_argument with a sentence.
std::uint64_t toSeed(const std::string& word);
/// "on" or "off". @throws std::invalid_argument with a sentence.
bool toSwitch(const std::string& word);

}  // namespace franka_sim_mujoco::fci

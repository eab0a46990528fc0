// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "serve/cpu_latency_request.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <string_view>

namespace franka_sim::fci {

namespace {

/// The idle driver of some virtual machines (Linux' drivers/cpuidle/cpuidle-haltpoll.c).
constexpr std::string_view kHaltPoll = "haltpoll";

bool isHaltPoll(const std::string& idle_driver) noexcept {
  const Descriptor file(open(idle_driver.c_str(), O_RDONLY | O_CLOEXEC));
  std::array<char, kHaltPoll.size()> name{};
  return file && read(file.get(), name.data(), name.size()) == static_cast<ssize_t>(name.size()) &&
         std::string_view(name.data(), name.size()) == kHaltPoll;
}

}  // namespace

void CpuLatencyRequest::begin() noexcept {
  if (open_device_ || !isHaltPoll(idle_driver_)) {
    return;
  }
  open_device_ = Descriptor(open(device_.c_str(), O_WRONLY | O_CLOEXEC));
  const std::int32_t microseconds = 0;
  if (open_device_ &&
      write(open_device_.get(), &microseconds, sizeof(microseconds)) != sizeof(microseconds)) {
    end();
  }
}

}  // namespace franka_sim::fci

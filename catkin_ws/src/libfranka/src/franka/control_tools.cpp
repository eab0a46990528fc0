// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/control_tools.h>
#include <franka_core/transform.h>
#include <pthread.h>
#include <sched.h>

#include <cerrno>
#include <cstring>
#include <fstream>

namespace franka {

bool isValidElbow(const std::array<double, 2>& elbow) noexcept {
  return elbow[1] == -1.0 || elbow[1] == 1.0;
}

bool isHomogeneousTransformation(const std::array<double, 16>& transform) noexcept {
  return franka_core::isHomogeneousTransformation(transform);
}

bool hasRealtimeKernel() {
  std::ifstream realtime("/sys/kernel/realtime", std::ios_base::in);
  bool is_realtime = false;
  realtime >> is_realtime;
  return is_realtime;
}

bool setCurrentThreadToHighestSchedulerPriority(std::string* error_message) {
  const auto fail = [error_message](const char* what, int error) {
    if (error_message != nullptr) {
      *error_message = std::string("libfranka: ") + what + ": " + std::strerror(error) +
                       ". Allow realtime priorities for this user (limit rtprio in "
                       "/etc/security/limits.conf) or use franka::RealtimeConfig::kIgnore.";
    }
    return false;
  };
  sched_param parameters{};
  parameters.sched_priority = sched_get_priority_max(SCHED_FIFO);
  if (parameters.sched_priority == -1) {
    return fail("The system does not name a highest realtime priority", errno);
  }
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
  return error == 0 || fail("The thread cannot be given realtime priority", error);
}

}  // namespace franka

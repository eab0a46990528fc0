// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/control_tools.h>
#include <pthread.h>
#include <sched.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>

namespace franka {

namespace {

// How far the length of a rotation's row or column may be from 1 (fci.md 4).
constexpr double kOrthonormalTolerance = 1e-5;

bool isUnitLength(double x, double y, double z) noexcept {
  return std::abs(std::sqrt(x * x + y * y + z * z) - 1.0) <= kOrthonormalTolerance;
}

}  // namespace

bool isValidElbow(const std::array<double, 2>& elbow) noexcept {
  return elbow[1] == -1.0 || elbow[1] == 1.0;
}

bool isHomogeneousTransformation(const std::array<double, 16>& transform) noexcept {
  const std::array<double, 16>& t = transform;
  if (t[3] != 0.0 || t[7] != 0.0 || t[11] != 0.0 || t[15] != 1.0) {
    return false;
  }
  for (std::size_t i = 0; i < 3; i++) {
    if (!isUnitLength(t[4 * i], t[4 * i + 1], t[4 * i + 2]) ||
        !isUnitLength(t[i], t[4 + i], t[8 + i])) {
      return false;
    }
  }
  return true;
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

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// A client of a running franka_sim, by this project's libfranka: zero torques for some seconds of
// the robot's time. Prints a report as JSON:
//   times_real_time  the robot's time over the wall's; in lock-step the speed of the pair
//   lost             commands that the robot counts as lost
//   p50_us, p999_us  from an answer's sending to the next state's arrival; in lock-step the
//                    server's turn-round with physics, and the way there and back
//   bare_p50_us, bare_p999_us  the same of two threads that only exchange datagrams of these sizes
//                    and wait without sleep, as often, in the same run: the reference
#include <franka/active_control_base.h>
#include <franka/exception.h>
#include <franka/robot.h>
#include <franka_core/fci/command_codec.h>
#include <franka_core/fci/state_codec.h>
#include <franka_core/numbers.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>
#include <vector>

#include "echo_robot.h"

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kWarmUp = 200;  // cycles that are not timed

struct Seen {
  std::vector<double> microseconds;
  double robot_seconds{0.0};
  double wall_seconds{0.0};
  double lost{0.0};
};

// The success rate is the share of the last hundred; the sum of its drops is the loss.
class Losses {
 public:
  double count(double rate) {
    lost_ += std::max(0.0, std::round(100.0 * (last_ - rate)));
    last_ = rate;
    return lost_;
  }

 private:
  double last_{1.0};
  double lost_{0.0};
};

Seen hold(franka::Robot& robot, double seconds) {
  Seen seen;
  const auto cycles = static_cast<std::size_t>(1000.0 * seconds);
  seen.microseconds.reserve(cycles);
  franka::Torques torques({0, 0, 0, 0, 0, 0, 0});
  const auto motion = robot.startTorqueControl();
  motion->readOnce();
  Losses losses;
  Clock::time_point begin;
  for (std::size_t i = 0; seen.robot_seconds < seconds; i++) {
    const Clock::time_point sent = Clock::now();
    if (i == kWarmUp) {
      begin = sent;
    }
    motion->writeOnce(torques);
    const auto [state, period] = motion->readOnce();
    if (i >= kWarmUp) {
      const std::chrono::duration<double, std::micro> passed = Clock::now() - sent;
      seen.microseconds.push_back(passed.count());
      seen.robot_seconds += period.toSec();
      seen.lost = losses.count(state.control_command_success_rate);
    }
  }
  seen.wall_seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  torques.motion_finished = true;
  motion->writeOnce(torques);
  return seen;
}

/// Durations of round trips [us] of a command and a state between two threads that never sleep.
std::vector<double> pingPong(std::uint16_t version, std::size_t count) {
  const franka_bench::Socket client(SOCK_DGRAM), robot(SOCK_DGRAM);
  const std::array<char, 4096> datagram{};
  const auto send = [&datagram](const franka_bench::Socket& from, const franka_bench::Socket& to,
                                std::size_t size) {
    sendto(from.get(), datagram.data(), size, 0, reinterpret_cast<const sockaddr*>(&to.address()),
           sizeof(to.address()));
  };
  const auto receive = [](const franka_bench::Socket& socket) {
    std::array<char, 4096> buffer;
    while (recv(socket.get(), buffer.data(), buffer.size(), MSG_DONTWAIT) < 0) {
    }
  };
  std::thread echo([&] {
    for (std::size_t i = 0; i < count; i++) {
      receive(robot);
      send(robot, client, franka_core::fci::stateSize(version));
    }
  });
  std::vector<double> microseconds(count);
  for (double& passed : microseconds) {
    const Clock::time_point sent = Clock::now();
    send(client, robot, franka_core::fci::commandSize(version));
    receive(client);
    passed = std::chrono::duration<double, std::micro>(Clock::now() - sent).count();
  }
  echo.join();
  return microseconds;
}

double percentile(std::vector<double>& values, double share) {
  const auto place =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

}  // namespace

int main(int argc, char** argv) {
  const double seconds = argc == 3 ? franka_core::readNumber(argv[2]).value_or(0.0) : 0.0;
  if (!(seconds > 0.0)) {
    std::fputs("Usage: client_of_franka_sim_bench ADDRESS SECONDS\n", stderr);
    return 2;
  }
  try {
    franka::Robot robot(argv[1], franka::RealtimeConfig::kIgnore);
    Seen seen = hold(robot, seconds);
    std::vector<double> bare = pingPong(robot.serverVersion(), seen.microseconds.size());
    std::printf(
        "{\"times_real_time\": %.3f, \"lost\": %.0f, \"p50_us\": %.1f, \"p999_us\": %.1f, "
        "\"bare_p50_us\": %.1f, \"bare_p999_us\": %.1f}\n",
        seen.robot_seconds / seen.wall_seconds, seen.lost, percentile(seen.microseconds, 0.5),
        percentile(seen.microseconds, 0.999), percentile(bare, 0.5), percentile(bare, 0.999));
    return 0;
  } catch (const franka::Exception& error) {
    std::fprintf(stderr, "client_of_franka_sim_bench: %s\n", error.what());
    return 1;
  }
}

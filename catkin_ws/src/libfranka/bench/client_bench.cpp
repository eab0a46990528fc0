// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Cost of the client in one millisecond, for each layout of the protocol.
// cycle/<version>: decode the state, call back, filter, limit, encode the command; compared with
// copies/<version>, which only copies both datagrams.
// roundTrip/<version>: a command over UDP and the state that answers it, through the whole client;
// compared with barePingPong/<version>, plain sockets with datagrams of the same sizes. Counters
// p50_us and p999_us are percentiles of single round trips, p50_ratio the client's p50 over that of
// the bare sockets.
#include <benchmark/benchmark.h>
#include <franka/active_control_base.h>
#include <franka/lowpass_filter.h>
#include <franka/robot.h>
#include <franka_core/fci/command_codec.h>
#include <franka_core/to_franka.h>
#include <sched.h>

#include <algorithm>
#include <chrono>

#include "echo_robot.h"
#include "franka/command_shaping.h"

namespace {

namespace fci = franka_core::fci;
using Clock = std::chrono::steady_clock;

franka_core::RobotState movingState() {
  franka_core::RobotState state;
  state.robot_mode = franka_core::RobotMode::kMove;
  state.q = state.q_d = {0.0, -0.8, 0.0, -2.4, 0.0, 1.6, 0.8};
  state.m_ee = 0.73;
  state.m_load = 0.5;
  state.F_x_Cee = {-0.01, 0.0, 0.03};
  state.elbow = state.elbow_c = {0.0, -1.0};
  for (auto* pose : {&state.O_T_EE, &state.O_T_EE_c, &state.F_T_EE, &state.EE_T_K}) {
    *pose = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.3, 0.0, 0.5, 1};
  }
  return state;
}

franka::CartesianPose nextPose(const franka::RobotState& state, franka::Duration) {
  std::array<double, 16> pose = state.O_T_EE_c;
  pose[12] += 1e-5;
  return franka::CartesianPose(pose, state.elbow_c);
}

franka::Torques nextTorques(const franka::RobotState& state, franka::Duration) {
  franka::Torques torques({0, 0, 0, 0, 0, 0, 0});
  for (std::size_t i = 0; i < 7; i++) {
    torques.tau_J[i] = 100.0 * (state.q_d[i] - state.q[i]) + 0.1;
  }
  return torques;
}

// The most expensive mode: a pose with an elbow, and torques.
void cycle(benchmark::State& loop) {
  const auto version = static_cast<std::uint16_t>(loop.range(0));
  fci::StateBuffer datagram{};
  fci::encodeState(version, movingState(), datagram);
  const franka::ArmRateLimits limits = franka::rateLimitsOfProtocol(version);
  const franka::Shaping shaping{&limits, franka::kDefaultCutoffFrequency, false};
  const std::function<franka::CartesianPose(const franka::RobotState&, franka::Duration)> motion =
      nextPose;
  const std::function<franka::Torques(const franka::RobotState&, franka::Duration)> control =
      nextTorques;
  franka_core::RobotState wire_state;
  franka::RobotState state;
  franka_core::RobotCommand command;
  fci::CommandBuffer buffer{};
  for (auto _ : loop) {
    fci::decodeState(version, {datagram.data(), fci::stateSize(version)}, wire_state);
    franka_core::toFranka(wire_state, state);
    franka::shape(shaping, motion(state, franka::Duration(1)), wire_state, command);
    franka::shape(shaping, control(state, franka::Duration(1)), wire_state, command);
    fci::encodeCommand(version, command, buffer);
    benchmark::DoNotOptimize(buffer);
  }
}

void copies(benchmark::State& loop) {
  const auto version = static_cast<std::uint16_t>(loop.range(0));
  fci::StateBuffer from{}, to{};
  fci::CommandBuffer command_from{}, command_to{};
  for (auto _ : loop) {
    std::memcpy(to.data(), from.data(), fci::stateSize(version));
    std::memcpy(command_to.data(), command_from.data(), fci::commandSize(version));
    benchmark::DoNotOptimize(to);
    benchmark::DoNotOptimize(command_to);
  }
}

/// Times single round trips.
class Times {
 public:
  Times() { seconds_.reserve(1 << 20); }
  template <typename Function>
  double measure(Function function) {
    const Clock::time_point begin = Clock::now();
    function();
    seconds_.push_back(std::chrono::duration<double>(Clock::now() - begin).count());
    return seconds_.back();
  }
  double percentile(double share) {
    std::sort(seconds_.begin(), seconds_.end());
    return seconds_[static_cast<std::size_t>(share * static_cast<double>(seconds_.size() - 1))];
  }

 private:
  std::vector<double> seconds_;
};

// Otherwise the scheduler's choice of cores decides between 15 and 60 us.
void runOnCore(std::size_t core) {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  CPU_SET(core, &cores);
  sched_setaffinity(0, sizeof(cores), &cores);
}

enum class Subject { kClient, kBare };

// Alternates both kinds of round trip, so that other load affects both equally; reports the time of
// one of them.
void pingPong(benchmark::State& loop, Subject subject) {
  const auto version = static_cast<std::uint16_t>(loop.range(0));
  runOnCore(1);  // inherited by the servers' threads
  franka_bench::EchoRobot echo_robot(version);
  franka_bench::EchoServer echo(fci::stateSize(version));
  runOnCore(0);
  franka::Robot robot(echo_robot.address(), franka::RealtimeConfig::kIgnore);
  const auto motion = robot.startTorqueControl();
  const franka::Torques torques({1, 2, 3, 4, 5, 6, 7});
  motion->readOnce();
  franka_bench::Socket socket(SOCK_DGRAM, 1000);
  std::vector<std::uint8_t> command(fci::commandSize(version));
  std::uint8_t state[4096];
  Times client_times, bare_times;
  for (auto _ : loop) {
    const double client = client_times.measure([&] {
      motion->writeOnce(torques);
      benchmark::DoNotOptimize(motion->readOnce());
    });
    const double bare = bare_times.measure([&] {
      sendto(socket.get(), command.data(), command.size(), 0,
             reinterpret_cast<const sockaddr*>(&echo.address()), sizeof(sockaddr_in));
      if (recv(socket.get(), state, sizeof(state), 0) <= 0) {
        loop.SkipWithError("no answer");
      }
    });
    loop.SetIterationTime(subject == Subject::kClient ? client : bare);
  }
  Times& times = subject == Subject::kClient ? client_times : bare_times;
  loop.counters["p50_us"] = 1e6 * times.percentile(0.5);
  loop.counters["p999_us"] = 1e6 * times.percentile(0.999);
  loop.counters["p50_ratio"] = client_times.percentile(0.5) / bare_times.percentile(0.5);
}

void roundTrip(benchmark::State& loop) { pingPong(loop, Subject::kClient); }
void barePingPong(benchmark::State& loop) { pingPong(loop, Subject::kBare); }

BENCHMARK(cycle)->Arg(3)->Arg(4)->Arg(5)->Arg(9)->Arg(10);
BENCHMARK(copies)->Arg(3)->Arg(4)->Arg(5)->Arg(9)->Arg(10);
BENCHMARK(roundTrip)->Arg(5)->Arg(10)->UseManualTime()->Iterations(10000);
BENCHMARK(barePingPong)->Arg(5)->Arg(10)->UseManualTime()->Iterations(10000);

}  // namespace

BENCHMARK_MAIN();

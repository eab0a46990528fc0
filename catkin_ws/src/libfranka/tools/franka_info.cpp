// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Reports a robot's state and whether the connection is good enough to control it.
#include <franka/control_tools.h>
#include <franka/exception.h>
#include <franka/gripper.h>
#include <franka/robot.h>
#include <franka_core/fci/texts.h>
#include <franka_core/numbers.h>
#include <franka_core/robot_versions.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "connection_statistics.h"
#include "recording.h"
#include "round_trips.h"

namespace {

using franka_core::fixedText;
using franka_info::ConnectionStatistics;
using franka_info::quantileOf;
using franka_info::RoundTrips;

constexpr const char* kDescription =
    "Connects to the robot at ADDRESS, listens for SECONDS and prints its type, its connection\n"
    "quality, and whether it is ready to be controlled. The robot is not moved. To time its\n"
    "answers franka_info requests a virtual wall (Panda) or the description (FR3). An FR3 of\n"
    "protocol version 6 or 7 has no such request: if it is idle, franka_info sets its present\n"
    "stiffness frame EE_T_K again. The status is 0 if the robot is ready, 1 if it is not, 2 if it\n"
    "cannot be reached, 3 for invalid arguments.";

constexpr const char* kRecordDescription =
    "Records the robot's signals for SECONDS as a CSV file, from which fit_robot estimates its\n"
    "friction, the offsets of its torque sensors and an unknown load (docs/sim_to_real.md).\n"
    "Without --move the robot is not moved: guide it by hand meanwhile.";

enum Status { kReady = 0, kNotReady = 1, kUnreachable = 2, kBadArguments = 3 };

// Below this share of states the robot would soon abort a motion (20 lost in a row).
constexpr double kGoodRate = 0.99;
// Later states leave no time for a callback within the millisecond [ms].
constexpr double kGoodLateness = 0.5;
constexpr double kTooManyDegrees = 70.0;

const char* modeName(franka::RobotMode mode) {
  return franka_core::fci::modeName(static_cast<franka_core::RobotMode>(mode));
}

/// The action that the user must take before this robot can be controlled; empty: none.
std::string obstacle(const franka::RobotState& state) {
  switch (state.robot_mode) {
    case franka::RobotMode::kIdle:
      return "";
    case franka::RobotMode::kMove:
      return "it is moving: another program controls it, or a motion has not ended";
    case franka::RobotMode::kGuiding:
      return "it is being guided by hand: let go of the buttons";
    case franka::RobotMode::kReflex:
      return "it stopped by reflex: call automaticErrorRecovery (error_recovery in ROS)";
    case franka::RobotMode::kUserStopped:
      return "the user stop is pressed: release the external activation device";
    case franka::RobotMode::kAutomaticErrorRecovery:
      return "it is recovering from an error: wait a moment";
    case franka::RobotMode::kOther:
      break;
  }
  return "its brakes are closed or another task runs: open the brakes in Desk";
}

void printVersions(const franka::Robot& robot) {
  const auto* const version = franka_core::findRobotVersion(robot.serverVersion());
  std::printf("Robot           %s, control interface version %u",
              version ? version->robot : "unknown", robot.serverVersion());
  if (version != nullptr) {
    std::printf(" (system %s; the vendor's libfranka %s)", version->system, version->libraries);
  }
  std::printf("\n");
}

void printState(const franka::RobotState& state) {
  std::printf("Mode            %s\n", modeName(state.robot_mode));
  std::printf("Errors          %s\n", static_cast<std::string>(state.current_errors).c_str());
  std::printf("Last motion     %s\n", static_cast<std::string>(state.last_motion_errors).c_str());
  std::printf("Joints [rad]   ");
  for (double q : state.q) {
    std::printf(" %s", fixedText(q, 4).c_str());
  }
  std::printf("\nEnd effector    %s kg, load %s kg\n", fixedText(state.m_ee, 3).c_str(),
              fixedText(state.m_load, 3).c_str());
  std::printf("External force ");
  for (std::size_t i = 0; i < 3; i++) {
    std::printf(" %s", fixedText(state.O_F_ext_hat_K[i], 2).c_str());
  }
  std::printf(" N\n");
}

void printGripper(const std::string& address) {
  // The port is that of the robot; the hand has its own.
  const std::string host = address.substr(0, address.find(':'));
  try {
    const franka::Gripper gripper(host);
    const franka::GripperState state = gripper.readOnce();
    std::printf("Hand            version %u, open %s of %s mm, %s, %u degrees Celsius%s\n",
                gripper.serverVersion(), fixedText(1e3 * state.width, 1).c_str(),
                fixedText(1e3 * state.max_width, 1).c_str(),
                state.is_grasped ? "holding an object" : "holding nothing", state.temperature,
                state.temperature > kTooManyDegrees ? " (hot)" : "");
  } catch (const franka::Exception& error) {
    std::printf("Hand            none (%s)\n", error.what());
  }
}

ConnectionStatistics listen(franka::Robot& robot, double seconds, franka::RobotState& last) {
  ConnectionStatistics statistics;
  const auto end = ConnectionStatistics::Clock::now() + std::chrono::duration<double>(seconds);
  robot.read([&](const franka::RobotState& state) {
    const auto now = ConnectionStatistics::Clock::now();
    statistics.add(state.time, now);
    last = state;
    return now < end;
  });
  return statistics;
}

void printRoundTrips(const RoundTrips& trips) {
  if (!trips.error().empty()) {
    std::printf("Round trip      not measured (%s)\n", trips.error().c_str());
    return;
  }
  std::printf("Round trip      median %s, 99 %% %s, worst %s ms (%zu times %s and its answer)\n",
              fixedText(quantileOf(trips.times(), 0.5), 3).c_str(),
              fixedText(quantileOf(trips.times(), 0.99), 3).c_str(),
              fixedText(quantileOf(trips.times(), 1.0), 3).c_str(), trips.times().size(),
              trips.command());
}

void printStatistics(const ConnectionStatistics& statistics) {
  std::printf("States          %llu received, %llu lost (%s %%), at most %llu in a row\n",
              static_cast<unsigned long long>(statistics.received()),
              static_cast<unsigned long long>(statistics.lost()),
              fixedText(100.0 * (1.0 - statistics.rate()), 2).c_str(),
              static_cast<unsigned long long>(statistics.mostLostInARow()));
  if (!statistics.keepsTime()) {
    std::printf(
        "Pace            %s of the clock's: a simulated robot in lock-step or at another speed.\n"
        "                It waits for its client, or its client has more or less time; lateness "
        "does not count\n",
        fixedText(statistics.pace(), 2).c_str());
    return;
  }
  std::printf("Lateness [ms]   median %s, 99 %% %s, worst %s\n",
              fixedText(statistics.lateness(0.5), 3).c_str(),
              fixedText(statistics.lateness(0.99), 3).c_str(),
              fixedText(statistics.lateness(1.0), 3).c_str());
}

int verdict(const franka::RobotState& state, const ConnectionStatistics& statistics) {
  std::vector<std::string> problems;
  if (!obstacle(state).empty()) {
    problems.push_back(obstacle(state));
  }
  if (statistics.rate() < kGoodRate) {
    problems.emplace_back(
        "states are lost: connect the robot's control by cable, without a switch");
  }
  if (statistics.keepsTime() && statistics.lateness(0.99) > kGoodLateness) {
    problems.emplace_back(
        "states come late: raise this program's priority, switch power saving off");
  }
  if (statistics.keepsTime() && !franka::hasRealtimeKernel()) {
    std::printf(
        "Note            this kernel is not a real-time one: robots that are not on a loopback "
        "address need RealtimeConfig::kIgnore; expect lost commands under load\n");
  }
  if (problems.empty()) {
    std::printf("Verdict         ready to be controlled\n");
    return kReady;
  }
  for (const std::string& problem : problems) {
    std::printf("Verdict         not ready: %s\n", problem.c_str());
  }
  return kNotReady;
}

int inform(const std::string& address, double seconds) {
  franka::Robot robot(address, franka::RealtimeConfig::kIgnore);
  printVersions(robot);
  franka::RobotState state = robot.readOnce();
  RoundTrips trips(robot, state);
  const ConnectionStatistics statistics = listen(robot, seconds, state);
  trips.stop();
  printState(state);
  printGripper(address);
  printRoundTrips(trips);
  printStatistics(statistics);
  return verdict(state, statistics);
}

// CLI11 reads numbers by the locale. Another text becomes NaN, which is refused.
void addSeconds(CLI::App& app, double& seconds, const char* description) {
  app.add_option_function<std::string>(
         "SECONDS",
         [&seconds](const std::string& text) {
           seconds = franka_core::readNumber(text).value_or(std::nan(""));
         },
         description)
      ->option_text(" ");
}

int informAs(CLI::App& app, int argc, char** argv, std::string& address) {
  double seconds = 2.0;
  app.footer("franka_info record --help: about recording a robot's motion for fit_robot.");
  app.add_option("ADDRESS", address, "Name or IP address, maybe with a port, HOST:PORT")
      ->option_text(" ")
      ->required();
  addSeconds(app, seconds, "A time above 0 and up to 3600 s (2)");
  app.parse(argc, argv);
  if (address.empty() || !(seconds > 0.0 && seconds <= 3600.0)) {
    throw CLI::ValidationError("one address is needed, and maybe a time above 0 and up to 3600 s");
  }
  return inform(address, seconds);
}

int recordAs(CLI::App& app, int argc, char** argv, std::string& address) {
  franka_info::RecordingOptions options;
  app.add_option("ADDRESS", options.address, "Name or IP address of the robot")
      ->option_text(" ")
      ->required();
  app.add_option("FILE", options.file, "CSV file to write")->option_text(" ")->required();
  addSeconds(app, options.seconds, "A time from 10 to 600 s (30)");
  app.add_flag("--move", options.moves,
               "swing every joint by 0.25 rad about where it is; stand clear");
  app.parse(argc, argv);
  address = options.address;
  if (!(options.seconds >= 10.0 && options.seconds <= 600.0)) {
    throw CLI::ValidationError("the time must be 10 to 600 s");
  }
  record(options);
  std::printf("%s holds the recording\n", options.file.c_str());
  return kReady;
}

}  // namespace

int main(int argc, char** argv) {
  const bool records = argc > 1 && std::string(argv[1]) == "record";
  CLI::App app(records ? kRecordDescription : kDescription,
               records ? "franka_info record" : "franka_info");
  std::string address;
  try {
    return records ? recordAs(app, argc - 1, argv + 1, address)
                   : informAs(app, argc, argv, address);
  } catch (const CLI::CallForHelp&) {
    std::cout << app.help();
    return kReady;
  } catch (const CLI::ParseError& error) {
    std::cerr << "franka_info: " << error.what() << "\n" << app.help();
    return kBadArguments;
  } catch (const franka::Exception& error) {
    std::cerr << "franka_info: " << address << " cannot be used. " << error.what() << std::endl;
    return kUnreachable;
  } catch (const std::runtime_error& error) {
    std::cerr << "franka_info: " << error.what() << std::endl;
    return kNotReady;
  }
}

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "options.h"

#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <stdexcept>

namespace franka_sim_mujoco {

const char* const kUsage =
    "Usage: franka_sim [options]\n"
    "A simulated robot that genuine libfranka programs can connect to.\n"
    "  --robot panda|fr3   which robot (panda)\n"
    "  --ip ADDRESS        where it is found (127.0.0.1); each robot needs an address of its own,\n"
    "                      for example 127.0.0.2\n"
    "  --protocol N        speak this protocol version only: 3 to 5 for a panda, 6 to 10 for an "
    "fr3\n"
    "                      (all of them)\n"
    "  --pace PACE         realtime, lockstep, or a factor such as 0.5 (realtime)\n"
    "  --world FILE        the scene, MJCF: a file or the name of one that comes along, such as\n"
    "                      stone.xml (an empty world)\n"
    "  --base X,Y,Z        where the robot stands in it [m] (0,0,0)\n"
    "  --urdf FILE         another robot description; its chain is found by --arm-id\n"
    "  --arm-id PREFIX     prefix of the joints' names (the robot's name)\n"
    "  --friction SET      none or fr3 (none)\n"
    "  --no-hand           no gripper server\n"
    "  --viewer            open a window\n"
    "  --control-port N    where lines of text press the user stop, push the arm and so on (1340;\n"
    "                      0: nowhere); send the line help for all of them\n"
    "  --help              this text\n";

namespace {

std::uint16_t toProtocol(const std::string& text) {
  char* end = nullptr;
  const long number = std::strtol(text.c_str(), &end, 10);
  if (text.empty() || *end != '\0' || number < 3 || number > 10) {
    throw std::invalid_argument("--protocol " + text + ": give a number from 3 to 10.");
  }
  return static_cast<std::uint16_t>(number);
}

std::array<double, 3> toPosition(const std::string& text) {
  std::array<double, 3> position{};
  const char* next = text.c_str();
  for (std::size_t i = 0; i < 3; i++) {
    char* end = nullptr;
    position[i] = std::strtod(next, &end);
    if (end == next || *end != (i == 2 ? '\0' : ',') || !std::isfinite(position[i])) {
      throw std::invalid_argument("--base " + text + ": give three numbers such as -0.5,0,0.");
    }
    next = end + 1;
  }
  return position;
}

std::uint16_t toPort(const std::string& text) {
  char* end = nullptr;
  const long number = std::strtol(text.c_str(), &end, 10);
  if (text.empty() || *end != '\0' || number < 0 || number > 65535) {
    throw std::invalid_argument("--control-port " + text + ": give a number from 0 to 65535.");
  }
  return static_cast<std::uint16_t>(number);
}

fci::Pace toPace(const std::string& text) {
  fci::Pace pace;
  if (text == "lockstep") {
    pace.lockstep = true;
    return pace;
  }
  if (text == "realtime") {
    return pace;
  }
  char* end = nullptr;
  pace.factor = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(pace.factor >= 0.001 && pace.factor <= 100.0)) {
    throw std::invalid_argument("--pace " + text +
                                ": give realtime, lockstep, or a factor from 0.001 to 100.");
  }
  return pace;
}

void checkTogether(const Options& options) {
  if (options.robot != "panda" && options.robot != "fr3") {
    throw std::invalid_argument("--robot " + options.robot + ": there are panda and fr3.");
  }
  const bool panda = options.robot == "panda";
  if (options.protocol != 0 && panda != (options.protocol <= 5)) {
    throw std::invalid_argument(
        "--protocol " + std::to_string(options.protocol) + ": a " + options.robot + " speaks " +
        (panda ? "3 to 5; 6 to 10 are an fr3's." : "6 to 10; 3 to 5 are a panda's."));
  }
}

}  // namespace

Options readOptions(int argc, const char* const* argv) {
  Options options;
  const std::map<std::string, std::function<void(const std::string&)>> with_value{
      {"--robot", [&](const std::string& value) { options.robot = value; }},
      {"--ip", [&](const std::string& value) { options.ip = value; }},
      {"--protocol", [&](const std::string& value) { options.protocol = toProtocol(value); }},
      {"--pace", [&](const std::string& value) { options.pace = toPace(value); }},
      {"--world", [&](const std::string& value) { options.world = value; }},
      {"--base", [&](const std::string& value) { options.base = toPosition(value); }},
      {"--urdf", [&](const std::string& value) { options.urdf = value; }},
      {"--arm-id", [&](const std::string& value) { options.arm_id = value; }},
      {"--control-port", [&](const std::string& value) { options.control_port = toPort(value); }},
      {"--friction", [&](const std::string& value) { options.friction = value; }},
  };
  const std::map<std::string, std::function<void()>> flags{
      {"--no-hand", [&] { options.hand = false; }},
      {"--viewer", [&] { options.viewer = true; }},
      {"--help", [&] { options.help = true; }},
      {"-h", [&] { options.help = true; }},
  };
  for (int i = 1; i < argc; i++) {
    const std::string word = argv[i];
    if (word.rfind("__", 0) == 0) {
      continue;  // roslaunch tells every program its name and log file
    }
    if (const auto flag = flags.find(word); flag != flags.end()) {
      flag->second();
    } else if (const auto option = with_value.find(word); option == with_value.end()) {
      throw std::invalid_argument("'" + word + "' is no option of franka_sim; see --help.");
    } else if (i + 1 == argc) {
      throw std::invalid_argument(word + " needs a value; see --help.");
    } else {
      option->second(argv[++i]);
    }
  }
  checkTogether(options);
  if (options.arm_id.empty()) {
    options.arm_id = options.robot;
  }
  return options;
}

}  // namespace franka_sim_mujoco

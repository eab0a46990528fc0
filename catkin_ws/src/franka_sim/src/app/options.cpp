// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "options.h"

#include <franka_core/fci/protocol.h>
#include <franka_sim/fci/sockets.h>
#include <franka_sim/physics/sizes.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>

namespace franka_sim {

const char* const kUsage =
    "Usage: franka_sim [options]\n"
    "Simulated robots that genuine libfranka programs can connect to.\n"
    "Of each robot:\n"
    "  --robot panda|fr3   which robot (panda). Each further --robot puts one more into the "
    "world;\n"
    "                      the options of this group that follow it are its own\n"
    "  --ip ADDRESS        where it is found (127.0.0.1); each robot needs an address of its own,\n"
    "                      for example 127.0.0.2\n"
    "  --protocol N        speak this protocol version only: 3 to 5 for a panda, 6 to 10 for an "
    "fr3\n"
    "                      (all of them)\n"
    "  --base X,Y,Z[,YAW]  where the robot stands in the world [m] and how far it is turned there\n"
    "                      [rad] (0,0,0,0)\n"
    "  --urdf FILE         another robot description; its chain is found by --arm-id\n"
    "  --arm-id PREFIX     prefix of the joints' names (the robot's name; panda_2 and so on where\n"
    "                      that is taken)\n"
    "  --friction SET      none or fr3 (none)\n"
    "  --hand HAND         gripper, vacuum or none: what is served (gripper)\n"
    "  --no-hand           short for --hand none\n"
    "  --control-port N    where lines of text press the user stop, push the arm and so on (1340;\n"
    "                      0: nowhere); send the line help for all of them\n"
    "Of all:\n"
    "  --pace PACE         realtime, patient, lockstep, or a factor such as 0.5 (realtime)\n"
    "  --patience SECONDS  with --pace patient or lockstep: how long a client that is silent in "
    "its\n"
    "                      motion is waited for, 0.01 to 86400, or forever (30)\n"
    "  --world FILE        the scene, MJCF or SDF: a file, or the name of one that comes along:\n"
    "                      stone.xml (an empty world)\n"
    "  --linger SECONDS    when told to end by a signal, wait so long for clients to go first (0)\n"
    "  --viewer            open a window\n"
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

void readBase(const std::string& text, ArmOptions& arm) {
  std::vector<double> numbers;
  const char* next = text.c_str();
  char* end = nullptr;
  do {
    numbers.push_back(std::strtod(next, &end));
    if (end == next || (*end != ',' && *end != '\0') || !std::isfinite(numbers.back())) {
      numbers.clear();
      break;
    }
    next = end + 1;
  } while (*end == ',');
  if (numbers.size() != 3 && numbers.size() != 4) {
    throw std::invalid_argument("--base " + text +
                                ": give three numbers such as -0.5,0,0, or four with the angle.");
  }
  arm.base = {numbers[0], numbers[1], numbers[2]};
  for (const double coordinate : arm.base) {
    if (std::abs(coordinate) > sizes::kFarthest) {
      throw std::invalid_argument("--base " + text + ": give metres, 1000 at most.");
    }
  }
  arm.yaw = numbers.size() == 4 ? numbers[3] : 0.0;
}

Tool toTool(const std::string& text) {
  const std::map<std::string, Tool> tools{
      {"gripper", Tool::kGripper}, {"vacuum", Tool::kVacuum}, {"none", Tool::kNone}};
  const auto tool = tools.find(text);
  if (tool == tools.end()) {
    throw std::invalid_argument("--hand " + text + ": there are gripper, vacuum and none.");
  }
  return tool->second;
}

std::uint16_t toPort(const std::string& text) {
  char* end = nullptr;
  const long number = std::strtol(text.c_str(), &end, 10);
  if (text.empty() || *end != '\0' || number < 0 || number > 65535) {
    throw std::invalid_argument("--control-port " + text + ": give a number from 0 to 65535.");
  }
  if (number == franka_core::fci::kRobotPort || number == franka_core::fci::kGripperPort ||
      number == franka_core::fci::kVacuumGripperPort) {
    throw std::invalid_argument(
        "--control-port " + text +
        ": the ports 1337 to 1339 are those of robot, gripper and vacuum gripper; give another "
        "one, or 0 for none.");
  }
  return static_cast<std::uint16_t>(number);
}

fci::Pace toPace(const std::string& text) {
  fci::Pace pace;
  if (text == "lockstep") {
    pace.mode = fci::PaceMode::kLockStep;
    return pace;
  }
  if (text == "patient") {
    pace.mode = fci::PaceMode::kPatient;
    return pace;
  }
  if (text == "realtime") {
    return pace;
  }
  char* end = nullptr;
  pace.factor = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(pace.factor >= 0.001 && pace.factor <= 100.0)) {
    throw std::invalid_argument(
        "--pace " + text + ": give realtime, patient, lockstep, or a factor from 0.001 to 100.");
  }
  return pace;
}

std::string toFriction(const std::string& text) {
  if (text != "none" && text != "fr3") {
    throw std::invalid_argument("--friction " + text + ": there are none and fr3.");
  }
  return text;
}

std::string toAddress(const std::string& text) {
  if (!fci::isAddress(text)) {
    throw std::invalid_argument("--ip " + text +
                                ": this is not an IPv4 address; give one that this machine has, "
                                "such as 127.0.0.1 or 127.0.0.2.");
  }
  return text;
}

double toSeconds(const std::string& text) {
  char* end = nullptr;
  const double seconds = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(seconds >= 0.0 && seconds <= 60.0)) {
    throw std::invalid_argument("--linger " + text + ": give a number of seconds from 0 to 60.");
  }
  return seconds;
}

std::chrono::milliseconds toPatience(const std::string& text) {
  if (text == "forever") {
    return std::chrono::hours(24 * 365 * 100);  // in nanoseconds it still is a number
  }
  char* end = nullptr;
  const double seconds = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(seconds >= 0.01 && seconds <= 86400.0)) {
    throw std::invalid_argument("--patience " + text +
                                ": give a number of seconds from 0.01 to 86400, or forever.");
  }
  return std::chrono::milliseconds(std::lround(1e3 * seconds));
}

void usePatience(const std::string& text, fci::Pace& pace) {
  if (text.empty()) {
    return;
  }
  pace.patience = toPatience(text);
  if (!pace.waitsForClients()) {
    throw std::invalid_argument("--patience " + text +
                                ": only a robot that waits for its client has patience; give "
                                "--pace patient or --pace lockstep as well.");
  }
}

void checkArm(const ArmOptions& arm) {
  if (arm.robot != "panda" && arm.robot != "fr3") {
    throw std::invalid_argument("--robot " + arm.robot + ": there are panda and fr3.");
  }
  const bool panda = arm.robot == "panda";
  if (arm.protocol != 0 && panda != (arm.protocol <= 5)) {
    throw std::invalid_argument(
        "--protocol " + std::to_string(arm.protocol) + ": a " + arm.robot + " speaks " +
        (panda ? "3 to 5; 6 to 10 are an fr3's." : "6 to 10; 3 to 5 are a panda's."));
  }
}

void nameArms(std::vector<ArmOptions>& arms) {
  std::set<std::string> names;
  for (const ArmOptions& arm : arms) {
    if (!arm.arm_id.empty() && !names.insert(arm.arm_id).second) {
      throw std::invalid_argument("--arm-id " + arm.arm_id +
                                  ": two robots have it; each needs one of its own.");
    }
  }
  for (ArmOptions& arm : arms) {
    std::string name = arm.robot;
    for (int number = 2; arm.arm_id.empty(); number++) {
      if (names.insert(name).second) {
        arm.arm_id = name;
      }
      name = arm.robot + "_" + std::to_string(number);
    }
  }
}

// The foot of an arm is that wide: closer together they would stand within each other.
constexpr double kLeastDistance = 0.2;  // [m]

void checkPlaces(const std::vector<ArmOptions>& arms) {
  for (std::size_t i = 0; i < arms.size(); i++) {
    for (std::size_t k = 0; k < i; k++) {
      const auto& a = arms[i].base;
      const auto& b = arms[k].base;
      if (std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) < kLeastDistance) {
        throw std::invalid_argument("The robots at " + arms[k].ip + " and " + arms[i].ip +
                                    " stand within each other; give them places with --base.");
      }
    }
  }
}

void checkTogether(std::vector<ArmOptions>& arms) {
  std::set<std::string> addresses;
  for (const ArmOptions& arm : arms) {
    checkArm(arm);
    if (!addresses.insert(arm.ip).second) {
      throw std::invalid_argument("--ip " + arm.ip +
                                  ": two robots have it; each needs an address of its own.");
    }
  }
  checkPlaces(arms);
  nameArms(arms);
}

}  // namespace

Options readOptions(int argc, const char* const* argv) {
  Options options;
  std::string patience;
  bool robot_named = false;
  const auto arm = [&options]() -> ArmOptions& { return options.arms.back(); };
  const std::map<std::string, std::function<void(const std::string&)>> with_value{
      {"--robot",
       [&](const std::string& value) {
         if (robot_named) {
           options.arms.emplace_back();
         }
         robot_named = true;
         arm().robot = value;
       }},
      {"--ip", [&](const std::string& value) { arm().ip = toAddress(value); }},
      {"--protocol", [&](const std::string& value) { arm().protocol = toProtocol(value); }},
      {"--base", [&](const std::string& value) { readBase(value, arm()); }},
      {"--urdf", [&](const std::string& value) { arm().urdf = value; }},
      {"--arm-id", [&](const std::string& value) { arm().arm_id = value; }},
      {"--friction", [&](const std::string& value) { arm().friction = toFriction(value); }},
      {"--hand", [&](const std::string& value) { arm().tool = toTool(value); }},
      {"--control-port", [&](const std::string& value) { arm().control_port = toPort(value); }},
      {"--pace", [&](const std::string& value) { options.pace = toPace(value); }},
      {"--patience", [&](const std::string& value) { patience = value; }},
      {"--linger", [&](const std::string& value) { options.linger = toSeconds(value); }},
      {"--world", [&](const std::string& value) { options.world = value; }},
  };
  const std::map<std::string, std::function<void()>> flags{
      {"--no-hand", [&] { arm().tool = Tool::kNone; }},
      {"--viewer", [&] { options.viewer = true; }},
      {"--help", [&] { options.help = true; }},
      {"-h", [&] { options.help = true; }},
  };
  for (int i = 1; i < argc; i++) {
    std::string word = argv[i];
    std::optional<std::string> value;
    if (word.rfind("__", 0) == 0) {
      continue;  // roslaunch tells every program its name and log file
    }
    if (const std::size_t equals = word.find('=');
        word.rfind("--", 0) == 0 && equals != word.npos) {
      value = word.substr(equals + 1);
      word.erase(equals);
    }
    if (const auto flag = flags.find(word); flag != flags.end()) {
      if (value) {
        throw std::invalid_argument(word + " takes no value; see --help.");
      }
      flag->second();
    } else if (const auto option = with_value.find(word); option == with_value.end()) {
      throw std::invalid_argument("'" + word + "' is no option of franka_sim; see --help.");
    } else if (value) {
      option->second(*value);
    } else if (i + 1 == argc) {
      throw std::invalid_argument(word + " needs a value; see --help.");
    } else {
      option->second(argv[++i]);
    }
  }
  usePatience(patience, options.pace);
  checkTogether(options.arms);
  return options;
}

}  // namespace franka_sim

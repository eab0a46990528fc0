// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "options.h"

#include <fcntl.h>
#include <franka_core/fci/protocol.h>
#include <franka_core/numbers.h>
#include <franka_core/spin_rule.h>
#include <franka_sim/physics/input_limits.h>
#include <franka_sim/robot/realism.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "fci/sockets.h"

namespace franka_sim {

namespace {

bool isWithin(double least, double most, const std::string& text, double& number) {
  number = franka_core::readNumber(text).value_or(std::nan(""));
  return number >= least && number <= most;
}

// CLI::Range would accept NaN as a number in its range.
CLI::Validator within(double least, double most, const std::string& advice) {
  return {[=](const std::string& text) {
            double number;
            return isWithin(least, most, text, number) ? ""
                                                       : "give " + advice + ", not " + text + ".";
          },
          ""};
}

std::string wholeNumberFault(const std::string& text) {
  return std::fmod(franka_core::readNumber(text).value_or(0.5), 1.0) == 0.0
             ? ""
             : text + " is not a whole number.";
}

std::string addressFault(const std::string& text) {
  return fci::isAddress(text) ? ""
                              : text +
                                    " is not an IPv4 address; give one that this machine has, "
                                    "such as 127.0.0.1 or 127.0.0.2.";
}

std::string realismFault(const std::string& text) {
  try {
    readRealism(text, kServedProfile);
    return "";
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

std::string portFault(const std::string& text) {
  using namespace franka_core::fci;
  for (const std::uint16_t port : {kRobotPort, kGripperPort, kVacuumGripperPort}) {
    if (franka_core::readNumber(text) == static_cast<double>(port)) {
      return "the ports 1337 to 1339 are those of robot, gripper and vacuum gripper; give another "
             "one, or 0 for none.";
    }
  }
  return "";
}

void readBase(ArmOptions& arm, const std::string& text) {
  std::vector<double> numbers;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    numbers.push_back(
        franka_core::readNumber(text.substr(begin, end - begin)).value_or(std::nan("")));
    begin = end + 1;
  }
  const bool known = std::none_of(numbers.begin(), numbers.end(),
                                  [](double number) { return std::isnan(number); });
  if (!known || (numbers.size() != 3 && numbers.size() != 4)) {
    throw CLI::ValidationError(
        "--base", "give three numbers such as -0.5,0,0, or four with the angle, not " + text + ".");
  }
  std::copy_n(numbers.begin(), 3, arm.base.begin());
  arm.yaw = numbers.size() == 4 ? numbers[3] : 0.0;
  for (const double coordinate : arm.base) {
    if (!(std::abs(coordinate) <= sizes::kMaxPosition)) {
      throw CLI::ValidationError("--base", "give meters, 1000 at most, not " + text + ".");
    }
  }
}

void readPace(const std::string& text, fci::Pace& pace) {
  if (text == "lockstep") {
    pace.mode = fci::PaceMode::kLockStep;
  } else if (text == "patient") {
    pace.mode = fci::PaceMode::kPatient;
  } else if (text != "realtime" && !isWithin(0.001, 100.0, text, pace.factor)) {
    throw CLI::ValidationError(
        "--pace",
        "give realtime, patient, lockstep, or a factor from 0.001 to 100, not " + text + ".");
  }
}

void readPatience(const std::string& text, fci::Pace& pace) {
  if (text == "forever") {
    pace.patience = fci::Pace::kForever;
    return;
  }
  double seconds = 0.0;
  if (!isWithin(0.01, 86400.0, text, seconds)) {
    throw CLI::ValidationError(
        "--patience", "give a number of seconds from 0.01 to 86400, or forever, not " + text + ".");
  }
  pace.patience = std::chrono::milliseconds(std::lround(1e3 * seconds));
}

void readWait(const std::string& text, fci::Pace& pace) {
  const std::optional<franka_core::WaitMode> mode = franka_core::toWaitMode(text);
  if (!mode) {
    throw CLI::ValidationError("--wait", "give auto, spin or block, not " + text + ".");
  }
  pace.wait = *mode;
}

// A descriptor that was opened for this program, and not one of the terminal's.
void readReady(const std::string& text, fci::Descriptor& ready) {
  const int number = static_cast<int>(franka_core::readNumber(text).value());
  const int flags = ::fcntl(number, F_GETFL);
  if (flags < 0 || (flags & O_ACCMODE) == O_RDONLY) {
    throw CLI::ValidationError(
        "--ready-fd",
        "descriptor " + text + " is not open for writing: in a shell 3>FILE opens 3.");
  }
  ::fcntl(number, F_SETFD, FD_CLOEXEC);
  ready = fci::Descriptor(number);
}

// Options that only a robot with the pace patient or lockstep can follow.
void checkPace(const CLI::App& app, const fci::Pace& pace) {
  for (const char* option : {"--patience", "--wait"}) {
    if (app.count(option) > 0 && !pace.waitsForClients()) {
      throw CLI::ValidationError(
          option,
          "it needs --pace patient or --pace lockstep: only such a robot waits for its client.");
    }
  }
}

void checkProtocol(const ArmOptions& arm) {
  const bool panda = arm.robot == "panda";
  if (arm.protocol != 0 && panda != (arm.protocol <= 5)) {
    throw CLI::ValidationError("--protocol", "a " + arm.robot + " speaks " +
                                                 (panda ? "3 to 5; 6 to 10 are an fr3's."
                                                        : "6 to 10; 3 to 5 are a panda's."));
  }
}

void checkDesk(const CLI::App& app, const Options& options) {
  for (const char* option : {"--desk-user", "--desk-password"}) {
    if (app.count(option) > 0 && !options.desk.served) {
      throw CLI::ValidationError(option, "it belongs to Desk; give --desk as well.");
    }
  }
  for (const ArmOptions& arm : options.arms) {
    if (options.desk.served && arm.control_port == 0) {
      throw CLI::ValidationError("--control-port",
                                 "Desk needs the control interface; give a port other than 0.");
    }
  }
}

void nameArms(std::vector<ArmOptions>& arms) {
  std::set<std::string> names;
  for (const ArmOptions& arm : arms) {
    if (!arm.arm_id.empty() && !names.insert(arm.arm_id).second) {
      throw CLI::ValidationError("--arm-id " + arm.arm_id,
                                 "two robots have it; each needs one of its own.");
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

// The width of an arm's foot: arms that are closer together would overlap.
constexpr double kMinDistance = 0.2;  // [m]

void checkPlaces(const std::vector<ArmOptions>& arms) {
  for (std::size_t i = 0; i < arms.size(); i++) {
    for (std::size_t k = 0; k < i; k++) {
      const auto& a = arms[i].base;
      const auto& b = arms[k].base;
      if (std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) < kMinDistance) {
        throw CLI::ValidationError("The robots at " + arms[k].ip + " and " + arms[i].ip +
                                   " overlap; give them different positions with --base.");
      }
    }
  }
}

void checkTogether(std::vector<ArmOptions>& arms) {
  std::set<std::string> addresses;
  for (const ArmOptions& arm : arms) {
    checkProtocol(arm);
    if (!addresses.insert(arm.ip).second) {
      throw CLI::ValidationError("--ip " + arm.ip,
                                 "two robots have it; each needs an address of its own.");
    }
  }
  checkPlaces(arms);
  nameArms(arms);
}

// Options of a robot follow its --robot: each one is stored when it is parsed.
void addOptionsOfRobots(CLI::App& app, std::vector<ArmOptions>& arms, bool& robot_named) {
  const auto add = [&](const char* name, const char* values, const char* description, auto read) {
    return app
        .add_option_function<std::string>(
            name, [&arms, read](const std::string& text) { read(arms.back(), text); }, description)
        ->option_text(values)
        ->group("Of each robot")
        ->trigger_on_parse();
  };
  const auto text = [](std::string ArmOptions::* member) {
    return [member](ArmOptions& arm, const std::string& value) { arm.*member = value; };
  };
  const auto number = [](std::uint16_t ArmOptions::* member) {
    return [member](ArmOptions& arm, const std::string& value) {
      arm.*member = static_cast<std::uint16_t>(franka_core::readNumber(value).value());
    };
  };
  add("--robot", "panda|fr3",
      "which robot (panda). Each further --robot puts one more into the world;\n"
      "the options of this group that follow it are its own",
      [&arms, &robot_named](ArmOptions& /*arm*/, const std::string& robot) {
        if (robot_named) {
          arms.emplace_back();
        }
        robot_named = true;
        arms.back().robot = robot;
      })
      ->check(CLI::IsMember({"panda", "fr3"}));
  add("--ip", "ADDRESS",
      "its address (127.0.0.1); each robot needs an address of its own,\n"
      "for example 127.0.0.2",
      text(&ArmOptions::ip))
      ->check({addressFault, ""});
  add("--protocol", "N",
      "speak this protocol version only: 3 to 5 for a panda, 6 to 10 for an fr3\n(all of them)",
      number(&ArmOptions::protocol))
      ->check(within(3, 10, "a number from 3 to 10"))
      ->check({wholeNumberFault, ""});
  add("--base", "X,Y,Z[,YAW]",
      "position of the robot in the world [m] and its rotation about z [rad]\n(0,0,0,0)", readBase);
  add("--urdf", "FILE", "another robot description; its chain is found by --arm-id",
      text(&ArmOptions::urdf));
  add("--arm-id", "PREFIX",
      "prefix of the joints' names (the robot's name; panda_2 and so on where\nthat is taken)",
      text(&ArmOptions::arm_id));
  add("--realism", "PROFILE",
      "ideal, real or recorded (real): without friction and noise, as recordings\n"
      "of real robots, or with noise and an error of its model too; then changes\n"
      "such as real,friction=off,delay=2 (docs/sim_to_real.md)",
      text(&ArmOptions::realism))
      ->check({realismFault, ""});
  add("--hand", "HAND", "gripper, vacuum or none: what is served (gripper)",
      [](ArmOptions& arm, const std::string& hand) {
        arm.tool = hand == "gripper"  ? Tool::kGripper
                   : hand == "vacuum" ? Tool::kVacuum
                                      : Tool::kNone;
      })
      ->check(CLI::IsMember({"gripper", "vacuum", "none"}));
  app.add_flag_callback(
         "--no-hand", [&arms] { arms.back().tool = Tool::kNone; }, "short for --hand none")
      ->group("Of each robot")
      ->trigger_on_parse();
  add("--control-port", "N",
      "port of the control interface: lines of text that press the user stop, push\n"
      "the arm and so on (1340; 0: none); the line help lists them",
      number(&ArmOptions::control_port))
      ->check(within(0, 65535, "a number from 0 to 65535"))
      ->check({wholeNumberFault, ""})
      ->check({portFault, ""});
}

void addOptionsOfDesk(CLI::App& app, Options& options) {
  app.option_defaults()->group("Of Desk")->take_last();
  app.add_option_function<std::string>(
         "--desk",
         [&options](const std::string& address) {
           options.desk.served = true;
           options.desk.address = address;
         },
         "serve Desk, the robots' web interface (each robot's own address, port\n"
         "443, or 8443 if that is not permitted). Robots start locked")
      ->option_text("[ADDRESS:PORT]")
      ->expected(0, 1);
  app.add_option("--desk-user", options.desk.user, "user that may log in (franka)")
      ->option_text("NAME");
  app.add_option("--desk-password", options.desk.password,
                 "the password (a new one, printed at the start). Others can read it\n"
                 "here; the variable FRANKA_DESK_PASSWORD is for this program only")
      ->option_text("WORD");
  app.add_option_function<std::string>(
         "--start", [&options](const std::string& word) { options.locked = word == "locked"; },
         "ready, or locked: with closed brakes and without FCI, as a real robot\n"
         "after power-up (ready; with --desk: locked)")
      ->option_text("ready|locked")
      ->check(CLI::IsMember({"ready", "locked"}));
}

void addOptionsOfAll(CLI::App& app, Options& options) {
  const auto pace = [&options](const std::string& text) { readPace(text, options.pace); };
  const auto wait = [&options](const std::string& text) { readWait(text, options.pace); };
  const auto patience = [&options](const std::string& text) { readPatience(text, options.pace); };
  // Not by CLI11, which reads numbers by the locale.
  const auto linger = [&options](const std::string& text) {
    options.linger = franka_core::readNumber(text).value();
  };
  app.option_defaults()->group("Of all")->take_last();
  app.add_option_function<std::string>(
         "--pace", pace, "realtime, patient, lockstep, or a factor such as 0.5 (realtime)")
      ->option_text("PACE");
  app.add_option_function<std::string>(
         "--patience", patience,
         "with --pace patient or lockstep: how long to wait for a client that is\n"
         "silent in its motion, 0.01 to 86400, or forever (30)")
      ->option_text("SECONDS");
  app.add_option_function<std::string>(
         "--wait", wait,
         "how such a robot waits for each answer: auto, spin (without sleep, for a\n"
         "moment) or block (asleep) (auto: without sleep while a processor is free)")
      ->option_text("MODE");
  app.add_option("--world", options.world,
                 "the scene, MJCF or SDF: a file, or the name of one that is installed with\n"
                 "franka_sim: stone.xml, push.xml or hand_over.xml (an empty world)")
      ->option_text("FILE");
  app.add_option_function<std::string>(
         "--linger", linger, "after a signal, wait this long for clients to disconnect (0)")
      ->option_text("SECONDS")
      ->check(within(0, 60, "a number of seconds from 0 to 60"));
  app.add_flag("--viewer", options.viewer, "open a window");
  app.add_option_function<std::string>(
         "--ready-fd", [&options](const std::string& text) { readReady(text, options.ready); },
         "write one line of JSON to this descriptor when clients can connect: robots,\n"
         "addresses, ports; or the error (docs/franka_sim.md)")
      ->option_text("N")
      ->check(within(3, 1e6, "a number from 3"))
      ->check({wholeNumberFault, ""})
      ->trigger_on_parse();
}

// An earlier option, which scripts may still give.
void addReplacedOptions(CLI::App& app) {
  const auto refuse = [](const std::string& /*value*/) {
    throw CLI::ValidationError("--friction",
                               "it is a part of --realism: --realism ideal,friction=on.");
  };
  app.add_option_function<std::string>("--friction", refuse)
      ->expected(0, 1)
      ->trigger_on_parse()
      ->group("");  // not in the help
}

// The words in the order for CLI::App::parse, last one first.
std::vector<std::string> wordsOf(int argc, const char* const* argv) {
  std::vector<std::string> words;
  for (int i = argc - 1; i > 0; i--) {
    std::string word = argv[i];
    if (word.rfind("__", 0) == 0) {
      continue;  // roslaunch adds a name and a log file to each command line
    }
    for (const std::string flag : {"--viewer", "--no-hand"}) {
      if (word.rfind(flag + "=", 0) == 0) {
        throw CLI::ValidationError(flag, "it takes no value.");
      }
    }
    if (word.rfind("--", 0) == 0 && word.back() == '=') {
      words.emplace_back();  // otherwise CLI11 would use the next word as the value
      word.pop_back();
    }
    words.push_back(word);
  }
  return words;
}

}  // namespace

void readOptions(int argc, const char* const* argv, Options& options) {
  CLI::App app("Simulated robots that genuine libfranka programs can connect to.", "franka_sim");
  bool robot_named = false;
  addOptionsOfRobots(app, options.arms, robot_named);
  addOptionsOfAll(app, options);
  addOptionsOfDesk(app, options);
  addReplacedOptions(app);
  app.set_help_flag("-h,--help", "this text");
  try {
    app.parse(wordsOf(argc, argv));
    checkPace(app, options.pace);
    checkDesk(app, options);
    options.locked = options.locked || (options.desk.served && app.count("--start") == 0);
    checkTogether(options.arms);
    for (ArmOptions& arm : options.arms) {
      arm.meshes = options.viewer;
    }
  } catch (const CLI::CallForHelp&) {
    options.help = app.help();
  } catch (const CLI::ParseError& error) {
    throw std::invalid_argument(error.what());
  }
}

}  // namespace franka_sim

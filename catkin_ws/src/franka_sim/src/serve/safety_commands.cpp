// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/motion_limits.h>
#include <franka_core/numbers.h>
#include <franka_core/typed_transform.h>
#include <franka_sim/robot/control_unit_parameters.h>
#include <franka_sim/serve/operator_commands.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "fci/robot_server.h"
#include "serve/robot_report.h"

namespace franka_sim {

namespace {

using fci::LineServer;
using fci::toNumber;
using fci::toSwitch;
using Words = LineServer::Words;

constexpr std::uint64_t kReaction = 500;  // [ticks] in lock-step, until the arm has reacted

// The longest durations that a line may set [s].
constexpr double kMaxBusyDuration = 60.0;
constexpr double kMaxClock = 1e6;

std::string require(Refusal refusal) {
  if (refusal != Refusal::kNone) {
    throw std::runtime_error(std::string(nameOf(refusal)) + ": " +
                             std::string(sentenceOf(refusal)));
  }
  return "";
}

template <std::size_t kCount>
std::size_t indexIn(const std::array<std::string_view, kCount>& names, const std::string& word) {
  for (std::size_t i = 0; i < kCount; i++) {
    if (names[i] == word) {
      return i;
    }
  }
  std::string all;
  for (const std::string_view name : names) {
    all += (all.empty() ? "" : ", ") + std::string(name);
  }
  throw std::invalid_argument("'" + word + "' must be one of " + all + ".");
}

template <std::size_t kCount>
bool isIn(const std::array<std::string_view, kCount>& names, const std::string& word) {
  for (const std::string_view name : names) {
    if (name == word) {
      return true;
    }
  }
  return false;
}

// One of two words; true for the first.
bool isFirst(const std::string& word, const char* first, const char* second) {
  if (word != first && word != second) {
    throw std::invalid_argument("'" + word + "' is neither " + first + " nor " + second + ".");
  }
  return word == first;
}

double toDuration(const std::string& word, double longest) {
  const double seconds = toNumber(word);
  if (!(seconds >= 0.0 && seconds <= longest)) {
    throw std::invalid_argument("'" + word + "' is not a duration from 0 to " +
                                std::to_string(std::lround(longest)) + " s.");
  }
  return seconds;
}

template <std::size_t kCount>
std::array<double, kCount> toNumbers(const Words& words, std::size_t first) {
  std::array<double, kCount> numbers;
  for (std::size_t i = 0; i < kCount; i++) {
    numbers[i] = toNumber(words.at(first + i));
  }
  return numbers;
}

void addStops(LineServer& lines, fci::SimRobot& robot, fci::Host& host) {
  SafetyController& safety = robot.whole().safety();
  lines.add("user_stop on|off", [&](const Words& words) {
    setUserStop(robot.whole(), toSwitch(words.at(0)));
    host.runFree(kReaction);
    return "";
  });
  lines.add("input x31|x32|x33|x4|guiding on|off", [&](const Words& words) {
    const auto input = static_cast<SafetyInput>(indexIn(kSafetyInputNames, words.at(0)));
    safety.press(input, toSwitch(words.at(1)));
    host.runFree(kReaction);
    return "";
  });
  lines.add("button circle|cross|check|up|down|left|right on|off", [&](const Words& words) {
    safety.press(indexIn(kButtonNames, words.at(0)), toSwitch(words.at(1)));
    return "";
  });
}

void addBrakes(LineServer& lines, fci::SimRobot& robot, fci::Host& host) {
  SafetyController& safety = robot.whole().safety();
  const auto lock = [&](bool closed) {
    setBrakes(robot.whole(), closed);
    host.runFree(kReaction);
    return "";
  };
  lines.add("brakes open|close",
            [=](const Words& words) { return lock(!isFirst(words.at(0), "open", "close")); });
  lines.add("joints unlock|lock", [=, &safety](const Words& words) {
    lock(!isFirst(words.at(0), "unlock", "lock"));
    return fci::Reply::when([&safety] { return !safety.state().brakes_moving; });
  });
}

void addFci(LineServer& lines, fci::SimRobot& robot) {
  SafetyController& safety = robot.whole().safety();
  lines.add("fci on|off", [&](const Words& words) {
    setFci(robot, toSwitch(words.at(0)));
    return "";
  });
  lines.add("operating_mode execution|programming", [&](const Words& words) {
    const bool execution = isFirst(words.at(0), "execution", "programming");
    if (!safety.isFr3()) {
      throw std::invalid_argument(
          "A Panda has no operating mode: its activation device decides (input x4 on|off).");
    }
    return require(safety.setOperatingMode(execution ? OperatingMode::kExecution
                                                     : OperatingMode::kProgramming));
  });
}

void addGuiding(LineServer& lines, fci::SimRobot& robot, fci::Host& host) {
  SafetyController& safety = robot.whole().safety();
  lines.add("guiding on|off", [&](const Words& words) {
    setGuiding(robot.whole(), toSwitch(words.at(0)));
    host.runFree(kReaction);
    return "";
  });
  lines.add("guiding_mode free|translation|rotation|user [7 AXES on|off]", [&](const Words& words) {
    const auto mode = static_cast<GuidingMode>(indexIn(kGuidingModeNames, words.at(0)));
    std::array<bool, 7> axes{};
    for (std::size_t i = 0; mode == GuidingMode::kUser && i < axes.size(); i++) {
      axes[i] = toSwitch(words.at(1 + i));
    }
    return require(safety.setGuidingMode(mode, axes));
  });
  lines.add("navigation desk|robot", [&](const Words& words) {
    safety.setArrowsGuideDesk(isFirst(words.at(0), "desk", "robot"));
    return "";
  });
}

fci::Reply recover(ControlUnit& unit) {
  const std::optional<Status> answer =
      unit.request(franka_core::fci::AutomaticErrorRecoveryRequest{});
  if (answer == Status::kManualErrorRecoveryRequiredRejected) {
    throw std::runtime_error(
        "JointRecoveryRequired: A joint is beyond its limits, or a stop is pressed; guide the arm "
        "back, or release the stop.");
  }
  if (answer && answer != Status::kSuccess) {
    throw std::runtime_error(
        "MotionActive: Errors cannot be cleared in the mode in which the robot is.");
  }
  return fci::Reply([&unit]() -> std::optional<std::string> {
    const franka_core::RobotMode mode = unit.state().robot_mode;
    if (mode == franka_core::RobotMode::kAutomaticErrorRecovery) {
      return std::nullopt;
    }
    if (mode == franka_core::RobotMode::kReflex) {
      throw std::runtime_error("The recovery has failed: the arm does not come to rest.");
    }
    return "";
  });
}

void addErrors(LineServer& lines, fci::SimRobot& robot) {
  SafetyController& safety = robot.whole().safety();
  lines.add("self_test [due SECONDS]", [&](const Words& words) {
    if (words.size() == 0) {
      return require(safety.startSelfTest());
    }
    if (words[0] != "due") {
      throw std::invalid_argument("self_test takes nothing, or 'due' and seconds; '" + words[0] +
                                  "' is neither.");
    }
    safety.setSelfTestDue(toDuration(words.at(1), kMaxClock));
    return std::string();
  });
  lines.add("acknowledge ERROR", [&](const Words& words) {
    if (isIn(kDemandedRecoveryNames, words.at(0))) {
      const std::size_t index = indexIn(kDemandedRecoveryNames, words[0]);
      return require(safety.acknowledge(static_cast<DemandedRecovery>(index)));
    }
    const std::size_t index = indexIn(kRecoverableErrorNames, words[0]);
    return require(safety.acknowledge(static_cast<RecoverableError>(index)));
  });
  lines.add("inject ERROR [JOINT] on|off", [&](const Words& words) {
    if (isIn(kDemandedRecoveryNames, words.at(0))) {
      const auto joint = franka_core::wholeNumber(toNumber(words.at(1)), 1, 7);
      if (!joint) {
        throw std::invalid_argument("'" + words[1] + "' is not the number of a joint, 1 to 7.");
      }
      const std::size_t index = indexIn(kDemandedRecoveryNames, words[0]);
      safety.inject(static_cast<DemandedRecovery>(index), static_cast<std::size_t>(*joint) - 1,
                    toSwitch(words.at(2)));
    } else {
      const std::size_t index = indexIn(kRecoverableErrorNames, words[0]);
      safety.inject(static_cast<RecoverableError>(index), toSwitch(words.at(1)));
    }
    return "";
  });
  lines.add("recover", [&](const Words&) { return recover(robot.unit()); });
}

void addPower(LineServer& lines, fci::SimRobot& robot, fci::Host& host) {
  SafetyController& safety = robot.whole().safety();
  lines.add("power on|off", [&](const Words& words) {
    setPower(robot, toSwitch(words.at(0)));
    host.runFree(kReaction);
    return "";
  });
  lines.add("timing brakes|self_test SECONDS", [&](const Words& words) {
    const bool brakes = isFirst(words.at(0), "brakes", "self_test");
    const double seconds = toDuration(words.at(1), kMaxBusyDuration);
    brakes ? safety.setBrakeTime(seconds) : safety.setSelfTestTime(seconds);
    return "";
  });
}

void addEndEffector(LineServer& lines, fci::SimRobot& robot) {
  lines.add("end_effector MASS X Y Z INERTIA(9) F_T_NE(16)", [&](const Words& words) {
    const franka_core::TypedTransform frame =
        franka_core::readTypedTransform(toNumbers<16>(words, 13));
    const SetEndEffector request{
        {toNumber(words.at(0)), toNumbers<3>(words, 1), toNumbers<9>(words, 4)}, frame.matrix};
    const std::string fault = frame.fault.empty() ? frameFault(frame.matrix) : frame.fault;
    const std::optional<Status> answer = robot.unit().request(request);
    if (answer == Status::kInvalidArgumentRejected) {
      throw std::invalid_argument(
          "The end effector was refused. " +
          (isPayload(request.payload)
               ? "F_T_NE is not a column-major 4x4 transform to a frame on the arm: " + fault + "."
               : payloadFault(request.payload)));
    }
    require(answer == Status::kSuccess ? Refusal::kNone : Refusal::kMotionActive);
    return frame.warning.empty() ? "" : "F_T_NE: " + frame.warning + ".";
  });
  lines.add("end_effector_power on|off", [&](const Words& words) {
    setEndEffectorPower(robot, toSwitch(words.at(0)));
    return "";
  });
}

[[noreturn]] void refuseTakenPort(const std::string& what, std::uint16_t port) {
  throw std::runtime_error(what + " stays off, because its port " + std::to_string(port) +
                           " cannot be opened: another program has taken it. End that program.");
}

// Ports open or close before the answer is sent.
void servePorts(fci::SimRobot& robot) {
  robot.serve(true);
  SafetyController& safety = robot.whole().safety();
  if (robot.unit().status().fci_active && !robot.server().isOpen()) {
    safety.deactivateFci();
    refuseTakenPort("The FCI", robot.server().port());
  }
  if (const std::optional<std::uint16_t> port = robot.takenToolPort()) {
    safety.setEndEffectorPower(false);
    refuseTakenPort("The end effector's power", *port);
  }
}

fci::Reply startMotion(WholeRobot& robot, const std::array<double, 7>& q, double speed) {
  require(robot.safety().allowsOperatorMotion());
  OperatorMotion& motion = robot.operatorMotion();
  const Status answer = motion.start(q, speed);
  if (answer == Status::kInvalidArgumentRejected) {
    const std::optional<std::size_t> joint = motion.jointOutOfReach(q);
    throw std::invalid_argument("The motion was refused: " +
                                (joint
                                     ? "joint " + std::to_string(*joint + 1) + " can be " +
                                           robot.unit().limits().reachText(*joint, q[*joint]) + "."
                                     : "the speed must be above 0 and at most 1."));
  }
  require(answer == Status::kMotionStarted ? Refusal::kNone : Refusal::kMotionActive);
  return fci::Reply([&motion]() -> std::optional<std::string> {
    if (motion.active()) {
      return std::nullopt;
    }
    if (!motion.arrived()) {
      throw std::runtime_error("The motion was ended before its target was reached.");
    }
    return "";
  });
}

void addMotion(LineServer& lines, fci::SimRobot& robot, fci::Host& host) {
  constexpr double kSpeed = 0.3;  // share of the joints' velocity limits (chosen here)
  WholeRobot& whole = robot.whole();
  lines.add("move pack|stop|Q1 Q2 Q3 Q4 Q5 Q6 Q7 [SPEED]", [&](const Words& words) -> fci::Reply {
    if (words.at(0) == "stop") {
      host.runFree(kReaction);
      whole.operatorMotion().stop();
      return "";
    }
    const bool pack = words[0] == "pack";
    const std::array<double, 7> target = pack ? OperatorMotion::kPackPose : toNumbers<7>(words, 0);
    const double speed = !pack && words.size() > 7 ? toNumber(words[7]) : kSpeed;
    fci::Reply reply = startMotion(whole, target, speed);
    host.runFree(kReaction);
    return reply;
  });
}

void addReport(LineServer& lines, const OperatorContext& context) {
  lines.add("report", [context](const Words&) {
    fci::JsonWriter json;
    json.beginObject().member("time", context.world.time()).member("arm_id", context.arm_id);
    fci::writeReport(context.robot, json);
    json.member("fault", context.world.fault()).endObject();
    return json.text();
  });
}

}  // namespace

void setUserStop(WholeRobot& robot, bool pressed) { robot.safety().pressUserStop(pressed); }

void setGuiding(WholeRobot& robot, bool active) { require(robot.safety().guide(active)); }

void setBrakes(WholeRobot& robot, bool closed) {
  if (closed) {
    robot.safety().lock();
  } else {
    require(robot.safety().unlock());
  }
}

void setFci(fci::SimRobot& robot, bool active) {
  SafetyController& safety = robot.whole().safety();
  if (active) {
    require(safety.activateFci());
  } else {
    safety.deactivateFci();
  }
  servePorts(robot);
}

void setPower(fci::SimRobot& robot, bool on) {
  robot.whole().setPower(on);
  robot.observe();  // a new control unit has no measurement yet
  servePorts(robot);
}

void setEndEffectorPower(fci::SimRobot& robot, bool on) {
  robot.whole().safety().setEndEffectorPower(on);
  servePorts(robot);
}

void addSafetyCommands(LineServer& lines, const OperatorContext& context) {
  addStops(lines, context.robot, context.host);
  addBrakes(lines, context.robot, context.host);
  addFci(lines, context.robot);
  addGuiding(lines, context.robot, context.host);
  addErrors(lines, context.robot);
  addPower(lines, context.robot, context.host);
  addEndEffector(lines, context.robot);
  addMotion(lines, context.robot, context.host);
  addReport(lines, context);
}

}  // namespace franka_sim

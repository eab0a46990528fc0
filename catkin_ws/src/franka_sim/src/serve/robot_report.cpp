// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "serve/robot_report.h"

#include <franka_core/fci/texts.h>
#include <franka_core/robot_error.h>
#include <franka_sim/serve/sim_robot.h>

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "fci/robot_server.h"

namespace franka_sim::fci {

namespace {

template <std::size_t kCount>
std::vector<std::string_view> namesOf(const std::array<bool, kCount>& flags,
                                      const std::array<std::string_view, kCount>& names) {
  std::vector<std::string_view> set;
  for (std::size_t i = 0; i < kCount; i++) {
    if (flags[i]) {
      set.push_back(names[i]);
    }
  }
  return set;
}

template <std::size_t kCount>
void writeFlags(JsonWriter& json, std::string_view name, const std::array<bool, kCount>& flags,
                const std::array<std::string_view, kCount>& names) {
  json.key(name).beginObject();
  for (std::size_t i = 0; i < kCount; i++) {
    json.member(names[i], flags[i]);
  }
  json.endObject();
}

void writeErrors(const ControlUnit& unit, JsonWriter& json) {
  std::vector<std::string_view> names;
  std::map<std::string, std::string> details;
  for (std::size_t i = 0; i < franka_core::kErrorCount; i++) {
    if (unit.state().errors[i]) {
      names.emplace_back(franka_core::kErrorNames[i]);
      if (const std::string detail = detailOf(unit, i); !detail.empty()) {
        details.emplace(franka_core::kErrorNames[i], detail);
      }
    }
  }
  json.member("errors", names).member("details", details);
}

void writeMeasurements(const franka_core::RobotState& state, JsonWriter& json) {
  json.member("q", state.q).member("dq", state.dq).member("q_d", state.q_d);
  json.member("tau_J", state.tau_J).member("tau_ext", state.tau_ext_hat_filtered);
  json.member("O_T_EE", state.O_T_EE).member("O_F_ext", state.O_F_ext_hat_K);
  json.member("success_rate", state.control_command_success_rate);
}

void writeGuiding(const SafetyState& safety, bool active, JsonWriter& json) {
  json.key("guiding").beginObject().member("active", active);
  json.member("mode", kGuidingModeNames[static_cast<std::size_t>(safety.guiding_mode)]);
  json.member("axes", safety.guiding_axes).endObject();
  json.member("navigation", safety.arrows_guide_desk ? "desk" : "robot");
}

// The inputs as they act, and what presses the user stop and has to be released.
void writeInputs(const SafetyController& controller, JsonWriter& json) {
  const SafetyState& safety = controller.state();
  std::array<bool, kSafetyInputCount> pressed{};
  std::vector<std::string_view> sources;
  if (safety.user_stop) {
    sources.emplace_back("user_stop");
  }
  for (std::size_t i = 0; i < pressed.size(); i++) {
    const auto input = static_cast<SafetyInput>(i);
    pressed[i] = controller.pressed(input);
    if (safety.inputs[i] && controller.isStop(input)) {
      sources.push_back(kSafetyInputNames[i]);
    }
  }
  if (safety.conflicting_inputs && !controller.isFr3()) {
    sources.emplace_back("conflicting_inputs");
  }
  writeFlags(json, "inputs", pressed, kSafetyInputNames);
  json.member("user_stop", sources);
}

void writeSafety(const SafetyController& controller, JsonWriter& json) {
  const SafetyState& safety = controller.state();
  const Light light = controller.light();
  json.member("power", safety.power).member("brakes", safety.brakes_closed);
  json.member("brakes_moving", safety.brakes_moving);
  json.member("operating_mode",
              safety.mode == OperatingMode::kExecution ? "execution" : "programming");
  json.member("fci", controller.fciActive());
  writeInputs(controller, json);
  writeFlags(json, "buttons", safety.buttons, kButtonNames);
  json.key("self_test").beginObject().member("running", safety.self_test);
  json.member("left", safety.self_test_left).member("due", safety.self_test_due).endObject();
  json.member("recoverable", namesOf(safety.recoverable, kRecoverableErrorNames));
  json.member("joint_limit_violation", safety.demanded[0]);
  json.member("joint_position_error", safety.demanded[1]);
  json.key("light").beginObject();
  json.member("color", kLightColorNames[static_cast<std::size_t>(light.color)]);
  json.member("blinking", light.blinking).endObject();
}

void writeHand(WholeRobot& robot, JsonWriter& json) {
  json.key("hand").beginObject();
  const GripperUnit* hand = robot.hand();
  json.member("kind", hand != nullptr ? "gripper" : robot.vacuum() != nullptr ? "vacuum" : "none");
  json.member("homed", hand != nullptr && hand->isHomed());
  json.member("width", hand != nullptr ? hand->width() : 0.0);
  json.member("max_width", hand != nullptr ? hand->maxWidth() : 0.0);
  json.member("grasped", hand != nullptr && hand->isGrasped());
  json.member("busy", hand != nullptr && hand->isBusy());
  json.endObject();
}

void writeEndEffector(const franka_core::RobotState& state, bool power, JsonWriter& json) {
  json.key("end_effector").beginObject().member("mass", state.m_ee);
  json.member("center", state.F_x_Cee).member("inertia", state.I_ee);
  json.member("F_T_NE", state.F_T_NE).member("power", power).endObject();
}

}  // namespace

void writeReport(SimRobot& robot, JsonWriter& json) {
  WholeRobot& units = robot.whole();
  const ControlUnit& unit = units.unit();
  const franka_core::RobotState& state = unit.state();
  const SafetyController& safety = units.safety();
  const RobotServer& server = robot.server();
  json.member("type", safety.isFr3() ? "fr3" : "panda");
  json.key("protocol").beginArray();
  json.value(server.oldestVersion()).value(server.newestVersion()).endArray();
  json.member("client", server.version());
  json.member("rules", safety.rules() == SafetyRules::kDesk ? "desk" : "open");
  json.member("mode", std::string_view(franka_core::fci::modeName(state.robot_mode)));
  writeErrors(unit, json);
  writeMeasurements(state, json);
  writeSafety(safety, json);
  writeGuiding(safety.state(), state.robot_mode == franka_core::RobotMode::kGuiding, json);
  writeHand(units, json);
  writeEndEffector(state, safety.state().end_effector_power, json);
  json.member("motion", units.operatorMotion().active());
}

}  // namespace franka_sim::fci

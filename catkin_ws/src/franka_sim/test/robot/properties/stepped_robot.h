// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/robot/whole_robot.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <ostream>

#include "fake_hand.h"
#include "properties/model_arm.h"
#include "properties/observation.h"
#include "properties/step.h"
#include "properties/word_hash.h"

namespace franka_sim::test {

/// Which robot a sequence is for.
struct Setting {
  const char* name;
  unsigned version;  ///< of the protocol: up to 5 a Panda, otherwise an FR3
  InterfaceRules rules;
  SafetyRules safety;
  bool unlocked;           ///< with Desk's rules: brakes open, FCI active
  bool noise{false};       ///< of the sensors
  unsigned delay{0};       ///< of commands [ticks]
  double hand_latency{0};  ///< [s]

  bool isFr3() const { return version > 5; }
};

inline std::ostream& operator<<(std::ostream& out, const Setting& setting) {
  return out << setting.name;
}

rc::Gen<Setting> settings();

/// A robot that carries out generated steps.
class SteppedRobot {
 public:
  /// The answer to an action.
  enum class Answer {
    kDone,
    kRefused,
    kIllegalAccepted,  ///< a value that no robot accepts was accepted
  };

  explicit SteppedRobot(const Setting& setting);
  SteppedRobot(const SteppedRobot&) = delete;
  SteppedRobot& operator=(const SteppedRobot&) = delete;
  ~SteppedRobot() = default;

  /// Takes over the condition of a robot of the same setting.
  void takeOver(const SteppedRobot& other);

  /// Carries out the action of a step, without its ticks.
  Answer act(const Step& step);
  void press(SafetyInput input, bool pressed);
  void pressUserStop(bool pressed);
  /// Puts the arm into its start pose, at rest.
  void place();
  void tick();
  void run(unsigned ticks);

  WholeRobot& robot() { return robot_; }
  const WholeRobot& robot() const { return robot_; }
  const franka_core::RobotState& state() const { return robot_.unit().state(); }
  const ModelArm& arm() const { return arm_; }
  const FakeHand& hand() const { return hand_; }
  const Setting& setting() const { return setting_; }
  Observation observation() const { return Observation(robot_); }
  /// A hash of all ticks, torques and answers since the start.
  std::uint64_t trace() const { return trace_.value(); }
  /// Allocations and locks in ticks.
  std::size_t realTimeFaults() const { return real_time_faults_; }

  /// The answers that came in this tick: PendingAnswer.
  const std::array<std::optional<Status>, 3>& answers() const { return answers_; }
  /// Whether any source of the user stop that this robot has is pressed.
  bool stopPressed() const;

 private:
  Answer request(const UnitRequest& request, bool legal = true);
  Answer client(const Step& step);
  Answer operate(const Step& step);
  Answer configure(const Step& step);
  Answer moveByOperator(unsigned variant);
  Answer commandHand(unsigned variant);
  const franka_core::RobotCommand* nextCommand();

  Setting setting_;
  ModelArm arm_;
  FakeHand hand_;
  WholeRobot robot_;
  bool operator_stop_{false};
  std::array<bool, kSafetyInputCount> inputs_{};
  unsigned commands_;              // what the client sends: nextCommand()
  unsigned motion_ticks_{0};       // since the start of the motion
  franka_core::RobotState start_;  // of the motion
  franka_core::RobotCommand command_;
  std::array<std::optional<Status>, 3> answers_;
  WordHash trace_;
  std::size_t real_time_faults_{0};
};

}  // namespace franka_sim::test

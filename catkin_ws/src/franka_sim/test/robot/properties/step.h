// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rapidcheck.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <ostream>
#include <tuple>
#include <vector>

namespace franka_sim::test {

/// What a step does before its ticks.
enum class Action : std::uint8_t {
  kWait,
  // the client
  kSend,
  kMove,
  kStopMove,
  kRecover,
  kClientLost,
  kLoseCommands,
  // the operator
  kUserStop,
  kInput,
  kUnlock,
  kLock,
  kFci,
  kOperatingMode,
  kGuide,
  kGuidingMode,
  kSelfTest,
  kInject,
  kAcknowledge,
  kPower,
  kOperatorMotion,
  // setters
  kSetLoad,
  kSetEndEffector,
  kSetNEToEE,
  kSetEEToK,
  kSetCollisionBehavior,
  kSetJointImpedance,
  kSetCartesianImpedance,
  kSetFilters,
  kSetVirtualWall,
  kSetProtocolVersion,
  // the hand and the world
  kHand,
  kSpoilMeasurement,
  kPush,
  kRestart,
};

constexpr std::array<const char*, 34> kActionNames{"wait",
                                                   "send",
                                                   "move",
                                                   "stop move",
                                                   "recover",
                                                   "client lost",
                                                   "lose commands",
                                                   "user stop",
                                                   "input",
                                                   "unlock",
                                                   "lock",
                                                   "FCI",
                                                   "operating mode",
                                                   "guide",
                                                   "guiding mode",
                                                   "self-test",
                                                   "inject",
                                                   "acknowledge",
                                                   "power",
                                                   "operator motion",
                                                   "load",
                                                   "end effector",
                                                   "NE_T_EE",
                                                   "EE_T_K",
                                                   "collision",
                                                   "joint stiff",
                                                   "Cartesian stiff",
                                                   "filters",
                                                   "virtual wall",
                                                   "protocol",
                                                   "hand",
                                                   "spoil measurement",
                                                   "push",
                                                   "restart"};
static_assert(kActionNames.size() == static_cast<std::size_t>(Action::kRestart) + 1);

/// One step of a generated sequence. What a variant means: SteppedRobot::act.
struct Step {
  Action action{Action::kWait};
  unsigned variant{0};
  unsigned ticks{0};
};

constexpr unsigned kVariants = 26;

inline std::ostream& operator<<(std::ostream& out, const Step& step) {
  return out << kActionNames[static_cast<std::size_t>(step.action)] << ' ' << step.variant << ", "
             << step.ticks << " ticks";
}

/// Any number below a bound, each as often. (RapidCheck's own range grows with the size of a case,
/// so that most cases have the first few values only.)
inline rc::Gen<std::size_t> below(std::size_t bound) {
  return rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::size_t>(0, bound));
}

/// Sequences of steps. Smaller ones are shorter, have earlier actions, variants and fewer ticks.
inline rc::Gen<std::vector<Step>> sequences() {
  using A = Action;
  // Motions, stops and commands are frequent: others then find the arm in each of its conditions.
  static const std::vector<Action> actions = [] {
    std::vector<Action> all;
    for (std::size_t i = 0; i < kActionNames.size(); i++) {
      all.push_back(static_cast<Action>(i));
    }
    all.insert(all.end(),
               {A::kMove, A::kMove, A::kMove, A::kMove, A::kSend, A::kSend, A::kSend, A::kUserStop,
                A::kInput, A::kRecover, A::kRecover, A::kFci, A::kUnlock, A::kHand, A::kStopMove});
    return all;
  }();
  static constexpr std::array<unsigned, 10> kTicks{0, 0, 1, 1, 2, 3, 5, 8, 20, 60};
  return rc::gen::container<std::vector<Step>>(rc::gen::map(
      rc::gen::tuple(below(actions.size()), below(kVariants), below(kTicks.size())),
      [](const std::tuple<std::size_t, std::size_t, std::size_t>& drawn) {
        return Step{actions[std::get<0>(drawn)], static_cast<unsigned>(std::get<1>(drawn)),
                    kTicks[std::get<2>(drawn)]};
      }));
}

}  // namespace franka_sim::test

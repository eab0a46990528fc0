// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "properties/observation.h"

#include "properties/word_hash.h"

namespace franka_sim::test {

namespace {

template <typename... Values>
std::uint64_t hashOf(const Values&... values) {
  WordHash hash;
  (hash.add(values), ...);
  return hash.value();
}

void addThresholds(WordHash& hash, const CollisionThresholds& thresholds) {
  hash.add(thresholds.lower_torque);
  hash.add(thresholds.upper_torque);
  hash.add(thresholds.lower_force);
  hash.add(thresholds.upper_force);
}

std::uint64_t hashOfStatus(const UnitStatus& status) {
  WordHash hash;
  for (const bool flag : {status.brakes_closed, status.user_stop_pressed, status.fci_active,
                          status.measured, status.settling, status.resting, status.answers_at_rest,
                          status.joint_collision.happened, status.cartesian_collision.happened}) {
    hash.add(flag);
  }
  addThresholds(hash, status.thresholds);
  return hash.value();
}

std::uint64_t hashOfThresholds(const ControlUnitParameters& parameters) {
  WordHash hash;
  addThresholds(hash, parameters.nominal);
  addThresholds(hash, parameters.acceleration);
  return hash.value();
}

std::uint64_t hashOfWalls(const ControlUnit& unit) {
  WordHash hash;
  for (std::int32_t id = 0; const auto* wall = unit.virtualWall(id); id++) {
    hash.add(wall->object_world_size);
    hash.add(wall->object_frame);
    hash.add(wall->active);
  }
  return hash.value();
}

std::uint64_t hashOfSafety(const SafetyState& s) {
  return hashOf(s.power, s.brakes_closed, s.brakes_moving, s.mode, s.inputs, s.conflicting_inputs,
                s.buttons, s.arrows_guide_desk, s.guiding_mode, s.guiding_axes, s.recoverable,
                s.demanded, s.self_test, s.self_test_left, s.self_test_due, s.end_effector_power);
}

std::uint64_t hashOfHand(const GripperUnit* hand) {
  return hand == nullptr ? 0
                         : hashOf(hand->state(), hand->width(), hand->isGrasped(), hand->isBusy(),
                                  hand->isHomed(), hand->temperature());
}

}  // namespace

Observation::Observation(const WholeRobot& robot) {
  const ControlUnit& unit = robot.unit();
  const ControlUnitParameters& p = unit.configuration();
  hashes_ = {hashOf(unit.state()),
             hashOfStatus(unit.status()),
             hashOf(p.load),
             hashOf(p.end_effector),
             hashOf(p.F_T_NE),
             hashOf(p.NE_T_EE),
             hashOf(p.EE_T_K),
             hashOfThresholds(p),
             hashOf(p.cartesian_stiffness),
             hashOf(p.protocol_version),
             hashOf(p.max_torque, p.rotor_inertia, p.gravity, p.joint_stiffness, p.rules),
             hashOfWalls(unit),
             hashOfSafety(robot.safety().state()),
             hashOf(robot.operatorMotion().active(), robot.operatorMotion().arrived()),
             hashOfHand(robot.hand())};
}

std::string Observation::differences(const Observation& other) const {
  std::string names;
  for (std::size_t i = 0; i < hashes_.size(); i++) {
    if (hashes_[i] != other.hashes_[i]) {
      names += (names.empty() ? "" : ", ") + std::string(kPartNames[i]);
    }
  }
  return names;
}

}  // namespace franka_sim::test

// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/errors.h>
#include <franka_core/robot_error.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

namespace {

using franka::Errors;
using Member = const bool& (*)(const Errors&);

struct NamedMember {
  const char* name;
  Member member;
};

#define MEMBER(name)                                                       \
  NamedMember {                                                            \
    #name, [](const Errors& errors) -> const bool& { return errors.name; } \
  }

// In the order of the wire (protocol 4.3).
const NamedMember kMembers[] = {
    MEMBER(joint_position_limits_violation),
    MEMBER(cartesian_position_limits_violation),
    MEMBER(self_collision_avoidance_violation),
    MEMBER(joint_velocity_violation),
    MEMBER(cartesian_velocity_violation),
    MEMBER(force_control_safety_violation),
    MEMBER(joint_reflex),
    MEMBER(cartesian_reflex),
    MEMBER(max_goal_pose_deviation_violation),
    MEMBER(max_path_pose_deviation_violation),
    MEMBER(cartesian_velocity_profile_safety_violation),
    MEMBER(joint_position_motion_generator_start_pose_invalid),
    MEMBER(joint_motion_generator_position_limits_violation),
    MEMBER(joint_motion_generator_velocity_limits_violation),
    MEMBER(joint_motion_generator_velocity_discontinuity),
    MEMBER(joint_motion_generator_acceleration_discontinuity),
    MEMBER(cartesian_position_motion_generator_start_pose_invalid),
    MEMBER(cartesian_motion_generator_elbow_limit_violation),
    MEMBER(cartesian_motion_generator_velocity_limits_violation),
    MEMBER(cartesian_motion_generator_velocity_discontinuity),
    MEMBER(cartesian_motion_generator_acceleration_discontinuity),
    MEMBER(cartesian_motion_generator_elbow_sign_inconsistent),
    MEMBER(cartesian_motion_generator_start_elbow_invalid),
    MEMBER(force_controller_desired_force_tolerance_violation),
    MEMBER(start_elbow_sign_inconsistent),
    MEMBER(communication_constraints_violation),
    MEMBER(power_limit_violation),
    MEMBER(cartesian_motion_generator_joint_position_limits_violation),
    MEMBER(cartesian_motion_generator_joint_velocity_limits_violation),
    MEMBER(cartesian_motion_generator_joint_velocity_discontinuity),
    MEMBER(cartesian_motion_generator_joint_acceleration_discontinuity),
    MEMBER(cartesian_position_motion_generator_invalid_frame),
    MEMBER(controller_torque_discontinuity),
    MEMBER(joint_p2p_insufficient_torque_for_planning),
    MEMBER(tau_j_range_violation),
    MEMBER(instability_detected),
    MEMBER(joint_move_in_wrong_direction),
    MEMBER(cartesian_spline_motion_generator_violation),
    MEMBER(joint_via_motion_generator_planning_joint_limit_violation),
    MEMBER(base_acceleration_initialization_timeout),
    MEMBER(base_acceleration_invalid_reading),
};

#undef MEMBER

std::array<bool, 41> only(std::size_t index) {
  std::array<bool, 41> flags{};
  flags[index] = true;
  return flags;
}

TEST(Errors, EachFlagHasAMemberAndAName) {
  ASSERT_EQ(41u, std::size(kMembers));
  std::set<std::string> names;
  for (std::size_t i = 0; i < 41; i++) {
    const Errors errors(only(i));
    for (std::size_t k = 0; k < 41; k++) {
      EXPECT_EQ(i == k, kMembers[k].member(errors)) << i << " " << kMembers[k].name;
    }
    const std::string name = franka_core::kErrorNames[i];
    EXPECT_TRUE(static_cast<bool>(errors));
    EXPECT_EQ("[\"" + name + "\"]", static_cast<std::string>(errors));
    const std::string expected = i == 31   ? std::string(kMembers[i].name) + "_flag"
                                 : i == 34 ? "tau_J_range_violation"
                                           : kMembers[i].name;
    EXPECT_EQ(expected, name);
    names.insert(name);
  }
  EXPECT_EQ(41u, names.size());
  EXPECT_EQ("[]", static_cast<std::string>(Errors()));
}

TEST(Errors, CopiesReferToTheirOwnFlags) {
  Errors copy;
  {
    const Errors errors(only(6));
    copy = errors;
    const Errors other(errors);  // NOLINT(performance-unnecessary-copy-initialization)  is tested
    EXPECT_TRUE(other.joint_reflex);
    EXPECT_NE(&other.joint_reflex, &errors.joint_reflex);
  }
  EXPECT_TRUE(copy.joint_reflex);
  const bool& member = copy.joint_reflex;
  copy = Errors();
  EXPECT_FALSE(member);
  copy = *&copy;
  EXPECT_FALSE(static_cast<bool>(copy));
}

}  // namespace

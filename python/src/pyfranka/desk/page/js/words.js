// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Sentences for names of the robot. A name without one is shown as its words: "joint_reflex" as "joint reflex".

const ERRORS = {
  joint_position_limits_violation: "A joint is at its limit.",
  cartesian_position_limits_violation: "The end effector has left its workspace.",
  self_collision_avoidance_violation: "The arm came too close to itself.",
  joint_velocity_violation: "A joint was faster than its limit.",
  cartesian_velocity_violation: "The end effector was faster than its limit.",
  force_control_safety_violation: "A force exceeded the safety limit of force control.",
  joint_reflex: "A joint's external torque exceeded its threshold.",
  cartesian_reflex: "The external force on the end effector exceeded its threshold.",
  max_goal_pose_deviation_violation: "The end effector is too far from its desired pose.",
  max_path_pose_deviation_violation: "The end effector has left its path.",
  cartesian_velocity_profile_safety_violation: "The Cartesian velocity profile exceeded a safety limit.",
  joint_position_motion_generator_start_pose_invalid: "The motion does not start at the present joint positions.",
  joint_motion_generator_position_limits_violation: "The motion would exceed a joint's position limit.",
  joint_motion_generator_velocity_limits_violation: "The motion would exceed a joint's velocity limit.",
  joint_motion_generator_velocity_discontinuity: "The commanded joint velocity has a jump.",
  joint_motion_generator_acceleration_discontinuity: "The commanded joint acceleration has a jump.",
  cartesian_position_motion_generator_start_pose_invalid: "The motion does not start at the present pose.",
  cartesian_motion_generator_elbow_limit_violation: "The motion would move the elbow beyond its limit.",
  cartesian_motion_generator_velocity_limits_violation: "The motion would exceed the Cartesian velocity limit.",
  cartesian_motion_generator_velocity_discontinuity: "The commanded Cartesian velocity has a jump.",
  cartesian_motion_generator_acceleration_discontinuity: "The commanded Cartesian acceleration has a jump.",
  force_controller_desired_force_tolerance_violation: "The desired force is outside its tolerance.",
  controller_torque_discontinuity: "The commanded torque has a jump.",
  start_elbow_sign_inconsistent: "The sign of the elbow differs from that of the motion.",
  communication_constraints_violation: "Too many commands of the client were lost or late.",
  power_limit_violation: "The motion would need more power than allowed.",
  joint_p2p_insufficient_torque_for_planning: "The load is too heavy for the planned motion.",
  tau_j_range_violation: "A measured torque is out of range.",
  instability_detected: "The control has become unstable.",
  joint_move_in_wrong_direction: "A joint moved further beyond its limit.",
};

const RECOVERABLE = {
  td2Timeout: "The self-test is overdue.",
  genericJointError: "A joint reports an error.",
  jointPositionError: "A joint has lost its position.",
  safeInputErrorX31: "Safety input X3.1 is inconsistent.",
  safeInputErrorX32: "Safety input X3.2 is inconsistent.",
  safeInputErrorX33: "Safety input X3.3 is inconsistent.",
  safeInputErrorX4: "Safety input X4 is inconsistent.",
  guidingEnablingDevice: "The guiding enabling device is inconsistent.",
  environmentDataTimeout: "Environment data are late.",
  fsoeConnectionError: "The safe connection to a joint was lost.",
};

/** What the user must do after a refusal, by its code. */
export const ADVICE = {
  NotReady: "The robot is off or still starting.",
  BrakesClosed: "Unlock the joints first.",
  EmergencyStopPressed: "Release the user stop first.",
  SelfTestRunning: "Wait until the self-test has ended.",
  RecoverableErrorActive: "Acknowledge the error first.",
  JointRecoveryRequired: "A joint must be recovered first.",
  WrongOperatingMode: "Switch to the other operating mode first.",
  MotionActive: "Stop the motion first.",
  NoAckRequired: "Nothing has to be acknowledged.",
  NotHomed: "Home the hand first.",
  NoHand: "This robot has no gripper.",
};

function spelled(name) {
  const words = name.replace(/_/g, " ").replace(/([a-z])([A-Z0-9])/g, "$1 $2").toLowerCase();
  return words.charAt(0).toUpperCase() + words.slice(1) + ".";
}

export const errorSentence = (name) => ERRORS[name] ?? spelled(name);
export const recoverableSentence = (name) => RECOVERABLE[name] ?? spelled(name);
export const kindOf = (type) => ({ panda: "Panda", fr3: "FR3" })[type] ?? type;

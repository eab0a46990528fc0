# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The list of names that a user can reach has a known name of each kind."""

from reachable_names import reachable_names

KNOWN = {
    "action franka_control_node ~error_recovery franka_msgs/ErrorRecovery",
    "action franka_sim_mujoco/FrankaGripperSim ~grasp franka_gripper/Grasp",
    "action-file franka_gripper/Grasp 0 float64 width",
    "action-or-service-that-it-calls spawner controller_manager/load_controller "
    "controller_manager_msgs/LoadController",
    "c++ franka::Robot::control",
    "cmake-library franka_hw franka_hw",
    "cmake-package Franka",
    "cmake-package franka_hw",
    "cmake-target Franka::Franka",
    "command ./franka build",
    "debian-package ros-franka-franka-hw",
    "dynamic-parameter compliance_param translational_stiffness double",
    "header franka/robot.h",
    "launch-argument franka_control launch/franka_control.launch robot_ip = 127.0.0.1; None",
    "launch-file franka_control launch/franka_control.launch",
    "msg-file franka_msgs/FrankaState 0 float64[7] q",
    "node franka_control franka_control_node",
    "operator-line panda user_stop on|off",
    "option ./franka --long",
    "option franka_sim_mujoco franka_sim --pace",
    "option pytest franka_short_fixtures",
    "parameter franka_hw/FrankaHW arm_id string",
    "plugin franka_hw/FrankaCombinableHW hardware_interface::RobotHW",
    "program franka_control franka_control_node",
    "published-topic franka_control/FrankaStateController ~franka_states franka_msgs/FrankaState",
    "python-call pyfranka.is_valid_elbow(elbow)",
    "python-class pyfranka.Robot",
    "python-function pyfranka.meshes.install",
    "python-field pyfranka.sim.Panda.address",
    "python-member pyfranka.Robot.read_once",
    "python-module pyfranka.sim",
    "python-value pyfranka.remote.PORT",
    "ros-package franka_hw",
    "service franka_control_node ~set_load franka_msgs/SetLoad",
    "shared-file franka_sim worlds/stone.xml",
    "srv-file franka_msgs/SetLoad 0 float64 mass",
    "subscribed-topic joint_trajectory_controller ~command trajectory_msgs/JointTrajectory",
    "topic franka_control_node ~has_error std_msgs/Bool, latched",
    "variable FRANKA_DESK_PASSWORD",
    "wheel-entry pytest11",
    "wheel-extra gym",
    "wheel-program franka_sim",
    "xacro-argument franka_description panda.urdf.xacro parent = world",
}


def test_a_known_name_of_each_kind_is_found():
    found = set(reachable_names())
    kinds = {each.partition(" ")[0] for each in found}
    assert kinds == {each.partition(" ")[0] for each in KNOWN}
    assert KNOWN <= found

# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Every YAML file with the original's name loads like the original: unchanged, and with only the original's
arguments substituted. The result has the original's values (decision 51)."""

import re
from pathlib import Path

import pytest
import rosparam
from roslaunch.substitution_args import resolve_args

SOURCE = Path(__file__).resolve().parent.parent / "catkin_ws" / "src"
CONFIG = {path.name: path for path in SOURCE.glob("franka_*/config/*.yaml")}

ARM = {"arm_id": "left"}


def joints(arm: str) -> list[str]:
    return [f"{arm}_joint{i}" for i in range(1, 8)]


def thresholds(torque: list[float], force: list[float]) -> dict:
    """One value for contact and collision, while accelerating and otherwise."""
    kinds = {"torque": torque, "force": force}
    return {
        f"{bound}_{kind}_thresholds_{phase}": values
        for bound in ("lower", "upper")
        for kind, values in kinds.items()
        for phase in ("acceleration", "nominal")
    }


TORQUES, FORCES = [20.0, 20.0, 18.0, 18.0, 16.0, 14.0, 12.0], [20.0, 20.0, 20.0, 25.0, 25.0, 25.0]
WIDE_TORQUES, WIDE_FORCES = [25.0, 25.0, 23.0, 23.0, 20.0, 17.5, 15.0], [40.0] * 6


def hardware(arm: str, cutoff: float, limits: dict, **more) -> dict:
    return {
        "arm_id": arm,
        "joint_names": joints(arm),
        "joint_limit_warning_threshold": 0.1,
        "rate_limiting": True,
        "cutoff_frequency": cutoff,
        "internal_controller": "joint_impedance",
        "collision_config": limits,
        **more,
    }


def one_of_several(arm: str, limits: dict) -> dict:
    return hardware(arm, 1000, limits, type="franka_hw/FrankaCombinableHW")


def gains(of_joints: list[str], **more) -> dict:
    p, d = [600] * 4 + [250, 150, 50], [30] * 4 + [10, 10, 5]
    return {joint: {"p": p[i % 7], "d": d[i % 7], "i": 0, **more} for i, joint in enumerate(of_joints)}


def goals(of_joints: list[str]) -> dict:
    return {"goal_time": 0.5, **{joint: {"goal": 0.05} for joint in of_joints}}


def state_controller(arm: str) -> dict:
    kind = "franka_control/FrankaStateController"
    return {"type": kind, "publish_rate": 30, "joint_names": joints(arm), "arm_id": arm}


def trajectory(kind: str, of_joints: list[str], **more) -> dict:
    return {"type": f"{kind}/JointTrajectoryController", "joints": of_joints, **more}


PAIR = joints("panda_1") + joints("panda_2")
START = [0, -0.785398163397, 0, -2.35619449019, 0, 1.57079632679, 0.785398163397]
CONTROLLERS = {
    "joint_impedance_example_controller": {
        "arm_id": "left",
        "joint_names": joints("left"),
        "k_gains": [600, 600, 600, 600, 250, 150, 50],
        "d_gains": [50, 50, 50, 20, 20, 20, 10],
        "radius": 0.1,
        "acceleration_time": 2.0,
        "vel_max": 0.15,
        "publish_rate": 10,
        "coriolis_factor": 1.0,
    },
    "dual_arm_cartesian_impedance_example_controller": {
        "right": {"arm_id": "panda_1", "joint_names": joints("panda_1")},
        "left": {"arm_id": "panda_2", "joint_names": joints("panda_2")},
    },
    "teleop_joint_pd_example_controller": {
        "leader": {"joint_names": joints("leader"), "contact_force_threshold": 4.0},
        "follower": {"joint_names": joints("follower"), "contact_force_threshold": 5.0},
    },
    **{
        f"{name}_example_controller": {}
        for name in (
            "joint_velocity",
            "joint_position",
            "cartesian_pose",
            "elbow",
            "cartesian_velocity",
            "model",
            "force",
            "cartesian_impedance",
        )
    },
}

# Substitutions of the original's launch files, and the values that must result (among others).
FILES = {
    "franka_control_node.yaml": (
        ARM,
        hardware("left", 100, thresholds(TORQUES, FORCES), realtime_config="enforce"),
    ),
    "franka_combined_control_node.yaml": (
        {},
        {
            "robot_hardware": ["panda_1", "panda_2"],
            "panda_1": one_of_several("panda_1", thresholds(TORQUES, FORCES)),
            "panda_2": one_of_several("panda_2", thresholds(TORQUES, FORCES)),
        },
    ),
    "default_controllers.yaml": (
        ARM,
        {
            "position_joint_trajectory_controller": trajectory(
                "position_controllers", joints("left"), constraints=goals(joints("left"))
            ),
            "effort_joint_trajectory_controller": trajectory(
                "effort_controllers",
                joints("left"),
                gains=gains(joints("left")),
                constraints=goals(joints("left")),
            ),
            "franka_state_controller": state_controller("left"),
        },
    ),
    "default_combined_controllers.yaml": (
        {},
        {
            "effort_joint_trajectory_controller": trajectory(
                "effort_controllers", PAIR, gains=gains(PAIR, i_clamp=1), constraints=goals(PAIR)
            ),
            "panda_1_state_controller": state_controller("panda_1"),
            "panda_2_state_controller": state_controller("panda_2"),
        },
    ),
    "start_pose.yaml": (ARM, {"joint_pose": dict(zip(joints("left"), START))}),
    "franka_gripper_node.yaml": (
        {},
        {"publish_rate": 30, "default_speed": 0.1, "default_grasp_epsilon": {"inner": 0.005, "outer": 0.005}},
    ),
    "robot_settings.yaml": ({}, {"joint_names": joints("panda")}),
    "gripper_settings.yaml": ({}, {"joint_names": ["panda_finger_joint1", "panda_finger_joint2"]}),
    "franka_hw_sim.yaml": (
        ARM,
        {
            "arm_id": "left",
            "singularity_warning_threshold": 0.0001,
            "tau_ext_lowpass_filter": 1.0,
            "franka_gripper": {
                "type": "franka_gazebo/FrankaGripperSim",
                "arm_id": "left",
                "finger1": {"gains": {"p": 100, "i": 0, "d": 1.0}},
                "finger2": {"gains": {"p": 100, "i": 0, "d": 1.0}},
            },
        },
    ),
    "sim_controllers.yaml": (
        ARM,
        {
            "franka_state_controller": state_controller("left"),
            "effort_joint_trajectory_controller": trajectory(
                "effort_controllers", joints("left"), gains=gains(joints("left"))
            ),
            "position_joint_trajectory_controller": trajectory("position_controllers", joints("left")),
            "joint_velocity_example_controller": {"arm_id": "left", "joint_names": joints("left")},
            "joint_position_example_controller": {"joint_names": joints("left")},
            "model_example_controller": {"arm_id": "left"},
            "force_example_controller": {"arm_id": "left", "joint_names": joints("left")},
            "cartesian_impedance_example_controller": {"arm_id": "left", "joint_names": joints("left")},
        },
    ),
    "franka_example_controllers.yaml": (ARM, CONTROLLERS),
    "teleop_joint_pd_example_control_node.yaml": (
        {},
        {
            "robot_hardware": ["leader", "follower"],
            "leader": one_of_several("leader", thresholds(WIDE_TORQUES, WIDE_FORCES)),
            "follower": one_of_several("follower", thresholds(WIDE_TORQUES, WIDE_FORCES)),
        },
    ),
    "teleop_state_controllers.yaml": (
        {},
        {
            "leader_state_controller": state_controller("leader"),
            "follower_state_controller": state_controller("follower"),
        },
    ),
}


def differences(loaded, expected, path: str = "") -> list[str]:
    """Expected values that are missing or different."""
    if isinstance(expected, dict):
        if not isinstance(loaded, dict):
            return [f"{path}: {loaded!r} is not a map"]
        return [
            line
            for key, value in expected.items()
            for line in (
                differences(loaded[key], value, f"{path}/{key}")
                if key in loaded
                else [f"{path}/{key} is missing"]
            )
        ]
    return [] if loaded == expected else [f"{path}: {loaded!r} instead of {expected!r}"]


@pytest.mark.parametrize("name", FILES)
def test_file_matches_the_original_with_the_originals_arguments(name):
    (arguments, expected), text = FILES[name], CONFIG[name].read_text()
    rosparam.load_file(str(CONFIG[name]))
    for argument in re.findall(r"\$\(arg (\w+)\)", text):
        assert argument in arguments, f"the original's file has no argument {argument}"
    ((loaded, _),) = rosparam.load_str(resolve_args(text, context={"arg": arguments}), name)
    assert differences(loaded, expected) == []


def test_files_with_the_same_name_are_identical():
    """Otherwise the table above would miss some of them."""
    found = {}
    for path in SOURCE.glob("franka_*/config/*.yaml"):
        assert found.setdefault(path.name, path.resolve()) == path.resolve()

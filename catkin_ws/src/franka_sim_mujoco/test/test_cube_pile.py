# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A pile of cubes from a script for Gazebo has more contacts than MuJoCo's default, and comes to rest."""

import runpy
import subprocess
import sys
from pathlib import Path

import pytest
from franka_sim_mujoco.msg import Contacts
from franka_sim_mujoco.srv import Step
from gazebo_msgs.srv import GetModelState
from geometry_msgs.msg import Vector3
from ros_client import call, latest, launched

SCRIPT = Path(__file__).with_name("spawn_cubes.py")
TOP, SIDE = (runpy.run_path(str(SCRIPT))[name] for name in ("TOP", "SIDE"))
DEFAULT_CONTACTS = 100  # of MuJoCo 2.2, for a world without <size>
LIMIT = 850  # [s] of the script and of the steps

pytestmark = pytest.mark.own_process("layers")


def size(vector: Vector3) -> float:
    return max(abs(vector.x), abs(vector.y), abs(vector.z))


@pytest.mark.parametrize(
    "layers",
    [
        pytest.param([4, 3, 2, 1], id="30"),
        pytest.param([8, 7, 6, 5, 4, 3, 1], id="200", marks=pytest.mark.long_form("200 cubes")),
    ],
)
def test_a_pile_of_cubes_rests_on_a_table(layers, tmp_path):
    world = ["gazebo_ros", "empty_world.launch", "gui:=false", "paused:=true"]
    with launched(*world, log=tmp_path / "launch.log"):
        words = [sys.executable, str(SCRIPT), *map(str, layers)]
        subprocess.run(words, check=True, timeout=LIMIT)
        call("/gazebo/step", Step, 500)
        assert len(latest("/gazebo/contacts", Contacts).body1s) > DEFAULT_CONTACTS
        number = 0
        for layer, count in enumerate(layers):
            for _ in range(count * count):
                state = call("/gazebo/get_model_state", GetModelState, f"cube_{number}", "world")
                height = state.pose.position.z - TOP - SIDE / 2
                assert height == pytest.approx(layer * SIDE, abs=1e-3), number
                assert size(state.twist.linear) < 1e-2 and size(state.twist.angular) < 0.1, number
                number += 1

# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""franka_combined_control.launch as a user starts it: torques for all arms, one of which hits something."""

import json
from pathlib import Path

import pytest
import yaml
from franka_sim_mujoco.session import Session

HERE = Path(__file__).resolve().parent

SUCCEEDED, IDLE = 3, 1
ROBOTS = [("panda", 2), ("fr3", 2), ("panda", 4)]
CONFIG = HERE.parent / "catkin_ws/src/franka_control/config"

# Arms side by side, for any number of them.
DESCRIPTION = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="arms">
  <xacro:include filename="$(find franka_description)/robots/common/franka_arm.xacro" />
  <xacro:property name="limits"
    value="${{xacro.load_yaml('$(find franka_description)/robots/{robot}/joint_limits.yaml')}}" />
  <link name="base" />{arms}
</robot>"""
ONE_ARM = """
  <xacro:franka_arm arm_id="{arm}" connected_to="base" xyz="0 {place} 0" joint_limits="${{limits}}" />"""


def arguments(robot, arms, folder):
    """Arguments of the launch file; for two Pandas only their addresses are needed."""
    addresses = ", ".join(f"{arm}/robot_ip: {address}" for arm, address in arms.items())
    launch = [f"robot_ips:={{{addresses}}}", f"sim_robot:={robot}"]
    if list(arms) == ["panda_1", "panda_2"]:
        return launch
    placed = "".join(ONE_ARM.format(arm=arm, place=place) for place, arm in enumerate(arms))
    description = folder / "arms.urdf.xacro"
    description.write_text(DESCRIPTION.format(robot=robot, arms=placed))
    states = ", ".join(f"{arm}_state_controller/joint_states" for arm in arms)
    return [
        *launch,
        f"robot:={description}",
        f"hw_config_file:={for_arms('franka_combined_control_node.yaml', arms, folder)}",
        f"controllers_file:={for_arms('default_combined_controllers.yaml', arms, folder)}",
        "controllers_to_start:=" + " ".join(f"{arm}_state_controller" for arm in arms),
        f"joint_states_source_list:=[{states}]",
    ]


def for_arms(name, arms, folder):
    """A file for panda_1 and panda_2, rewritten for other arms: all get the values of panda_1."""
    merged = {}
    for arm in arms:
        merge(merged, yaml.safe_load(alone((CONFIG / name).read_text()).replace("panda_1", arm)))
    path = folder / name
    path.write_text(yaml.safe_dump(merged))
    return path


def alone(text):
    """The file without the values of panda_2."""

    def first(value):
        if isinstance(value, dict):
            return {key: first(item) for key, item in value.items() if not key.startswith("panda_2")}
        if isinstance(value, list):
            return [item for item in value if not str(item).startswith("panda_2")]
        return value

    return yaml.safe_dump(first(yaml.safe_load(text)))


def merge(into, more):
    """Lists that both have are joined."""
    for key, value in more.items():
        if isinstance(value, dict):
            merge(into.setdefault(key, {}), value)
        elif isinstance(value, list):
            into[key] = into.get(key, []) + value
        else:
            into[key] = value


@pytest.fixture(scope="module", params=ROBOTS, ids=lambda p: f"{p[1]} {p[0]}")
def report(request, tmp_path_factory):
    robot, count = request.param
    folder = tmp_path_factory.mktemp("combined")
    arms = {f"{robot}_{i + 1}": f"127.0.7.{5 + i}" for i in range(count)}
    launch = ["franka_control", "franka_combined_control.launch", "sim:=true"]
    launch += arguments(robot, arms, folder)
    with Session(*launch, log=folder / "launch.log") as session:
        session.wait_for_master()
        load = ["rosrun", "controller_manager", "controller_manager", "load"]
        session.environment["ROS_NAMESPACE"] = "combined_panda"
        loaded = session.run(*load, "effort_joint_trajectory_controller", check=False, timeout=90)
        assert "Loaded" in loaded.stdout, f"{loaded}\n{session.tail(60)}"
        client = ["/usr/bin/python3", str(HERE / "combined_client.py")]
        client += [f"{arm}={address}" for arm, address in arms.items()]
        result = session.run(*client, check=False, timeout=240)
        print(result.stdout, session.tail(80), sep="\n")
        assert result.returncode == 0, f"{result}\n{session.tail(60)}"
        session.check()
        return json.loads(result.stdout.strip().splitlines()[-1])


def test_one_controller_moves_all_arms(report):
    assert report["states"] and report["started"] and report["moves"]
    assert report["error"] < 0.01


def test_an_early_recovery_changes_nothing(report):
    assert report["early"] == [SUCCEEDED, SUCCEEDED]
    assert report["goes_on"]
    # It does not clear a later error either.
    assert report["hit"]["reflex"]


def test_one_arm_recovers_and_the_others_stay_unchanged(report):
    assert report["hit"]["reflex"]
    # One controller moves all arms: they wait.
    assert all(other == [IDLE, True] for other in report["hit"]["others"])
    assert report["recovered"] == SUCCEEDED
    assert report["moves_again"]
    for before, after in zip(report["hit"]["others_at"], report["others_at"]):
        assert after == pytest.approx(before, abs=0.005)
    assert report["error_again"] < 0.01


def test_all_recover_at_once(report):
    assert report["all_hit"]
    assert report["all_recovered"] == SUCCEEDED
    assert report["all_move"]
    assert report["error_at_last"] < 0.01


def test_controllers_stop(report):
    assert report["stopped"] and report["idle"]

# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The service calls of docs/how_to/services.md are answered with success, which `rosservice` does not say by
its status."""

from pathlib import Path

import genpy
import pytest
import rospy
import rosservice
import yaml
from franka_msgs.msg import FrankaState
from page_commands import commands_of
from ros_client import START, Controllers, call, latest, launched

TOP = Path(__file__).resolve().parent.parent
CONTROLLER = "joint_impedance_example_controller"
WITHIN_A_MOTION = [
    "/franka_control/set_K_frame",
    f"EE_T_K: {[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0.01, 1]}",
]
SERVED = "127.0.43.1"


def answer(service: str, *arguments: str) -> tuple[bool, str]:
    """Success and error of a call, made as `rosservice call` does; each program would need a second."""
    rospy.wait_for_service(service, START)
    kind = rosservice.get_service_class_by_name(service)
    request = kind._request_class()
    genpy.message.fill_message_args(request, [yaml.safe_load(text) for text in arguments])
    answer = call(service, kind, request)
    success = getattr(answer, "success", getattr(answer, "ok", True))
    return bool(success), getattr(answer, "error", getattr(answer, "message", ""))


pytestmark = pytest.mark.own_process


@pytest.fixture(scope="module")
def session(tmp_path_factory):
    """A simulation with a robot under ros_control, and a served one."""
    launch = [str(TOP / "tests/data/how_to.launch"), f"fci_ip:={SERVED}"]
    with launched(*launch, log=tmp_path_factory.mktemp("how_to") / "launch.log") as running:
        latest("/franka_state_controller/franka_states", FrankaState, START)
        rospy.wait_for_service("/served/franka_sim/get_state", START)
        yield running


def test_every_service_call_succeeds(session):
    refused, count = [], 0
    for words in commands_of(TOP / "docs/how_to/services.md"):
        if words[:2] != ["rosservice", "call"]:
            continue
        service = words[2].replace("/franka_sim/", "/served/franka_sim/")
        calls = [(service, *words[3:])]
        if "stop_controllers: [joint" in " ".join(words):
            controllers = Controllers()
            controllers.load(CONTROLLER)
            controllers.start(CONTROLLER)  # as the argument `controller` of the launch file does
            calls.insert(0, WITHIN_A_MOTION)
        for request in calls:
            success, error = answer(*request)
            count += 1
            if not success:
                refused.append((request, error))
    assert count > 50
    assert not refused

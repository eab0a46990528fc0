# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The service calls and the ROS programs of docs/how_to work in simulation."""

import re
import subprocess

import genpy
import page_output
import pytest
import rospy
import rosservice
import yaml
from franka_msgs.msg import FrankaState
from ros_client import START, Controllers, call, latest, launched
from test_how_to import HOW_TO, TOP, blocks, service_calls

CONTROLLER = "joint_impedance_example_controller"
WITHIN_A_MOTION = [
    "/franka_control/set_K_frame",
    f"EE_T_K: {[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0.01, 1]}",
]
SERVED = "127.0.43.1"


def programs_with_ros() -> dict[str, str]:
    """The pages' Python programs that need a master."""
    names = [page.stem for page in HOW_TO.glob("*.md")]
    found = {name: [text for text in blocks(name, "python") if "import rospy" in text] for name in names}
    return {name: "\n".join(texts) for name, texts in found.items() if texts}


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


def test_programs_with_ros_run(session):
    programs = {
        name: subprocess.Popen(
            ["/usr/bin/python3", "-c", text],
            env=session.environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        for name, text in programs_with_ros().items()
    }
    printed = {name: program.communicate(timeout=120) for name, program in programs.items()}
    assert set(printed) == {"services", "recovery", "gripper"}
    assert "Traceback" not in "".join(error for _, error in printed.values()), printed
    assert "refused" not in printed["services"][1]
    for name in ("recovery", "gripper"):
        shown = "".join(each.output for each in page_output.examples(f"how_to/{name}.md"))
        expected = re.escape(shown).replace(re.escape("..."), r"\d+\.\d+")  # a number of this run
        assert re.fullmatch(expected, printed[name][0])


def test_every_service_call_succeeds(session):
    """The last case: the calls change the simulation."""
    refused, count = [], 0
    for words in service_calls():
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

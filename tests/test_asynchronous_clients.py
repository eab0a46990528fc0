# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Asynchronous motions with Franka's own client, which sends about fifty targets per second, or a single one.
No cycle of such a motion waits for an answer, and none counts as lost.
"""

import json
import signal
import subprocess

import pytest
from fci_session import simulated
from fci_wire import COMMUNICATION, IDLE, REFLEX, connected
from genuine_clients import client_python

# Joint 4 moves back and forth; each line reports the end of one motion.
CLIENT = """
import json, sys, time
import pylibfranka as franka

Handler = franka.AsyncPositionControlHandler
address, way, rounds = sys.argv[1], sys.argv[2], int(sys.argv[3])
robot = franka.Robot(address, franka.RealtimeConfig.kIgnore)
first = list(robot.read_once().q_d)
result = Handler.configure(robot, Handler.Configuration([0.5] * 7, 0.001))
if result.handler is None:
    sys.exit(result.error_message)
handler = result.handler
for number in range(rounds):
    goal = list(first)
    goal[3] += 0.1 if number % 2 == 0 else 0.0
    sent, end, seen = 0, time.monotonic() + 60, None
    while time.monotonic() < end:
        if way == "burst" and sent == 0:
            for _ in range(400):
                handler.set_joint_position_target(Handler.JointPositionTarget(first))
        if way == "stream" or sent == 0:
            accepted = handler.set_joint_position_target(Handler.JointPositionTarget(goal))
            sent += 1
        time.sleep(0.02)  # the loop's period
        seen = handler.get_target_feedback()
        if seen.status.name != "kExecuting":
            break
    print(json.dumps({"accepted": accepted.was_successful, "sent": sent, "status": seen.status.name,
                      "error": seen.error_message}), flush=True)
handler.stop_control()
state = robot.read_once()
for _ in range(30000):
    if state.robot_mode.name != "Move":
        break
    state = robot.read_once()
off = max(abs(a - b) for a, b in zip(state.q_d, goal))
print(json.dumps({"mode": state.robot_mode.name, "off": off}), flush=True)
"""


def command(address: str, way: str, rounds: int) -> list[str]:
    return [str(client_python("pylibfranka")), "-c", CLIENT, address, way, str(rounds)]


@pytest.fixture(scope="module")
def sim():
    with simulated("fr3", "lockstep") as sim:
        yield sim


@pytest.mark.parametrize("way", ["stream", "once", "burst"])
def test_targets_are_reached_at_any_update_rate(sim, way):
    done = subprocess.run(command(sim.address, way, 2), capture_output=True, text=True, timeout=200)
    assert done.returncode == 0, done.stderr
    *ways, end = [json.loads(line) for line in done.stdout.splitlines()]
    for seen in ways:
        assert seen["accepted"] and seen["status"] == "kTargetReached", seen
        assert seen["sent"] == 1 or way == "stream", seen
    assert len(ways) == 2
    assert end["mode"] == "Idle" and end["off"] < 1e-6, end  # single precision
    assert sim.remote.state().errors == {}


def test_an_asynchronous_motion_ends_with_its_client(sim):
    client = subprocess.Popen(command(sim.address, "once", 1000000), stdout=subprocess.PIPE, text=True)
    try:
        assert json.loads(client.stdout.readline())["status"] == "kTargetReached"
        assert sim.remote.state().mode == "Move"
    finally:
        client.send_signal(signal.SIGKILL)
        client.wait()
        client.stdout.close()
    with connected(sim) as next_client:
        state = next_client.state_until(lambda state: state.mode == REFLEX)
        assert state.reasons == [COMMUNICATION]
        assert next_client.recover().mode == IDLE

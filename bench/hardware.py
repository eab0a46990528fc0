# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The hardware nodes with a simulated robot in real time: losses and memory."""

import json
import tempfile
from pathlib import Path

from franka_sim_mujoco.session import Session
from processes import resident, wait_running
from report import figure, print_stalls
from stalls import Stalls

CONTROLLER = "effort_joint_trajectory_controller"

# Counts the milliseconds of the robot's time without a message. Messages are not decoded, because Python
# is too slow: `time` and the success rate are 99 and 91 bytes before the end of a FrankaState.
LISTENER = """
import json, struct, sys, time
import rospy
import rospy_connections
times, rates = [], []
def took(message):
    time_s, rate = struct.unpack("<dd", message._buff[-99:-83])
    times.append(time_s)
    rates.append(rate)
rospy_connections.init_node("listener")
rospy.Subscriber("/franka_state_controller/franka_states", rospy.AnyMsg, took, tcp_nodelay=True)
time.sleep(2.0)
del times[:], rates[:]
time.sleep(float(sys.argv[1]))
seen, rates = list(times), list(rates)
steps = [round((b - a) * 1000) for a, b in zip(seen, seen[1:])]
print(json.dumps({"messages": len(seen), "missing": sum(s - 1 for s in steps), "longest": max(steps),
                  "least": min(rates), "mean": sum(rates) / len(rates)}))
"""


def hardware() -> None:
    """A minute of torque control in real time, with all publishers on; half a minute with a patient robot.

    Losses with the latter are those of the nodes, not of the robot.
    """
    for pace, seconds in (("realtime", 60.0), ("patient", 30.0)):
        torque_control(pace, seconds)


def torque_control(pace: str, seconds: float) -> None:
    print(f"franka_control_node and the gripper node with a simulated robot (pace:={pace})")
    launch = [
        "franka_control",
        "franka_control.launch",
        "sim:=true",
        "robot:=panda",
        "robot_ip:=127.0.42.1",
        f"pace:={pace}",
    ]
    manager = ["rosrun", "controller_manager", "controller_manager"]
    with (
        tempfile.TemporaryDirectory() as folder,
        Session(*launch, log=Path(folder) / "launch.log") as session,
    ):
        session.wait_for_master()
        wait_running(session, "franka_state_controller")
        for act in ("stop", "unload"):
            session.run(*manager, act, "franka_state_controller", timeout=60)
        session.run("rosparam", "set", "/franka_state_controller/publish_rate", "1000")
        session.run(*manager, "spawn", "franka_state_controller", CONTROLLER, timeout=60)
        wait_running(session, CONTROLLER)
        with Stalls() as stalls:
            heard = session.run("/usr/bin/python3", "-c", LISTENER, str(seconds), timeout=seconds + 60).stdout
        heard = json.loads(heard.strip().splitlines()[-1])
        title = f"{seconds:.0f} s of torque control"
        figure(f"{title}: least control_command_success_rate", heard["least"], "", 0.99, at_least=True)
        figure(f"{title}: mean control_command_success_rate", heard["mean"], "", 0.999, at_least=True)
        figure(f"{title}: FrankaStates at 1 kHz", heard["messages"] / seconds, "Hz", 999, at_least=True)
        figure(f"{title}: milliseconds without a FrankaState", heard["missing"], "", 0)
        print_stalls(stalls)
        figure("franka_control_node: resident memory", resident(session, b"franka_control_node"), "MB", 60)
        figure("franka_gripper_node: resident memory", resident(session, b"franka_gripper_node"), "MB", 80)

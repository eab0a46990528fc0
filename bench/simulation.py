# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The in-process simulation as a whole: a tick, several arms, cameras, memory, start."""

import tempfile
import time
from pathlib import Path

from franka_sim_mujoco.session import Session
from processes import resident, wait_running
from report import figure

CONTROLLER = "cartesian_impedance_example_controller"
SIMULATION = b"franka_sim_mujoco_node"


def simulation(folder: Path, world: str, *arguments: str) -> Session:
    return Session(
        "franka_sim_mujoco",
        "panda.launch",
        f"world:={world}",
        f"controller:={CONTROLLER}",
        "interactive_marker:=false",
        *arguments,
        log=folder / "launch.log",
    )


def call(session: Session, service: str, request: str) -> dict[str, float]:
    """Calls a service and reads the numbers of its answer."""
    text = session.run("rosservice", "call", service, request, timeout=300).stdout
    values = {}
    for line in text.splitlines():
        key, _, value = line.partition(":")
        try:
            values[key.strip()] = float(value)
        except ValueError:
            continue
    return values


def tick() -> None:
    # So many ticks that the start of the program that asks for them is a small part of the time.
    print("One tick of 1 ms: physics, control unit, hardware, controller manager, impedance controller")
    for title, world, speed, ratio in (
        ("arm, hand and controller", "empty.xml", 80, 1.35),
        ("pick-and-place scene", "stone.xml", 50, 1.2),
    ):
        with (
            tempfile.TemporaryDirectory() as folder,
            simulation(Path(folder), world, "x:=-0.5", "real_time_factor:=0") as session,
        ):
            wait_running(session, CONTROLLER)
            best = min(
                (call(session, "/gazebo/benchmark", "ticks: 100000") for _ in range(3)),
                key=lambda answer: answer["tick_us"] / answer["bare_us"],
            )
            for part in ("physics_us", "read_us", "update_us", "write_us"):
                figure(f"{title}: {part}", best[part], "us")
            figure(f"{title}: tick", best["tick_us"], "us")
            figure(f"{title}: tick / bare mj_step", best["tick_us"] / best["bare_us"], "x", ratio)
            figure(
                f"{title}: times real time, flat out",
                1000 / best["tick_us"],
                "x",
                speed,
                at_least=True,
            )


# Waits until a controller runs on each arm, then calls list_controllers of each ten times.
# Prints the time since `begin` when all ran, and the longest of the calls [s].
ALL_RUNNING = """
import sys, time
import rospy
from controller_manager_msgs.srv import ListControllers
begin, controller, namespaces = float(sys.argv[1]), sys.argv[2], sys.argv[3:]
rospy.init_node("watch", disable_rostime=True)
services = [rospy.ServiceProxy(f"{name}/controller_manager/list_controllers", ListControllers)
            for name in namespaces]
def runs(service):
    try:
        return any(one.name == controller and one.state == "running" for one in service().controller)
    except rospy.ServiceException:
        return False
while not all([runs(service) for service in services]):
    assert time.monotonic() < begin + 200, "not all run"
    time.sleep(0.1)
ready = time.monotonic() - begin
def duration(service):
    start = time.monotonic()
    service()
    return time.monotonic() - start
print(ready, max(duration(service) for _ in range(10) for service in services))
"""


def arms() -> None:
    """Several arms with impedance controllers in one simulation, launched like the manual's two."""
    print("Several arms in one simulation, each with an impedance controller")
    for count, factor in ((1, 0), (2, 0), (4, 0), (8, 1), (8, 0)):
        title = f"{count} arm{'s' if count > 1 else ''}, {'real time' if factor else 'flat out'}"
        namespaces = [f"/arm_{i}" for i in range(count)]
        with tempfile.TemporaryDirectory() as folder:
            launch = Path(folder) / "arms.launch"
            elements = "".join(one_of_many(i, factor) for i in range(count))
            launch.write_text(f"<launch>{elements}</launch>")
            begin = time.monotonic()
            with Session(str(launch), log=Path(folder) / "launch.log") as session:
                session.wait_for_master()
                watch = ["/usr/bin/python3", "-c", ALL_RUNNING, str(begin), CONTROLLER, *namespaces]
                ready, listing = map(float, session.run(*watch, timeout=300).stdout.split())
                figure(f"{title}: roslaunch to all controllers running", ready, "s", 20)
                figure(f"{title}: longest call of list_controllers", listing, "s", 1)
                if factor:
                    continue
                best = min(
                    (call(session, "/gazebo/benchmark", "ticks: 50000") for _ in range(3)),
                    key=lambda answer: answer["tick_us"],
                )
                goal = {1: 100, 2: 90, 4: 50, 8: 25}[count]
                figure(f"{title}: times real time", 1000 / best["tick_us"], "x", goal, at_least=True)
                figure(f"{title}: tick / bare mj_step", best["tick_us"] / best["bare_us"], "x", 1.5)


def one_of_many(index: int, factor: float) -> str:
    """The launch element of one arm; the first one starts the simulation."""
    arguments = {
        "arm_id": f"arm_{index}",
        "gazebo": "true" if index == 0 else "false",
        "use_gripper": "false",
        "controller": CONTROLLER,
        "interactive_marker": "false",
        "real_time_factor": str(factor),
        "x": str(1.5 * index),
    }
    inner = "".join(f'<arg name="{name}" value="{value}"/>' for name, value in arguments.items())
    file = "$(find franka_sim_mujoco)/launch/panda.launch"
    return f'<group ns="arm_{index}"><include file="{file}">{inner}</include></group>'


# A camera at its maximum rate; then its pictures in a number of wall seconds are counted.
COUNT_PICTURES = """
import sys, time
import rospy
import rospy_connections
from franka_sim_mujoco.srv import SpawnObject
from geometry_msgs.msg import Point, Pose, Quaternion
from sensor_msgs.msg import Image
rospy_connections.init_node("viewer")
size, seconds = sys.argv[1].split("x"), float(sys.argv[2])
eye = f'''<sdf version='1.6'><model name='eye'><static>true</static><link name='link'>
<sensor name='cam' type='camera'><update_rate>1000</update_rate><camera><horizontal_fov>1.0</horizontal_fov>
<image><width>{size[0]}</width><height>{size[1]}</height></image></camera></sensor></link></model></sdf>'''
spawn = rospy.ServiceProxy("/gazebo/spawn_object", SpawnObject)
answer = spawn("eye", eye, Pose(Point(-2.5, 0, 0.6), Quaternion(0, 0, 0, 1)))
assert answer.success, answer.error
times = []
rospy.Subscriber("/gazebo/eye/link/cam/image_raw", Image, lambda image: times.append(time.monotonic()),
                 buff_size=2**24)
begin = time.monotonic()
while len(times) < 3 and time.monotonic() < begin + 60:
    time.sleep(0.1)
time.sleep(seconds)
print((len(times) - 1) / (times[-1] - times[0]))
"""


def cameras() -> None:
    print("Cameras (rendered without a GPU where there is none)")
    for size, goal in (("320x240", 25), ("640x480", None)):
        with (
            tempfile.TemporaryDirectory() as folder,
            simulation(Path(folder), "stone.xml", "x:=-0.5") as session,
        ):
            wait_running(session, CONTROLLER)
            counted = session.run("/usr/bin/python3", "-c", COUNT_PICTURES, size, "10", timeout=120)
            figure(
                f"{size}: pictures a second beside the running robot",
                float(counted.stdout),
                "Hz",
                goal,
                at_least=True,
            )


def memory() -> None:
    print("Memory of the simulation's process")
    with (
        tempfile.TemporaryDirectory() as folder,
        simulation(Path(folder), "stone.xml", "x:=-0.5", "real_time_factor:=0") as session,
    ):
        wait_running(session, CONTROLLER)
        before = resident(session, SIMULATION)
        figure("resident before the first picture", before, "MB", 150)
        begin = simulated_seconds(session)
        wait_simulated(session, begin + 30)  # threads, publishers and buffers exist then
        settled = resident(session, SIMULATION)
        wait_simulated(session, begin + 630)
        figure("growth over 10 simulated minutes", resident(session, SIMULATION) - settled, "MB", 1)


def simulated_seconds(session: Session) -> float:
    text = session.run("rostopic", "echo", "-n1", "-p", "/clock/clock", timeout=30).stdout
    return float(text.split()[-1].split(",")[-1]) / 1e9


def wait_simulated(session: Session, until: float, timeout: float = 200.0) -> None:
    """Runs the simulation as fast as possible until its clock has passed a time [s]."""
    deadline = time.monotonic() + timeout
    while simulated_seconds(session) < until:
        if time.monotonic() > deadline:
            raise RuntimeError(f"the simulation did not reach {until:.0f} s within {timeout:.0f} s")
        time.sleep(0.5)


def start() -> None:
    print("Start")
    with tempfile.TemporaryDirectory() as folder:
        begin = time.monotonic()
        with simulation(Path(folder), "empty.xml") as session:
            wait_running(session, CONTROLLER)
            figure("roslaunch to the first controller running", time.monotonic() - begin, "s", 2.5)

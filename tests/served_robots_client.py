# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Clients of served robots in a ROS world, and their operator; prints a report as JSON.

Run by test_served_robots.py with the interpreter that ROS uses. Clients use fci_wire: each of their cycles is
a call, so that services act between two cycles.
"""

import json
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent / "support"))

import rospy  # noqa: E402
import rospy_connections  # noqa: E402
from fci_session import go_first  # noqa: E402
from fci_wire import IDLE, JOINT_IMPEDANCE, JOINT_POSITION, MOVE, REFLEX, Client, command  # noqa: E402
from franka_msgs.srv import SetLoad  # noqa: E402
from franka_sim_mujoco.srv import (  # noqa: E402
    DeleteRobot,
    GetJointStates,
    GetServedRobot,
    SetPacketDelay,
    SetPacketLoss,
    SpawnRobot,
)
from geometry_msgs.msg import Point, Pose, Quaternion  # noqa: E402
from sensor_msgs.msg import JointState  # noqa: E402
from std_srvs.srv import Empty, SetBool, Trigger  # noqa: E402

WAIT = 60.0  # wall seconds, for any start
ROBOTS = {"panda": ("127.0.31.1", 5), "fr3": ("127.0.31.2", 10)}


def call(name, kind, *arguments):
    rospy.wait_for_service(name, WAIT)
    return rospy.ServiceProxy(name, kind)(*arguments)


def at(x, y, z):
    return Pose(Point(x, y, z), Quaternion(0, 0, 0, 1))


class Operator:
    """The operator of a robot."""

    def __init__(self, robot):
        self._services = f"/{robot}/franka_sim/"

    def does(self, name, kind, *arguments):
        answer = call(self._services + name, kind, *arguments)
        return [answer.success, getattr(answer, "error", "") or getattr(answer, "message", "")]

    def sees(self):
        return call(self._services + "get_state", GetServedRobot)


class Motion:
    """A client's joint motion, cycle by cycle."""

    def __init__(self, client):
        self.client, self.state = client, client.start(JOINT_IMPEDANCE, JOINT_POSITION)
        self.first = self.state.joints("q_d")

    def run(self, ticks, joint=3, by=0.0, finish=True):
        """Moves one joint by `by` [rad] within a number of cycles. @returns the last state."""
        for k in range(1, ticks + 1):
            if self.state.mode != MOVE:
                break
            x = k / ticks
            q = list(self.first)
            q[joint] += by * x**3 * (10 - 15 * x + 6 * x * x)
            self.client.send(
                command(self.client.version, self.state.message_id, q, finished=finish and k == ticks)
            )
            self.state = self.client.state()
        return self.state

    def during(self, action, *arguments):
        """Result of the operator's action; holds the arm meanwhile, however long that takes."""
        with ThreadPoolExecutor(1) as operator:
            result = operator.submit(action, *arguments)
            while not result.done() and self.state.mode == MOVE:
                self.run(1, finish=False)
            return result.result()

    def end(self):
        """End of the motion as reported: status of the reply, mode, reasons."""
        status = self.client.reply()[1][0]
        self.state = self.client.state_until(lambda state: state.mode != MOVE)
        return {"status": status, "mode": self.state.mode, "reasons": self.state.reasons}


def moves(client):
    """A motion, as the client and ROS report it."""
    begin = rospy.get_time()
    motion = Motion(client)
    motion.run(1000, by=0.1)
    outcome = motion.end()
    outcome["moved"] = client.state_until(at_rest).joints("q")[3] - motion.first[3]
    deadline = time.monotonic() + WAIT
    while rospy.get_time() < begin + 1.0 and time.monotonic() < deadline:
        time.sleep(0.01)
    outcome["clock"] = rospy.get_time() - begin
    return outcome


def at_rest(state):
    return max(map(abs, state.joints("dq"))) < 1e-6


def shown_by_ros(robot, client):
    """Joint positions from the client and from the world."""
    joints = [f"{robot}_joint{i}" for i in range(1, 8)]
    seen = call("/gazebo/get_joint_states", GetJointStates, joints).state.position
    while client.state(0.5).mode != IDLE:  # old states wait in the socket
        pass
    return max(abs(a - b) for a, b in zip(seen, Operator(robot).sees().q))


def stopped(client, operator):
    """The user stop during a motion, its release, and another motion."""
    motion = Motion(client)
    motion.run(100, finish=False)
    pressed = motion.during(operator.does, "set_user_stop", SetBool, True)
    motion.run(1000, finish=False)
    outcome = {"pressed": pressed, **motion.end()}
    outcome["shown"] = operator.sees().text.split(",")[0]
    outcome["released"] = operator.does("set_user_stop", SetBool, False)
    client.state_until(lambda state: state.mode == IDLE)
    motion = Motion(client)
    motion.run(200)
    outcome["again"] = motion.end()["status"]
    return outcome


def with_lost_commands(client, operator, count):
    """The link loses a number of consecutive commands."""
    motion = Motion(client)
    motion.run(150, finish=False)
    assert motion.during(operator.does, "set_packet_loss", SetPacketLoss, 0.0, 0, count)[0]
    rate = motion.run(200, finish=False).rate
    motion.run(1)
    outcome = {**motion.end(), "rate": rate}
    if outcome["mode"] == REFLEX:
        outcome["errors"] = operator.sees().errors
        outcome["recovered"] = client.recover().mode
    return outcome


def configured(client, operator):
    """Answers of setters at rest, in a motion, and for invalid values."""
    nothing = [0.0] * 9
    outcome = {"load": operator.does("set_load", SetLoad, 0.5, [0, 0, 0.1], nothing)}
    outcome["bad_load"] = operator.does("set_load", SetLoad, -1.0, [0, 0, 0], nothing)
    outcome["bad_loss"] = operator.does("set_packet_loss", SetPacketLoss, 1.5, 0, 0)
    outcome["bad_delay"] = operator.does("set_packet_delay", SetPacketDelay, 21)
    outcome["delay"] = operator.does("set_packet_delay", SetPacketDelay, 1)
    motion = Motion(client)
    motion.run(100, finish=False)
    outcome["load_in_motion"] = motion.during(operator.does, "set_load", SetLoad, 0.0, [0, 0, 0], nothing)
    reset = motion.during(call, "/gazebo/reset", Trigger)
    outcome["reset_in_motion"] = [reset.success, reset.message]
    motion.run(100)
    outcome["ended"] = motion.end()["status"]
    operator.does("set_packet_delay", SetPacketDelay, 0)
    outcome["no_load"] = operator.does("set_load", SetLoad, 0.0, [0, 0, 0], nothing)
    for switch in ("guiding", "brakes"):
        assert operator.does(f"set_{switch}", SetBool, True)[0]
        outcome[switch] = operator.sees().text.split(",")[0]
        assert operator.does(f"set_{switch}", SetBool, False)[0]
        outcome["after " + switch] = operator.sees().text.split(",")[0]
    return outcome


def paused(client):
    """A motion pauses with the world for longer than a client's timeout, then continues."""
    motion = Motion(client)
    motion.run(100, finish=False)
    motion.during(call, "/gazebo/pause_physics", Empty)
    newest = motion.state.message_id
    end = time.monotonic() + 1.5
    repeated = longest = 0
    while time.monotonic() < end:
        asked = time.monotonic()
        motion.state = client.state()
        longest = max(longest, time.monotonic() - asked)
        repeated += motion.state.message_id == newest
        newest = motion.state.message_id
    motion.during(call, "/gazebo/unpause_physics", Empty)
    motion.run(100)
    return {**motion.end(), "repeated": repeated, "longest": longest}


def check_robot(robot, report):
    address, version = ROBOTS[robot]
    operator = Operator(robot)
    report["idle"] = operator.sees().text.split(", q")[0]
    with Client(address, version) as client:
        report["connect"] = client.connect()
        report["protocol"] = operator.sees().protocol
        report["move"] = moves(client)
        report["ros"] = shown_by_ros(robot, client)
        report["stop"] = stopped(client, operator)
        report["lose 10"] = with_lost_commands(client, operator, 10)
        report["lose 20"] = with_lost_commands(client, operator, 20)
        report["configured"] = configured(client, operator)
        report["halted"] = paused(client)
    reset = call("/gazebo/reset", Trigger)
    report["reset"] = reset.success
    report["after_reset"] = list(operator.sees().q)


def check_inside():
    """Controllers in the simulation move the robot without an address, beside the others."""
    state = rospy.wait_for_message("/inside/franka_state_controller/joint_states", JointState, WAIT)
    return len(state.position)


def check_refusals():
    """An address in use is refused; a deleted robot frees its address."""
    urdf = rospy.get_param("/panda/simulated_robot_description").replace('"panda_', '"late_')
    rospy.set_param("/late/arm_id", "late")
    rospy.set_param("/late/fci_ip", ROBOTS["panda"][0])
    order = ("late", urdf, "late", at(0, -3, 0), [], [])
    report = {}
    answer = call("/gazebo/spawn_robot", SpawnRobot, *order)
    report["taken"] = [answer.success, answer.error]
    rospy.set_param("/late/fci_ip", "127.0.31.9")
    answer = call("/gazebo/spawn_robot", SpawnRobot, *order)
    report["spawned"] = [answer.success, answer.error]
    with Client("127.0.31.9", 5) as client:
        report["connect"] = client.connect()
        report["deleted"] = call("/gazebo/delete_robot", DeleteRobot, "late").success
        report["ended"] = client.ended()
    return report


def main():
    rospy_connections.init_node("served_robots_client")
    go_first()
    report = {robot: {} for robot in ROBOTS}
    report["inside"] = check_inside()
    for robot in ROBOTS:
        check_robot(robot, report[robot])
    report["refusals"] = check_refusals()
    print(json.dumps(report))


main()

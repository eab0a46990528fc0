# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Robots of a ROS world that are served over the FCI, each with its address, beside one that is not.

Clients use fci_wire: each of their cycles is a call, so that services act between two cycles.
"""

import select
from concurrent.futures import ThreadPoolExecutor, wait
from pathlib import Path

import pytest
import rospy
from fci_motion import begin, drive, hold
from fci_wire import (
    COMMUNICATION,
    IDLE,
    JOINT_IMPEDANCE,
    JOINT_POSITION,
    LAYOUTS,
    MOVE,
    REFLEX,
    START,
    STOP,
    Client,
    move_request,
)
from franka_msgs.srv import SetLoad
from franka_sim_mujoco.srv import (
    DeleteObject,
    DeleteRobot,
    GetJointStates,
    GetServedRobot,
    RestoreSnapshot,
    SetJointStates,
    SetPacketDelay,
    SetPacketLoss,
    SpawnObject,
    SpawnRobot,
    TakeSnapshot,
)
from geometry_msgs.msg import Point, Pose, Quaternion
from ros_client import call, latest, launched
from sensor_msgs.msg import JointState
from std_srvs.srv import Empty, SetBool, Trigger
from waiting import wait_for

HERE = Path(__file__).resolve().parent

WAIT = 60.0  # wall seconds, for any start
ROBOTS = {"panda": ("127.0.31.1", 5), "fr3": ("127.0.31.2", 10)}  # addresses and protocols
READY = [0, -0.785398163, 0, -2.35619449, 0, 1.57079632679, 0.785398163397]
USER_STOPPED = 5
SUCCESS, MOTION_STARTED, PREEMPTED = 0, 1, 2  # statuses of replies
OK = (True, "")
NOTHING = [0.0] * 9  # as an inertia
BALL = "<body name='ball'><freejoint/><geom type='sphere' size='0.05' mass='0.3'/></body>"

pytestmark = pytest.mark.own_process


@pytest.fixture(scope="module", autouse=True)
def world(tmp_path_factory):
    log = tmp_path_factory.mktemp("served") / "launch.log"
    with launched(str(HERE / "data" / "served_robots.launch"), log=log):
        wait_for(lambda: rospy.get_time() > 0, "The world is paused until its last robot is spawned", WAIT)
        yield


fr3 = pytest.mark.parametrize("robot", ["fr3"], indirect=True)


@pytest.fixture
def robot(request):
    """The Panda, unless a mark says otherwise."""
    return getattr(request, "param", "panda")


@pytest.fixture
def operator(robot):
    """The operator of a robot that is as the launch has left it."""
    operator = Operator(robot)
    for switch in ("user_stop", "guiding", "brakes"):
        operator.does(f"set_{switch}", SetBool, False)
    return operator


@pytest.fixture
def client(robot, operator):
    address, version = ROBOTS[robot]
    with Client(address, version) as client:
        assert client.connect() == (0, version)
        # The motion of a client that has gone may still end.
        if client.state_until(lambda state: state.mode != MOVE).mode == REFLEX:
            client.recover()
        yield client


def at(x, y, z):
    return Pose(Point(x, y, z), Quaternion(0, 0, 0, 1))


class Operator:
    """The operator of a robot."""

    def __init__(self, robot):
        self._services = f"/{robot}/franka_sim/"

    def does(self, name, kind, *arguments):
        answer = call(self._services + name, kind, *arguments)
        return answer.success, getattr(answer, "error", "") or getattr(answer, "message", "")

    def sees(self):
        return call(self._services + "get_state", GetServedRobot)


class Motion:
    """A client's joint motion, cycle by cycle."""

    def __init__(self, client):
        self.client = client
        self.state, self.first = begin(client)

    def run(self, ticks, joint=3, by=0.0, finish=True):
        """Moves one joint by `by` [rad] within a number of cycles. @returns the last state."""

        def positions(k):
            x = (k + 1) / ticks
            q = list(self.first)
            q[joint] += by * x**3 * (10 - 15 * x + 6 * x * x)
            return q

        for state in drive(self.client, self.state, positions, ticks, finish):
            self.state = state
        return self.state

    def turn_until(self, action, *arguments, joint=0, speed=0.25):
        """Turns a joint with a constant speed [rad/s], and calls the action at that speed.

        @returns its result
        """
        q, result, ramp = list(self.first), None, 0.5
        with ThreadPoolExecutor(1) as operator:
            for k in range(1, 8000):
                s = min(1e-3 * k / ramp, 1.0)
                way = ramp * s**4 * (2.5 - 3 * s + s * s) + max(1e-3 * k - ramp, 0.0)
                q[joint] = self.first[joint] + speed * way
                (self.state,) = drive(self.client, self.state, hold(q), 1)
                if s == 1.0 and result is None:
                    result = operator.submit(action, *arguments)
                if result is not None and wait({result}, timeout=0.01).done:
                    break
            return result.result()

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


@pytest.mark.parametrize("robot", ROBOTS, indirect=True)
def test_a_client_finds_its_robot(robot, operator):
    address, version = ROBOTS[robot]
    alone = "Idle, no client, errors none"
    wait_for(lambda: operator.sees().text.split(", q")[0] == alone, alone, WAIT)
    with Client(address, version) as client:
        assert client.connect() == (0, version)
        assert operator.sees().protocol == version


def at_rest(state):
    return max(map(abs, state.joints("dq"))) < 1e-6


@fr3
def test_the_robot_moves_in_simulated_time(robot, operator, client):
    begin = rospy.get_time()
    motion = Motion(client)
    motion.run(1000, by=0.1)
    end = motion.end()
    assert (end["status"], end["mode"]) == (0, IDLE)
    moved = client.state_until(at_rest).joints("q")[3] - motion.first[3]
    assert moved == pytest.approx(0.1, abs=1e-3)
    wait_for(lambda: rospy.get_time() >= begin + 1.0, "A second of /clock", WAIT)
    # Read one after the other, while the arm still settles.
    joints = [f"{robot}_joint{i}" for i in range(1, 8)]
    seen = call("/gazebo/get_joint_states", GetJointStates, joints).state.position
    assert seen == pytest.approx(operator.sees().q, abs=1e-6)


def test_the_user_stop_ends_its_motion(robot, operator, client):
    motion = Motion(client)
    motion.run(100, finish=False)
    assert motion.during(operator.does, "set_user_stop", SetBool, True) == OK
    motion.run(1000, finish=False)
    end = motion.end()
    assert end["mode"] == USER_STOPPED and operator.sees().text.split(",")[0] == "User stopped"
    reflex = LAYOUTS[ROBOTS[robot][1]].reflex
    assert end["status"] not in (0, reflex), "That is not an abort by the user stop."
    assert operator.does("set_user_stop", SetBool, False) == OK
    client.state_until(lambda state: state.mode == IDLE)
    motion = Motion(client)
    motion.run(200)
    assert motion.end()["status"] == 0


def test_twenty_lost_commands_end_the_motion(robot, operator, client):
    motion = Motion(client)
    motion.run(150, finish=False)
    assert motion.during(operator.does, "set_packet_loss", SetPacketLoss, 0.0, 0, 20)[0]
    motion.run(200, finish=False)
    end = motion.end()
    assert end["mode"] == REFLEX and end["reasons"] == [COMMUNICATION]
    assert end["status"] == LAYOUTS[ROBOTS[robot][1]].reflex
    assert operator.sees().errors == ["communication_constraints_violation"]
    assert client.recover().mode == IDLE


def test_setters_work_at_rest_and_report_refusals(operator, client):
    assert operator.does("set_load", SetLoad, 0.5, [0, 0, 0.1], NOTHING) == OK
    assert "load was refused" in operator.does("set_load", SetLoad, -1.0, [0, 0, 0], NOTHING)[1]
    assert "The probability" in operator.does("set_packet_loss", SetPacketLoss, 1.5, 0, 0)[1]
    assert "from 0 to 20" in operator.does("set_packet_delay", SetPacketDelay, 21)[1]
    assert operator.does("set_packet_delay", SetPacketDelay, 1) == OK
    motion = Motion(client)
    motion.run(100, finish=False)
    in_motion = motion.during(operator.does, "set_load", SetLoad, 0.0, [0, 0, 0], NOTHING)
    reset = motion.during(call, "/gazebo/reset", Trigger)
    motion.run(100)
    assert motion.end()["status"] == 0
    assert "load was refused" in in_motion[1]
    assert not reset.success and "over the FCI" in reset.message
    assert operator.does("set_packet_delay", SetPacketDelay, 0) == OK
    assert operator.does("set_load", SetLoad, 0.0, [0, 0, 0], NOTHING) == OK


@pytest.mark.parametrize(
    ("robot", "switch", "mode"),
    [("panda", "guiding", "Guiding"), ("fr3", "brakes", "Other")],
    indirect=["robot"],
)
def test_a_switch_of_the_robot_changes_its_mode(operator, client, switch, mode):
    assert operator.does(f"set_{switch}", SetBool, True)[0]
    assert operator.sees().text.split(",")[0] == mode
    assert operator.does(f"set_{switch}", SetBool, False)[0]
    assert operator.sees().text.split(",")[0] == "Idle"


@fr3
def test_a_paused_world_pauses_its_motions(client):
    """A motion pauses with the world, and then continues. Meanwhile the client gets the same state again."""
    motion = Motion(client)
    motion.run(100, finish=False)
    motion.during(call, "/gazebo/pause_physics", Empty)
    newest = motion.state.message_id
    repeated = 0
    while repeated < 20:
        motion.state = client.state()
        repeated += motion.state.message_id == newest
        newest = motion.state.message_id
    motion.during(call, "/gazebo/unpause_physics", Empty)
    motion.run(100)
    end = motion.end()
    assert (end["status"], end["mode"]) == (0, IDLE)


def test_a_motion_that_is_requested_before_the_first_tick_starts_with_it(client):
    """As in a world that is paused when it is launched."""
    call("/gazebo/pause_physics", Empty)
    assert call("/gazebo/reset", Trigger).success
    client.request(START, move_request(client.version, JOINT_IMPEDANCE, JOINT_POSITION))
    states = [client.state() for _ in range(20)]
    assert not select.select([client.tcp], [], [], 0)[0] and states[-1].mode == IDLE
    call("/gazebo/unpause_physics", Empty)
    assert client.reply()[1][0] == MOTION_STARTED
    client.state_until(lambda state: state.mode == MOVE)


def test_objects_come_and_go_during_a_motion(client):
    motion = Motion(client)
    motion.run(100, finish=False)
    assert motion.during(call, "/gazebo/spawn_object", SpawnObject, "ball", BALL, at(2, 2, 1)).success
    assert motion.during(call, "/gazebo/delete_object", DeleteObject, "ball").success
    motion.run(100)
    end = motion.end()
    assert (end["status"], end["mode"]) == (0, IDLE)


def overtake(robot, service):
    """Puts the arm elsewhere. @returns where it then is"""
    if service == "reset":
        assert call("/gazebo/reset", Trigger).success
        return READY
    if service == "restore_snapshot":
        assert call("/gazebo/restore_snapshot", RestoreSnapshot, "ready").success
        return READY
    elsewhere = [0.2, -0.5, 0.1, -2.0, -0.1, 1.6, 0.4]
    joints = [f"{robot}_joint{i}" for i in range(1, 8)]
    assert call("/gazebo/set_joint_states", SetJointStates, joints, elsewhere, []).success
    return elsewhere


@pytest.mark.parametrize(
    ("robot", "service"),
    [("panda", "reset"), ("fr3", "restore_snapshot"), ("panda", "set_joint_states")],
    indirect=["robot"],
)
def test_a_service_that_overtakes_a_braking_arm_leaves_no_request_unanswered(
    robot, operator, client, service
):
    assert call("/gazebo/reset", Trigger).success
    assert call("/gazebo/take_snapshot", TakeSnapshot, "ready").success
    motion = Motion(client)
    motion.turn_until(call, "/gazebo/pause_physics", Empty)
    assert abs(motion.state.joints("dq")[0]) > 0.1, "The arm does not move."
    # In a paused world the arm brakes until the test says otherwise.
    stop = client.request(STOP)
    client.state_until(lambda state: state.mode == IDLE)
    place = overtake(robot, service)
    statuses = [reply[0] for _, reply in sorted([client.reply(), client.reply()])]
    assert statuses == [PREEMPTED, SUCCESS], f"Move and request {stop}, StopMove"
    call("/gazebo/unpause_physics", Empty)
    # Nothing of the braking remains.
    seen = operator.sees()
    assert (seen.text.split(",")[0], seen.errors) == ("Idle", [])
    assert list(seen.q) == pytest.approx(place, abs=1e-3)
    motion = Motion(client)
    motion.run(200, by=0.02)
    assert motion.end()["status"] == SUCCESS
    assert client.state_until(at_rest).joints("q") == pytest.approx(
        [q + 0.02 * (i == 3) for i, q in enumerate(place)], abs=2e-3
    )


def test_a_robot_without_an_address_is_controlled_in_the_simulation():
    """Controllers in the simulation move it, beside the others."""
    state = latest("/inside/franka_state_controller/joint_states", JointState, WAIT)
    assert len(state.position) == 7


def test_each_address_belongs_to_one_robot():
    """An address in use is refused; a deleted robot frees its address."""
    urdf = rospy.get_param("/panda/simulated_robot_description").replace('"panda_', '"late_')
    rospy.set_param("/late/arm_id", "late")
    rospy.set_param("/late/fci_ip", ROBOTS["panda"][0])
    order = ("late", urdf, "late", at(0, -3, 0), [], [])
    answer = call("/gazebo/spawn_robot", SpawnRobot, *order)
    assert not answer.success and "Another simulated robot runs there" in answer.error
    rospy.set_param("/late/fci_ip", "127.0.31.9")
    answer = call("/gazebo/spawn_robot", SpawnRobot, *order)
    assert (answer.success, answer.error) == OK
    with Client("127.0.31.9", 5) as client:
        assert client.connect() == (0, 5)
        assert call("/gazebo/delete_robot", DeleteRobot, "late").success
        assert client.ended()

# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""An hour of simulated work of an arm under ros_control, as fast as possible. That memory and threads do not
grow in the gate, test_cell_properties.py checks."""

import random
import xmlrpc.client
from pathlib import Path

import pytest
import rosgraph
import rospy
from actionlib_msgs.msg import GoalStatus
from fci_session import descriptors_of, memory_of
from franka_msgs.msg import ErrorRecoveryAction, ErrorRecoveryGoal, FrankaState
from franka_sim_mujoco.pick_and_place import Gripper, TaskError
from franka_sim_mujoco.srv import PushBody, Step
from geometry_msgs.msg import Point, Vector3
from ros_client import Action, Controllers, call, launched
from rosgraph_msgs.msg import Log
from std_srvs.srv import Empty, Trigger
from waiting import wait_for

HERE = Path(__file__).resolve().parent
FROM_START = ["cartesian_pose", "elbow", "joint_impedance"]  # controllers that need the start pose
CHAIN = [
    "joint_velocity",
    "cartesian_impedance",
    "joint_position",
    "cartesian_velocity",
]  # from wherever it is
ROUNDS = 1000  # a round is one switch and one gripper goal
ROUND = 3.6  # [s] at least: an hour are a thousand
REFLEX_EVERY = 10  # rounds
PUSH, PUSH_TICKS = 40.0, 100  # [N], [ms]
LIMIT = 60.0  # wall seconds for any wait
AFTER_RESET = 200  # ticks
SETTLING = 10  # rounds: all connections are open once the first reflex has been recovered from

pytestmark = [
    pytest.mark.own_process,
    pytest.mark.timeout(1800),
    pytest.mark.long_form("takes 5 to 15 minutes"),
]


def full(name):
    return f"{name}_example_controller"


class Soak:
    def __init__(self):
        self.log, self.state = [], None
        self.controllers = Controllers()
        self.controllers.wait_for("franka_state_controller", "franka_gripper")
        self.controllers.load(*map(full, FROM_START + CHAIN))
        rospy.Subscriber("/franka_state_controller/franka_states", FrankaState, self._store, queue_size=1)
        rospy.Subscriber("/rosout_agg", Log, self._hear)
        self.gripper = Gripper()
        self.gripper.wait_ready()
        self._recovery = Action("/franka_control/error_recovery", ErrorRecoveryAction)
        wait_for(lambda: self.state is not None, "The first state")
        self.running = None
        self.switches = self.goals = self.reflexes = self.resets = 0
        self.hashes = set()
        uri = rosgraph.Master("/soak").lookupNode("/gazebo")
        self._pid = xmlrpc.client.ServerProxy(uri).getPid("/soak")[2]

    def _store(self, state):
        self.state = state

    def _hear(self, line):
        if line.level >= Log.WARN and line.name == "/gazebo":
            self.log.append(line.msg)

    def footprint(self):
        """Memory of the simulation [MB] and its open files."""
        return memory_of(self._pid), descriptors_of(self._pid)

    def clock_offset(self):
        """ROS time minus the duration of all ticks [ms]: must be constant."""
        now = call("/gazebo/step", Step, 0)
        return round(now.time.to_nsec() / 1e6) - now.tick

    def switch_to(self, name):
        stop = [self.running] if self.running else []
        start = [name] if name else []
        if not self.controllers.switches(start, stop):
            raise TaskError(f"The switch from {self.running} to {name} was refused.")
        self.running = name
        self.switches += 1

    def grip(self, width, speed):
        self.gripper.move(width, speed)
        self.goals += 1

    def _in_mode(self, mode):
        asked = call("/gazebo/step", Step, 0).time
        wait_for(lambda: self.state.header.stamp > asked and self.state.robot_mode == mode, f"Mode {mode}")

    def meet_an_obstacle(self):
        """A push that ends the motion; then recovery, after which the controller continues."""
        self._in_mode(FrankaState.ROBOT_MODE_MOVE)
        x, y, z = self.state.O_T_EE[12:15]
        far = Point(x - 0.5, y + 2.0, z)  # a lever
        call(
            "/gazebo/push_body", PushBody, "panda_hand", Vector3(0, PUSH, 0), Vector3(), True, far, PUSH_TICKS
        )
        self._in_mode(FrankaState.ROBOT_MODE_REFLEX)
        status, text = self._recovery.run(ErrorRecoveryGoal(), LIMIT)
        if status != GoalStatus.SUCCEEDED:
            raise TaskError(f"The recovery failed: {text}")
        self._in_mode(FrankaState.ROBOT_MODE_MOVE)
        self.reflexes += 1

    def reset(self):
        """Resets the world; afterwards the same tick gives bit-identical states."""
        self.switch_to(None)
        call("/gazebo/pause_physics", Empty)
        answer = call("/gazebo/reset", Trigger)
        if not answer.success:
            raise TaskError(f"The reset was refused: {answer.message}")
        self.hashes.add(call("/gazebo/step", Step, AFTER_RESET).state_hash)
        call("/gazebo/unpause_physics", Empty)
        self.resets += 1

    def round(self, number, chance):
        begin = rospy.get_time()
        block, part = divmod(number, 1 + len(CHAIN))
        if part < 2:
            self.reset()
        self.switch_to(full(CHAIN[part - 1] if part else FROM_START[block % len(FROM_START)]))
        self.grip(chance.uniform(0.0, 0.08), chance.uniform(0.05, 0.1))
        if number % REFLEX_EVERY == REFLEX_EVERY - 1:
            self.meet_an_obstacle()
        wait_for(lambda: rospy.get_time() - begin >= ROUND, "The end of the round")


@pytest.fixture(scope="module")
def soak(tmp_path_factory):
    log = tmp_path_factory.mktemp("soak") / "launch.log"
    with launched(str(HERE / "data" / "simulation_soak.launch"), log=log):
        yield Soak()


def test_one_hour_of_work_leaks_nothing(soak):
    chance, footprints = random.Random(1), []
    offset, begin = soak.clock_offset(), rospy.get_time()
    for number in range(ROUNDS):
        try:
            soak.round(number, chance)
        except TaskError as error:
            raise TaskError(f"Round {number}: {error} The log: {soak.log[-5:]}") from error
        footprints.append(soak.footprint())
    assert soak.goals == ROUNDS and soak.switches >= ROUNDS
    assert soak.resets == ROUNDS / 5 * 2 and soak.reflexes == ROUNDS / 10
    assert rospy.get_time() - begin >= ROUND * ROUNDS
    assert len(soak.hashes) == 1, "Worlds that were reset differ."
    assert soak.clock_offset() == offset, "[ms] between the clock and the ticks."
    memory, files = zip(*footprints[SETTLING:])
    assert memory[-1] - memory[0] < 0.5, f"{memory[0]:.1f} MB have grown to {memory[-1]:.1f} MB."
    assert max(files) == min(files)

# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Runs switches, gripper goals, reflexes and resets on a simulated arm; prints a report as JSON.

Run by test_simulation_soak.py with the interpreter that ROS uses. Argument: rounds. A round is one switch and
one gripper goal, and lasts ROUND simulated seconds at least.
"""

import json
import math
import os
import random
import sys
import time
import xmlrpc.client
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent / "support"))

import rosgraph  # noqa: E402
import rospy  # noqa: E402
import rospy_connections  # noqa: E402
from actionlib import ActionClient, CommState  # noqa: E402
from actionlib_msgs.msg import GoalStatus  # noqa: E402
from controller_manager_msgs.srv import (  # noqa: E402
    ListControllers,
    LoadController,
    SwitchController,
)
from fci_session import memory_of  # noqa: E402
from franka_msgs.msg import ErrorRecoveryAction, ErrorRecoveryGoal, FrankaState  # noqa: E402
from franka_sim_mujoco.pick_and_place import Gripper, TaskError, wait_until  # noqa: E402
from franka_sim_mujoco.srv import PushBody, Step  # noqa: E402
from geometry_msgs.msg import Point, Vector3  # noqa: E402
from rosgraph_msgs.msg import Log  # noqa: E402
from std_srvs.srv import Empty, Trigger  # noqa: E402

FROM_START = ["cartesian_pose", "elbow", "joint_impedance"]  # controllers that need the start pose
CHAIN = [
    "joint_velocity",
    "cartesian_impedance",
    "joint_position",
    "cartesian_velocity",
]  # from wherever it is
ROUND = 3.6  # [s]: an hour are a thousand
REFLEX_EVERY = 10  # rounds
STRICT = 2
PUSH, PUSH_TICKS = 40.0, 100  # [N], [ms]
LIMIT = 60.0  # wall seconds for any wait
AFTER_RESET = 200  # ticks


def full(name):
    return f"{name}_example_controller"


def until(condition, what):
    wait_until(condition, what, simulated=math.inf, wall=LIMIT)


class Soak:
    def __init__(self):
        self._calls, self.log, self.state = {}, [], None
        self._controllers_at_hand()
        rospy.Subscriber("/franka_state_controller/franka_states", FrankaState, self._store, queue_size=1)
        rospy.Subscriber("/rosout_agg", Log, self._hear)
        self.gripper = Gripper()
        self.gripper.wait_ready()
        self._recovery = ActionClient("/franka_control/error_recovery", ErrorRecoveryAction)
        until(lambda: self._recovery.wait_for_server(rospy.Duration(0.05)), "error_recovery")
        until(lambda: self.state is not None, "the first state")
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

    def call(self, name, kind, *arguments):
        if name not in self._calls:
            rospy.wait_for_service(name, LIMIT)
            self._calls[name] = rospy.ServiceProxy(name, kind, persistent=True)
        return self._calls[name](*arguments)

    def _controllers_at_hand(self):
        def state_controller_runs():
            listed = self.call("/controller_manager/list_controllers", ListControllers).controller
            return {"franka_state_controller", "franka_gripper"} <= {
                c.name for c in listed if c.state == "running"
            }

        until(state_controller_runs, "franka_state_controller and franka_gripper")
        for name in map(full, FROM_START + CHAIN):
            if not self.call("/controller_manager/load_controller", LoadController, name).ok:
                raise TaskError(f"{name} was not loaded.")

    def footprint(self):
        """Memory of the simulation [MB] and its open files."""
        return memory_of(self._pid), len(os.listdir(f"/proc/{self._pid}/fd"))

    def clock_offset(self):
        """ROS time minus the duration of all ticks [ms]: must be constant."""
        now = self.call("/gazebo/step", Step, 0)
        return round(now.time.to_nsec() / 1e6) - now.tick

    def switch_to(self, name):
        stop = [self.running] if self.running else []
        start = [name] if name else []
        answer = self.call(
            "/controller_manager/switch_controller", SwitchController, start, stop, STRICT, False, 20.0
        )
        if not answer.ok:
            raise TaskError(f"The switch from {self.running} to {name} was refused.")
        self.running = name
        self.switches += 1

    def grip(self, width, speed):
        self.gripper.move(width, speed)
        self.goals += 1

    def _in_mode(self, mode):
        asked = self.call("/gazebo/step", Step, 0).time
        until(lambda: self.state.header.stamp > asked and self.state.robot_mode == mode, f"mode {mode}")

    def meet_an_obstacle(self):
        """A push that ends the motion; then recovery, after which the controller continues."""
        self._in_mode(FrankaState.ROBOT_MODE_MOVE)
        x, y, z = self.state.O_T_EE[12:15]
        far = Point(x - 0.5, y + 2.0, z)  # a lever
        self.call(
            "/gazebo/push_body", PushBody, "panda_hand", Vector3(0, PUSH, 0), Vector3(), True, far, PUSH_TICKS
        )
        self._in_mode(FrankaState.ROBOT_MODE_REFLEX)
        handle = self._recovery.send_goal(ErrorRecoveryGoal())
        until(lambda: handle.get_comm_state() == CommState.DONE, "the recovery")
        if handle.get_terminal_state() != GoalStatus.SUCCEEDED:
            raise TaskError(f"The recovery failed: {handle.get_goal_status_text()}")
        self._in_mode(FrankaState.ROBOT_MODE_MOVE)
        self.reflexes += 1

    def reset(self):
        """Resets the world; afterwards the same tick gives bit-identical states."""
        self.switch_to(None)
        self.call("/gazebo/pause_physics", Empty)
        answer = self.call("/gazebo/reset", Trigger)
        if not answer.success:
            raise TaskError(f"The reset was refused: {answer.message}")
        self.hashes.add(self.call("/gazebo/step", Step, AFTER_RESET).state_hash)
        self.call("/gazebo/unpause_physics", Empty)
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
        until(lambda: rospy.get_time() - begin >= ROUND, "the end of the round")


def main():
    rounds = int(sys.argv[1])
    rospy_connections.init_node("soak")
    soak, chance = Soak(), random.Random(1)
    offset, begin, wall = soak.clock_offset(), rospy.get_time(), time.monotonic()
    footprints = []
    for number in range(rounds):
        try:
            soak.round(number, chance)
        except TaskError as error:
            raise TaskError(f"Round {number}: {error} The log: {soak.log[-5:]}") from error
        footprints.append(soak.footprint())
    report = {name: getattr(soak, name) for name in ("switches", "goals", "reflexes", "resets", "log")}
    report |= {"footprints": footprints, "hashes": len(soak.hashes), "offset": soak.clock_offset() - offset}
    report |= {"simulated": rospy.get_time() - begin, "wall": time.monotonic() - wall}
    print(json.dumps(report))


if __name__ == "__main__":
    main()

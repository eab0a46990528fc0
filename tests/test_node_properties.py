# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Sequences of steps on the control nodes, whose simulated robots run by themselves.

What a step does not name keeps its mode and motion. A refused call changes nothing. No controller runs
without effect. The states of every arm go on through errors, stops, recoveries and lost connections.
"""

import pytest
import rospy
from actionlib_msgs.msg import GoalStatus
from cell import load_of
from control_msgs.msg import FollowJointTrajectoryAction
from control_nodes import SUCCEEDED, ControlNode, node_of, robots_of
from franka_msgs.srv import SetLoad
from hypothesis import strategies as st
from hypothesis.stateful import initialize
from pyfranka.franka_sim import FrankaSim
from pyfranka.remote import LineRefused
from ros_client import Action, call, outcome, trajectory, trigger
from state_machines import Machine, rule, run
from waiting import holds, wait_for

PATIENCE_FOR_STATES = 10.0  # [s] of the robots' time
CONTROLLER = "effort_joint_trajectory_controller"  # of all joints of all arms
REST, LAST = "all_but_the_last", "the_last"  # controllers of all joints but the last arm's, and of these
SETUPS = [("panda", 1), ("panda", 2), ("fr3", 3)]  # robot, number of arms
STOPS = {"panda": ["user_stop", "input x4"], "fr3": ["user_stop", "input x33"]}  # sources of the stop
SIDES = st.integers(0, 2)  # of an arm; modulo their number
SEQUENCES = {1: 3, 2: 6, 3: 4}  # by the number of arms


class NodeMachine(Machine):
    """Steps on franka_control_node with one arm, on franka_combined_control_node with several.

    All arms wait while one has an error of its own, because one controller moves them.
    """

    node: ControlNode = None
    robot = ""
    goals: Action = None
    goals_of_rest: Action = None
    lost: set[str] = set()  # arms without a connection, also from the sequence before

    @initialize()
    def start(self):
        arms = self.node.arms
        self.unsure = set()  # lost in an error: whether it is in error afterwards depends on the moment
        self.stay = set()  # lost, or started in an error: they do not go on by themselves before a recovery
        for arm in arms:
            for source in STOPS[self.robot]:
                arm.operator.send(f"{source} off")
            arm.operator.wait(lambda state: state.mode != "User stopped")
        if self.lost:  # a robot with a joint beyond its limits takes no connection; the others wait
            wait_for(self.is_reset, "The end of the others' motion")
        self.connect_all()
        if CONTROLLER in self.node.controllers.running():
            self.node.controllers.stop(CONTROLLER)
        self.node.recover()
        self.node.wait_until_all_are("idle")
        arms[0].operator.reset()
        self.node.controllers.start(CONTROLLER)
        self.runs = True
        self.pressed = {arm.name: set() for arm in arms}
        self.failed, self.needy = set(), set()  # a motion was aborted; only the robot is in error
        self.check()

    def is_reset(self) -> bool:
        try:
            self.node.arms[0].operator.reset()
        except LineRefused:
            return False
        return True

    def is_off(self) -> bool:
        """franka_control_node without its robot has no loop, and so no states, recovery and switches."""
        return self.node.alone and bool(self.lost)

    def waits(self) -> bool:
        return bool(self.lost | self.unsure | self.failed | self.needy)

    def arm(self, side: int):
        return self.node.arms[side % len(self.node.arms)]

    def check(self) -> None:
        """What holds after each step, as soon as it has been noticed."""
        arms = self.node.arms
        for arm in arms:
            mode = arm.operator.state().mode
            stopped = mode in ("User stopped", "Other")
            assert stopped == bool(self.pressed[arm.name]), f"{arm.name}: {mode}, {self.pressed[arm.name]}"
        self.check_that_states_go_on()
        assert (CONTROLLER in self.node.controllers.running()) == self.runs
        if self.lost | self.unsure:
            return
        error = bool(self.failed)
        if error or not self.needy:
            wait_for(lambda: all(arm.has_error == error for arm in arms), f"The error of all arms: {error}")
        if not error and not self.needy:
            self.node.wait_until_all_are("moving" if self.runs else "idle")

    def check_that_states_go_on(self) -> None:
        """Measured in the time of the robots."""
        arms = self.node.arms
        if self.is_off():
            return
        before = [arm.states for arm in arms]
        end = arms[0].operator.time + PATIENCE_FOR_STATES

        def ended():
            return all(arm.states > n + 1 for arm, n in zip(arms, before)) or arms[0].operator.time > end

        assert holds(ended)
        silent = [arm.name for arm, n in zip(arms, before) if arm.states <= n]
        assert not silent, f"The states of {', '.join(silent)} have ended."

    def stops(self, name: str) -> None:
        """An arm stops, which is an error if it moves."""
        moves = self.runs and not self.failed and not self.needy
        if name not in self.failed:
            (self.failed if moves else self.needy).add(name)

    @rule(sides=st.sets(SIDES, min_size=1), recovered=st.none() | SIDES)
    def push(self, sides, recovered):
        """Arms that are not stopped have a reflex, all in their motion; then one arm may be recovered."""
        arms = {self.arm(side) for side in sides}
        arms = [arm for arm in arms if not self.pressed[arm.name] and arm.name not in self.lost]
        for arm in arms:
            arm.push()
        for arm in arms:
            arm.operator.wait(lambda state: state.mode == "Reflex")
            arm.wait_for_end_of_push()
            if len(arms) == 1 or self.failed:
                self.stops(arm.name)
            else:
                self.unsure.add(arm.name)  # the others stop when the first one has failed
        self.check()
        if recovered is not None:
            self.recover(self.arm(recovered))

    @rule(side=SIDES, second=st.booleans(), on=st.booleans())
    def press(self, side, second, on):
        arm, source = self.arm(side), STOPS[self.robot][second]
        stopped = bool(self.pressed[arm.name])
        others = [other for other in self.node.arms if other is not arm]
        before = [other.operator.report() for other in others]
        arm.operator.send(f"{source} {'on' if on else 'off'}")
        if on:
            self.stops(arm.name)
        (self.pressed[arm.name].add if on else self.pressed[arm.name].discard)(source)
        if stopped and not self.pressed[arm.name]:
            mode = arm.operator.wait(lambda state: state.mode != "User stopped").mode
            goes_on = self.node.alone and arm.name not in self.stay
            if goes_on and mode in ("Idle", "Move"):  # franka_control_node goes on by itself
                self.forget_errors({arm.name})
        for other, report in zip(others, before):
            now = other.operator.report()
            assert (now.inputs, now.fci, now.brakes) == (report.inputs, report.fci, report.brakes)
        self.check()

    @rule(side=SIDES)
    def lose(self, side):
        """The robot ends the connection."""
        arm = self.arm(side)
        if arm.name in self.failed | self.needy or self.lost:
            self.unsure.add(arm.name)
        else:
            self.stops(arm.name)
        arm.operator.deactivate_fci()
        self.lost.add(arm.name)
        self.stay.add(arm.name)
        self.check()

    @rule(when=lambda self: self.lost)
    def connect_again(self):
        self.connect_all()
        self.check()

    def connect_all(self) -> None:
        if not self.lost:
            return
        for arm in self.node.arms:
            if arm.name in self.lost:
                arm.operator.activate_fci()
        wait_for(lambda: self.node.trigger("connect")[0], "A connection with all arms")
        self.lost.clear()

    @rule(side=SIDES)
    def recover_one(self, side):
        self.recover(self.arm(side))

    def recover(self, arm) -> None:
        """Not an arm without a connection, which has no such action."""
        if arm.name in self.lost:
            return
        done = arm.recover() == SUCCEEDED
        if self.pressed[arm.name]:
            assert not done or arm.name not in self.failed, "recovered in spite of its stop"
        else:
            assert done, f"{arm.name} was not recovered."
            self.forget_errors({arm.name})
        self.check()

    def forget_errors(self, names: set[str]) -> None:
        for errors in (self.failed, self.needy, self.unsure, self.stay):
            errors -= names

    @rule(when=lambda self: not self.is_off())
    def recover_all(self):
        self.node.recover()
        self.forget_errors({name for name, by in self.pressed.items() if not by} - self.lost)
        self.check()

    @rule(when=lambda self: not self.is_off(), start=st.booleans())
    def switch(self, start):
        names = [CONTROLLER]
        if self.node.controllers.switches(**({"start": names} if start else {"stop": names})):
            self.runs = start
            self.stay |= self.needy if start else set()
        self.check()

    @rule(when=lambda self: not self.waits(), by=st.sampled_from([0.01, -0.01]), refused=st.booleans())
    def send_goal(self, by, refused):
        """Of a trajectory, which succeeds if no arm waits, also if a switch is refused meanwhile."""
        motion = self.goals.send(patient(targets(self.node.arms, by), 0.5 if refused else 0.1))
        if refused and self.runs:
            assert not self.node.controllers.switches(start=["nothing"], stop=[CONTROLLER])
        ended = outcome(motion)
        assert (ended[0] == GoalStatus.SUCCEEDED) == self.runs, ended
        self.check()

    @rule(when=lambda self: not self.node.alone and not self.waits() and not any(self.pressed.values()))
    def switch_refused_by_a_disconnected_arm(self):
        """The motion of the other arms goes on."""
        *others, last = self.node.arms
        switches = self.node.controllers.switches
        assert not self.runs or switches(stop=[CONTROLLER])
        self.node.wait_until_all_are("idle")
        assert trigger(last.service("disconnect"))[0]
        self.lost.add(last.name)
        assert switches(start=[REST])
        wait_for(lambda: all(arm.is_in("moving") for arm in others), "The motion of the others")
        motion = self.goals_of_rest.send(patient(targets(others, 0.01), 0.5))
        assert not switches(start=[LAST], stop=[REST])
        ended = outcome(motion)
        assert ended[0] == GoalStatus.SUCCEEDED, ended
        assert switches(stop=[REST])
        self.connect_all()
        assert not self.runs or switches(start=[CONTROLLER])
        self.check()

    @rule(side=SIDES)
    def refused(self, side):
        assert not self.node.controllers.switches(start=["nothing"])
        arm = self.arm(side)
        if arm.name not in self.lost:
            assert not call(arm.service("set_load"), SetLoad, **load_of(100.0)).success
        wrong = self.goals.run(trajectory({"nobody": 0.1}, 0.1))
        assert wrong[0] == GoalStatus.REJECTED, wrong
        self.check()


def targets(arms, by: float) -> dict[str, float]:
    return {f"{arm.name}_joint{i + 1}": arm.state.q_d[i] + by for arm in arms for i in range(7)}


def patient(goals: dict[str, float], seconds: float):
    """A trajectory that waits until the arms rest: a push before it may still swing them."""
    goal = trajectory(goals, seconds)
    goal.goal_time_tolerance = rospy.Duration(PATIENCE_FOR_STATES)
    return goal


@pytest.fixture(scope="module", params=SETUPS, ids=lambda setup: f"{setup[1]}_{setup[0]}")
def node(request, tmp_path_factory):
    robot, count = request.param
    robots = robots_of(robot, count, realism="ideal")
    with (
        FrankaSim(*robots, pace="patient") as server,
        node_of([server], tmp_path_factory.mktemp("node")),
    ):
        arms = {robot.name: robot.address for robot in server.robots}
        NodeMachine.node, NodeMachine.robot = ControlNode(arms), robot
        controllers = NodeMachine.node.controllers
        joints = [f"{arm}_joint{i}" for arm in arms for i in range(1, 8)]
        gains = {joint: {"p": 600.0, "d": 30.0} for joint in joints}
        names = [CONTROLLER]
        for name, driven in ((REST, joints[:-7]), (LAST, joints[-7:])) if count > 1 else ():
            parameters = {"type": "effort_controllers/JointTrajectoryController", "joints": driven}
            rospy.set_param(f"{controllers.namespace}/{name}", {**parameters, "gains": gains})
            names.append(name)
        controllers.load(*names)
        NodeMachine.goals, NodeMachine.goals_of_rest = [
            Action(f"{controllers.namespace}/{name}/follow_joint_trajectory", FollowJointTrajectoryAction)
            for name in (CONTROLLER, REST if count > 1 else CONTROLLER)
        ]
        yield NodeMachine


@pytest.mark.own_process("node")
def test_steps_on_arms_of_hardware_change_what_they_name(node):
    arms = len(node.node.arms)
    run(node, SEQUENCES[arms], steps=12, seed=arms, shrink=False)


@pytest.mark.own_process("node")
@pytest.mark.long_form("other sequences each time")
def test_random_steps_on_arms_of_hardware(node):
    run(node, sequences=100, steps=20, shrink=False)

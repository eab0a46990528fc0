# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Sequences of steps on cells of several arms, whose controllers run in the simulation's process.

What a step does not name keeps its mode, motion and rate. A refused call changes nothing. No controller runs
without effect, and the states never end. A stop is pressed while any of its sources is.
"""

import pytest
from cell import (
    ARMS,
    GRIPPER,
    MOTIONS,
    MOVE,
    REFLEX,
    START,
    STATE,
    USER_STOPPED,
    controller,
    load_of,
    started_cell,
)
from controller_manager_msgs.srv import LoadController, UnloadController
from franka_sim_mujoco.srv import (
    DeleteObject,
    DeleteRobot,
    PushBody,
    RestoreSnapshot,
    SetBodyPose,
    SetJointStates,
    SpawnObject,
    SpawnRobot,
    TakeSnapshot,
)
from geometry_msgs.msg import Point, Pose, Quaternion, Vector3
from hypothesis import strategies as st
from hypothesis.stateful import initialize, invariant
from ros_client import call
from state_machines import Machine, rule, run

BRAKING = 500  # [ticks] after which an arm rests, and its brakes have opened
SOURCES = ("service", "user_stop", "input x31", "input x32", "input x33")  # of the served robot's stop
SETTLING = 3  # [ticks] after each step, in which its effects show
HORIZON = 900  # [ticks] of the motions without any step
# How far motions without steps may differ [rad, rad/s]: by the last bits of fingers' constraints, whose
# solver couples all robots of a world; and more once a spawn has changed its scales.
SAME, SAME_AFTER_SPAWN = 1e-7, 1e-4
FORMATIONS = (
    {"left": "position", "right": "velocity", "solo": "twist"},
    {"left": "velocity", "right": "pose", "solo": "position"},
    {"left": "torque", "right": "torque", "solo": "velocity"},
    {"left": None, "right": "position", "solo": "torque"},
    {"left": "trajectory", "right": "trajectory", "solo": "trajectory"},
)
SINGULAR = -0.466  # [rad] of joint 4, at which the elbows of both robots are stretched
NAMES = st.sampled_from(list(ARMS))
KINDS = st.sampled_from(list(MOTIONS))
FAR = Pose(position=Point(x=0, y=9, z=1), orientation=Quaternion(w=1))
BOX = (
    "<mujoco><worldbody><body name='{}'><freejoint/><geom type='box' size='.1 .1 .1' mass='1'/></body>"
    "</worldbody></mujoco>"
)


def world(service: str, kind, **fields) -> bool:
    return call(f"/gazebo/{service}", kind, **fields).success


# Requests that are refused, whatever the arm does. Each says whether it succeeded.
OF_ARM = {
    "a place of an unknown joint": lambda c, a: a.place(["nobody"], [0.1]).success,
    "a place beyond a limit": lambda c, a: a.place([a.joints[3]], [9.0]).success,
    "a place with too many positions": lambda c, a: a.place([a.joints[3]], [-2.0, -2.1]).success,
    "a place of nothing": lambda c, a: a.place([], []).success,
    "a load that is too heavy": lambda c, a: a.set_load(**load_of(100.0)).success,
    "a load of no number": lambda c, a: a.set_load(**load_of(float("nan"))).success,
    "a frame that is none": lambda c, a: a.set_EE_frame([0.0] * 16).success,
}
OF_MANAGER = {
    "an unknown controller": lambda c, a: c.switch(a.name, start=["nothing"]),
    "two controllers of one kind of motion": lambda c, a: c.switch(a.name, start=["position", "velocity"]),
    "a stop of an unknown controller": lambda c, a: c.switch(a.name, stop=["nothing"]),
    "a start and an unknown stop": lambda c, a: c.switch(a.name, start=["torque"], stop=["nothing"]),
    "a controller without parameters": lambda c, a: (
        call(f"{a.namespace}/controller_manager/load_controller", LoadController, "nothing").ok
    ),
    "a second controller of a name": lambda c, a: (
        call(
            f"{a.namespace}/controller_manager/load_controller", LoadController, controller(a.name, STATE)
        ).ok
    ),
    "an unload of a running controller": lambda c, a: (
        call(
            f"{a.namespace}/controller_manager/unload_controller", UnloadController, controller(a.name, STATE)
        ).ok
    ),
}
OF_WORLD = {
    "a robot that is there": lambda c, a: world(
        "spawn_robot", SpawnRobot, name="duo", urdf="<robot name='duo'/>"
    ),
    "a robot that is none": lambda c, a: world("spawn_robot", SpawnRobot, name="more", urdf="<robot"),
    "an object that is none": lambda c, a: world("spawn_object", SpawnObject, name="more", xml="<mujoco>"),
    "the end of an unknown robot": lambda c, a: world("delete_robot", DeleteRobot, name="nobody"),
    "the end of an unknown object": lambda c, a: world("delete_object", DeleteObject, name="nothing"),
    "a body's place that it cannot have": lambda c, a: world(
        "set_body_pose", SetBodyPose, body=f"{a.name}_link3", pose=FAR
    ),
    "a push of nothing": lambda c, a: world("push_body", PushBody, body="nothing", ticks=5),
    "joint states of nobody": lambda c, a: world(
        "set_joint_states", SetJointStates, names=[a.joints[0], "nobody"], positions=[0.1, 0.1]
    ),
    "an unknown snapshot": lambda c, a: world("restore_snapshot", RestoreSnapshot, name="never taken"),
}


def some_of(requests: dict):
    return st.lists(st.sampled_from(list(requests)), min_size=1, max_size=4)


class CellMachine(Machine):
    """Steps on the cell. Arms that none has named are on their reference, which is a run without steps."""

    cell = None
    references: dict[int, dict] = {}
    threads = memory = 0

    @initialize(formation=st.integers(0, len(FORMATIONS) - 1))
    def start(self, formation):
        self.kinds = FORMATIONS[formation]
        self.sources = {}
        for source in SOURCES:
            self.press_served(source, False)
        for name, arm in self.cell.arms.items():
            self.bring_home(name, arm)
        self.cell.reset()
        self.cell.step(BRAKING)  # what the last sequence has left in filters and hands
        if formation not in self.references:
            self.cell.reset()
            self.references[formation] = self.record()
        self.reference = self.references[formation]
        self.cell.reset()
        self.running = {
            name: {STATE, GRIPPER} | ({kind} if kind else set()) for name, kind in self.kinds.items()
        }
        self.tolerance = SAME
        self.named, self.stopped, self.apart, self.unrecovered = set(), set(), set(), set()
        self.check_growth()

    def press_served(self, source: str, on: bool) -> None:
        """Presses or releases a stop of the served robot, by its service or by a line."""
        if source == "service":
            assert self.cell.stop_served(on).success
        else:
            self.cell.operator.send(f"{source} {'on' if on else 'off'}")
        self.sources[source.replace("service", "user_stop")] = on

    def bring_home(self, name, arm) -> None:
        """As after the launch, with the controllers of the formation."""
        arm.set_user_stop(False)
        arm.connect()
        running = self.cell.running()[name]
        assert self.cell.switch(name, stop=running & set(MOTIONS))
        self.cell.step(BRAKING)
        self.cell.reset()
        assert self.cell.recover(name)
        arm.set_load(**load_of(0.0))
        kind = self.kinds[name]
        missing = ({STATE, GRIPPER} | ({kind} if kind else set())) - (running - set(MOTIONS))
        assert self.cell.switch(name, start=missing), (name, missing)

    def record(self) -> dict:
        """The positions of each tick without any step."""
        positions = {}
        for _ in range(HORIZON):
            self.cell.step(1)
            positions[self.cell.age] = self.cell.positions()
        return positions

    def check_growth(self) -> None:
        """Both may grow in the first sequences, until all that a process uses has been used once."""
        threads, memory = self.cell.threads, self.cell.memory
        if self.sequences == 10:
            type(self).threads, type(self).memory = threads, memory
        if self.sequences > 10:
            assert threads <= self.threads + 4, "threads grow"
            assert memory <= 2 * self.memory, "memory grows"

    def name(self, arm: str) -> None:
        """The present step may change the motion of this arm."""
        self.named.add(arm)

    @rule(when=lambda self: self.cell.age < HORIZON, ticks=st.sampled_from([1, 5, 30, 100]))
    def step(self, ticks):
        self.cell.step(ticks)

    def check_refused(self, table: dict, requests: list[str], arm: str) -> None:
        """The next ticks of an arm on its reference show whether anything has changed."""
        arm = arm if arm not in self.named else next((a for a in ARMS if a not in self.named), arm)
        for request in requests:
            assert not table[request](self.cell, self.cell.arms[arm]), f"{request} was accepted."
        self.cell.step(3)

    @rule(arm=NAMES, requests=some_of(OF_ARM))
    def refused_by_the_arm(self, arm, requests):
        self.check_refused(OF_ARM, requests, arm)

    @rule(arm=NAMES, requests=some_of(OF_MANAGER))
    def refused_by_the_controller_manager(self, arm, requests):
        self.check_refused(OF_MANAGER, requests, arm)

    @rule(arm=NAMES, requests=some_of(OF_WORLD))
    def refused_by_the_world(self, arm, requests):
        self.check_refused(OF_WORLD, requests, arm)

    @rule(arm=NAMES, start=st.sets(KINDS, max_size=2), stop=st.booleans())
    def switch(self, arm, start, stop):
        """Controllers that run may be stopped with it."""
        stopped = self.running[arm] & set(MOTIONS) if stop else set()
        if self.cell.switch(arm, start, stopped):
            self.running[arm] = (self.running[arm] - stopped) | start
            if start or stopped:
                self.name(arm)
            if start and arm not in self.stopped:
                self.unrecovered.discard(arm)

    @rule(arm=NAMES, kind=st.sampled_from(["twist", "pose"]))
    def switch_at_a_singular_pose(self, arm, kind):
        """To a Cartesian motion, which the arm refuses there: what runs goes on."""
        runs = self.commanded(arm)
        self.put(arm, SINGULAR)
        if runs and not runs & {"twist", "pose"} and arm not in self.stopped | self.apart | self.unrecovered:
            if self.cell.switch(arm, {kind}, runs):  # it has moved away from that pose, and maybe back to it
                self.running[arm] -= runs
                self.running[arm] |= self.cell.running()[arm] & {kind}
            else:
                self.cell.fresh_states()
                mode = self.cell.arms[arm].state.robot_mode
                assert mode in (MOVE, REFLEX), f"{arm} is in mode {mode}, although {runs} run."
        self.put(arm, START[3])

    @rule(arm=NAMES)
    def switch_gripper(self, arm):
        on = GRIPPER not in self.running[arm]
        assert self.cell.switch(arm, [GRIPPER] * on, [GRIPPER] * (not on))
        self.running[arm] ^= {GRIPPER}
        self.name(arm)

    @rule(arm=NAMES, position=st.sampled_from([START[3], -2.0]))
    def place(self, arm, position):
        request = self.cell.arms[arm]
        answer = self.cell.during_steps(lambda: request.place([request.joints[3]], [position]))
        assert answer.success, answer.error
        self.name(arm)

    @rule(arm=NAMES, position=st.sampled_from([START[3], -2.0]))
    def put_by_the_world(self, arm, position):
        """The door that knows joints only."""
        self.put(arm, position)

    def put(self, arm: str, position: float) -> None:
        names = [self.cell.arms[arm].joints[3]]
        assert world("set_joint_states", SetJointStates, names=names, positions=[position])
        self.name(arm)

    @rule(when=lambda self: self.named == set(ARMS))
    def reset_the_world(self):
        """All arms go on from their start: not as at first, because hands and filters keep what they had.
        Only when there is nothing left to compare with a run without steps."""
        self.cell.reset()
        for arm in ARMS:
            self.name(arm)

    @rule(by=st.sampled_from([-1000, 1000]))
    def jump_clock(self, by):
        """A clock of somebody else, then again that of the simulation."""
        self.cell.jump_clock(by)

    @rule(arm=NAMES, right=st.booleans())
    def send_goal(self, arm, right):
        """To the trajectory controller, which may not run."""
        accepted = self.cell.accepts_goal(arm, right)
        assert accepted == (right and "trajectory" in self.running[arm])
        if accepted:
            self.name(arm)

    @rule()
    def spawn_and_delete_a_robot(self):
        self.tolerance = SAME_AFTER_SPAWN
        self.cell.spawn("guest")
        self.cell.step(3)
        assert world("delete_robot", DeleteRobot, name="guest")

    @rule(arm=NAMES, pressed=st.booleans())
    def press_user_stop(self, arm, pressed):
        if pressed != (arm in self.stopped):
            self.name(arm)
            self.unrecovered.add(arm)
        assert self.cell.arms[arm].set_user_stop(pressed).success
        (self.stopped.add if pressed else self.stopped.discard)(arm)

    @rule(arm=NAMES)
    def recover(self, arm):
        recovered = self.cell.recover(arm)
        assert not recovered or arm not in self.stopped
        if recovered:
            self.unrecovered.discard(arm)
            self.name(arm)

    @rule(arm=NAMES, connected=st.booleans())
    def connect(self, arm, connected):
        request = self.cell.arms[arm]
        answer = (request.connect if connected else request.disconnect)()
        possible = (arm in self.apart) if connected else arm not in self.apart and not self.commanded(arm)
        assert answer.success == possible, answer.message
        if answer.success:
            (self.apart.discard if connected else self.apart.add)(arm)
            self.name(arm)

    def commanded(self, arm: str) -> set[str]:
        return self.running[arm] & set(MOTIONS)

    @rule(arm=NAMES, mass=st.sampled_from([0.0, 0.4]))
    def set_load(self, arm, mass):
        if self.cell.arms[arm].set_load(**load_of(mass)).success:
            self.name(arm)

    @rule(arm=NAMES, force=st.sampled_from([1.0, 300.0]))
    def push(self, arm, force):
        assert world("push_body", PushBody, body=f"{arm}_link6", force=Vector3(x=force), ticks=30)
        self.name(arm)

    @rule(presses=st.lists(st.tuples(st.sampled_from(SOURCES), st.booleans()), min_size=1, max_size=5))
    def press_stops_of_the_served_robot(self, presses):
        for source, on in presses:
            self.press_served(source, on)
            mode = self.cell.operator.state().mode
            pressed = [name for name, is_on in self.sources.items() if is_on]
            assert mode == "User stopped" or not pressed, f"{mode}, although these are pressed: {pressed}"

    @rule()
    def take_a_snapshot(self):
        assert world("take_snapshot", TakeSnapshot, name="one")

    @rule()
    def spawn_and_delete_an_object(self):
        self.tolerance = SAME_AFTER_SPAWN
        answer = call("/gazebo/spawn_object", SpawnObject, name="box", xml=BOX.format("box"), pose=FAR)
        assert answer.success, answer.error
        self.cell.step(3)
        assert world("delete_object", DeleteObject, name="box")

    @rule()
    def watch(self):
        """What the states say of each arm."""
        self.cell.fresh_states()
        for name, arm in self.cell.arms.items():
            mode = arm.state.robot_mode
            if mode == REFLEX:
                assert name in self.named, f"{name}: a reflex without a step"
                self.unrecovered.add(name)
            stands = f"{name} is in mode {mode}; {self.running[name]} run"
            assert (mode == USER_STOPPED) == (name in self.stopped), stands
            if not {name} & (self.stopped | self.apart | self.unrecovered):
                assert (mode == MOVE) == bool(self.commanded(name)), stands

    @invariant()
    def all_that_was_not_named_is_as_before(self):
        if not hasattr(self, "reference"):
            return
        self.cell.step(SETTLING)
        assert self.cell.running() == self.running
        expected = self.reference.get(self.cell.age)
        if expected is None:
            return
        for name, positions in self.cell.positions().items():
            if name not in self.named:
                deviation = max(abs(a - b) for a, b in zip(positions, expected[name]))
                assert deviation <= self.tolerance, (
                    f"{name} deviates by {deviation} after {self.cell.age} ticks"
                )


@pytest.fixture(scope="module")
def cell(tmp_path_factory):
    with started_cell(tmp_path_factory.mktemp("cell")) as started:
        CellMachine.cell = started
        yield CellMachine


@pytest.mark.own_process
def test_steps_on_arms_in_the_simulation_change_what_they_name(cell):
    run(cell, sequences=16, steps=15, seed=1)


@pytest.mark.own_process
@pytest.mark.long_form("other sequences each time")
def test_random_steps_on_arms_in_the_simulation(cell):
    run(cell, sequences=1000, steps=40)

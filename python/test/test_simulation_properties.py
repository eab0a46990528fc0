# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Sequences of calls on simulations with one to three robots.

Each robot is compared, bit for bit, with the same robot alone in a world of its own, which gets only those
calls that name the robot or its world and that were accepted. So what a call does not name stays as it is,
and a refused call changes nothing.
"""

import math
import pickle
from dataclasses import dataclass, field

import numpy as np
import pytest
from hypothesis import strategies as st
from hypothesis.stateful import initialize, invariant
from pyfranka import RobotMode, RobotState
from pyfranka.sim import FR3, Gripper, Panda, SimulatedRobot, Simulation
from pyfranka_arguments import HAND, ROBOT, SIMULATION
from sentences import ERRORS, unlike_ours
from state_machines import Machine, rule, run
from wrong_calls import wrong_calls

# The solver of constraints, such as those of fingers, friction and stops, couples all robots of a world in
# the last bits. Robots with fingers and friction stand alone.
SETUPS = {
    "panda": Panda(name="panda"),
    "fr3": FR3(name="fr3", realism="recorded"),
    "left": Panda(name="left", hand=False),
    "middle": FR3(name="middle", base=(0, 2, 0), hand=False),
    "right": Panda(name="right", base=(0, 4, 0, 1.5), hand=False),
}
# A stone falls beside them, without end.
WORLD = (
    "<mujoco><worldbody><body name='stone' pos='0 -3 1'><freejoint/>"
    "<geom size='0.05' mass='1'/></body></worldbody></mujoco>"
)
LINEUPS = (["panda"], ["fr3"], ["left", "middle"], ["left", "middle", "right"])
STOPPED = (RobotMode.UserStopped, RobotMode.Other)
TICKS = st.sampled_from([1, 1, 7, 60, 400])
SIZES = st.sampled_from([0.0, 1e-4, 0.02, -0.02, 0.2, -0.2, 3.0])
INDICES = st.integers(0, 6)


def unit(index: int, count: int = 7) -> np.ndarray:
    return np.eye(count)[index % count]


def shifted(pose: np.ndarray, size: float, index: int) -> np.ndarray:
    """A pose moved along an axis [m], or turned about it [rad]."""
    pose = pose.copy()
    if index % 2:
        pose[:3, 3] += size * unit(index // 2, 3)
        return pose
    c, s = math.cos(size), math.sin(size)
    i, j = [(0, 1), (1, 2), (0, 2)][index // 2 % 3]
    turn = np.eye(3)
    turn[[i, i, j, j], [i, j, i, j]] = c, -s, s, c
    pose[:3, :3] = turn @ pose[:3, :3]
    return pose


def collision(size, index):
    return {
        "lower_torque": 20 + 50 * size * unit(index),
        "upper_torque": [40.0] * 7,
        "lower_force": [20.0] * 6,
        "upper_force": 40 + 5 * size * unit(index, 6),
    }


# Each call by its name: the function, and from the robot's state, a size and an index its arguments.
COMMANDS = {
    "torques": ("command", lambda s, x, i: {"torque": 5 * x * unit(i), "limit_rate": i > 2}),
    "damped torques": (
        "command",
        lambda s, x, i: {"torque": x * unit(i), "limit_rate": True, "damping": [5 * abs(x)] * 7},
    ),
    "joint positions": ("command", lambda s, x, i: {"joint_positions": s.q_d + 1e-3 * x * unit(i)}),
    "joint velocities": (
        "command",
        lambda s, x, i: {
            "joint_velocities": s.dq_d + 1e-2 * x * unit(i),
            "controller": "cartesian_impedance",
        },
    ),
    "a pose": ("command", lambda s, x, i: {"cartesian_pose": shifted(s.O_T_EE_d, 1e-4 * x, i)}),
    "an elbow": (
        "command",
        lambda s, x, i: {"cartesian_velocities": x * 1e-2 * unit(i, 6), "elbow": s.elbow_d},
    ),
    "joint impedance": (
        "joint_impedance",
        lambda s, x, i: {
            "target": s.q_d + x * unit(i),
            "duration": 0.1 * i,
            "stiffness": [100.0 * i + 50] * 7,
            "linear": i > 3,
        },
    ),
    "Cartesian impedance": (
        "cartesian_impedance",
        lambda s, x, i: {
            "target": shifted(s.O_T_EE_d, x, i),
            "duration": 0.1 * i,
            "stiffness": [200.0 * i + 50] * 6,
            "nullspace_stiffness": 2.0 * i,
            "damping": [abs(x)] * 7,
        },
    ),
}
ENDS = {
    "finish": ("finish", lambda s, x, i: {}),
    "recover": ("recover", lambda s, x, i: {}),
    "press or release the stop": ("set_user_stop", lambda s, x, i: {"pressed": i > 3}),
    "close the brakes": ("close_brakes", lambda s, x, i: {}),
    "open the brakes": ("open_brakes", lambda s, x, i: {}),
    "guide": ("set_guiding", lambda s, x, i: {"active": i > 3}),
}
SETTERS = {
    "joint stiffness": ("set_joint_impedance", lambda s, x, i: {"K_theta": [300.0 * i + 500] * 7}),
    "Cartesian stiffness": (
        "set_cartesian_impedance",
        lambda s, x, i: {"K_x": [500.0] * 3 + [20.0 * i + 10] * 3},
    ),
    "collision behavior": ("set_collision_behavior", lambda s, x, i: collision(x, i)),
    "end effector": ("set_EE", lambda s, x, i: {"NE_T_EE": shifted(np.eye(4), x, i)}),
    "stiffness frame": ("set_K", lambda s, x, i: {"EE_T_K": shifted(np.eye(4), x, i)}),
    "load": (
        "set_load",
        lambda s, x, i: {
            "mass": 0.3 * i,
            "F_x_Cload": 0.1 * x * unit(i, 3),
            "load_inertia": np.eye(3) * 1e-3,
        },
    ),
}
HAND_CALLS = {
    "hand: homing": ("gripper.homing", lambda s, x, i: {}),
    "hand: move": ("gripper.move", lambda s, x, i: {"width": 0.01 * i, "speed": 0.1 * abs(x)}),
    "hand: grasp": (
        "gripper.grasp",
        lambda s, x, i: {"width": 0.01 * i, "speed": 0.1, "force": 30 * abs(x), "epsilon_inner": 0.1},
    ),
    "hand: stop": ("gripper.stop", lambda s, x, i: {}),
}
CALLS = {**COMMANDS, **ENDS, **SETTERS, **HAND_CALLS}
# The field of the state that shows what a setter has set.
SHOWN = {"set_EE": ("NE_T_EE", "NE_T_EE"), "set_K": ("EE_T_K", "EE_T_K"), "set_load": ("m_load", "mass")}
# Calls that never succeed, of the classes of a robot, its hand and its simulation.
REFUSED = {
    kind: [*wrong_calls(kind, table, ("__init__", "__getitem__", "close_extras"))]
    for kind, table in ((SimulatedRobot, ROBOT), (Gripper, HAND), (Simulation, SIMULATION))
}
ROUNDING = 1e-6
FIELDS = [name for name, value in vars(RobotState).items() if isinstance(value, property)]
FIELDS = [name for name in FIELDS if isinstance(getattr(RobotState(), name), (float, np.ndarray))]
_cells: dict[tuple[str, ...], "Cell"] = {}


@dataclass
class Pair:
    """A robot among others, and the same robot alone in its world."""

    among: SimulatedRobot
    world: Simulation
    alone: SimulatedRobot = field(init=False)

    def __post_init__(self):
        self.alone = self.world[self.among.name]


class Cell:
    """A simulation of several robots, and one simulation for each of them."""

    def __init__(self, folder, names: tuple[str, ...]):
        world = folder / "world.xml"
        world.write_text(WORLD)
        self.sim = Simulation(world, [SETUPS[name] for name in names])
        self.pairs = {name: Pair(self.sim[name], Simulation(world, [SETUPS[name]])) for name in names}
        self.worlds = [self.sim, *(pair.world for pair in self.pairs.values())]
        self.start = self.snapshot()

    def snapshot(self) -> list:
        return [world.snapshot() for world in self.worlds]

    def restore(self, snapshots: list) -> None:
        for world, snapshot in zip(self.worlds, snapshots):
            world.restore(snapshot)


def call(robot: SimulatedRobot, function: str, arguments: dict):
    owner, _, name = function.rpartition(".")
    return getattr(getattr(robot, owner) if owner else robot, name)(**arguments)


def refusal(function, *arguments):
    """What a call raises, and what it returns."""
    try:
        return None, function(*arguments)
    except ERRORS as error:
        text = str(error.args[0]) if error.args else ""
        assert not unlike_ours(text), text
        return error, None


def condition(robot: SimulatedRobot) -> tuple:
    """All that a robot shows."""
    hand = robot.gripper if robot.setup.hand else None
    fingers = (hand.width, hand.is_grasped, hand.temperature) if hand else ()
    return robot.moving, robot.brakes_closed, robot.state_hash(), fingers, pickle.dumps(robot.state)


def difference(first: SimulatedRobot, second: SimulatedRobot, several: bool) -> str:
    """Where two robots differ. Those of several may differ in the last bits, once an arm has met a stop."""
    one, two = condition(first), condition(second)
    if one == two:
        return ""
    values = [{name: getattr(robot.state, name) for name in FIELDS} for robot in (first, second)]
    fields = [
        name
        for name in FIELDS
        if not np.allclose(*(v[name] for v in values), rtol=0, atol=several * ROUNDING)
    ]
    modes = [
        (r.moving, r.brakes_closed, r.state.robot_mode, str(r.state.current_errors)) for r in (first, second)
    ]
    same = several and not fields and modes[0] == modes[1]
    return "" if same else f"{first.name}: {modes[0]}, alone: {modes[1]}; other values of {fields}"


class CallsMachine(Machine):
    """Calls on a world with robots."""

    folder = None

    @initialize(names=st.sampled_from(LINEUPS))
    def start(self, names):
        key = tuple(names)
        if key not in _cells:
            _cells[key] = Cell(self.folder, key)
        self.cell = _cells[key]
        self.cell.restore(self.cell.start)
        self.names = names
        self.kept = []
        self.forget()

    def teardown(self):
        super().teardown()
        self.kept = []

    def forget(self) -> None:
        """What the sequence knows of the robots, at their start."""
        self.stopped = dict.fromkeys(self.names, False)
        self.closed = dict.fromkeys(self.names, False)
        self.ending = set()
        self.shown = {name: {} for name in self.names}
        self.actions = {name: [] for name in self.names}

    def forget_motions(self) -> None:
        """The same at a reset, which keeps the settings."""
        shown = self.shown
        self.forget()
        self.shown = shown

    def pair(self, index: int) -> tuple[str, Pair]:
        name = self.names[index % len(self.names)]
        return name, self.cell.pairs[name]

    @rule(which=INDICES, name=st.sampled_from(list(CALLS)), size=SIZES, index=INDICES)
    def call(self, which, name, size, index):
        robot, pair = self.pair(which)
        function, arguments = CALLS[name]
        if function.startswith("gripper") and not pair.among.setup.hand:
            return
        arguments = arguments(pair.among.state, size, index)
        error, result = refusal(call, pair.among, function, arguments)
        if error:
            return
        other = call(pair.alone, function, arguments)
        if name in HAND_CALLS:
            self.actions[robot].append((result, other))
        self.note_effect(robot, function, arguments)

    def note_effect(self, robot: str, function: str, arguments: dict) -> None:
        if function == "set_user_stop":
            self.stopped[robot] = bool(arguments["pressed"])
        elif function in ("close_brakes", "open_brakes"):
            self.closed[robot] = function == "close_brakes"
        elif function == "finish":
            self.ending.add(robot)
        elif function in SHOWN:
            shown, argument = SHOWN[function]
            self.shown[robot][shown] = np.array(arguments[argument], dtype=float)
        elif function in ("command", "joint_impedance", "cartesian_impedance"):
            self.ending.discard(robot)

    @rule(which=INDICES, kind=st.sampled_from(list(REFUSED)), index=st.integers(0, 10**6))
    def refused_call(self, which, kind, index):
        _, pair = self.pair(which)
        if kind is Gripper and not pair.among.setup.hand:
            return
        things = {SimulatedRobot: pair.among, Simulation: self.cell.sim}
        before = self.cell.sim.state_hash()
        where, _, _, wrong_call = REFUSED[kind][index % len(REFUSED[kind])]
        error, _ = refusal(wrong_call, things.get(kind) or pair.among.gripper)
        assert error, f"{where} was accepted."
        assert self.cell.sim.state_hash() == before, where

    @rule(ticks=TICKS)
    def step(self, ticks):
        times = {name: round(1e3 * pair.among.state.time) for name, pair in self.cell.pairs.items()}
        for world in self.cell.worlds:
            world.step(ticks)
        for name, pair in self.cell.pairs.items():
            assert round(1e3 * pair.among.state.time) == times[name] + ticks, "each tick has a state"
            self.check_modes(name, pair.among)

    def check_modes(self, name: str, robot: SimulatedRobot) -> None:
        mode = robot.state.robot_mode
        stands = self.stopped[name] or self.closed[name]
        if stands or mode in STOPPED:
            # The brakes take some ticks to open.
            assert mode in STOPPED or not stands, f"{robot}: stop or brakes"
            assert stands or robot.brakes_closed, f"{robot} stands still without a reason"
            assert not (stands and robot.moving), f"{robot} moves although it is stopped"
        assert robot.moving or mode != RobotMode.Move, f"{robot}: a motion of nobody"
        if robot.moving and name not in self.ending:
            assert mode == RobotMode.Move, f"{robot}: a motion without effect"
        for shown, value in self.shown[name].items():
            assert np.allclose(getattr(robot.state, shown), value, rtol=0, atol=1e-12), f"{robot}: {shown}"

    @rule(which=INDICES, link=st.integers(1, 7), force=st.sampled_from([0.5, 30.0, 300.0]), ticks=TICKS)
    def push(self, which, link, force, ticks):
        name, pair = self.pair(which)
        for world in (self.cell.sim, pair.world):
            world.push(f"{name}_link{link}", [0, force, force], ticks=ticks)

    @rule(x=st.floats(0.5, 2.0))
    def place_the_ball(self, x):
        for world in self.cell.worlds:
            world.place_body("stone", [x, -3, 1])

    @rule(which=INDICES, size=SIZES, index=INDICES)
    def reset(self, which, size, index):
        """To a pose of one robot; the others begin at theirs."""
        name, pair = self.pair(which)
        q = pair.among.state.q + size * unit(index)
        error, _ = refusal(lambda: self.cell.sim.reset(q={name: q}, objects={"stone": [1, -3, 1]}))
        if error:
            return
        for robot, other in self.cell.pairs.items():
            other.world.reset(q={name: q} if robot == name else None, objects={"stone": [1, -3, 1]})
        self.forget_motions()

    @rule()
    def take_a_snapshot(self):
        self.kept.append(
            (self.cell.snapshot(), pickle.dumps((self.stopped, self.closed, self.ending, self.shown)))
        )

    @rule(when=lambda self: self.kept, which=INDICES)
    def restore_a_snapshot(self, which):
        snapshots, known = self.kept[which % len(self.kept)]
        self.cell.restore(snapshots)
        self.stopped, self.closed, self.ending, self.shown = pickle.loads(known)

    @invariant()
    def each_robot_is_as_if_it_were_alone(self):
        if not hasattr(self, "cell"):
            return
        for name, pair in self.cell.pairs.items():
            assert not (text := difference(pair.among, pair.alone, len(self.names) > 1)), text
            for one, two in self.actions[name]:
                assert one.outcome == two.outcome, (one, two)
            poses = [np.concatenate(w.body_pose("stone")).tobytes() for w in (self.cell.sim, pair.world)]
            assert poses[0] == poses[1]


@pytest.fixture
def machine(tmp_path):
    _cells.clear()
    CallsMachine.folder = tmp_path
    return CallsMachine


def test_each_robot_is_as_if_alone_and_refused_calls_change_nothing(machine):
    run(machine, sequences=150, steps=40, seed=1)


@pytest.mark.long_form("other sequences each time")
def test_random_sequences(machine):
    run(machine, sequences=2000, steps=60)

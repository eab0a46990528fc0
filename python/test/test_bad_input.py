# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Bad input of each public function of pyfranka.sim and pyfranka.gym: a sentence, and nothing half done."""

import inspect

import numpy as np
import pyfranka.gym
import pyfranka.sim
import pytest
from pyfranka.sim import FR3, KINDS, Gripper, Panda, SimulatedRobot, Simulation, SimulationBatch
from sentences import ERRORS, check_refused_while_another_thread_steps, faults_of
from wrong_calls import (
    EYE,
    INF,
    NAN,
    Kind,
    Table,
    faults_of_arguments,
    functions_with_arguments,
    number,
    numbers,
    pose,
    switch,
    text,
    whole,
    wrong_calls,
)

BASE = (-0.5, 0, 0)  # beside the table of stone.xml
ROBOTS_TAKE_TURNS = True
START = (0, -0.785, 0, -2.356, 0, 1.571, 0.785)  # [rad]
FAR = 1e4  # [m], [N]: beyond what a world takes
QUATERNION_0 = (0, 0, 1, 0, 0, 0, 0)

FLAT = [0.0] * 7
IN_WORLD = Kind({"stone": [0, 0, 1]}, ([1], {3: [0, 0, 1]}, {"brick": [0, 0, 1]}), word="bod")
SEED = whole(1, -1)
TICKS = whole(1, -1)
BODY = text("stone", "nothing")
POSITIONS = Kind(
    START, ("anywhere", [1, 2], [NAN] * 7, ["a"], np.ones(7), {"ur5": "random"}, object()), word=""
)
ROBOTS = Kind(None, (Panda(), "panda", 5, [5], ["ur5"]), word="robot")
WORLD = Kind("stone.xml", ("moon.xml", 5, "<mujoco/>"))

SIMULATION: Table = {
    "__init__": {"world": WORLD, "robots": ROBOTS, "seed": SEED},
    "__getitem__": {"name": Kind("panda", ("ur5", [1], 5), word="robot")},
    "serve": {
        "ip": text("127.0.34.1"),
        "robot": Kind("panda", ("ur5", 5)),
        "pace": text("lockstep", "fast"),
        "patience": Kind(30.0, ("long", 0, -1, NAN, [1])),
        "wait": text("auto", "sleep"),
    },
    "step": {"ticks": TICKS},
    "reset": {"q": POSITIONS, "objects": IN_WORLD, "seed": SEED},
    "restore": {"snapshot": Kind(None, (None, 5, Simulation().snapshot()))},
    "body_pose": {"body": BODY},
    "place_body": {
        "body": Kind("stone", BODY.wrong, unknown=("table",)),
        "position": numbers([0, 0, 1], [0, 0, -FAR]),
        "orientation": numbers([1, 0, 0, 0], [0, 0, 0, 0]),
    },
    "push": {
        "body": BODY,
        "force": numbers([1, 0, 0], [FAR, 0, 0], [0, -1001, 0]),
        "torque": numbers([0, 0, 0], [0, 0, FAR]),
        "ticks": whole(1, 0, -5),
    },
    "render": {
        "camera": text("", "nowhere"),
        "width": whole(64, 0, 5000, 64.0),
        "height": whole(64, -1, 5000),
    },
}

COMMANDED = {"cartesian_velocities": [0.0] * 6}
MOVED = {"joint_positions": FLAT}
TORQUE = {"torque": FLAT}
DURATION = number(0.0, -1.0, INF, 1e7)
DAMPING = numbers(FLAT, [-1.0] * 7)

ROBOT: Table = {
    "command": {
        "torque": numbers(FLAT),
        "joint_positions": numbers(FLAT),
        "joint_velocities": numbers(FLAT, np.zeros((2, 7))),
        "cartesian_pose": pose(),
        "cartesian_velocities": numbers([0.0] * 6),
        "elbow": numbers([0.0, 1.0], given=COMMANDED),
        "controller": text("joint_impedance", "soft", given=MOVED),
        "limit_rate": switch(given=TORQUE),
        "damping": Kind(FLAT, DAMPING.wrong, given=TORQUE),
    },
    "joint_impedance": {
        "target": Kind(START, (*numbers(START).wrong, np.degrees(START), [*START[:6], 3.1]), word=""),
        "duration": DURATION,
        "stiffness": numbers([100.0] * 7, [-1.0] * 7),
        "linear": switch(),
    },
    "cartesian_impedance": {
        "target": pose(np.zeros((4, 4)), EYE + 3 * np.eye(4, k=3)),
        "duration": DURATION,
        "stiffness": numbers([100.0] * 6, [-1.0] * 6),
        "nullspace_stiffness": number(1.0, INF, -1.0),
        "linear": switch(),
        "damping": DAMPING,
    },
    "set_user_stop": {"pressed": switch()},
    "set_guiding": {"active": switch()},
    "set_joint_impedance": {"K_theta": numbers([1000.0] * 7, [1e9] * 7, word="")},
    "set_cartesian_impedance": {"K_x": numbers([100.0] * 6, [-5.0] * 6, word="")},
    "set_collision_behavior": {
        "lower_torque": numbers([1.0] * 7),
        "upper_torque": numbers([1.0] * 7),
        "lower_force": numbers([1.0] * 6),
        "upper_force": numbers([1.0] * 6),
    },
    "set_EE": {"NE_T_EE": pose(2 * EYE)},
    "set_K": {"EE_T_K": pose(2 * EYE)},
    "set_load": {
        "mass": number(0.1, 100.0, -1.0, INF),
        "F_x_Cload": numbers([0.0] * 3, [5.0] * 3, word=""),
        "load_inertia": numbers([0.0] * 9, [-1.0] * 9, word=""),
    },
}

WIDTH, SPEED = number(0.05, INF, 5.0, -0.03), number(0.1, INF, -1, 100)
EPSILON = number(0.005, INF)
GRIPPER: Table = {
    "move": {"width": WIDTH, "speed": SPEED},
    "grasp": {
        "width": WIDTH,
        "speed": SPEED,
        "force": number(10.0, INF, -1, FAR),
        "epsilon_inner": EPSILON,
        "epsilon_outer": EPSILON,
    },
}

LOADS = (5, (1.0,), ("a", (0, 0, 0)), (1.0, (0, 0)), (1.0, (0, 0, 0), [1]), (1, (0, 0, 0), np.ones((9, 1))))
SETUP: Table = {
    "__init__": {
        "name": text("left", "a b"),
        "base": Kind(
            BASE,
            (
                *("a", (1, 2), (NAN, 0, 0), (0, 0, 0, INF)),
                *((-500, 0, 0), (0, 0, 101), (0, 0, 0, 90)),  # millimeters, and degrees
            ),
        ),
        "hand": Kind(True, ("yes", 1, None)),
        "load": Kind(None, LOADS),
        "realism": text("ideal", "reel", word="real"),
        "urdf": Kind("", (5, "/nowhere.urdf", "<robot>" + 2000 * " ")),
        "protocol": whole(0, 2),
        "address": text(""),
        "arguments": Kind((), ("--patience 5", 5)),
    }
}

BATCH: Table = {
    "__init__": {
        "number": whole(2, 0),
        "world": WORLD,
        "robots": ROBOTS,
        "seed": SEED,
        "threads": whole(1, 0),
        "observe": Kind(None, (["panda.color"], "time", 5, [5]), word=""),
    },
    "__getitem__": {"index": Kind(0, (7, "first", 1.5), word="world")},
    "step": {"ticks": TICKS},
    "reset": {"q": POSITIONS, "objects": IN_WORLD, "worlds": Kind([0], ([5], 5, ["a"]), word="world")},
    "replace": {
        "number": Kind(0, (9, "a", 1.5), word="world"),
        "simulation": Kind(None, (None, 5, Simulation(robots=[FR3()])), word=""),
    },
}

# What concerns several arguments: "function" -> a part of the sentence -> the call of an object.
TOGETHER = {
    Simulation: {
        "__init__": {
            "Two robots have the name 'a'": lambda x: Simulation(
                robots=[Panda("a"), FR3("a", base=(0, 1, 0))]
            ),
            "protocol of panda is for robots on": lambda x: Simulation(robots=[Panda(protocol=5)]),
            "vacuum gripper is served on the network": lambda x: Simulation(robots=[Panda(hand="vacuum")]),
            "10 kg": lambda x: Simulation(robots=[Panda(load=(100.0, (0, 0, 0)))]),
        },
        "serve": {"address": lambda x: x.serve("moon")},
        "reset": {
            "Joint 4 of": lambda x: x.reset(q=np.ones(7)),
            "pose of 'stone' must be 3 or 7 finite": lambda x: x.reset(objects={"stone": [0, 0]}),
            "pose of 'stone' must be 3 or 7 finite numbers, not [nan": lambda x: x.reset(
                objects={"stone": [NAN, 0, 0]}
            ),
            "is not free to move": lambda x: x.reset(objects={"table": [0, 0, 1]}),
            "is not a unit quaternion": lambda x: x.reset(objects={"stone": QUATERNION_0}),
            "The position for body 'stone'": lambda x: x.reset(objects={"stone": [FAR, 0, 0]}),
            "seed must be 0 to": lambda x: x.reset(seed=-1, objects={"stone": [0, 0, 1]}),
        },
    },
    SimulatedRobot: {
        "command": {
            "A command is one of": lambda x: x.command(),
            "given: torque, joint_positions": lambda x: x.command(torque=FLAT, joint_positions=FLAT),
            "An elbow goes with": lambda x: x.command(torque=FLAT, elbow=[0, 1]),
            "limit_rate and damping go": lambda x: x.command(joint_positions=FLAT, limit_rate=True),
        },
        "joint_impedance": {
            "Joint 2 of": lambda x: x.joint_impedance(np.degrees(START)),
            "Joint 7 of": lambda x: x.joint_impedance([*START[:6], 3.1]),
        },
        "set_collision_behavior": {
            "outside of what the robot accepts": lambda x: x.set_collision_behavior(
                [-1] * 7, [1] * 7, [1] * 6, [1] * 6
            ),
        },
    },
    SimulationBatch: {
        "replace": {
            "already world 1": lambda x: x.replace(0, x[1]),
            "There is no value 'panda.q'": lambda x: x.replace(0, Simulation(robots=[FR3()])),
        },
        "reset": {"is not a unit quaternion": lambda x: x.reset(objects={"stone": QUATERNION_0})},
    },
}

SIDES = ((0, 10), (1.5, 10), 5)
# Of an environment, and of many.
OPTIONS = {
    "task": text("PickAndPlace", "Cook"),
    "robot": text("panda", "ur5"),
    "control": text("torque", "mind"),
    "observation": text("state", "smell"),
    "reward": text("sparse", "huge"),
    "frequency": number(20.0, 30, 0, INF),
    "realism": text("ideal", "reel", word="real"),
    "randomize": Kind(
        None, (["mass"], {"color": 1}, {"load": 1}, {"load": (2, 1)}, {"realism": 5}), word="randomize"
    ),
    "on_reflex": text("recover", "ignore"),
    "time_limit": Kind("task", ("long", -1, NAN, [1, 2])),
    "camera": text("", "nowhere"),
    "size": Kind((128, 96), SIDES),
    "render_mode": Kind(None, ("ansi", 5)),
    "render_size": Kind((640, 480), SIDES),
}
EPISODE_OPTIONS = {
    "q": Kind(START, ([9.0] * 7, "random"), word=""),
    "object": Kind([0, 0, 1], ([1, 2], QUATERNION_0, [FAR, 0, 0]), word=""),
    "goal": Kind([0, 0, 1], ([NAN] * 3, [0, 0, 2.6])),
}


def environment_cases(kind, shape, **more):
    """Of the options, which a signature does not list."""
    cases = {
        "__init__": {
            "has no option 'hue', 'speed'; its options are robot, control": lambda x: kind(
                task="Reach", **more, hue=1, speed=2
            ),
            "randomize: mass is that of an object": lambda x: kind(
                task="Reach", **more, randomize={"mass": (1, 2)}
            ),
        },
        "reset": {
            "options must be a dict": lambda x: x.reset(options=[1]),
            "not 'color'": lambda x: x.reset(options={"color": 1}),
        },
        "step": {
            "has the shape": lambda x: x.step(np.zeros(3)),
            "finite numbers": lambda x: x.step(np.full(shape, NAN)),
            "array of numbers": lambda x: x.step("left"),
        },
    }
    for option, each in OPTIONS.items():
        for value in each.wrong:
            if value is not None:
                arguments = {"task": "PickAndPlace", **more, option: value}
                cases[f"__init__({option}={value!r})"] = {
                    each.word or option: lambda x, arguments=arguments: kind(**arguments)
                }
    for option, each in EPISODE_OPTIONS.items():
        for value in each.wrong:
            cases[f"reset({option}={value!r})"] = {
                each.word or "": lambda x, options={option: value}: x.reset(seed=3, options=options)
            }
    return cases


TOGETHER[pyfranka.gym.Environment] = environment_cases(pyfranka.gym.Environment, (7,))
TOGETHER[pyfranka.gym.VectorEnvironment] = {
    **environment_cases(pyfranka.gym.VectorEnvironment, (2, 7), num_envs=2),
    "render_mode": {
        "The render_mode of many environments is one of rgb_array": lambda x: pyfranka.gym.VectorEnvironment(
            1, render_mode="human", task="Reach"
        )
    },
    "reset_mask": {"reset_mask needs 2 bools": lambda x: x.reset(options={"reset_mask": [True]})},
}
ACTION = Kind(None, (), word="action")  # see environment_cases
ENVIRONMENT: Table = {
    "__init__": {"task": OPTIONS["task"]},
    "reset": {"seed": SEED, "options": ACTION},
    "step": {"action": ACTION},
    "compute_reward": {
        "achieved_goal": Kind(np.zeros(4), ("near", np.zeros(3)), word="goal"),
        "desired_goal": Kind(np.zeros(4), ("near", np.zeros(3)), word="goal"),
        "info": Kind({"reach": 0.0}),
    },
}
VECTOR: Table = {
    "__init__": {
        "num_envs": whole(1, 0, given={"task": "Reach"}),
        "threads": whole(1, 0, given={"task": "Reach"}),
        "max_episode_steps": Kind(1, (object(), "a", 1.5, NAN, 0, -5), given={"task": "Reach"}),
        "autoreset_mode": Kind("NextStep", ("never",), given={"task": "Reach"}),
    },
    "reset": {"seed": Kind(1, (-1, 1.5, "a", [1, 2, 3], [1, -1])), "options": ACTION},
    "step": {"actions": ACTION},
}


class Thing:
    """What is called wrongly, and what of it must not change."""

    def __init__(self, thing, sims):
        self.thing, self._sims = thing, sims
        self.close = thing.close if hasattr(thing, "close") else lambda: None

    def condition(self):
        return [
            (
                sim.ticks,
                sim.state_hash(),
                [(r.state_hash(), r.moving, r.state.q.tolist()) for r in sim.values()],
            )
            for sim in self._sims
        ]


def in_simulation(get):
    def make(name):
        sim = Simulation("stone.xml", [KINDS[name](name="panda", base=BASE)])
        sim.step(10)
        made = Thing(get(sim), [sim])
        made.close = sim.close
        return made

    return make


def batch_of(name):
    batch = SimulationBatch(2, "stone.xml", [KINDS[name](name="panda", base=BASE)])
    batch.step(10)
    return Thing(batch, list(batch))


def environment_of(name):
    env = pyfranka.gym.Environment("PickAndPlace", robot=name)
    env.reset(seed=1)
    return Thing(env, [env.simulation])


def vector_of(name):
    env = pyfranka.gym.VectorEnvironment(2, task="PickAndPlace", robot=name)
    env.reset(seed=1)
    return Thing(env, [episode.sim for episode in env.episodes])


# The class, how one is made, and its cases.
CLASSES = {
    Simulation: (in_simulation(lambda sim: sim), SIMULATION),
    SimulatedRobot: (in_simulation(lambda sim: sim["panda"]), ROBOT),
    Gripper: (in_simulation(lambda sim: sim["panda"].gripper), GRIPPER),
    Panda: (lambda name: Thing(Panda, []), SETUP),
    FR3: (lambda name: Thing(FR3, []), SETUP),
    SimulationBatch: (batch_of, BATCH),
    pyfranka.gym.Environment: (environment_of, ENVIRONMENT),
    pyfranka.gym.VectorEnvironment: (vector_of, VECTOR),
}


@pytest.mark.parametrize("kind", CLASSES, ids=lambda kind: kind.__name__)
def test_each_public_function_is_in_the_table(kind):
    # close() calls the first one; a simulation makes its robots, and they their hands.
    own = {"close_extras"} | ({"__init__"} if kind in (SimulatedRobot, Gripper) else set())
    assert set(CLASSES[kind][1]) >= functions_with_arguments(kind) - own


@pytest.mark.parametrize("kind", CLASSES, ids=lambda kind: kind.__name__)
def test_bad_input_is_refused_with_a_sentence_and_changes_nothing(kind, name):
    make, table = CLASSES[kind]
    used = make(name)
    wrong = faults_of_arguments(kind, table, used.thing, used.condition)
    before = used.condition()
    wrong += faults_of(TOGETHER.get(kind, {}), used.thing, kind.__name__)
    if used.condition() != before:
        wrong.append("The calls with several arguments have changed something.")
    used.close()
    assert not wrong, "\n".join(wrong)


# Right in themselves, and refused while the arm moves.
REFUSED_IN_MOTION = [
    lambda x: x.set_joint_impedance([1000.0] * 7),
    lambda x: x.set_cartesian_impedance([500.0] * 3 + [50.0] * 3),
    lambda x: x.set_collision_behavior([50.0] * 7, [60.0] * 7, [50.0] * 6, [60.0] * 6),
    lambda x: x.set_EE(np.eye(4)),
    lambda x: x.set_K(np.eye(4)),
    lambda x: x.set_load(0.5, [0, 0, 0.05], 1e-3 * np.eye(3).ravel()),
    lambda x: x.recover(),
    lambda x: x.command(torque=[0.0] * 7),
    lambda x: x.command(cartesian_velocities=[0.0] * 6),
    lambda x: x.joint_impedance([0.0, -0.8, 0.0, -2.4, 0.0, 1.6, 0.8]),
    lambda x: x.cartesian_impedance(x.state.O_T_EE),
]


def test_refused_calls_do_not_disturb_a_motion(name):
    def calls_of(kind):
        together = [call for cases in TOGETHER.get(kind, {}).values() for call in cases.values()]
        return [call for _, _, call in wrong_calls(kind, CLASSES[kind][1])] + together

    def things(sim):
        arm = sim["panda"]
        return (
            (arm, calls_of(SimulatedRobot) + REFUSED_IN_MOTION),
            (arm.gripper, calls_of(Gripper)),
            (sim, calls_of(Simulation)),
        )

    hashes = []
    for disturbed in (False, True):
        with Simulation("stone.xml", [KINDS[name](name="panda", base=BASE)]) as sim:
            arm = sim["panda"]
            arm.command(joint_velocities=[0.0] * 7)
            for tick in range(1, 21):
                arm.command(joint_velocities=[1e-3 * tick] + [0.0] * 6)
                sim.step()
            arm.gripper.move(0.02)
            sim.step(5)
            for thing, calls in things(sim) if disturbed else []:
                for call in calls:
                    with pytest.raises(ERRORS):
                        call(thing)
            sim.step(300)
            assert arm.moving
            hashes.append(sim.state_hash())
    assert hashes[0] == hashes[1]


def test_bad_input_of_an_episode_keeps_its_random_numbers(name):
    """What a wrong reset would have drawn is drawn by the next one."""
    wrong, right = pyfranka.gym.Environment("Push", robot=name), pyfranka.gym.Environment("Push", robot=name)
    for env in (wrong, right):
        env.reset(seed=5)
    for options in ({"object": [FAR, 0, 0]}, {"q": [9.0] * 7}, {"color": 1}):
        with pytest.raises((ValueError, RuntimeError)):
            wrong.reset(seed=9, options=options)
    first, second = wrong.reset()[0], right.reset()[0]
    assert all((first[part] == second[part]).all() for part in first)
    for env in (wrong, right):
        env.close()


MISSING_FILES = {
    "world": lambda file: Simulation(world=file),
    "world of a batch": lambda file: SimulationBatch(2, world=file),
    "urdf of a Panda": lambda file: Panda(urdf=file),
    "urdf of an FR3": lambda file: FR3(urdf=file),
}


@pytest.mark.parametrize("suffix", ["xml", "world", "urdf"])
@pytest.mark.parametrize("call", MISSING_FILES.values(), ids=MISSING_FILES)
def test_a_missing_file_is_named(call, suffix):
    with pytest.raises(FileNotFoundError, match=f"'/nowhere.{suffix}'.*[.]$"):
        call(f"/nowhere.{suffix}")


# ---- closed, and in use by another thread ------------------------------------------------------------------

# What works in any case: names and views.
ALWAYS = {
    Simulation: {"close", "keys", "items", "values"},
    SimulatedRobot: {"name"},
    Gripper: set(),
}
ARGUMENTS = {
    ("Simulation", "serve"): ("127.0.34.2",),
    ("Simulation", "body_pose"): ("stone",),
    ("Simulation", "place_body"): ("stone", (0, 0, 1)),
    ("Simulation", "push"): ("stone", (0, 0, 1)),
    ("SimulatedRobot", "command"): (),
    ("SimulatedRobot", "joint_impedance"): ([0, 0, 0, -1.5, 0, 1.5, 0],),
    ("SimulatedRobot", "cartesian_impedance"): (np.eye(4),),
    ("SimulatedRobot", "set_user_stop"): (True,),
    ("SimulatedRobot", "set_guiding"): (True,),
    ("SimulatedRobot", "set_joint_impedance"): ([1000.0] * 7,),
    ("SimulatedRobot", "set_cartesian_impedance"): ([1000.0] * 6,),
    ("SimulatedRobot", "set_collision_behavior"): ([10.0] * 7, [10.0] * 7, [10.0] * 6, [10.0] * 6),
    ("SimulatedRobot", "set_EE"): (np.eye(4),),
    ("SimulatedRobot", "set_K"): (np.eye(4),),
    ("SimulatedRobot", "set_load"): (0.1, [0, 0, 0], np.zeros(9)),
    ("Gripper", "move"): (0.05,),
    ("Gripper", "grasp"): (0.05, 0.1, 10.0),
}


def calls_of(thing, snapshot):
    """Every public function and attribute of an object, as calls by name."""
    kind = type(thing)
    for name, member in inspect.getmembers(kind):
        if name.startswith("_") or name in ALWAYS[kind]:
            continue
        if isinstance(member, property):
            yield f"{kind.__name__}.{name}", lambda name=name: getattr(thing, name)
        elif inspect.isfunction(member):
            arguments = ARGUMENTS.get((kind.__name__, name), ())
            arguments = (snapshot,) if name == "restore" else arguments
            keywords = {"torque": [0.0] * 7} if name == "command" else {}
            yield (
                f"{kind.__name__}.{name}",
                lambda name=name, a=arguments, k=keywords: getattr(thing, name)(*a, **k),
            )


@pytest.fixture
def sim(name):
    with Simulation("stone.xml", [KINDS[name](base=BASE)]) as simulation:
        yield simulation


def all_calls(sim, name):
    gripper, snapshot = sim[name].gripper, sim.snapshot()
    return [call for thing in (sim, sim[name], gripper) for call in calls_of(thing, snapshot)]


# Made once, then only shown.
CACHED = {"SimulatedRobot.gripper"}
# Views, which another thread's step changes.
VIEWS = {"SimulatedRobot.live_state", "SimulatedRobot.model"}


def test_a_closed_simulation_raises_at_each_call(sim, name):
    calls = all_calls(sim, name)
    called = {called for called, _ in calls}
    assert {f"SimulatedRobot.{each}" for each in ("state_hash", "state", "model", "moving")} <= called
    sim.close()
    for called, call in calls:
        if called not in CACHED:
            with pytest.raises(RuntimeError, match="The simulation is closed"):
                call()
                pytest.fail(called)


def test_while_another_thread_steps_each_call_is_refused(sim, name):
    calls = [(called, call) for called, call in all_calls(sim, name) if called not in CACHED | VIEWS]
    check_refused_while_another_thread_steps(sim, calls)

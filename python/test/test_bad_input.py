# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Bad input of each public function of pyfranka: a sentence with the argument's name, and nothing half done.

The calls are made from the signatures, each with one wrong argument. A function with an argument that has no
kind here fails.
"""

import re
from types import SimpleNamespace

import numpy as np
import pyfranka
import pyfranka.gym
import pyfranka.plot
import pyfranka.sim
import pyfranka.sweeps
import pytest
from pyfranka.franka_sim import FrankaSim
from pyfranka.remote import Remote
from pyfranka.sim import FR3, KINDS, Gripper, Panda, SimulatedRobot, Simulation, SimulationBatch
from pyfranka_arguments import (
    CLIENT,
    FAR,
    FLAT,
    HAND,
    IN_A_WORLD,
    QUATERNION_0,
    ROBOT,
    SIMULATION,
    STATE,
)
from wrong_calls import (
    EYE,
    INF,
    NAN,
    Kind,
    bound,
    faults_of_calls,
    functions_of,
    number,
    numbers,
    text,
    whole,
    wrong_calls,
)

BASE = (-0.5, 0, 0)  # beside the table of stone.xml
ROBOTS_TAKE_TURNS = True
HUGE = 10**400  # no double


def check(calls, thing, condition=lambda: None):
    wrong = faults_of_calls(calls, thing, condition)
    assert not wrong, "\n".join(wrong)


def together(owner, calls):
    """Calls of an object of which only several arguments together are wrong."""
    return [(f"{owner.__name__}, {i}", "", None, call) for i, call in enumerate(calls)]


# ---- simulations -----------------------------------------------------------------------------------------

LOADS = (5, (1.0,), ("a", (0, 0, 0)), (1.0, (0, 0)), (1.0, (0, 0, 0), [1]), (1, (0, 0, 0), np.ones((9, 1))))
BASES = ("a", (1, 2), (NAN, 0, 0), (0, 0, 0, INF))
BASES += ((-500, 0, 0), (0, 0, 101), (0, 0, 0, 90))  # millimeters, and degrees
SETUP = {
    "name": text("left", "a b"),
    "base": Kind(BASE, BASES),
    "hand": Kind(True, ("yes", 1, None)),
    "load": Kind(None, LOADS),
    "realism": text("ideal", "reel", word="real"),
    "urdf": Kind("", (5, "<robot>" + 2000 * " "), unknown=("/nowhere.urdf",)),
    "protocol": whole(0, 2),
    "address": text(""),
    "arguments": Kind((), ("--patience 5", 5)),
}
BATCH = {
    **IN_A_WORLD,
    "number": whole(2, 0),
    "threads": whole(1, 0),
    "observe": Kind(None, unnamed=(["panda.color"], "time", 5, [5])),
    "index": Kind(0, (7, "first", 1.5), word="world"),
    "worlds": Kind([0], ([5], 5, ["a"]), word="world"),
    "replace.number": Kind(0, (9, "a", 1.5), word="world"),
    "simulation": Kind(None, unnamed=(None, 5, Simulation(robots=[FR3()]))),
}
TOGETHER = {
    Simulation: [
        lambda x: Simulation(robots=[Panda("a"), FR3("a", base=(0, 1, 0))]),
        lambda x: Simulation(robots=[Panda(protocol=5)]),
        lambda x: Simulation(robots=[Panda(hand="vacuum")]),
        lambda x: Simulation(robots=[Panda(load=(100.0, (0, 0, 0)))]),
        lambda x: x.serve("moon"),
        lambda x: x.reset(seed=-1, objects={"stone": [0, 0, 1]}),
    ],
    SimulatedRobot: [
        lambda x: x.command(),
        lambda x: x.command(torque=FLAT, joint_positions=FLAT),
        lambda x: x.command(torque=FLAT, elbow=[0, 1]),
        lambda x: x.command(joint_positions=FLAT, limit_rate=True),
        lambda x: x.set_collision_behavior([-1] * 7, [1] * 7, [1] * 6, [1] * 6),
    ],
    SimulationBatch: [lambda x: x.replace(0, x[1])],
}

# ---- environments ----------------------------------------------------------------------------------------

SIDES = ((0, 10), (1.5, 10), 5)
# Keywords of the constructor, which its signature does not list.
OPTIONS = {
    "task": text("PickAndPlace", "Cook"),
    "robot": text("panda", "ur5"),
    "control": text("torque", "mind"),
    "observation": text("state", "smell"),
    "reward": text("sparse", "huge"),
    "frequency": number(20.0, 30, 0, INF),
    "realism": text("ideal", "reel", word="real"),
    "randomize": Kind(None, (["mass"], {"color": 1}, {"load": 1}, {"load": (2, 1)}, {"realism": 5})),
    "on_reflex": text("recover", "ignore"),
    "time_limit": Kind("task", ("long", -1, NAN, [1, 2])),
    "camera": text("", "nowhere"),
    "size": Kind((128, 96), SIDES),
    "render_mode": Kind(None, ("ansi", 5)),
    "render_size": Kind((640, 480), SIDES),
}
EPISODE_OPTIONS = {
    "q": ([9.0] * 7, "random"),
    "object": ([1, 2], QUATERNION_0, [FAR, 0, 0]),
    "goal": ([NAN] * 3, [0, 0, 2.6]),
    "color": (1,),
}


def keyword_calls(kind, shape, **more):
    """Of the options, and of actions, whose shape depends on them."""
    for option, each in OPTIONS.items():
        for value in [*each.wrong, *each.unknown]:
            if value is not None:
                keywords = {"task": "PickAndPlace", **more, option: value}
                word = str(value) if value in each.unknown else each.word or option
                yield f"{option}={value!r}", word, value, lambda x, keywords=keywords: kind(**keywords)
    yield "hue", "'hue'", 1, lambda x: kind(task="Reach", **more, hue=1)
    yield "mass", "object", 1, lambda x: kind(task="Reach", **more, randomize={"mass": (1, 2)})
    for option, wrong in EPISODE_OPTIONS.items():
        for value in wrong:
            options = {option: value}
            yield f"reset({options})", "", value, lambda x, o=options: x.reset(seed=3, options=o)
    yield "options", "options", [1], lambda x: x.reset(options=[1])
    for action in (np.zeros(3), np.full(shape, NAN), "left"):
        yield f"step({action!r})", "action", action, lambda x, action=action: x.step(action)


NO_KINDS = Kind(None)  # see keyword_calls
GOAL = Kind(np.zeros(4), ("near", np.zeros(3)), word="goal")
ENVIRONMENT = {
    "task": OPTIONS["task"],
    "seed": whole(1, -1),
    "options": NO_KINDS,
    "action": NO_KINDS,
    "achieved_goal": GOAL,
    "desired_goal": GOAL,
    "info": Kind({"reach": 0.0}),
}
OF_REACH = {"given": {"task": "Reach"}}
VECTOR = {
    "num_envs": whole(1, 0, **OF_REACH),
    "threads": whole(1, 0, **OF_REACH),
    "max_episode_steps": Kind(1, (object(), "a", 1.5, NAN, 0, -5), **OF_REACH),
    "autoreset_mode": Kind("NextStep", unknown=("never",), **OF_REACH),
    "seed": Kind(1, (-1, 1.5, "a", [1, 2, 3], [1, -1])),
    "options": NO_KINDS,
    "actions": NO_KINDS,
}
TOGETHER[pyfranka.gym.VectorEnvironment] = [
    lambda x: pyfranka.gym.VectorEnvironment(1, render_mode="human", task="Reach"),
    lambda x: x.reset(options={"reset_mask": [True]}),
]


def in_simulation(get):
    def make(name):
        sim = Simulation("stone.xml", [KINDS[name](name="panda", base=BASE)])
        sim.step(10)
        return get(sim), [sim]

    return make


def batch_of(name):
    batch = SimulationBatch(2, "stone.xml", [KINDS[name](name="panda", base=BASE)])
    batch.step(10)
    return batch, list(batch)


def environment_of(name):
    env = pyfranka.gym.Environment("PickAndPlace", robot=name)
    env.reset(seed=1)
    return env, [env.simulation]


def vector_of(name):
    env = pyfranka.gym.VectorEnvironment(2, task="PickAndPlace", robot=name)
    env.reset(seed=1)
    return env, [episode.sim for episode in env.episodes]


# The class, how an object and its simulations are made, and the kinds of its arguments.
CLASSES = {
    Simulation: (in_simulation(lambda sim: sim), SIMULATION),
    SimulatedRobot: (in_simulation(lambda sim: sim["panda"]), ROBOT),
    Gripper: (in_simulation(lambda sim: sim["panda"].gripper), HAND),
    Panda: (lambda name: (Panda, []), SETUP),
    FR3: (lambda name: (FR3, []), SETUP),
    SimulationBatch: (batch_of, BATCH),
    pyfranka.gym.Environment: (environment_of, ENVIRONMENT),
    pyfranka.gym.VectorEnvironment: (vector_of, VECTOR),
}
# close() calls the first one; a simulation makes its robots, and they their hands.
INTERNAL = {SimulatedRobot: ("__init__",), Gripper: ("__init__",)}


def calls_of(kind):
    calls = [*wrong_calls(kind, CLASSES[kind][1], INTERNAL.get(kind, ("close_extras",)))]
    calls += together(kind, TOGETHER.get(kind, ()))
    if kind is pyfranka.gym.Environment:
        calls += keyword_calls(kind, (7,))
    elif kind is pyfranka.gym.VectorEnvironment:
        calls += keyword_calls(kind, (2, 7), num_envs=2)
    return calls


@pytest.mark.parametrize("kind", CLASSES, ids=lambda kind: kind.__name__)
def test_in_this_process(kind, name):
    thing, sims = CLASSES[kind][0](name)

    def condition():
        robots = [(r.state_hash(), r.moving, r.state.q.tolist()) for sim in sims for r in sim.values()]
        return [(sim.ticks, sim.state_hash()) for sim in sims], robots

    check(calls_of(kind), thing, condition)
    for sim in sims:
        sim.close()


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
    "urdf": lambda file: Panda(urdf=file),
}


@pytest.mark.parametrize("suffix", ["xml", "world", "urdf"])
@pytest.mark.parametrize("call", MISSING_FILES.values(), ids=MISSING_FILES)
def test_a_missing_file_is_named(call, suffix):
    with pytest.raises(FileNotFoundError, match=f"'/nowhere.{suffix}'.*[.]$"):
        call(f"/nowhere.{suffix}")


# ---- the control interface -------------------------------------------------------------------------------


def word(right, *unknown) -> Kind:
    """A word of a line."""
    return Kind(right, (object(), 5, None, "", "a b", "stone\nquit", "\t"), unknown=unknown)


def matrix(size) -> Kind:
    return Kind(np.eye(size), (np.eye(7 - size), [[1], [1, 2]], None, np.full((size, size), NAN)))


def row(right) -> Kind:
    return numbers(right, [[1], [2, 3]], np.zeros((1, len(right))))


def count(right, *beyond) -> Kind:
    return Kind(right, (object(), 1.5, NAN, None, "5"), unknown=beyond)


PRESSED = Kind(True, (object(), 1, "on", "yes", None, NAN))
THREE = row([0.0] * 3)
READY = [0.0, -0.7, 0.0, -2.3, 0.0, 1.5, 0.7]
REMOTE = {
    "timeout": Kind(None, ("soon", "5", [], -1, 0, NAN, HUGE, 1j, np.complex64(1))),
    "address": Kind("127.0.0.1", ("", 5, None)),
    "port": Kind(1340, ("1340", 70000, 0, 1.5)),
    "line": Kind("time", (5, b"time", "time\nstate", "where \ud800"), unknown=("dance",)),
    **dict.fromkeys(("pressed", "active", "on", "present"), PRESSED),
    "operating_mode.mode": word("execution", "dance"),
    "guiding_mode.mode": word("user", "dance"),
    "set_input.name": word("x31", "x99"),
    "button.name": word("circle", "square"),
    "mesh.name": word("stone", "nothing"),
    "axes": Kind([True] * 7, (5, [1] * 7)),
    "user": word("desk", "mars"),
    "due": number(5.0, "5", HUGE),
    "error": word("jointPositionError", "nothing"),
    "joint": count(1),
    "target": Kind(READY, (5, None, "", "a b", *row(READY).wrong[2:])),
    "move.speed": number(0.3, "5", HUGE, 100, 0),
    "what": word("brakes", "lunch"),
    "health": Kind("green", word("green").wrong, unnamed=("blue",)),
    "body": word("stone", "nothing"),
    "condition": Kind(None, (5, "Idle")),
    **dict.fromkeys(("mass", "seconds", "probability"), number(0.04, "5", HUGE)),
    "width": number(0.04, "5", HUGE, unnamed=(0.09,)),
    **dict.fromkeys(("speed", "force"), number(0.04, "5", HUGE, unnamed=(-0.1,))),
    **dict.fromkeys(("center", "F_x_Cload", "position", "push.force"), THREE),
    "torque": numbers([0.0] * 3, unnamed=([0, 0, 1e6],)),
    "edges": numbers([1.0] * 3, unnamed=([1, 1, -1],)),
    "orientation": row([1.0, 0.0, 0.0, 0.0]),
    **dict.fromkeys(("inertia", "load_inertia"), matrix(3)),
    "F_T_NE": matrix(4),
    "wall.number": count(1, 9),
    "remove_wall.number": count(1, 8),
    **dict.fromkeys(("seed", "commands", "step.ticks"), count(1, -1)),
    "delay.ticks": Kind(1, count(1).wrong, unnamed=(21,)),
    "ticks": count(1, 2**70),
}


@pytest.fixture(scope="module")
def server(franka_sim_session):
    robots = [
        Panda(base=(-0.5, 0, 0), realism="ideal", hand="vacuum"),
        FR3(name="left", base=(0, 2, 0), realism="ideal"),
    ]
    return franka_sim_session(*robots, world="stone.xml", pace="lockstep")


@pytest.mark.parametrize(("robot", "kept"), [("panda", False), ("left", True)])
def test_of_the_control_interface(server, robot, kept):
    remote = Remote(server[robot].address)
    if kept:
        remote.__enter__()
    check(
        wrong_calls(Remote, REMOTE),
        remote,
        lambda: (remote.report(), remote.state_hash(), remote.poses().tolist(), remote.time),
    )
    remote.close()


@pytest.mark.parametrize(
    "address", ["a..b", "x" * 70, "a\0b", "\ud800", "127.0.32.20", "no.such.host.invalid"]
)
def test_an_address_without_a_robot_is_a_sentence(address):
    with pytest.raises(ConnectionError, match="There is no control interface at"):
        Remote(address).state()


# ---- clients ---------------------------------------------------------------------------------------------

Handler = pyfranka.AsyncPositionControlHandler
# A Panda refuses these before it looks at values.
OF_FR3 = ("start_async_joint_position_control",)


def client_calls(thing, table, without=()):
    """With wrong values, and with an unknown name of an argument."""
    cls = type(thing)
    yield from wrong_calls(cls, table, without)
    for function, (parameters, *_) in functions_of(cls).items():
        if function != "__init__":
            needed = {p.name: table[p.name].right for p in parameters if p.default is p.empty}
            keywords = {**needed, "nothing": 1}
            yield (
                f"{function}(nothing=1)",
                "nothing",
                1,
                lambda x, f=function, k=keywords: getattr(x, f)(**k),
            )


def what_setters_change(robot):
    state = robot.read_once()
    fields = ("robot_mode", "q_d", "NE_T_EE", "EE_T_K", "m_load", "F_x_Cload", "I_load")
    errors = str(state.current_errors), str(state.last_motion_errors)
    return [np.array(getattr(state, field)).tolist() for field in fields], errors


@pytest.fixture(scope="module")
def clients(server, served, robots):
    """An object of each class for each robot; hands have one client at a time."""
    vacuum = pyfranka.VacuumGripper(server["panda"].address)
    return {kind: (robots[kind], served[kind].gripper(), vacuum, robots[kind].load_model()) for kind in KINDS}


@pytest.mark.parametrize("index", range(4), ids=["Robot", "Gripper", "VacuumGripper", "Model"])
def test_of_clients(index, clients, name):
    robot, hand, *_ = clients[name]
    check(
        client_calls(clients[name][index], CLIENT, OF_FR3 if name == "panda" else ()),
        clients[name][index],
        lambda: (what_setters_change(robot), hand.read_once().width),
    )


@pytest.mark.parametrize("kind", ["ArmModel", "ModelKDL"])
def test_other_models_refuse_wrong_arguments_as_the_robots_own_does(kind, robots, name):
    if kind == "ArmModel":
        arm = Simulation(robots=[name])[name]
        thing, table = arm.model, {**CLIENT, "state": bound("state", arm.state)}
    else:
        urdf = robots["fr3"].get_robot_model()
        names = re.findall(r'link name="(\w*link[08])"', urdf)
        thing = pyfranka.ModelKDL(urdf, *names)
        table = CLIENT | {"urdf": text(urdf), "root": text(names[0]), "tip": text(names[1])}
    check(wrong_calls(type(thing), table), thing)
    assert np.isfinite(thing.mass(table["state"].right)).all()


# Values may hold any numbers.
VALUES = {
    **dict.fromkeys((pyfranka.Torques, pyfranka.JointPositions, pyfranka.JointVelocities), FLAT),
    pyfranka.CartesianVelocities: [0.0] * 6,
    pyfranka.CartesianPose: np.eye(4).tolist(),
}
ELBOW = Kind([0.0, 1.0], (object(), "a", [1.0]))
FUNCTIONS = {
    "max_derivatives": Kind(FLAT, (*bound("", FLAT).wrong, 5.0, [-1.0] * 7, [NAN, *FLAT[1:]])),
    "commanded_values": bound("commanded_values", FLAT),
    "last_commanded_values": numbers(FLAT),
    "motion_finished.command": Kind(None, (object(), 5)),
    "elbow": ELBOW,
    "log": Kind([], (object(), "a", [5])),
    "transform": Kind(EYE, (object(), "a", np.eye(3)), word=""),
}


@pytest.mark.parametrize("cls", VALUES, ids=lambda cls: cls.__name__)
def test_of_values(cls):
    right = VALUES[cls]
    values = Kind(right, bound("", right).wrong, word=f"{cls.__name__} needs")
    table = {"values": values, "command": bound("command", cls(right)), "elbow": ELBOW}
    check(wrong_calls(cls, table), cls(right))


def test_of_attributes(robots):
    state = pyfranka.RobotState()
    fields = [name for name, each in vars(pyfranka.RobotState).items() if isinstance(each, property)]
    for owner, names in ((state, fields), (pyfranka.Torques(FLAT), ("tau_J", "motion_finished"))):
        calls = [
            (f"{name} = {wrong!r}", "", wrong, lambda x, n=name, w=wrong, o=owner: setattr(o, n, w))
            for name in names
            for wrong in (object(), "a", [[1.0]])
        ]
        check(calls, owner, lambda owner=owner: str(owner))


def test_of_functions():
    named = ("limit_rate", "motion_finished", "is_valid_elbow", "log_to_csv", "is_homogeneous_transformation")
    functions = SimpleNamespace(**{name: getattr(pyfranka, name) for name in named})
    check(wrong_calls(functions, FUNCTIONS), functions)
    limits = {"version": whole(5, 2), "q": Kind(FLAT, ([1.0],))}
    check(wrong_calls(pyfranka.ArmLimits, limits), pyfranka.ArmLimits(5))


def test_of_an_asynchronous_motion(robots):
    """What is wrong by its type raises; what is wrong by its value is in the result, as in libfranka."""
    fr3 = robots["fr3"]
    before = what_setters_change(fr3)
    right = Handler.Configuration([1.0] * 7)
    configuration = {"goal_tolerance": bound("tolerance", 0.1), "joint_positions": bound("positions", FLAT)}
    for cls in (Handler.Configuration, Handler.JointPositionTarget):
        table = CLIENT | configuration
        names = {name: Kind(each.right, each.wrong[:2], each.word) for name, each in table.items()}
        check(wrong_calls(cls, names), None)
    table = CLIENT | {"robot": bound("robot", fr3), "configuration": bound("configuration", right)}
    table["target"] = bound("target", Handler.JointPositionTarget(FLAT))
    handler = Handler.configure(fr3, right).handler
    check(wrong_calls(Handler, table), handler)
    for wrong in ([1.0] * 3, [NAN] * 7, [-1.0] * 7):
        result = Handler.configure(fr3, Handler.Configuration(wrong))
        assert result.handler is None and result.error_message.endswith("."), wrong
    for robot, tolerance in ((fr3, NAN), (robots["panda"], 0.1)):
        result = Handler.configure(robot, Handler.Configuration([1.0] * 7, tolerance))
        assert result.handler is None and result.error_message.endswith(".")
    for positions in (FLAT[:3], [NAN] * 7):
        result = handler.set_joint_position_target(Handler.JointPositionTarget(positions))
        assert not result.was_successful and result.error_message.endswith("."), positions
    assert handler.get_target_feedback().status == pyfranka.TargetStatus.kIdle
    handler.stop_control()
    target = Handler.JointPositionTarget(fr3.read_once().q.tolist())
    assert "configure a new" in handler.set_joint_position_target(target).error_message
    assert handler.get_target_feedback().status == pyfranka.TargetStatus.kAborted
    assert what_setters_change(fr3) == before


def test_of_an_active_control(robot):
    with robot.start_torque_control() as motion:
        motion.read_once()
        table = {"command": bound("command", pyfranka.Torques(FLAT))}
        table["torques"] = bound("torques", pyfranka.Torques(FLAT))
        check(wrong_calls(type(motion), table), motion)
        motion.write_once(pyfranka.Torques(FLAT))


# ---- programs and plots ----------------------------------------------------------------------------------

FRANKA_SIM = {
    "world": Kind("", (5,), unknown=("moon.xml",)),
    "program": Kind("", (), unknown=("/nowhere",)),
    "pace": Kind("lockstep", unknown=("fast",)),
    "patience": Kind(None, unknown=("long",)),
    "wait": Kind(None, unknown=("sleep",)),
    "linger": Kind(None, unknown=("long",)),
    **dict.fromkeys(("start", "viewer", "desk", "desk_user", "desk_password", "arguments"), Kind(None)),
    "name": Kind("panda", unknown=("ur5",)),
    "since": whole(0, -1),
}


def test_of_franka_sim(server):
    check(wrong_calls(FrankaSim, FRANKA_SIM), server)
    check(together(FrankaSim, [lambda x: FrankaSim(5), lambda x: FrankaSim("ur5")]), server)


def good(case, seed):
    return 0


SWEEP = {
    "function": Kind(good, unnamed=(3,)),
    "cases": Kind(1, (0, True, 1.5, "abc", []), word="cases"),
    "cluster": Kind(None, unnamed=(8786,), unknown=("somewhere", "nowhere.json")),
    **dict.fromkeys(("output", "progress"), Kind(None)),
    "retry_failed": Kind(False),
    "seed": Kind(1, (-1, 1.5, None)),
    "retries": Kind(1, (-1,)),
    "workers": Kind(1, (0,)),
    "patience": Kind(600.0, (NAN, 0)),
    "index": Kind(0, (-1,)),
}


def test_of_sweeps():
    functions = SimpleNamespace(sweep=pyfranka.sweeps.sweep, seed_of=pyfranka.sweeps.seed_of)
    check(wrong_calls(functions, SWEEP), functions)


def recording():
    collector = pyfranka.plot.Collector("robot", 5)
    collector.add(pyfranka.RobotState())
    return collector.recording()


JOINTS = Kind((1,), (3,), word="joint", unnamed=([0], [8]))
SIGNALS = Kind(("q",), ("q",), word="signal", unnamed=(["color"], [5], [], ["q+rpy"]))
PLOT = {
    "recording": Kind(recording(), (5, None)),
    "signals": SIGNALS,
    "plot_abort.signals": Kind((), SIGNALS.wrong, word="signal", unnamed=(["color"], [5], ["q+rpy"])),
    "joints": JOINTS,
    "limits": Kind("auto", unknown=("some",)),
    "title": Kind(""),
    "abort": Kind(None, ("reason",)),
    "error": Kind(None, (ValueError("It moved."),)),
    "version": Kind(5),
    "log": Kind(None, (5, [5]), unnamed=([],)),
    "name": Kind("robot"),
    "text": Kind("", (None, 5)),
    "file": Kind("", (5,), unknown=("/nowhere.csv",)),
    "reason": Kind(None),
    "state": Kind(STATE, (5,)),
    "time": Kind(None),
}


def test_of_plots():
    named = ("plot", "plot_abort", "abort_figure", "of_log", "read_log")
    functions = {name: getattr(pyfranka.plot, name) for name in named}
    functions["of_text"] = lambda text: pyfranka.plot.Abort.of_text(text)
    functions["of_text"].__module__ = "pyfranka"
    functions["add"] = pyfranka.plot.Collector("a").add
    functions = SimpleNamespace(**functions)
    check(wrong_calls(functions, PLOT), functions)
    empty = pyfranka.plot.Recording("empty", np.zeros(1), {})
    calls = [
        lambda x: pyfranka.plot.plot_abort(empty),
        lambda x: pyfranka.plot.Collector("a").recording(),
    ]
    check(together(pyfranka.plot, calls), None)

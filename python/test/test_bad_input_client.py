# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Bad input of the functions of pyfranka's client, FrankaSim and plots: a sentence, and nothing half done."""

import copy
import math
import os
import pickle
import re
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from datetime import timedelta
from functools import partial

import numpy as np
import pyfranka
import pyfranka.plot
import pyfranka.sim
import pytest
import sentences
from pyfranka import Frame, RobotState, Torques
from pyfranka.franka_sim import FrankaSim
from pyfranka.plot import Abort, Collector, Recording, abort_figure, of_log, plot, plot_abort, read_log
from pyfranka.sim import KINDS, Panda
from sentences import ERRORS, faults_of, unlike_ours
from wrong_calls import signatures_of

NAN = math.nan
ROBOTS_TAKE_TURNS = True
STATE = RobotState()
SEVEN = [0.0] * 7


def never_called(*arguments):
    raise AssertionError("The motion has begun.")


# Right values of the client's arguments by their names; calls with wrong ones follow from them.
RIGHT = {
    **dict.fromkeys(("callback", "control_callback", "motion_generator_callback"), never_called),
    "torque_callback": never_called,
    "controller_mode": pyfranka.ControllerMode.JointImpedance,
    "callback_order": pyfranka.CallbackOrder.MotionFirst,
    "first_cycle_reference": pyfranka.FirstCycleReference.Command,
    "limit_rate": True,
    "id": 0,
    **dict.fromkeys(("q", "dq", "K_theta", "maximum_velocities"), [1.0] * 7),
    "K_x": [300.0] * 6,
    "guiding_mode": [True] * 6,
    "elbow": True,
    **dict.fromkeys(("NE_T_EE", "EE_T_K", "F_T_EE"), np.eye(4).tolist()),
    **dict.fromkeys(("mass", "m_total"), 0.1),
    **dict.fromkeys(("F_x_Cload", "F_x_Ctotal"), [0.0] * 3),
    "gravity_earth": [0.0, 0.0, -9.81],
    **dict.fromkeys(("load_inertia", "I_total"), [0.0] * 9),
    "frame": Frame.Flange,
    "state": STATE,
    **dict.fromkeys(("width", "epsilon_inner", "epsilon_outer"), 0.04),
    "speed": 0.1,
    "force": 10.0,
    "vacuum": 5,
    "timeout": timedelta(seconds=1),
    "profile": pyfranka.VacuumGripper.ProductionSetupProfile.P0,
}


def right(name):
    if name.endswith("_frequency"):
        return 100.0
    if name.startswith(("lower_", "upper_")):
        return [20.0] * (7 if "torque" in name else 6)
    return RIGHT[name]


def call(name, keywords, thing):
    return getattr(thing, name)(**keywords)


def of_wrong_type(value):
    return [object(), "a"]


def of_wrong_shape(value):
    return [value[1:], [value] * 2] if isinstance(value, list) else []


def not_a_number(value):
    if isinstance(value, list):
        return [(NAN * np.array(value)).tolist()]
    return [NAN] if isinstance(value, (int, float)) and not isinstance(value, bool) else []


def wrong_calls(cls, make, **others):
    """A table of calls with one wrong value each; the sentences name its argument, by its last word."""
    for name, signatures in signatures_of(cls).items():
        for parameters in signatures:
            keywords = {each.name: right(each.name) for each in parameters}
            keywords |= {each: value for each, value in others.items() if each in keywords}
            for argument, value in keywords.items():
                for wrong in make(value):
                    wrongly = partial(call, name, {**keywords, argument: wrong})
                    yield f"{name}, {argument}={wrong!r}", {argument.rpartition("_")[2]: wrongly}


def required(parameters):
    return {each.name: right(each.name) for each in parameters if each.default is each.empty}


# "function" -> a part of the sentence -> the call; x is an object of the class.
ROBOT = {
    "__init__": {
        "address must be a text": lambda x: pyfranka.Robot(5),
        "realtime_config must be a RealtimeConfig": lambda x: pyfranka.Robot("a", "ignore"),
        "log_size must be a whole number": lambda x: pyfranka.Robot("a", log_size="big"),
        "log_size must be 0 or more, not -1": lambda x: pyfranka.Robot("a", log_size=-1),
        "address: object": lambda x: pyfranka.Robot(),
        "Invoked with: 'a'; kwargs: port": lambda x: pyfranka.Robot("a", port=5),
    },
    "read_once": {"read_once(): incompatible": lambda x: x.read_once(5)},
    "get_virtual_wall": {"id: int": lambda x: x.get_virtual_wall(1.5)},
    "set_collision_behavior": {
        "upper_torque": lambda x: x.set_collision_behavior(SEVEN),
    },
    "set_guiding_mode": {
        "guiding_mode": lambda x: x.set_guiding_mode(["x"] * 6, False),
        "elbow must be True or False": lambda x: x.set_guiding_mode([True] * 6, 3),
    },
    "set_control_options": {
        "callback_order: pyfranka.CallbackOrder": lambda x: x.set_control_options("first"),
    },
    "control_torques": {
        "callback: ": lambda x: x.control_torques(5),
        "limit_rate: bool": lambda x: x.control_torques(never_called, "yes"),
        "The callback returned <class 'list'>": lambda x: x.control_torques(lambda state, period: SEVEN),
    },
    "start_torque_control": {"start_torque_control(): incompatible": lambda x: x.start_torque_control(5)},
    "start_async_joint_position_control": {
        "maximum_velocities: ": lambda x: x.start_async_joint_position_control("fast")
    },
}

GRIPPER = {
    "__init__": {
        "address must be a text": lambda x: pyfranka.Gripper(None),
        "Gripper(address: ": lambda x: pyfranka.Gripper(),
    },
    "move": {"width: ": lambda x: x.move()},
    "homing": {"homing(): incompatible": lambda x: x.homing(5)},
}

VACUUM = {
    "__init__": {"address must be a text": lambda x: pyfranka.VacuumGripper(5)},
    "vacuum": {
        "profile: pyfranka.VacuumGripper.ProductionSetupProfile": (
            lambda x: x.vacuum(5, timedelta(seconds=1), "P0")
        ),
        "vacuum: int": lambda x: x.vacuum(300, timedelta(seconds=1)),
    },
}

MODEL = {
    "mass": {
        "state: pyfranka.RobotState": lambda x: x.mass(5),
        "I_total": lambda x: x.mass(),
    },
    "pose": {"frame: pyfranka.Frame": lambda x: x.pose("flange", STATE)},
}

# Values, and functions of the module.
VALUES = {
    "Torques": {
        "Torques needs 7": lambda x: Torques([1.0]),
        "values": lambda x: Torques(),
        "pyfranka.Torques, arg0: bool": lambda x: setattr(Torques(SEVEN), "motion_finished", "yes"),
    },
    "CartesianPose": {
        "elbow needs 2": lambda x: pyfranka.CartesianPose(np.eye(4), [1]),
        "CartesianPose needs 16": lambda x: pyfranka.CartesianPose(np.eye(3)),
    },
    "RobotState": {
        "q needs 7": lambda x: setattr(RobotState(), "q", [1]),
        "pyfranka.RobotState, arg0: float": lambda x: setattr(RobotState(), "m_ee", "heavy"),
        "pyfranka.RobotState, arg0: pyfranka.RobotMode": lambda x: setattr(RobotState(), "robot_mode", 1),
        "RobotState(": lambda x: RobotState(5),
    },
    "RobotMode": {"value: int": lambda x: pyfranka.RobotMode("Idle")},
    "ArmLimits": {"version must be 3 to": lambda x: pyfranka.ArmLimits(2)},
    "Duration": {"A Duration is made of whole milliseconds": lambda x: pyfranka.Duration("long")},
    "limit_rate": {
        "commanded_values needs 7": lambda x: pyfranka.limit_rate(SEVEN, [1], SEVEN),
        "": lambda x: pyfranka.limit_rate(SEVEN, [NAN] * 7, SEVEN),
    },
    "motion_finished": {"command must be a command such as Torques": lambda x: pyfranka.motion_finished(5)},
    "is_valid_elbow": {"elbow needs 2": lambda x: pyfranka.is_valid_elbow("a")},
    "log_to_csv": {"log: ": lambda x: pyfranka.log_to_csv(5)},
    "configure": {"robot: pyfranka.Robot": lambda x: pyfranka.AsyncPositionControlHandler.configure(5, 6)},
    "method": {"self: pyfranka.Robot": lambda x: pyfranka.Robot.stop(5)},
}

FRANKA_SIM = {
    "__init__": {
        "There is no robot 'ur5'; there are: panda, fr3": lambda x: FrankaSim("ur5"),
        "robots are Panda(...), FR3(...) and their kinds, not 5": lambda x: FrankaSim(5),
        "world must be the name of a file, not 5": lambda x: FrankaSim("panda", world=5),
        "There is no program '/nowhere'": lambda x: FrankaSim("panda", program="/nowhere"),
        "not fast": lambda x: FrankaSim("panda", pace="fast"),
        "'moon.xml'": lambda x: FrankaSim("panda", world="moon.xml"),
        "not long": lambda x: FrankaSim("panda", patience="long"),
    },
    "__getitem__": {"There is no robot 'ur5'": lambda x: x["ur5"]},
    "log": {
        "since must be a whole number": lambda x: x.log("start"),
        "since must be 0 to": lambda x: x.log(-1),
    },
}


def recording():
    collector = Collector("robot", 5)
    collector.add(RobotState())
    return collector.recording()


PLOT = {
    "plot": {
        "recording must be what of_log() or read_log() has returned, not 5": lambda x: plot(5),
        'There is no signal "color"': lambda x: plot(x, ["color"]),
        "signals must be a list of names": lambda x: plot(x, "q"),
        "A signal is a name such as q or q+q_d, not 5": lambda x: plot(x, [5]),
        "limits is one of auto, all, none, not 'some'": lambda x: plot(x, limits="some"),
        "joints must be a list of numbers, not 3": lambda x: plot(x, joints=3),
        "The number of a joint must be 1 to 7, not 0": lambda x: plot(x, joints=[0]),
        "The number of a joint must be 1 to 7, not 8": lambda x: plot(x, joints=[8]),
        "There is no signal to plot": lambda x: plot(x, []),
        "must have one unit and the same joints or axes": lambda x: plot(x, ["q+rpy"]),
    },
    "plot_abort": {
        "recording must be": lambda x: plot_abort(None),
        "There is no signal to plot": lambda x: plot_abort(Recording("empty", np.zeros(1), {})),
        "abort must be an Abort, as Abort.of_text() makes it, not 'reason'": lambda x: plot_abort(
            x, "reason"
        ),
    },
    "abort_figure": {
        "error must be the ControlException of a motion": lambda x: abort_figure(ValueError("It moved.")),
    },
    "of_log": {
        "The exception has no log": lambda x: of_log([]),
        "log must be a list of records, that of a ControlException, not 5": lambda x: of_log(5),
        "log must be a list of records, that of a ControlException, not of 5": lambda x: of_log([5]),
    },
    "Abort": {"text must be a text, not None": lambda x: Abort.of_text(None)},
    "Collector": {
        "state must be a RobotState, not 5": lambda x: Collector("a").add(5),
        "a has no state": lambda x: Collector("a").recording(),
    },
    "read_log": {
        "file must be the name of a file, not 5": lambda x: read_log(5),
        "/nowhere.csv": lambda x: read_log("/nowhere.csv"),
    },
}


def condition(robot):
    """What setters and motions would change."""
    state = robot.read_once()
    return (
        state.robot_mode,
        state.q_d.tolist(),
        state.NE_T_EE.tolist(),
        state.EE_T_K.tolist(),
        state.m_load,
        state.F_x_Cload.tolist(),
        state.I_load.tolist(),
        str(state.current_errors),
        str(state.last_motion_errors),
    )


@pytest.fixture(scope="module")
def server(franka_sim_session):
    return franka_sim_session(Panda(hand="vacuum"))


@pytest.fixture(scope="module")
def things_of_both(server, served, robots):
    """An object of each class for each robot; hands have one client at a time."""
    vacuum = pyfranka.VacuumGripper(server.robot.address)
    objects = {
        kind: (robots[kind], served[kind].gripper(), vacuum, robots[kind].load_model()) for kind in KINDS
    }
    return {kind: {type(each).__name__: each for each in made} for kind, made in objects.items()}


@pytest.fixture
def things(things_of_both, name):
    return things_of_both[name]


# A Panda refuses these before it looks at values.
OF_FR3 = ("start_async_joint_position_control",)
TABLES = {"Robot": ROBOT, "Gripper": GRIPPER, "VacuumGripper": VACUUM, "Model": MODEL}


@pytest.mark.parametrize("kind", TABLES)
def test_wrong_arguments_are_refused_with_a_sentence_and_change_nothing(kind, things, name):
    thing, cls = things[kind], getattr(pyfranka, kind)
    of_fr3 = () if name == "fr3" else OF_FR3
    before = condition(things["Robot"]), things["Gripper"].read_once().width
    wrong = faults_of(TABLES[kind], thing, kind)
    wrong += faults_of(dict(wrong_calls(cls, of_wrong_type)), thing, kind)
    shapes = {
        where: cases for where, cases in wrong_calls(cls, of_wrong_shape) if not where.startswith(of_fr3)
    }
    wrong += faults_of(shapes, thing, kind)
    for function, (parameters, *_) in signatures_of(cls).items():
        unknown = partial(call, function, {**required(parameters), "nothing": 1})
        wrong += faults_of({function: {"nothing": unknown}}, thing, kind)
    for where, cases in wrong_calls(cls, not_a_number):
        (wrongly,) = cases.values()
        wrong += faults_of({where: {"": wrongly}}, thing, kind)
    assert not wrong, "\n".join(wrong)
    assert (condition(things["Robot"]), things["Gripper"].read_once().width) == before


@pytest.mark.parametrize("kind", ["ArmModel", "ModelKDL"])
def test_other_models_refuse_wrong_arguments_as_the_robots_own_does(kind, robots, name):
    if kind == "ArmModel":
        arm = pyfranka.sim.Simulation(robots=[name])[name]
        thing, others = arm.model, {"state": arm.state}
    else:
        urdf = robots["fr3"].get_robot_model()
        thing, others = pyfranka.ModelKDL(urdf, *re.findall(r'link name="(\w*link[08])"', urdf)), {}
    wrong = []
    for make in (of_wrong_type, of_wrong_shape, not_a_number):
        cases = dict(wrong_calls(type(thing), make, **others))
        assert len(cases) > 10
        wrong += faults_of(cases, thing, kind)
    assert not wrong, "\n".join(wrong)
    assert np.isfinite(thing.mass(others.get("state", STATE))).all()


Handler = pyfranka.AsyncPositionControlHandler
ASYNC = {
    "Configuration": {
        "maximum_joint_velocities: ": lambda x: Handler.Configuration("fast"),
        "goal_tolerance: float": lambda x: Handler.Configuration(SEVEN, "near"),
        "kwargs: speed": lambda x: Handler.Configuration(SEVEN, speed=1),
    },
    "JointPositionTarget": {
        "joint_positions: ": lambda x: Handler.JointPositionTarget(5),
        "arg0: ": lambda x: setattr(Handler.JointPositionTarget(SEVEN), "joint_positions", "home"),
    },
    "configure": {
        "robot: pyfranka.Robot": lambda x: Handler.configure(None, Handler.Configuration(SEVEN)),
        "configuration: ": lambda x: Handler.configure(x, SEVEN),
    },
}
NO_CONFIGURATIONS = {
    "wrong shape": Handler.Configuration([1.0] * 3),
    "NaN": Handler.Configuration([NAN] * 7),
    "negative": Handler.Configuration([-1.0] * 7),
    "NaN as the tolerance": Handler.Configuration([1.0] * 7, NAN),
}


def test_bad_input_of_an_asynchronous_motion_is_refused_with_a_sentence(robots):
    """What is wrong by its type raises; what is wrong by its value is in the result, as in libfranka."""
    fr3 = robots["fr3"]
    before = condition(fr3)
    wrong = faults_of(ASYNC, fr3, "AsyncPositionControlHandler")
    for name, configuration in NO_CONFIGURATIONS.items():
        result = Handler.configure(fr3, configuration)
        assert result.handler is None and result.error_message.endswith("."), name
    refused = Handler.configure(robots["panda"], Handler.Configuration([1.0] * 7))
    assert refused.handler is None and refused.error_message.endswith(".")
    assert condition(fr3) == before

    handler = Handler.configure(fr3, Handler.Configuration([1.0] * 7)).handler
    methods = {
        "set_joint_position_target": {"target: ": lambda x: x.set_joint_position_target(SEVEN)},
        "get_target_feedback": {"state: ": lambda x: x.get_target_feedback(5)},
        "stop_control": {"stop_control(): incompatible": lambda x: x.stop_control(5)},
    }
    wrong += faults_of(methods, handler, "AsyncPositionControlHandler")
    for positions in (SEVEN[:3], [NAN] * 7):
        result = handler.set_joint_position_target(Handler.JointPositionTarget(positions))
        assert not result.was_successful and result.error_message.endswith("."), positions
    assert handler.get_target_feedback().status == pyfranka.TargetStatus.kIdle
    handler.stop_control()
    assert not wrong, "\n".join(wrong)
    target = Handler.JointPositionTarget(fr3.read_once().q.tolist())
    assert "configure a new" in handler.set_joint_position_target(target).error_message
    assert handler.get_target_feedback().status == pyfranka.TargetStatus.kAborted
    handler.stop_control()
    assert condition(fr3) == before


def test_bad_input_of_franka_sim_is_refused_with_a_sentence(server):
    wrong = faults_of(FRANKA_SIM, server, "FrankaSim")
    assert not wrong, "\n".join(wrong)


def test_bad_input_of_an_active_control_is_refused_with_a_sentence(robot):
    with robot.start_torque_control() as motion:
        motion.read_once()
        wrong = faults_of(
            {
                "write_once": {
                    "command: pyfranka.Torques": lambda x: x.write_once(SEVEN),
                    "torques: Optional[pyfranka.Torques]": lambda x: x.write_once(
                        pyfranka.JointPositions(SEVEN), 5
                    ),
                }
            },
            motion,
            "ActiveControl",
        )
        motion.write_once(Torques(SEVEN))
    assert not wrong, "\n".join(wrong)
    closed = {
        "read_once": {"This motion has been closed": lambda x: x.read_once()},
        "write_once": {"This motion has been closed": lambda x: x.write_once(Torques(SEVEN))},
    }
    wrong = faults_of(closed, motion, "ActiveControl")
    assert not wrong, "\n".join(wrong)


def test_bad_input_of_values_and_functions_is_refused_with_a_sentence():
    wrong = faults_of(VALUES, None, "pyfranka")
    assert not wrong, "\n".join(wrong)


def test_bad_input_of_plots_is_refused_with_a_sentence():
    wrong = faults_of(PLOT, recording(), "pyfranka.plot")
    assert not wrong, "\n".join(wrong)


# ---- in use by another thread, closed, after a fork --------------------------------------------------------

# Functions that need no answer of the robot, and those that it answers while it moves.
LOCAL = {"get_lower_joint_velocity_limits", "get_upper_joint_velocity_limits", "set_control_options"}
ANSWERED_IN_MOTION = LOCAL | {"load_model", "get_robot_model", "get_virtual_wall", "stop"}


def refusals(thing, without=()):
    """Calls each public function with right arguments: name -> sentence of its refusal, or nothing"""
    found = {}
    for name, (parameters, *_) in signatures_of(type(thing)).items():
        if name not in without:
            try:
                call(name, required(parameters), thing)
                found[name] = ""
            except ERRORS as error:
                found[name] = str(error)
                assert not unlike_ours(str(error)), (name, error)
    return found


def accepted(found):
    return {name for name, sentence in found.items() if not sentence}


def test_while_another_thread_moves_the_robot_other_operations_are_refused(robot):
    moving, ended = threading.Event(), threading.Event()

    def hold(state, period):
        moving.set()
        command = Torques(SEVEN)
        return pyfranka.motion_finished(command) if ended.is_set() else command

    worker = threading.Thread(target=robot.control_torques, args=(hold,))
    worker.start()
    try:
        assert moving.wait(60)
        found = refusals(robot, without={"stop"})  # it would end the motion
        assert LOCAL <= accepted(found) <= ANSWERED_IN_MOTION
    finally:
        ended.set()
        worker.join()


@pytest.mark.parametrize("kind", ["Gripper", "VacuumGripper", "Model"])
def test_two_threads_may_use_one_object(kind, things):
    with ThreadPoolExecutor(2) as threads:
        for found in threads.map(refusals, [things[kind]] * 2):
            reasons = {sentence for sentence in found.values() if sentence}
            assert all("aborted" in each or "another read operation" in each for each in reasons)
    assert not any(refusals(things[kind]).values())


def test_a_lost_robot_is_reported_by_each_function(name):
    with FrankaSim(KINDS[name](), Panda(name="vacuum", hand="vacuum", base=(0, 2, 0))) as server:
        robot, hand = server[name].connect(), server[name].gripper()
        vacuum, model = pyfranka.VacuumGripper(server["vacuum"].address), robot.load_model()
        server.kill()
        assert accepted(refusals(robot)) == LOCAL
        assert accepted(refusals(hand)) == accepted(refusals(vacuum)) == set()
        assert all(not sentence for sentence in refusals(model).values())


IN_FORKED_PROCESS = """
import os, sys
sys.path[:0] = {path!r}
import pyfranka
from test_bad_input_client import LOCAL, SEVEN, Torques, accepted, faults_of, refusals

def check(robot, model, others, motion):
    found = refusals(robot)
    assert accepted(found) == LOCAL, found
    assert not any(refusals(model).values())
    for found in (found, *map(refusals, others)):
        for name in set(found) - LOCAL:
            lacking = "version" in found[name]  # refused before, because this robot's version lacks it
            assert lacking or "forked" in found[name] and "Connect again in this one" in found[name], name
    write = {{"before the process was forked": lambda x: x.write_once(Torques(SEVEN))}}
    assert not faults_of({{"write_once": write}}, motion)

robot = pyfranka.Robot({address!r}, pyfranka.RealtimeConfig.Ignore)
hand, vacuum = pyfranka.Gripper({address!r}), pyfranka.VacuumGripper({vacuum!r})
model = robot.load_model()
motion = robot.start_torque_control()
motion.read_once()
child = os.fork()
if child == 0:
    status = 1
    try:
        check(robot, model, (hand, vacuum), motion)
        motion.close()
        del robot, hand, motion, vacuum  # as at the end of the interpreter
        status = 0
    finally:
        sys.excepthook(*sys.exc_info()) if status else None
        os._exit(status)
ended = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
motion.write_once(Torques(SEVEN))
motion.read_once()
motion.close()
assert hand.read_once().width >= 0.0
assert not vacuum.read_once().part_present
vacuum.stop()
robot.read_once()
sys.exit(ended)
"""


def test_a_forked_process_can_neither_use_nor_end_the_connections_of_the_other(name):
    path = [os.path.dirname(__file__), os.path.dirname(sentences.__file__)]
    with FrankaSim(KINDS[name](), Panda(name="vacuum", hand="vacuum", base=(0, 2, 0))) as server:
        addresses = {"address": server[name].address, "vacuum": server["vacuum"].address}
        code = IN_FORKED_PROCESS.format(path=path, **addresses)
        done = subprocess.run([sys.executable, "-c", code], text=True, capture_output=True, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr


# What belongs to a process, and what to do elsewhere.
OF_A_SIMULATION = {
    "Simulation": (lambda sim: sim, "make one with the same world"),
    "SimulatedRobot": (lambda sim: sim["panda"], "Make a Simulation with the same world"),
    "ArmModel": (lambda sim: sim["panda"].model, "Make a Simulation"),
    "Gripper": (lambda sim: sim["panda"].gripper, "Make a Simulation"),
    "Action": (lambda sim: sim["panda"].gripper.move(0.05), "Use its outcome"),
    "Snapshot": (lambda sim: sim.snapshot(), "restore it in the process"),
    "SimulationBatch": (lambda sim: pyfranka.sim.SimulationBatch(1), "make one with the same arguments"),
}
OF_A_CONNECTION = {
    "Robot": "Connect to its address",
    "Gripper": "Connect to its address",
    "VacuumGripper": "Connect to its address",
    "Model": r"Call load_model\(\)",
}
copies = pytest.mark.parametrize("copied", [pickle.dumps, copy.copy, copy.deepcopy])


@copies
@pytest.mark.parametrize("make, instead", OF_A_SIMULATION.values(), ids=OF_A_SIMULATION)
def test_parts_of_a_simulation_refuse_copies_and_say_what_to_do(make, instead, copied):
    with pyfranka.sim.Simulation() as sim, pytest.raises(TypeError, match=instead):
        copied(make(sim))


@copies
@pytest.mark.parametrize("kind, instead", OF_A_CONNECTION.items(), ids=OF_A_CONNECTION)
def test_connections_refuse_copies_and_say_what_to_do(things, kind, instead, copied):
    with pytest.raises(TypeError, match=instead):
        copied(things[kind])

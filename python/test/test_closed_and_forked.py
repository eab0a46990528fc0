# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Objects of pyfranka that are closed, in use by another thread, lost, forked or copied: a sentence, and
nothing half done."""

import copy
import inspect
import multiprocessing
import os
import pickle
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pyfranka
import pyfranka.gym
import pyfranka.sim
import pytest
import sentences
from gymnasium.error import ClosedEnvironmentError
from pyfranka import Torques
from pyfranka.franka_sim import FrankaSim
from pyfranka.remote import Remote
from pyfranka.sim import KINDS, Panda, Simulation
from pyfranka_arguments import CLIENT, HAND, ROBOT, SIMULATION
from sentences import ERRORS, check_refused_while_another_thread_steps, unlike_ours
from wrong_calls import right_calls

ROBOTS_TAKE_TURNS = True
BASE = (-0.5, 0, 0)  # beside the table of stone.xml

# ---- in this process -------------------------------------------------------------------------------------

# Names and views work in any case; a hand is made once, then only shown.
ALWAYS = {"close", "keys", "items", "values", "name", "gripper", "serve"}
# Views, which another thread's step changes.
VIEWS = {"live_state", "model"}


def calls_of_a_simulation(sim):
    """Every public function and attribute of a simulation, its robot and hand, as calls by name."""
    (robot,) = sim.values()
    calls = {"serve at an address": lambda: sim.serve("127.0.34.2")}
    tables = {sim: SIMULATION, robot: ROBOT, robot.gripper: HAND}
    for thing, table in tables.items():
        table = {name: kind for name, kind in table.items() if name != "snapshot"}
        calls |= right_calls(thing, table, ALWAYS | {"restore", "command"})
        for name, member in inspect.getmembers(type(thing)):
            if isinstance(member, property) and name not in ALWAYS:
                calls[name] = lambda thing=thing, name=name: getattr(thing, name)
    snapshot = sim.snapshot()
    calls |= {
        "restore": lambda: sim.restore(snapshot),
        "command": lambda: robot.command(torque=[0.0] * 7),
        "body_pose": lambda: sim.body_pose("stone"),
    }
    assert {"state_hash", "state", "model", "moving", "step", "set_EE", "grasp", "width"} <= set(calls)
    return calls


def calls_of_an_environment(env):
    still = np.zeros(env.action_space.shape)
    return {"reset": env.reset, "step": lambda: env.step(still), "render": env.render}


def simulations(thing):
    if isinstance(thing, Simulation):
        return [thing]
    return [thing.simulation] if hasattr(thing, "simulation") else [each.sim for each in thing.episodes]


OPTIONS = {"task": "Reach", "render_mode": "rgb_array"}
MAKE = {
    "Simulation": lambda name: Simulation("stone.xml", [KINDS[name](base=BASE)]),
    "Environment": lambda name: pyfranka.gym.Environment(**OPTIONS, robot=name),
    "VectorEnvironment": lambda name: pyfranka.gym.VectorEnvironment(2, **OPTIONS, robot=name),
}


@pytest.fixture(params=MAKE)
def thing(request, name):
    thing = MAKE[request.param](name)
    thing.reset(seed=1)
    yield thing
    thing.close()


def calls_of(thing):
    return calls_of_a_simulation(thing) if isinstance(thing, Simulation) else calls_of_an_environment(thing)


def test_what_is_closed_raises_at_each_call(thing):
    calls = calls_of(thing)
    thing.close()
    error = RuntimeError if isinstance(thing, Simulation) else ClosedEnvironmentError
    for name, call in calls.items():
        with pytest.raises(error, match="is closed"):
            call()
            pytest.fail(name)
    thing.close()


def test_while_another_thread_steps_each_call_is_refused(thing):
    calls = [(name, call) for name, call in calls_of(thing).items() if name not in VIEWS]
    check_refused_while_another_thread_steps(simulations(thing)[-1], calls)
    thing.reset(seed=1)
    thing.step() if isinstance(thing, Simulation) else calls_of(thing)["step"]()


def in_the_forked_process(env, sender):
    found = {}
    for name, call in calls_of(env).items():
        try:
            call()
        except RuntimeError as error:
            found[name] = str(error)
    sender.send(found)


@pytest.mark.parametrize("thing", ["Environment", "VectorEnvironment"], indirect=True)
def test_a_forked_process_continues_with_one_environment_and_makes_many_itself(thing):
    fork = multiprocessing.get_context("fork")
    receiver, sender = fork.Pipe(duplex=False)
    hashes = [each.state_hash() for each in simulations(thing)]
    child = fork.Process(target=in_the_forked_process, args=(thing, sender))
    child.start()
    assert receiver.poll(60), "an answer"
    found = receiver.recv()
    child.join(60)
    assert child.exitcode == 0
    if len(hashes) == 1:
        assert set(found) <= {"render"}  # if another test has drawn
    else:
        assert "step" in found and "make one in the new process" in found["step"]
    assert not [text for text in found.values() if unlike_ours(text)]
    assert hashes == [each.state_hash() for each in simulations(thing)]
    calls_of(thing)["step"]()


# ---- clients ---------------------------------------------------------------------------------------------

SEVEN = [0.0] * 7
# Functions that need no answer of the robot, and those that it answers while it moves.
LOCAL = {"get_lower_joint_velocity_limits", "get_upper_joint_velocity_limits", "set_control_options"}
ANSWERED_IN_MOTION = LOCAL | {"load_model", "get_robot_model", "get_virtual_wall", "stop"}


def refusals(thing, without=frozenset()):
    """Calls each public function with right arguments: name -> sentence of its refusal, or nothing"""
    found = {}
    for name, call in right_calls(thing, CLIENT, without).items():
        try:
            call()
            found[name] = ""
        except ERRORS as error:
            found[name] = str(error)
            assert not unlike_ours(str(error)), (name, error)
    return found


def accepted(found):
    return {name for name, sentence in found.items() if not sentence}


@pytest.fixture(scope="module")
def vacuum(franka_sim_session):
    return pyfranka.VacuumGripper(franka_sim_session(Panda(hand="vacuum")).robot.address)


@pytest.fixture
def things(served, robots, vacuum, name):
    made = (robots[name], served[name].gripper(), vacuum, robots[name].load_model())
    yield {type(each).__name__: each for each in made}


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


def test_a_motion_that_was_closed_takes_no_command(robot):
    with robot.start_torque_control() as motion:
        motion.read_once()
        motion.write_once(Torques(SEVEN))
    for call in (motion.read_once, lambda: motion.write_once(Torques(SEVEN))):
        with pytest.raises(pyfranka.InvalidOperationException, match="This motion has been closed"):
            call()


IN_FORKED_PROCESS = """
import os, sys
sys.path[:0] = {path!r}
import pyfranka
from test_closed_and_forked import LOCAL, SEVEN, Torques, accepted, refusals

def check(robot, model, others, motion):
    found = refusals(robot)
    assert accepted(found) == LOCAL, found
    assert not any(refusals(model).values())
    for found in (found, *map(refusals, others)):
        for name in set(found) - LOCAL:
            lacking = "version" in found[name]  # refused before, because this robot's version lacks it
            assert lacking or "forked" in found[name] and "Connect again in this one" in found[name], name
    try:
        motion.write_once(Torques(SEVEN))
    except pyfranka.Exception as error:
        assert "before the process was forked" in str(error), error

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


def test_forked_and_lost_connections_are_reported_by_each_function(name):
    """A forked process can neither use nor end the connections of the other."""
    path = [os.path.dirname(__file__), os.path.dirname(sentences.__file__)]
    with FrankaSim(KINDS[name](), Panda(name="vacuum", hand="vacuum", base=(0, 2, 0))) as server:
        addresses = {"address": server[name].address, "vacuum": server["vacuum"].address}
        code = IN_FORKED_PROCESS.format(path=path, **addresses)
        done = subprocess.run([sys.executable, "-c", code], text=True, capture_output=True, timeout=120)
        assert done.returncode == 0, done.stdout + done.stderr

        robot, hand = server[name].connect(), server[name].gripper()
        vacuum, model = pyfranka.VacuumGripper(addresses["vacuum"]), robot.load_model()
        server.kill()
        assert accepted(refusals(robot)) == LOCAL
        assert accepted(refusals(hand)) == accepted(refusals(vacuum)) == set()
        assert all(not sentence for sentence in refusals(model).values())


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
    **dict.fromkeys(("Robot", "Gripper", "VacuumGripper"), "Connect to its address"),
    "Model": r"Call load_model\(\)",
}


@pytest.mark.parametrize("copied", [pickle.dumps, copy.copy, copy.deepcopy])
def test_what_belongs_to_a_process_refuses_copies_and_names_another_way(things, copied):
    with Simulation() as sim:
        made = [(make(sim), instead) for make, instead in OF_A_SIMULATION.values()]
        for thing, instead in made + [(things[kind], text) for kind, text in OF_A_CONNECTION.items()]:
            with pytest.raises(TypeError, match=instead):
                copied(thing)
                pytest.fail(str(thing))


# ---- control interface -----------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def address(franka_sim_session):
    return franka_sim_session(Panda(base=BASE), world="stone.xml", pace="lockstep").robot.address


def test_a_closed_remote_connects_by_itself(address):
    remote = Remote(address)
    with remote:
        remote.close()
        assert remote.state().mode == "Idle"
    remote.close()
    assert remote.state().mode == "Idle"


def test_copies_and_pickles_are_connections_of_their_own(address):
    with Remote(address, timeout=30.0) as remote:
        for again in (pickle.loads(pickle.dumps(remote)), copy.copy(remote), copy.deepcopy(remote)):
            assert (again.address, again.port, again.timeout) == (remote.address, remote.port, 30.0)
            again.close()
            assert again.state().mode == remote.state().mode == "Idle"


IN_FORKED_PROCESS_OF_A_REMOTE = """
import os, sys, threading
from pyfranka.remote import Remote

with Remote({address!r}, timeout=30.0) as remote:
    entered, ended = threading.Event(), threading.Event()
    def occupy():
        with remote._connection._lock:
            entered.set()
            ended.wait(60)
    thread = threading.Thread(target=occupy)
    thread.start()
    entered.wait(60)
    try:
        remote.state(timeout=0.05)
    except TimeoutError as error:
        assert "Another thread has used this Remote" in str(error), error
    else:
        raise AssertionError("used by two threads at once")
    child = os.fork()
    if child == 0:
        same = all(remote.body_position("stone").shape == (3,) for _ in range(200))
        remote.close()
        os._exit(0 if same else 3)
    ended.set()
    thread.join()
    answers = [remote.state().mode for _ in range(200)]
    code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    assert set(answers) == {{"Idle"}}, answers
    assert remote.state().mode == "Idle"
sys.exit(code)
"""


def test_threads_take_turns_and_a_forked_process_has_a_connection_of_its_own(address):
    code = IN_FORKED_PROCESS_OF_A_REMOTE.format(address=address)
    done = subprocess.run([sys.executable, "-c", code], text=True, capture_output=True, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr

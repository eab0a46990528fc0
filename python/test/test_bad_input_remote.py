# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Bad input of Remote's methods, closed, in other threads and after a fork: a sentence, nothing half done."""

import copy
import math
import pickle
import subprocess
import sys
import threading

import numpy as np
import pytest
from pyfranka.remote import Remote
from pyfranka.sim import FR3, Panda
from sentences import faults_of

NAN, HUGE = math.nan, 10**400
EYE, ZERO = np.eye(4), (0, 0, 0)

# As in test_bad_input_client.py: "function" -> a part of the sentence -> the call; x is a Remote.
REMOTE = {
    "__init__": {
        "Give the address of the robot": lambda x: Remote(""),
        "Give the address of the robot,": lambda x: Remote(5),
        "The port is a whole number, not '1340'": lambda x: Remote("a", "1340"),
        "The port is 1 to 65535, not 70000": lambda x: Remote("a", 70000),
        "The port is 1 to 65535, not 0": lambda x: Remote("a", 0),
        "A time limit is a positive number of seconds, not 'long'": lambda x: Remote("a", timeout="long"),
        "A time limit is a positive number of seconds, not nan": lambda x: Remote("a", timeout=NAN),
        "A time limit is a positive number of seconds, not 0": lambda x: Remote("a", timeout=0),
        "A time limit is a positive number of seconds, not 1j": lambda x: Remote("a", timeout=1j),
        "A time limit is a positive number of seconds, not": lambda x: Remote("a", timeout=np.complex64(1)),
        "A time limit": lambda x: Remote("a", timeout=HUGE),
    },
    "send": {
        "A line is a text, not 5": lambda x: x.send(5),
        "A line is a text, not b'time'": lambda x: x.send(b"time"),
        "Send one line at a time": lambda x: x.send("time\nstate"),
        "cannot be sent as UTF-8": lambda x: x.send("where \ud800"),
        "dance": lambda x: x.send("dance"),
        "A time limit": lambda x: x.send("time", -1),
    },
    "set_user_stop": {
        "Give True or False, not 1": lambda x: x.set_user_stop(1),
        "Give True or False, not 'on'": lambda x: x.set_user_stop("on"),
        "A time limit": lambda x: x.set_user_stop(True, NAN),
    },
    "set_guiding": {"Give True or False, not nan": lambda x: x.set_guiding(NAN)},
    "close_brakes": {"A time limit": lambda x: x.close_brakes(0)},
    "open_brakes": {"A time limit": lambda x: x.open_brakes("soon")},
    "activate_fci": {"A time limit": lambda x: x.activate_fci([])},
    "deactivate_fci": {"A time limit": lambda x: x.deactivate_fci("no")},
    "lock_joints": {"A time limit": lambda x: x.lock_joints(-1)},
    "unlock_joints": {"A time limit": lambda x: x.unlock_joints(-1)},
    "brakes": {"Give True or False": lambda x: x.brakes("shut")},  # with old names
    "fci": {"Give True or False": lambda x: x.fci(None)},
    "joints": {"Give True or False": lambda x: x.joints("locked")},
    "input": {"": lambda x: x.input("x99", True)},
    "hash": {"A time limit": lambda x: x.hash(0)},
    "user_stop": {"Give True or False": lambda x: x.user_stop(1)},
    "guiding": {"Give True or False": lambda x: x.guiding(1)},
    "end_effector_power": {"Give True or False": lambda x: x.end_effector_power(1)},
    "power": {"Give True or False": lambda x: x.power(1)},
    "load": {"takes numbers": lambda x: x.load("heavy")},
    "place": {"nothing": lambda x: x.place("nothing", ZERO)},
    "where": {"nothing": lambda x: x.where("nothing")},
    "help": {"A time limit": lambda x: x.help(0)},
    "operating_mode": {
        "The mode is one word, not 5": lambda x: x.operating_mode(5),
        "": lambda x: x.operating_mode("dance"),
    },
    "set_input": {
        "The name of an input is one word, not 'x 31'": lambda x: x.set_input("x 31", True),
        "Give True or False": lambda x: x.set_input("x31", 0),
        "": lambda x: x.set_input("x99", True),
    },
    "button": {
        "The name of a button is one word, not None": lambda x: x.button(None, True),
        "": lambda x: x.button("square", True),
    },
    "guiding_mode": {
        "The mode is one word, not ''": lambda x: x.guiding_mode(""),
        "The axes are a list, each True or False, not 5": lambda x: x.guiding_mode("user", 5),
        "Give True or False, not 1": lambda x: x.guiding_mode("user", [1] * 7),
        "": lambda x: x.guiding_mode("user", [True] * 3),
        "dance": lambda x: x.guiding_mode("dance"),
    },
    "navigation": {"": lambda x: x.navigation("mars"), "The user of the keys": lambda x: x.navigation(5)},
    "self_test": {
        "'self_test due' takes numbers, not 'soon'": lambda x: x.self_test("soon"),
        "'self_test due' takes numbers, not '5'": lambda x: x.self_test("5"),
        "": lambda x: x.self_test(NAN),
    },
    "acknowledge": {"one word, not 5": lambda x: x.acknowledge(5), "": lambda x: x.acknowledge("nothing")},
    "inject": {
        "A joint is a whole number, not 1.5": lambda x: x.inject("jointPositionError", True, 1.5),
        "": lambda x: x.inject("nothing", True),
        "Give True or False": lambda x: x.inject("nothing", "yes"),
    },
    "recover": {"A time limit": lambda x: x.recover(-1)},
    "move": {
        "The target is one word, not 'a b'": lambda x: x.move("a b"),
        "": lambda x: x.move("home"),
        "The target must have 7 numbers, not 6": lambda x: x.move([0.0] * 6),
        "The target must have 7 numbers, not [[1], [2, 3]]": lambda x: x.move([[1], [2, 3]]),
        "The target must have 7 numbers, not (1, 7)": lambda x: x.move(np.zeros((1, 7))),
        "nan": lambda x: x.move([NAN] * 7),
        "'move' takes numbers, not 'fast'": lambda x: x.move([0.0] * 7, "fast"),
        "'move' takes numbers, not 1000": lambda x: x.move([0.0] * 7, HUGE),
        "above 0 and at most 1, not nan": lambda x: x.move([0.0, -0.7, 0.0, -2.3, 0.0, 1.5, 0.7], NAN),
        "above 0 and at most 1, not 100": lambda x: x.move([0.0, -0.7, 0.0, -2.3, 0.0, 1.5, 0.7], 100),
        "above 0 and at most 1, not 0": lambda x: x.move([0.0, -0.7, 0.0, -2.3, 0.0, 1.5, 0.7], 0),
    },
    "end_effector": {
        "'end_effector' takes numbers, not '1'": lambda x: x.end_effector("1", ZERO, np.eye(3), EYE),
        "The center of mass must have 3": lambda x: x.end_effector(1, [0], np.eye(3), EYE),
        "The inertia is 3x3, or 9": lambda x: x.end_effector(1, ZERO, EYE, EYE),
        "The transform is 4x4, or 16": lambda x: x.end_effector(1, ZERO, np.eye(3), [[1], [1, 2]]),
        "The transform is 4x4": lambda x: x.end_effector(1, ZERO, np.eye(3), None),
        "": lambda x: x.end_effector(NAN, ZERO, np.eye(3), EYE),
    },
    "set_end_effector_power": {"Give True or False": lambda x: x.set_end_effector_power(1)},
    "set_power": {"Give True or False, not 'off'": lambda x: x.set_power("off")},
    "timing": {
        "The name is one word": lambda x: x.timing(5, 1.0),
        "": lambda x: x.timing("lunch", 1.0),
        "takes numbers, not None": lambda x: x.timing("brakes", None),
        "not a finite number": lambda x: x.timing("brakes", NAN),
    },
    "report": {"A time limit": lambda x: x.report(-1)},
    "set_load": {
        "'load' takes numbers, not 'heavy'": lambda x: x.set_load("heavy"),
        "F_x_Cload must have 3 numbers, not 2": lambda x: x.set_load(0.5, (0, 0)),
        "load_inertia is 3x3": lambda x: x.set_load(0.5, ZERO, EYE),
        "": lambda x: x.set_load(NAN),
        "-1": lambda x: x.set_load(-1.0),
        "not a finite number": lambda x: x.set_load(0.5, (NAN, 0, 0)),
    },
    "wall": {
        "The number of a wall is a whole number": lambda x: x.wall(1.5, ZERO, (1, 1, 1)),
        "The edges must have 3 numbers": lambda x: x.wall(1, ZERO, "big"),
        "": lambda x: x.wall(1, (NAN, 0, 0), (1, 1, 1)),
        "0 to 7": lambda x: x.wall(9, ZERO, (1, 1, 1)),
    },
    "remove_wall": {
        "a whole number, not None": lambda x: x.remove_wall(None),
        "0 to 7": lambda x: x.remove_wall(8),
    },
    "part": {"Give True or False": lambda x: x.part(None), "": lambda x: x.part(True)},
    "pump": {"The health is one word": lambda x: x.pump(1), "": lambda x: x.pump("blue")},
    "hand_homing": {"A time limit": lambda x: x.hand_homing(0)},
    "hand_move": {
        "'hand move' takes numbers, not '0.04'": lambda x: x.hand_move("0.04", 0.1),
        "'hand move' takes numbers, not [1]": lambda x: x.hand_move([1], 0.1),
        "": lambda x: x.hand_move(NAN, 0.1),
    },
    "hand_grasp": {
        "'hand grasp' takes numbers, not None": lambda x: x.hand_grasp(0.04, 0.1, None),
        "": lambda x: x.hand_grasp(0.04, 0.1, NAN),
    },
    "hand_stop": {"A time limit": lambda x: x.hand_stop("now")},
    "state": {"A time limit": lambda x: x.state(NAN)},
    "state_hash": {"A time limit": lambda x: x.state_hash(-5)},
    "loss": {
        "'loss' takes numbers, not 'much'": lambda x: x.loss("much"),
        "A seed is a whole number": lambda x: x.loss(0.1, 1.5),
        "": lambda x: x.loss(NAN),
        "seed": lambda x: x.loss(0.1, -1),
        "loss": lambda x: x.loss(1.5),
    },
    "lose": {"a whole number, not 0.5": lambda x: x.lose(0.5), "": lambda x: x.lose(-1)},
    "delay": {"A delay is a whole number": lambda x: x.delay(NAN), "20": lambda x: x.delay(21)},
    "push": {
        "The name of a body is one word, not 5": lambda x: x.push(5, ZERO),
        "nothing": lambda x: x.push("nothing", ZERO),
        "The force must have 3 numbers": lambda x: x.push("stone", 1.0),
        "The torque must have 3 numbers": lambda x: x.push("stone", ZERO, 100),
        "The duration is a whole number": lambda x: x.push("stone", ZERO, ticks=0.5),
        "": lambda x: x.push("stone", (NAN, 0, 0)),
    },
    "place_body": {
        "nothing": lambda x: x.place_body("nothing", ZERO),
        "The position must have 3 numbers, not 'high'": lambda x: x.place_body("stone", "high"),
        "The position must have 3 numbers": lambda x: x.place_body("stone", (0, 0)),
        "The orientation must have 4 numbers": lambda x: x.place_body("stone", ZERO, [1]),
        "": lambda x: x.place_body("stone", (0, 0, NAN)),
    },
    "body_position": {
        "one word, not 'stone\\nquit'": lambda x: x.body_position("stone\nquit"),
        "nothing": lambda x: x.body_position("nothing"),
        "one word": lambda x: x.body_position("\t"),
    },
    "scene": {"A time limit": lambda x: x.scene(0)},
    "mesh": {"nothing": lambda x: x.mesh("nothing"), "one word": lambda x: x.mesh(None)},
    "poses": {"A time limit": lambda x: x.poses(0)},
    "step": {
        "The number of ticks is a whole number, not 1.5": lambda x: x.step(1.5),
        "The number of ticks is a whole number, not nan": lambda x: x.step(NAN),
        "": lambda x: x.step(-1),
        "0": lambda x: x.step(HUGE),
    },
    "wait": {
        "The condition is a function of a RemoteState, not 5": lambda x: x.wait(5),
        "A time limit": lambda x: x.wait(timeout=0),
    },
    "reset": {"A time limit": lambda x: x.reset(-1)},
    "quit": {"A time limit": lambda x: x.quit(-1)},
    "commands": {"A time limit": lambda x: x.commands("a")},
}


@pytest.fixture(scope="module")
def server(franka_sim_session):
    robots = [Panda(base=(-0.5, 0, 0), realism="ideal"), FR3(name="left", base=(0, 2, 0), realism="ideal")]
    server = franka_sim_session(*robots, world="stone.xml", pace="lockstep")
    yield server
    server.stop()


def condition(remote):
    """What the lines of the table would change."""
    return remote.report(), remote.state_hash(), remote.poses().tolist(), remote.time


@pytest.mark.parametrize("name", ["panda", "left"])
@pytest.mark.parametrize("kept", [False, True], ids=["one call", "kept"])
def test_bad_input_is_refused_with_a_sentence_and_changes_nothing(server, name, kept):
    remote = Remote(server[name].address)
    if kept:
        remote.__enter__()
    try:
        before = condition(remote)
        wrong = faults_of(REMOTE, remote, "Remote")
        assert not wrong, "\n".join(wrong)
        assert repr(condition(remote)) == repr(before)
    finally:
        remote.close()


def test_the_table_has_each_method():
    public = {name for name in vars(Remote) if not name.startswith("_")}
    assert public - set(REMOTE) == {"address", "port", "close", "time"}, "They take no argument."


@pytest.mark.parametrize("address", ["a..b", "x" * 70, "a\0b", "\ud800"])
def test_an_address_that_cannot_be_one_is_a_sentence(address):
    with pytest.raises(ConnectionError, match="There is no control interface at"):
        Remote(address).state()


def test_a_closed_remote_connects_by_itself(server):
    remote = Remote(server["panda"].address)
    with remote:
        remote.close()
        assert remote.state().mode == "Idle"
    remote.close()
    assert remote.state().mode == "Idle"


def test_copies_and_pickles_are_connections_of_their_own(server):
    with Remote(server["panda"].address, timeout=30.0) as remote:
        for again in (pickle.loads(pickle.dumps(remote)), copy.copy(remote), copy.deepcopy(remote)):
            assert (again.address, again.port, again.timeout) == (remote.address, remote.port, 30.0)
            again.close()
            assert again.state().mode == remote.state().mode == "Idle"


def test_another_thread_that_waits_too_long_gets_a_sentence(server):
    remote = Remote(server["panda"].address)
    entered, ended = threading.Event(), threading.Event()

    def occupy():
        with remote._connection._lock:
            entered.set()
            ended.wait(60)

    thread = threading.Thread(target=occupy)
    thread.start()
    try:
        assert entered.wait(60)
        with pytest.raises(TimeoutError, match="Another thread has used this Remote"):
            remote.state(timeout=0.05)
    finally:
        ended.set()
        thread.join()
    assert remote.state().mode == "Idle"


IN_FORKED_PROCESS = """
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


def test_a_forked_process_has_a_connection_of_its_own(server):
    code = IN_FORKED_PROCESS.format(address=server["panda"].address)
    done = subprocess.run([sys.executable, "-c", code], text=True, capture_output=True, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr

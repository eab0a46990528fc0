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
from wrong_calls import Kind, faults_of_arguments, parameters_of

NAN, HUGE = math.nan, 10**400

TIMEOUT = Kind(None, ("soon", "5", [], -1, 0, NAN, HUGE, 1j, np.complex64(1)))
SWITCH = Kind(True, (1, "on", "yes", None, NAN))


def word(right, *unknown) -> Kind:
    """A word of a line."""
    return Kind(right, (5, None, "", "a b", "stone\nquit", "\t"), unknown=unknown)


def value(right, *beyond) -> Kind:
    return Kind(right, ("heavy", "5", [1], None, NAN, HUGE), unknown=beyond)


def row(right) -> Kind:
    size = len(right)
    shapes = (right[1:], [[1], [2, 3]], np.zeros((1, size)), "high", 5.0)
    return Kind(right, (*shapes, [NAN] * size))


def matrix(size) -> Kind:
    return Kind(np.eye(size), (np.eye(7 - size), [[1], [1, 2]], None, np.full((size, size), NAN)))


def count(right, *beyond) -> Kind:
    return Kind(right, (1.5, NAN, None, "5"), unknown=beyond)


BODY, THREE = word("stone", "nothing"), row([0.0] * 3)
READY = [0.0, -0.7, 0.0, -2.3, 0.0, 1.5, 0.7]
# The arguments of each method; `timeout` is the same everywhere.
REMOTE = {
    "__init__": {"address": Kind("127.0.0.1", ("", 5, None)), "port": Kind(1340, ("1340", 70000, 0, 1.5))},
    "send": {"line": Kind("time", (5, b"time", "time\nstate", "where \ud800"), unknown=("dance",))},
    **dict.fromkeys(("close_brakes", "open_brakes", "activate_fci", "deactivate_fci"), {}),
    **dict.fromkeys(("lock_joints", "unlock_joints", "recover", "report", "state", "state_hash"), {}),
    **dict.fromkeys(("hand_homing", "hand_stop", "scene", "poses", "reset", "quit", "commands"), {}),
    "set_user_stop": {"pressed": SWITCH},
    "set_guiding": {"active": SWITCH},
    **dict.fromkeys(("set_end_effector_power", "set_power"), {"on": SWITCH}),
    "operating_mode": {"mode": word("execution", "dance")},
    "set_input": {"name": word("x31", "x99"), "pressed": SWITCH},
    "button": {"name": word("circle", "square"), "pressed": SWITCH},
    "guiding_mode": {"mode": word("user", "dance"), "axes": Kind([True] * 7, (5, [1] * 7))},
    "navigation": {"user": word("desk", "mars")},
    "self_test": {"due": value(5.0)},
    "acknowledge": {"error": word("jointPositionError", "nothing")},
    "inject": {"error": word("jointPositionError", "nothing"), "active": SWITCH, "joint": count(1)},
    "move": {
        "target": Kind(READY, (*word("pack").wrong[2:], *row(READY).wrong[:3], row(READY).wrong[-1])),
        "speed": value(0.3, 100, 0),
    },
    "end_effector": {"mass": value(1.0), "center": THREE, "inertia": matrix(3), "F_T_NE": matrix(4)},
    "timing": {"what": word("brakes", "lunch"), "seconds": value(1.0)},
    "set_load": {"mass": value(0.5, -1), "F_x_Cload": THREE, "load_inertia": matrix(3)},
    "wall": {
        "number": count(1, 9),
        "center": THREE,
        "edges": row([1.0] * 3),
        "orientation": row([1.0, 0.0, 0.0, 0.0]),
    },
    "remove_wall": {"number": count(1, 8)},
    "part": {"present": SWITCH},
    "pump": {"health": Kind("green", word("green").wrong)},
    "hand_move": {"width": value(0.04), "speed": value(0.1)},
    "hand_grasp": {"width": value(0.04), "speed": value(0.1), "force": value(10.0)},
    "loss": {"probability": value(0.1), "seed": count(0, -1)},
    "lose": {"commands": count(1, -1)},
    "delay": {"ticks": count(1)},
    "push": {"body": BODY, "force": THREE, "torque": THREE, "ticks": count(1)},
    "place_body": {"body": BODY, "position": THREE, "orientation": row([1.0, 0.0, 0.0, 0.0])},
    "body_position": {"body": BODY},
    "mesh": {"name": BODY},
    "step": {"ticks": count(1, -1)},
    "wait": {"condition": Kind(None, (5, "Idle"))},
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
        wrong = faults_of_arguments(Remote, table(), remote, lambda: condition(remote))
        assert not wrong, "\n".join(wrong)
    finally:
        remote.close()


def table():
    """REMOTE with the time limits."""
    complete = {}
    for name, kinds in REMOTE.items():
        limits = {"timeout": TIMEOUT} if "timeout" in parameters_of(getattr(Remote, name)) else {}
        complete[name] = {**kinds, **limits}
    return complete


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

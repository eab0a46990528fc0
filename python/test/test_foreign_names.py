# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The names of pylibfranka and panda-python's libfranka in pyfranka."""

import copy
import datetime
import inspect
import pickle
import re
import subprocess
from collections import namedtuple
from pathlib import Path

import names_of_package
import numpy as np
import pyfranka
import pytest
from genuine_clients import client_python

HERE = Path(__file__).resolve().parent
SCRIPTS = HERE / "other_packages"
PACKAGES = {"panda": "panda_py.libfranka", "pylibfranka": "pylibfranka"}

# Differences that stay (docs/python.md): where the packages contradict pyfranka, pyfranka's API stays.
OTHER_DEFAULTS = {("constructor Robot", "realtime_config", "RealtimeConfig.kIgnore")}
# Without this argument the gravity that the robot measures applies.
LEFT_OUT = {("function Model.gravity", "robot_state", "gravity_earth")}
CALLABLE_NUMBERS = {"Robot.server_version", "Gripper.server_version", "VacuumGripper.server_version"}

Entry = namedtuple("Entry", "package kind path rest")


def entries():
    for package in PACKAGES:
        for line in (SCRIPTS / f"{package}_names.txt").read_text().splitlines():
            kind, path, *rest = line.split(" ", 2)
            yield Entry(package, kind, path, rest[0] if rest else "")


ENTRIES = list(entries())


def lookup(module, path):
    """The attribute itself, not its value for a class: a property stays one."""
    owner = module
    for name in path.split("."):
        owner = inspect.getattr_static(owner, name) if inspect.isclass(owner) else getattr(owner, name)
    return owner


def arguments(text):
    """(name, default or None) of each argument."""
    return [tuple(part.split("=", 1)) if "=" in part else (part, None) for part in text.split()]


def same_default(mine, theirs):
    """Compares defaults; pyfranka writes an enumeration's value without k and a tuple for a list."""
    plain = [re.sub(r"\.k(?=[A-Z])", ".", text).strip("[]()") for text in (mine, theirs)]
    return (
        plain[0].rpartition("ProductionSetupProfile")[2] == plain[1].rpartition("ProductionSetupProfile")[2]
    )


def takes(ours, entry):
    """Whether an overload of ours, `name=default ...`, may be called like theirs, by position and by name."""
    mine, theirs = arguments(ours), arguments(entry.rest)
    call = f"{entry.kind} {entry.path}"
    for index, (name, default) in enumerate(theirs):
        if index >= len(mine):
            return (call, theirs[0][0], name) in LEFT_OUT
        unnamed = re.fullmatch(r"arg\d+", name)
        if not unnamed and mine[index][0] != name:
            return False
        if default is None or (call, name, default) in OTHER_DEFAULTS:
            continue
        if mine[index][1] is None or not same_default(mine[index][1], default):
            return False
    return all(default is not None for _, default in mine[len(theirs) :])


def is_callable_like(entry):
    path = entry.path + (".__init__" if entry.kind == "constructor" else "")
    name = path.rpartition(".")[2]
    if entry.path == "Duration":
        return True  # made in test_durations_are_numbers
    member = lookup(pyfranka, path)
    doc = (member.__func__ if isinstance(member, staticmethod) else member).__doc__ or ""
    own_name = re.search(r"^(?:\d+\. )?(\w+)\(", doc.replace("(*args, **kwargs)", ""), re.MULTILINE)
    overloads = names_of_package.signatures(own_name.group(1) if own_name else name, doc)
    return any(takes(overload, entry) for overload in overloads)


@pytest.mark.parametrize("package, module", PACKAGES.items())
def test_the_list_is_that_of_the_package(package, module):
    printed = subprocess.run(
        [client_python(package), names_of_package.__file__, module],
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    ).stdout
    assert printed == (SCRIPTS / f"{package}_names.txt").read_text()


def test_every_name_exists():
    missing = []
    for entry in ENTRIES:
        try:
            lookup(pyfranka, entry.path)
        except AttributeError:
            missing.append(entry)
    assert missing == []


def check(entry):
    member = lookup(pyfranka, entry.path)
    if entry.kind == "value":
        return int(member) == int(entry.rest)
    if entry.kind == "class":
        return inspect.isclass(member)
    if entry.kind == "exception":
        return issubclass(member, RuntimeError)
    if entry.kind == "constant":
        return [float(text) for text in entry.rest.strip("[]").split(",")] == list(member)
    if entry.kind == "attribute":
        return isinstance(member, property) and (not entry.rest or member.fset is not None)
    return entry.path in CALLABLE_NUMBERS or is_callable_like(entry)


def test_names_mean_the_same():
    """Values and constants are equal, attributes can be assigned, functions take the same arguments."""
    assert [entry for entry in ENTRIES if not check(entry)] == []


# --- what each name does ----------------------------------------------------------------------------------


def test_durations_are_numbers():
    quarter = pyfranka.Duration(datetime.timedelta(milliseconds=250))
    assert isinstance(quarter, float) and quarter == 0.25
    assert (quarter.to_sec(), quarter.to_msec()) == (0.25, 250)
    assert type(quarter.to_sec()) is float and type(quarter.to_msec()) is int
    assert pyfranka.Duration() == 0 and pyfranka.Duration(np.int64(7)).to_msec() == 7
    assert pyfranka.Duration(milliseconds=3) == pyfranka.Duration(duration=datetime.timedelta(milliseconds=3))
    for length in (1, 1001, 10**10 + 7):
        for other in (copy.copy, lambda value: pickle.loads(pickle.dumps(value))):
            assert other(pyfranka.Duration(length)).to_msec() == length
    state = pyfranka.RobotState()
    state.time = 1.001
    assert state.time == pyfranka.Duration(1001) == 1.001
    with pytest.raises(TypeError, match="milliseconds"):
        pyfranka.Duration(0.25)
    with pytest.raises(ValueError, match="negative"):
        pyfranka.Duration(-1)
    with pytest.raises(OverflowError):
        pyfranka.Duration(2**70)


def test_each_error_has_its_flag():
    names = [name for name in vars(pyfranka.Errors) if not name.startswith("_")]
    assert len(names) == 41
    assert not any(getattr(pyfranka.Errors(), name) for name in names)


def test_attributes_can_be_assigned():
    state = pyfranka.RobotState()
    pose = np.arange(16.0).reshape(4, 4)
    state.O_T_EE = pose
    assert (state.O_T_EE == pose).all()
    state.O_T_EE = pose.ravel(order="F").tolist()
    assert (state.O_T_EE == pose).all()
    state.time = 1.5
    assert state.time.to_msec() == 1500
    with pytest.raises(ValueError, match="q needs 7 numbers, not 6"):
        state.q = [0.0] * 6
    for time in (-1.0, float("nan"), float("inf")):
        with pytest.raises(ValueError, match="at least 0"):
            state.time = time
    assert (state.q == 0).all() and state.time == 1.5
    command = pyfranka.CartesianPose(np.eye(4))
    command.elbow = [0.1, -1.0]
    command.O_T_EE = pose
    assert command.elbow.tolist() == [0.1, -1.0] and (command.O_T_EE == pose).all()
    with pytest.raises(ValueError, match="O_T_EE needs 16 numbers, not 9"):
        command.O_T_EE = np.eye(3)


def test_enumerations_keep_their_names():
    assert pyfranka.RobotMode.kIdle == pyfranka.RobotMode.Idle
    assert pyfranka.RobotMode.kIdle.name == "Idle"
    assert "kIdle" not in pyfranka.RobotMode.__members__

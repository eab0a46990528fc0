# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The names of pylibfranka and panda-python's libfranka in pyfranka, and scripts that were written for these
packages, with each package and with pyfranka, on equal robots."""

import copy
import datetime
import functools
import inspect
import json
import os
import pickle
import re
import subprocess
import sys
from collections import namedtuple
from pathlib import Path

import names_of_package
import numpy as np
import pyfranka
import pyfranka.sim
import pytest
from fci_session import simulated
from genuine_clients import client_python
from pyfranka import libfranka

HERE = Path(__file__).resolve().parent
SCRIPTS = HERE / "other_packages"
PACKAGES = {"panda": "panda_py.libfranka", "pylibfranka": "pylibfranka"}
ROBOTS = {"panda": "panda", "pylibfranka": "fr3"}

# Differences that stay (docs/python.md): where the packages contradict pyfranka, pyfranka's API stays.
OTHER_DEFAULTS = {("constructor Robot", "realtime_config", "RealtimeConfig.kIgnore")}
# Without this argument the gravity that the robot measures applies.
LEFT_OUT = {("function Model.gravity", "robot_state", "gravity_earth")}
CALLABLE_NUMBERS = {"Robot.server_version", "Gripper.server_version", "VacuumGripper.server_version"}

Entry = namedtuple("Entry", "kind path rest")


NAMES = "pyfranka", "libfranka"


@pytest.fixture(scope="module", params=PACKAGES)
def entries(request):
    """The names of a package, as its own interpreter lists them."""
    command = [client_python(request.param), names_of_package.__file__, PACKAGES[request.param]]
    listed = subprocess.run(command, capture_output=True, text=True, timeout=60, check=True).stdout
    found = []
    for line in listed.splitlines():
        kind, path, *rest = line.split(" ", 2)
        found.append(Entry(kind, path, rest[0] if rest else ""))
    assert len(found) > 100
    return found


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


@pytest.mark.parametrize("module", [pyfranka, libfranka], ids=NAMES)
def test_every_name_exists(module, entries):
    missing = []
    for entry in entries:
        try:
            lookup(module, entry.path)
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


def test_names_mean_the_same(entries):
    """Values and constants are equal, attributes can be assigned, functions take the same arguments."""
    assert [entry for entry in entries if not check(entry)] == []


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


def test_lists_are_flat_and_may_be_changed():
    state = libfranka.RobotState(pyfranka.RobotState())
    state.O_T_EE = [float(i) for i in range(16)]
    pose = state.O_T_EE
    assert pose == [float(i) for i in range(16)]
    pose[14] = 9.0
    assert state.O_T_EE[14] == 14.0
    command = libfranka.motion_finished(libfranka.CartesianPose(pose))
    assert command.O_T_EE == pose and command.motion_finished
    assert type(copy.copy(command)) is libfranka.CartesianPose
    limited = libfranka.limit_rate(libfranka.MAX_TORQUE_RATE, [5.0] * 7, [0.0] * 7)
    assert type(limited) is list and limited == pytest.approx([0.999999] * 7)


def test_enumerations_keep_their_names():
    assert pyfranka.RobotMode.kIdle == pyfranka.RobotMode.Idle
    assert pyfranka.RobotMode.kIdle.name == "Idle"
    assert "kIdle" not in pyfranka.RobotMode.__members__


# --- other bindings and other processes -------------------------------------------------------------------

OTHERS = {"panda_py": "panda", "pylibfranka": "pylibfranka", "franky": "franky"}
TOGETHER = """
import importlib, sys
import pyfranka_path
for name in sys.argv[1].split(","):
    importlib.import_module("pyfranka.sim" if name == "pyfranka" else name)
import pyfranka, pyfranka.sim
raised = {}
for name, options in {"panda_py.libfranka": 1, "pylibfranka": 1, "pyfranka": 1}.items():
    if name.partition(".")[0] in sys.modules:
        module = importlib.import_module(name)
        assert module.Torques([1.0] * 7).tau_J[0] == 1.0, name
        try:
            module.Robot("127.9.9.9", module.RealtimeConfig.kIgnore)
        except Exception as error:
            assert isinstance(error, RuntimeError), error
            raised[name] = type(error)
assert raised["pyfranka"] is pyfranka.NetworkException, raised
with pyfranka.sim.Simulation(robots=[pyfranka.sim.FR3()]) as sim:
    sim.step(10)
    print(sim["fr3"].state_hash())
"""


# Each of two bindings comes before the other once. franky and pylibfranka exclude each other, with pyfranka
# and without: both register the type Duration.
@pytest.mark.parametrize(
    "order",
    [
        ["pyfranka", "panda_py", "pylibfranka"],
        ["pylibfranka", "panda_py", "pyfranka"],
        ["pyfranka", "panda_py", "franky"],
        ["franky", "panda_py", "pyfranka"],
    ],
    ids=",".join,
)
def test_other_bindings_may_be_in_the_same_process_in_any_order(order, tmp_path):
    with pyfranka.sim.Simulation(robots=[pyfranka.sim.FR3()]) as sim:
        sim.step(10)
        expected = sim["fr3"].state_hash()
    folders = [
        str(folder)
        for name in order
        if name in OTHERS
        for folder in client_python(OTHERS[name]).parents[1].glob("lib/*/site-packages")
    ]
    # Their own numpy and so on come after ours.
    (tmp_path / "pyfranka_path.py").write_text(f"import numpy, sys\nsys.path += {folders!r}\n")
    environment = {**os.environ, "PYTHONPATH": f"{tmp_path}:{os.environ.get('PYTHONPATH', '')}"}
    done = subprocess.run(
        [sys.executable, "-c", TOGETHER, ",".join(order)],
        capture_output=True,
        text=True,
        timeout=120,
        env=environment,
    )
    assert done.returncode == 0, done.stderr
    assert int(done.stdout.split()[-1]) == expected


SPAWNED = """
import multiprocessing, sys
import pyfranka.sim

def work(number):
    with pyfranka.sim.Simulation("stone.xml", [pyfranka.sim.Panda(base=(-0.5, 0, 0))]) as sim:
        sim.step(50)
        return sim.state_hash(), int(sim.render(width=32, height=24).rgb.sum())

if __name__ == "__main__":
    with multiprocessing.get_context(sys.argv[1]).Pool(2) as pool:
        print(len(set([*pool.map(work, range(4)), work(0)])))
"""


@pytest.mark.parametrize("method", ["spawn", "fork", "forkserver"])
def test_processes_may_be_started_in_any_way(method, tmp_path):
    program = tmp_path / "work.py"
    program.write_text(SPAWNED)
    done = subprocess.run(
        [sys.executable, program, method], capture_output=True, text=True, timeout=120, cwd=tmp_path
    )
    assert (done.returncode, done.stdout) == (0, "1\n"), done.stderr


# --- scripts ----------------------------------------------------------------------------------------------

IMPORTS = {
    "pyfranka": {
        "from panda_py import libfranka": "import pyfranka as libfranka",
        "from pylibfranka import": "from pyfranka import",
        "import pylibfranka as franka": "import pyfranka as franka",
        "import pylibfranka\n": "import pyfranka as pylibfranka\n",
    },
    "libfranka": {
        "from panda_py import libfranka": "from pyfranka import libfranka",
        "from pylibfranka import": "from pyfranka.libfranka import",
        "import pylibfranka as franka": "from pyfranka import libfranka as franka",
        "import pylibfranka\n": "from pyfranka import libfranka as pylibfranka\n",
    },
}
# They index flat matrices, so that pyfranka's own arrays do not serve them.
FLAT = {"panda_poses", "pylibfranka_poses"}
# The number of its states depends on the program's speed, so their hash does, too.
UNREPEATABLE = {"pylibfranka_planned_motion"}
CASES = [
    (script.stem.partition("_")[0], script.stem, name)
    for script in sorted(SCRIPTS.glob("*.py"))
    for name in NAMES
    if not (name == "pyfranka" and script.stem in FLAT)
]


@pytest.fixture(scope="module")
def robot(request):
    """The robot that a package can connect to; `genuine` runs a script with the package, once."""
    python = client_python(request.param)
    with simulated(ROBOTS[request.param], "lockstep") as sim:
        sim.genuine = functools.cache(lambda script: run(sim, python, script))
        yield sim


def run(sim, python, script, imports=None):
    """Runs a script from the robot's initial pose. @returns its report and the robot's hash."""
    text = (SCRIPTS / f"{script}.py").read_text()
    replaced = 0
    for theirs, ours in (imports or {}).items():
        replaced += text.count(theirs)
        text = text.replace(theirs, ours)
    assert imports is None or replaced == 1, "one line of a script changes"
    sim.remote.reset()
    environment = dict(os.environ) if imports else {"PATH": os.environ["PATH"]}
    done = subprocess.run(
        [python, "-c", text, sim.address], capture_output=True, text=True, timeout=120, env=environment
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return json.loads(done.stdout.splitlines()[-1]), sim.remote.state_hash()


def same(mine, theirs):
    """Compares reports: texts, flags and whole numbers exactly, others within the rounding of two models."""
    if isinstance(theirs, dict):
        assert mine.keys() == theirs.keys()
        return all(same(mine[key], theirs[key]) for key in theirs)
    if isinstance(theirs, list):
        return len(mine) == len(theirs) and all(map(same, mine, theirs))
    if isinstance(theirs, float):
        return mine == pytest.approx(theirs, abs=1e-4)
    return mine == theirs


@pytest.mark.parametrize("robot, script, name", CASES, indirect=["robot"])
def test_script_runs_after_a_change_of_its_import_only(robot, script, name):
    theirs, their_hash = robot.genuine(script)
    mine, my_hash = run(robot, sys.executable, script, IMPORTS[name])
    assert same(mine, theirs), (mine, theirs)
    assert my_hash == their_hash or script in UNREPEATABLE

# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Names of the module in C++ as users import them, and its types, which a build makes."""

import builtins
import inspect
import os
import pickle
import re
import subprocess
import sys
from pathlib import Path

import _pyfranka
import pyfranka
import pyfranka.libfranka
import pyfranka.sim
import pytest

PACKAGE = Path(__file__).resolve().parents[1]
WRITE_TYPES, SOURCES = PACKAGE / "write_types.py", PACKAGE / "src"


def members(owner):
    """Names with their values; pyfranka loads those in C++ when they are used."""
    names = set(dir(owner)) - {"sweep"} if owner is pyfranka else vars(owner)
    return {name: vars(owner).get(name, getattr(owner, name)) for name in names}


def classes(owner=pyfranka, path=()):
    for name, value in members(owner).items():
        # A class stands under its own name; others are aliases.
        if inspect.isclass(value) and not name.startswith("_") and name == value.__name__:
            yield (*path, name), value
            yield from classes(value, (*path, name))


def test_a_star_import_hides_no_builtin():
    names = {}
    exec("from pyfranka import *", names)
    assert names["FrankaException"] is pyfranka.Exception and "RobotState" in names
    assert not set(names) & set(vars(builtins)) - {"__builtins__"}
    names = {}
    exec("from pyfranka.libfranka import *", names)
    assert names["RobotState"] is pyfranka.libfranka.RobotState and "numpy" not in names
    assert not set(names) & set(vars(builtins)) - {"__builtins__"}


def test_classes_show_and_are_pickled_under_the_names_that_users_import():
    errors = {cls for _, cls in classes() if issubclass(cls, RuntimeError)}
    assert len(errors) == 9
    for path, cls in classes():
        assert (cls.__module__, cls.__qualname__) == ("pyfranka", ".".join(path))
    for cls in (*errors, pyfranka.RobotState, pyfranka.RobotMode, pyfranka.sim.RequestRefused):
        assert pickle.loads(pickle.dumps(cls)) is cls
    for name in ("ArmModel", "GripperOutcome", "LiveState", "RequestRefused", "Snapshot"):
        assert getattr(pyfranka.sim, name).__module__ == "pyfranka.sim"
    assert pickle.loads(pickle.dumps(pyfranka.RobotMode.Reflex)) == pyfranka.RobotMode.Reflex
    assert pyfranka.limit_rate.__module__ == "pyfranka"


def docstrings(owner):
    for value in vars(owner).values():
        if inspect.isclass(value) and value.__module__.startswith("pyfranka"):
            yield from docstrings(value)
        for each in (value, getattr(value, "fget", None), getattr(value, "fset", None)):
            yield getattr(each, "__doc__", None) or ""


def test_docstrings_show_the_names_that_users_import():
    shown = [doc for module in (_pyfranka, _pyfranka._sim) for doc in docstrings(module)]
    assert any("pyfranka.sim.LiveState" in doc for doc in shown)
    assert [doc for doc in shown if re.search(r"_pyfranka\b", doc.replace("import _pyfranka", ""))] == []
    assert "state: pyfranka.RobotState" in pyfranka.Model.mass.__doc__


def test_types_are_local_so_that_other_bindings_of_libfranka_can_be_loaded():
    bound = {cls for _, cls in classes(_pyfranka) if type(cls).__name__ == "pybind11_type"}
    assert pyfranka.RobotState in bound
    shared = {cls for cls in bound if not any("pybind11_module_local" in name for name in vars(cls))}
    assert not shared


@pytest.mark.parametrize("options", [[], ["-O"], ["-OO"]])
def test_all_modules_can_be_imported_with_optimization(options):
    code = (
        "import importlib, pkgutil, pyfranka\n"
        "for module in pkgutil.walk_packages(pyfranka.__path__, 'pyfranka.'):\n"
        "    if not module.name.endswith('__main__'):\n"
        "        importlib.import_module(module.name)\n"
        "pyfranka.sim.Simulation(robots=[pyfranka.sim.FR3()]).step()"
    )
    done = subprocess.run([sys.executable, *options, "-c", code], text=True, capture_output=True, timeout=120)
    assert done.returncode == 0, done.stderr


@pytest.fixture(scope="module")
def types(tmp_path_factory):
    """Of the module, made as in a build, where pyfranka cannot be imported yet."""
    folder = tmp_path_factory.mktemp("types")
    code = (
        "import runpy, sys\n"
        "sys.modules['pyfranka'] = None\n"
        f"sys.argv = [{str(WRITE_TYPES)!r}, {str(folder)!r}]\n"
        "runpy.run_path(sys.argv[0], run_name='__main__')"
    )
    made = subprocess.run([sys.executable, "-c", code], text=True, capture_output=True, timeout=120)
    assert made.returncode == 0, made.stderr
    return folder


PROGRAM = """
import datetime
from typing import Any, assert_type
import numpy, numpy.typing
import pyfranka, pyfranka.sweeps

Array = numpy.typing.NDArray[numpy.float64]
robot = pyfranka.Robot("172.16.0.2", pyfranka.RealtimeConfig.Ignore)
model = robot.load_model()

def hold(state: pyfranka.RobotState, period: pyfranka.Duration) -> pyfranka.Torques:
    command = pyfranka.Torques(model.coriolis(state))
    return pyfranka.motion_finished(command) if period.to_sec() > state.time else command

try:
    robot.control_torques(hold, cutoff_frequency=100.0)
    robot.control(hold)
except pyfranka.ControlException as error:
    assert_type(error.log, list[pyfranka.Record])
    print(pyfranka.log_to_csv(error.log), error.log[0].state.q)
with robot.start_joint_position_control() as motion:
    assert_type(motion.readOnce(), tuple[pyfranka.RobotState, pyfranka.Duration])
robot.set_ee(numpy.eye(4))
robot.set_load(0.5, [0.0, 0.0, 0.05], 0.001 * numpy.eye(3))
state = robot.read_once()
state.q = [0.0] * 7
assert_type(state.q, Array)
assert_type(state.copy(), pyfranka.RobotState)
assert_type(state.to_dict(), dict[str, Any])
assert_type(robot.server_version(), int)
assert_type(pyfranka.Duration(datetime.timedelta(seconds=1)), pyfranka.Duration)
assert_type(pyfranka.MAX_TORQUE_RATE, list[float])
assert_type(pyfranka.ArmLimits(robot.server_version).velocity_range(state.q), tuple[Array, Array])
assert_type(pyfranka.sweep(lambda case, seed: case, 3), pyfranka.sweeps.Sweep)
"""
WRONG = {
    "robot.control_torques(pyfranka.JointPositions)": "arg-type",
    "robot.grasp(0.01, 0.1, 10.0)": "attr-defined",
    "pyfranka.Robto": "attr-defined",
    "pyfranka.Torques(object())": "call-overload",
    'robot.set_load("heavy")': "call-overload",
}


def checked_types(types, file):
    """What mypy says of a program, not of packages, which it would not report if they were installed."""
    settings = file.with_suffix(".ini")
    settings.write_text("[mypy]\nstrict = True\nfollow_imports = silent\nignore_missing_imports = True\n")
    command = [sys.executable, "-m", "mypy", "--config-file", settings, "--cache-dir", os.devnull, file]
    path = os.pathsep.join([str(types), str(SOURCES)])
    environment = {**os.environ, "MYPYPATH": path}
    ran = subprocess.run(
        command, cwd=file.parent, env=environment, text=True, capture_output=True, timeout=500
    )
    assert ran.returncode < 2, ran.stdout + ran.stderr
    return "\n".join(line for line in ran.stdout.splitlines() if line.startswith(file.name))


def test_a_type_checker_knows_the_types_of_the_module(types, tmp_path):
    file = tmp_path / "program.py"
    file.write_text(PROGRAM)
    said = checked_types(types, file)
    assert "error:" not in said, said


def test_a_type_checker_finds_what_the_module_would_refuse(types, tmp_path):
    file = tmp_path / "program.py"
    head = "import pyfranka\nrobot = pyfranka.Robot('172.16.0.2')\n"
    file.write_text(head + "\n".join(WRONG) + "\n")
    said = checked_types(types, file)
    found = re.findall(r":(\d+): error: .*\[(.*)\]$", said, re.MULTILINE)
    assert set(found) == {(str(3 + i), code) for i, code in enumerate(WRONG.values())}, said

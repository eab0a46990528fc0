# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The examples in the docstrings of public classes and functions, which are run with simulated robots."""

import datetime
import doctest
import importlib
import inspect
import re

import gymnasium
import numpy
import pyfranka
import pyfranka.gym
import pyfranka.sim
import pytest
from pyfranka.franka_sim import FrankaSim
from pyfranka.sim import FR3, Panda

MODULES = ("", ".franka_sim", ".gym", ".plot", ".sim", ".sweeps")
# Addresses that a real robot and a real gripper could have.
ROBOT, GRIPPER = "172.16.0.2", "172.16.0.3"
# Names without an example, with the reason. A new name gets an example.
PROGRAM = "a program's entry, with the program's own help"
OF_GYMNASIUM = "Gymnasium's own"
WITHOUT = {
    "pyfranka.set_current_thread_to_highest_scheduler_priority": "no test runs at real-time priority",
    "pyfranka.plot.read_bag": "needs a bag of ROS",
    "pyfranka.sweeps.main": PROGRAM,
}


def examples_are_expected(cls):
    """Enumerations and errors are described by their names; they have no calls."""
    return not issubclass(cls, BaseException) and not hasattr(cls, "__members__")


def public_names(module):
    """Public classes and functions of a module with their methods: name -> object."""
    found, seen = {}, set()
    for name in module.__all__:
        value = getattr(module, name)
        home = getattr(value, "__module__", "") or ""
        if not callable(value) or not home.startswith("pyfranka") or id(value) in seen:
            continue
        seen.add(id(value))
        full = f"{module.__name__}.{name}"
        if not inspect.isclass(value):
            found[full] = value
        elif examples_are_expected(value):
            found[full] = value
            found.update({f"{full}.{method}": each for method, each in methods(value, seen)})
    return {full: value for full, value in found.items() if not is_old(value)}


def methods(cls, seen):
    for name, value in inspect.getmembers(cls, inspect.isroutine):
        home = getattr(value, "__module__", "") or ""
        ours = home.startswith("pyfranka") and not name.startswith("_")
        if ours and id(getattr(value, "__func__", value)) not in seen:
            seen.add(id(getattr(value, "__func__", value)))
            yield name, value


def is_old(value):
    return (value.__doc__ or "").startswith("Deprecated")


def examples(value):
    # A class inherits no docstring of another class.
    doc = vars(value).get("__doc__") if inspect.isclass(value) else value.__doc__
    return doctest.DocTestParser().get_examples(doc or "")


PUBLIC = {
    module: public_names(importlib.import_module(f"pyfranka{module}" if module else "pyfranka"))
    for module in MODULES
}


@pytest.fixture(scope="module")
def server():
    robots = [
        Panda(base=(-0.5, 0, 0)),
        FR3(base=(-0.5, 2, 0)),
        Panda("other", base=(-0.5, 4, 0)),
        Panda("vacuum", base=(-0.5, 6, 0), hand="vacuum"),
        Panda("pump", base=(-0.5, 8, 0), hand="vacuum"),
    ]
    with FrankaSim(*robots, world="stone.xml") as server:
        yield server


@pytest.fixture(scope="module")
def client(server):
    """What the examples of pyfranka's own classes use."""
    robot, fr3 = server.robot.connect(), server["fr3"].connect()
    with pytest.raises(pyfranka.ControlException) as aborted:
        robot.control_torques(lambda state, period: pyfranka.Torques([0.0] * 6 + [11.0]), limit_rate=False)
    robot.automatic_error_recovery()
    return {
        "robot": robot,
        "fr3": fr3,
        "fr3_q": fr3.read_once().q.tolist(),
        "hand": server["fr3"].gripper(),
        "gripper": pyfranka.VacuumGripper(server["pump"].address),
        "model": robot.load_model(),
        "state": robot.read_once(),
        "error": aborted.value,
        "urdf": re.sub(r'"\w*link(\d)"', r'"panda_link\1"', fr3.get_robot_model()),
    }


@pytest.fixture(scope="module")
def simulated():
    """What those of pyfranka.sim use, as it is at the beginning."""
    with (
        pyfranka.sim.Simulation("stone.xml", [Panda(base=(-0.5, 0, 0))]) as sim,
        pyfranka.sim.SimulationBatch(2) as batch,
    ):
        beginning = sim.snapshot()

        def names():
            sim.restore(beginning)
            batch.reset()
            return {"sim": sim, "arm": sim["panda"], "batch": batch}

        yield names


@pytest.fixture
def namespace(server, client, simulated, tmp_path):
    def make(name):
        folder = tmp_path / name
        folder.mkdir()
        names = {
            "FrankaSim": FrankaSim,
            "datetime": datetime,
            "folder": folder,
            "gymnasium": gymnasium,
            "numpy": numpy,
            "pyfranka": pyfranka,
            "remote": server["other"].remote,
            "seed_of": pyfranka.sweeps.seed_of,
            "server": server,
            "sweep_of_squares": pyfranka.sweeps.Sweep(
                [pyfranka.sweeps.Outcome(i, i, i, i * i, None, 1, 0.0, "") for i in range(3)]
            ),
            **client,
            **simulated(),
        }
        if name.startswith("pyfranka.sim.ArmModel"):
            names |= {"model": names["arm"].model, "state": names["arm"].state}
        return names

    return make


@pytest.mark.parametrize("module", MODULES)
def test_examples_are_true(module, namespace, server):
    reports = []
    runner = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE, verbose=False)
    for name, value in PUBLIC[module].items():
        lines = examples(value)
        for line in lines:
            line.source = line.source.replace(ROBOT, server["other"].address)
            line.source = line.source.replace(GRIPPER, server["vacuum"].address)
        if lines:
            test = doctest.DocTest(lines, namespace(name), name, None, None, None)
            runner.run(test, out=reports.append)
    assert not reports, "".join(reports)


@pytest.mark.parametrize("module", MODULES)
def test_each_public_name_has_a_docstring_and_an_example(module):
    undocumented = [name for name, value in PUBLIC[module].items() if not (value.__doc__ or "").strip()]
    assert not undocumented
    without = {name for name, value in PUBLIC[module].items() if not examples(value)}
    assert without - set(WITHOUT) == set()
    assert set(WITHOUT) & set(PUBLIC[module]) <= without, "These have examples now: take them off the list."

# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""One program, three doors: a robot of this process, one that this process serves, and one of franka_sim."""

import copy
import inspect
import pickle

import numpy as np
import pyfranka
import pytest
from pyfranka.sim import KINDS, Simulation
from wrong_calls import parameters_of, signatures_of

ROBOTS_TAKE_TURNS = True
ADDRESSES = {"panda": "127.0.33.21", "fr3": "127.0.33.22"}
EYE, ZERO = np.eye(4), np.zeros((3, 3))


@pytest.fixture(params=["in this process", "served", "franka_sim"])
def door(request, name):
    """A robot and its hand."""
    if request.param == "franka_sim":
        served = request.getfixturevalue("served")[name]
        robot = served.connect()
        yield robot, pyfranka.Gripper(served.address)
        robot.set_load(0.0)
        return
    with Simulation(robots=[KINDS[name]()]) as sim:
        robot, hand = sim[name], sim[name].gripper
        sim.step()
        if request.param == "served":
            sim.serve(ADDRESSES[name])
            robot = pyfranka.Robot(ADDRESSES[name], pyfranka.RealtimeConfig.Ignore)
            hand = pyfranka.Gripper(ADDRESSES[name])

        yield robot, hand


def test_states_stay_and_are_values(door):
    robot, hand = door
    robot.set_load(0.2)
    log = [robot.state, robot.read_once(), hand.read_once()]
    robot.set_load(0.3, [0, 0, 0.03], ZERO)
    log.append(robot.state)
    # An FR3 sends single precision.
    assert [log[0].m_load, log[1].m_load, log[3].m_load] == pytest.approx([0.2, 0.2, 0.3], rel=1e-6)
    assert log[3] != log[0]
    for state in log:
        kept = pickle.loads(pickle.dumps(state))
        for other in (kept, state.copy(), copy.copy(state), copy.deepcopy(state)):
            assert other == state and other is not state
    row = log[3].to_dict()
    assert (row["m_load"], row["robot_mode"], row["last_motion_errors"]) == (log[3].m_load, "Idle", [])
    assert row["O_T_EE"].shape == (4, 4) and row["q"] == pytest.approx(log[3].q)
    assert hand.width == pytest.approx(log[2].width, abs=1e-4)
    assert (hand.max_width, hand.is_grasped) == (log[2].max_width, False)
    assert set(log[2].to_dict()) == {"time", "width", "max_width", "is_grasped", "temperature"}


# Exception -> calls of a robot and its hand.
WRONG = {
    ValueError: (
        lambda robot, hand: robot.set_load(float("nan")),
        lambda robot, hand: robot.set_EE(2 * EYE),
        lambda robot, hand: robot.set_K([1.0]),
        lambda robot, hand: robot.set_joint_impedance([float("inf")] * 7),
        lambda robot, hand: hand.move(float("nan")),
        lambda robot, hand: hand.grasp(0.03, float("nan"), 10.0),
    ),
    TypeError: (
        lambda robot, hand: robot.set_load("heavy"),
        lambda robot, hand: hand.move("wide"),
        lambda robot, hand: hand.grasp(0.03, 0.1, None),
    ),
    pyfranka.CommandException: (
        lambda robot, hand: robot.set_joint_impedance([1e9] * 7),
        lambda robot, hand: robot.set_cartesian_impedance([-5.0] * 6),
        lambda robot, hand: hand.move(5.0),
        lambda robot, hand: hand.grasp(0.03, -0.1, 10.0),
    ),
}


def test_errors_are_the_same(door):
    robot, hand = door
    for kind, calls in WRONG.items():
        for number, call in enumerate(calls):
            with pytest.raises(kind):
                call(robot, hand)
                pytest.fail(f"{kind.__name__} {number}")


@pytest.mark.parametrize(
    ("one", "other"),
    [(pyfranka.sim.SimulatedRobot, pyfranka.Robot), (pyfranka.sim.Gripper, pyfranka.Gripper)],
    ids=["robot", "hand"],
)
def test_functions_of_one_name_have_the_same_arguments(one, other):
    names = [name for name in dir(one) if not name.startswith("_") and hasattr(other, name)]
    assert {"read_once"} < set(names)
    for name in names:
        if inspect.isfunction(getattr(one, name)):
            signatures = [parameters_of(getattr(one, name)).values(), *signatures_of(other)[name]]
            ours, *theirs = [[(each.name, str(each.default)) for each in found] for found in signatures]
            assert ours in theirs, name

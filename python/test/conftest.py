# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The simulated robots that the tests of pyfranka share."""

import pyfranka
import pytest

KINDS = ("panda", "fr3")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    """In a file with ROBOTS_TAKE_TURNS, whose code depends on no robot, each test runs with one of them."""
    cases = {}
    for item in items:
        if getattr(getattr(item, "module", None), "ROBOTS_TAKE_TURNS", False) and "name" in item.fixturenames:
            kind = item.callspec.params["name"]
            turn = cases.setdefault(item.nodeid.replace(kind, ""), len(cases))
            if kind != KINDS[turn % 2]:
                item.add_marker(pytest.mark.long_form("with the other robot"))


@pytest.fixture(scope="session")
def served(franka_sim_session):
    """Robots in lock-step, without friction and latency."""
    return {kind: franka_sim_session(kind, pace="lockstep", realism="ideal").robot for kind in KINDS}


@pytest.fixture(scope="session")
def addresses(served):
    return {kind: robot.address for kind, robot in served.items()}


@pytest.fixture(scope="session")
def robots(served):
    return {kind: robot.connect() for kind, robot in served.items()}


@pytest.fixture
def narrow_world(tmp_path):
    """A world file with two balls on the ground and capacity for one contact."""
    ball = "<body name='{}' pos='{} 2 0.099'><freejoint/><geom type='sphere' size='0.1' mass='1'/></body>"
    world = tmp_path / "narrow.xml"
    world.write_text(
        "<mujoco><size nconmax='1' njmax='90'/><worldbody><geom type='plane' size='9 9 1'/>"
        f"{ball.format('first', 0)}{ball.format('second', 1)}</worldbody></mujoco>"
    )
    return world


@pytest.fixture(params=KINDS)
def name(request):
    return request.param


@pytest.fixture
def robot(robots, name):
    robots[name].automatic_error_recovery()
    yield robots[name]
    assert robots[name].read_once().robot_mode == pyfranka.RobotMode.Idle

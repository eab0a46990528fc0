# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Simulated robots as pytest fixtures (docs/python.md, "Tests of your own project").

    def test_my_controller(panda):
        robot = panda.connect()
        assert robot.read_once().robot_mode == pyfranka.RobotMode.Idle

Each robot has a loopback address of its own, so that tests and sessions may run beside each other. It is
ended after the test; if the test fails, the report shows what the robot has written.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack

import pytest

from pyfranka.franka_sim import FrankaSim, ServedRobot, SimRobot, last_lines

# Logs before the test: bytes of each, for those that ran then.
BEFORE: pytest.StashKey[dict[FrankaSim, int | None]] = pytest.StashKey()
SETTINGS = {
    "program": "the program franka_sim (the workspace's, this Python environment's, the one on PATH)",
    "pace": "of the simulated robots: lockstep, realtime, patient or a factor (lockstep)",
    "realism": "of the simulated robots whose test names none, such as ideal (franka_sim's default, real)",
}


def pytest_addoption(parser: pytest.Parser) -> None:
    group = parser.getgroup("pyfranka", "simulated robots (pyfranka)")
    for name, meaning in SETTINGS.items():
        group.addoption(f"--franka-sim-{name}", metavar=name.upper(), help=meaning)
        parser.addini(f"franka_sim_{name}", meaning)


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    item.stash[BEFORE] = {sim: None if sim.stopped else sim.log_size() for sim in FrankaSim.known()}


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item: pytest.Item):
    report = (yield).get_result()
    if not report.failed:
        return
    before = item.stash.get(BEFORE, {})
    for sim in FrankaSim.known():
        since = before.get(sim, 0)
        if since is not None:
            robots = ", ".join(f"{robot.arm_id} at {robot.address}" for robot in sim.robots)
            text = "\n".join(filter(None, [last_lines(sim.log(since)), sim.status()]))
            report.sections.append((f"franka_sim, {robots}", text))


class Factory:
    """Starts programs franka_sim with the session's settings."""

    def __init__(self, config: pytest.Config, stack: ExitStack):
        self._config, self._stack = config, stack

    def __call__(
        self,
        *robots: SimRobot | str,
        world: str = "",
        pace: str | float | None = None,
        arguments: Sequence[str] = (),
        **options,
    ) -> FrankaSim:
        """A running franka_sim with these robots, SimRobot or their kinds; without one, a panda. options are
        those of SimRobot, such as arm_id and realism, for robots that are given as their kind.

        Raises FrankaSimError with the program's own sentence.
        """
        realism = self._setting("realism")
        if realism and "realism" not in options:
            options["realism"] = realism
        kinds = robots or ("panda",)
        given = [SimRobot(each, **options) if isinstance(each, str) else each for each in kinds]
        return self._stack.enter_context(
            FrankaSim(
                *given,
                world=world,
                pace=(self._setting("pace") or "lockstep") if pace is None else pace,
                arguments=arguments,
                program=self._setting("program"),
            )
        )

    def _setting(self, name: str) -> str:
        return self._config.getoption(f"franka_sim_{name}") or self._config.getini(f"franka_sim_{name}")


@pytest.fixture
def franka_sim(pytestconfig: pytest.Config) -> Iterator[Callable[..., FrankaSim]]:
    """Starts franka_sim with robots; they are ended after the test. Arguments: see Factory.__call__."""
    with ExitStack() as stack:
        yield Factory(pytestconfig, stack)


@pytest.fixture(scope="session")
def franka_sim_session(pytestconfig: pytest.Config) -> Iterator[Callable[..., FrankaSim]]:
    """As franka_sim, for fixtures of a wider scope: its robots run until the session ends, unless the fixture
    ends them."""
    with ExitStack() as stack:
        yield Factory(pytestconfig, stack)


@pytest.fixture
def panda(franka_sim) -> ServedRobot:
    """A running Panda."""
    return franka_sim("panda").robot


@pytest.fixture
def fr3(franka_sim) -> ServedRobot:
    """A running FR3."""
    return franka_sim("fr3").robot

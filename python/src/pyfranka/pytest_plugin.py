# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Simulated robots as pytest fixtures (docs/python.md, "Tests of your own project").

    def test_my_controller(franka_panda):
        robot = franka_panda.connect()
        assert robot.read_once().robot_mode == pyfranka.RobotMode.Idle

Each robot has a loopback address of its own, so that tests and sessions may run beside each other. It is
ended after the test; if the test fails, the report shows what the robot has written.

The fixtures have the short names panda and fr3 too, unless `franka_short_fixtures = false` in the ini file
leaves these to the project. A session without these fixtures loads this module only.
"""

from __future__ import annotations

import os
import sys
import typing
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import ExitStack

import pytest

if typing.TYPE_CHECKING:
    from pyfranka.franka_sim import FrankaSim, ServedRobot
    from pyfranka.sim import FR3, Panda

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
    meaning = "whether franka_panda and franka_fr3 have the names panda and fr3, too (true)"
    parser.addini("franka_short_fixtures", meaning, type="bool", default=True)


def pytest_configure(config: pytest.Config) -> None:
    if config.getini("franka_short_fixtures"):
        config.pluginmanager.register(ShortNames(), "pyfranka short fixtures")


def _running() -> list[FrankaSim]:
    """The programs that this process has started; none before something has imported what starts them."""
    module = sys.modules.get("pyfranka.franka_sim")
    return module.FrankaSim.known() if module else []


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    item.stash[BEFORE] = {sim: None if sim.stopped else sim.log_size() for sim in _running()}


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Generator[None, typing.Any, None]:
    report = (yield).get_result()
    if not report.failed:
        return
    before = item.stash.get(BEFORE, {})
    for sim in _running():
        since = before.get(sim, 0)
        if since is not None:
            from pyfranka.franka_sim import last_lines

            robots = ", ".join(f"{robot.name} at {robot.address}" for robot in sim.robots)
            text = "\n".join(filter(None, [last_lines(sim.log(since)), sim.status()]))
            report.sections.append((f"franka_sim, {robots}", text))


class Factory:
    """Starts programs franka_sim with the session's settings."""

    def __init__(self, config: pytest.Config, stack: ExitStack):
        self._config, self._stack = config, stack

    def __call__(
        self,
        *robots: Panda | FR3 | str,
        world: str | os.PathLike[str] = "",
        pace: str | float | None = None,
        arguments: Sequence[str] = (),
        **options: typing.Any,
    ) -> FrankaSim:
        """A running franka_sim with these robots, pyfranka.sim.Panda and FR3 or their kinds; without one, a
        panda. options: further ones of FrankaSim, such as patience; and those of Panda and FR3, such as name
        and realism, for robots that are given as their kind.

        Raises FrankaSimError with the program's own sentence.
        """
        from inspect import signature

        from pyfranka.franka_sim import FrankaSim
        from pyfranka.sim.setups import described

        realism = self._setting("realism")
        if realism and "realism" not in options:
            options["realism"] = realism
        for_server = {name: options.pop(name) for name in signature(FrankaSim).parameters if name in options}
        given = [described(each, **options) for each in robots or ("panda",)]
        return self._stack.enter_context(
            FrankaSim(
                *given,
                world=world,
                pace=(self._setting("pace") or "lockstep") if pace is None else pace,
                arguments=arguments,
                **{"program": self._setting("program"), **for_server},
            )
        )

    def _setting(self, name: str) -> str:
        name = f"franka_sim_{name}"
        value: str = self._config.getoption(name) or self._config.getini(name)
        return value


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
def franka_panda(franka_sim: Callable[..., FrankaSim]) -> ServedRobot:
    """A running Panda."""
    return franka_sim("panda").robot


@pytest.fixture
def franka_fr3(franka_sim: Callable[..., FrankaSim]) -> ServedRobot:
    """A running FR3."""
    return franka_sim("fr3").robot


class ShortNames:
    """The same fixtures by their short names."""

    @pytest.fixture
    def panda(self, franka_panda: ServedRobot) -> ServedRobot:
        """A running Panda."""
        return franka_panda

    @pytest.fixture
    def fr3(self, franka_fr3: ServedRobot) -> ServedRobot:
        """A running FR3."""
        return franka_fr3

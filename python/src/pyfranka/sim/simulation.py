# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A world with robots, stepped by the program."""

from __future__ import annotations

import copy
import logging
import os
import threading
import time
import typing
import warnings
import weakref
from collections.abc import ItemsView, Iterator, KeysView, Mapping, Sequence, ValuesView

import numpy
from _pyfranka._sim import Snapshot
from numpy.typing import ArrayLike, NDArray

from pyfranka import _copies
from pyfranka._native import _sim

from .arguments import items, mapping, no_robot, numbers, path, seed_of, text
from .png import png_of
from .robot import Array, SimulatedRobot
from .setups import _Setup, described

NO_TURN = (1.0, 0.0, 0.0, 0.0)
ATTENTION = 0.02  # [s] between looks at the network (chosen here)
TRIES = 1000  # random poses before giving up (chosen here)
TRIAL = 20  # ticks after which a pose has shown what it touches (chosen here)
MOVED = 1e-3  # [rad] by then, of an arm that was pushed away (chosen here)
log = logging.getLogger("pyfranka.sim")


class Contact(typing.NamedTuple):
    """A contact of two bodies: names, position in the world [m], force on the second one, world axes [N].

    >>> sim.step(500)  # the stone comes to rest
    >>> sim.contacts()[0].body1, sim.contacts()[0].body2
    ('pick_tray', 'stone')
    """

    body1: str
    body2: str
    position: Array
    force: Array


class _Reset(typing.NamedTuple):
    """What reset() does. poses: None for a random one."""

    poses: dict[str, Array | None]
    places: dict[str, tuple[Array, Array]]
    seed: int | None


class Picture(typing.NamedTuple):
    """rgb: height x width x 3. depth along the viewing axis [m], height x width; None for the free camera.

    >>> rgb, depth = sim.render(width=64, height=48)
    >>> rgb.shape
    (48, 64, 3)
    """

    rgb: NDArray[numpy.uint8]
    depth: NDArray[numpy.float32] | None

    def _repr_png_(self) -> bytes:
        """What notebooks show."""
        return png_of(self.rgb)


def _attend(simulation: weakref.ref[Simulation]) -> None:
    """Serves clients until the simulation is closed or forgotten."""
    attended = True
    while attended and (served := simulation()) is not None:
        attended = served._native.attend()
        for event in served._native.take_events():
            log.warning("%s", event)
        del served
        time.sleep(ATTENTION)


class Simulation:
    """A world with robots, stepped by the program. `sim["panda"]` is a SimulatedRobot; `for name in sim`,
    `name in sim`, `len(sim)` and `sim.items()` are about its robots.

    world: an MJCF or SDF file, or the name of one that is installed with franka_sim (stone.xml, push.xml,
    hand_over.xml); empty: an empty world. robots: Panda, FR3 or their kinds. seed: of all
    randomness; the same seed and the same calls give the same bits.

    Raises FileNotFoundError, RuntimeError or ValueError with a sentence for a world or a robot that cannot be
    used. Warns (RuntimeWarning) of parts of a world that have no effect.

    >>> with pyfranka.sim.Simulation("stone.xml", [pyfranka.sim.Panda(base=(-0.5, 0, 0))]) as sim:
    ...     sim.step(100)
    ...     sim
    <Simulation of 'panda' at 0.1 s>
    """

    def __init__(
        self, world: str | os.PathLike[str] = "", robots: Sequence[_Setup | str] | None = None, seed: int = 1
    ):
        self._make(world, robots, seed)
        self._warn(3)

    def _make(self, world: str | os.PathLike[str], robots: Sequence[_Setup | str] | None, seed: int) -> None:
        """Any thread may call it."""
        world, seed = path(world, "world"), seed_of(seed)
        taken: set[str] = set()
        what = "Panda(...), FR3(...) and their kinds"
        given = [described(each) for each in (["panda"] if robots is None else items(robots, "robots", what))]
        for robot in given:
            robot._require_in_process()
        named = [robot._named(taken) for robot in given]
        setups = [robot._seeded(seed + i) for i, robot in enumerate(named)]
        self._random = numpy.random.default_rng(seed)
        self._attendant: threading.Thread | None = None
        self._native = _sim.Simulation(world, [setup._native() for setup in setups])
        self._robots = {setup.name: SimulatedRobot(self._native.robot(setup.name), setup) for setup in setups}

    def _warn(self, stacklevel: int) -> None:
        """Of what the world cannot have, and of robots within other bodies."""
        for warning in self._native.take_warnings():
            warnings.warn(warning, RuntimeWarning, stacklevel=stacklevel)
        for name in self:
            if overlaps := self._native.overlaps(name):
                warnings.warn(f"{overlaps} Give it another base.", stacklevel=stacklevel)

    __reduce__ = _copies.refused(
        "A Simulation can be neither pickled nor copied: make one with the same world, robots and seed where "
        "it is used."
    )

    def __repr__(self) -> str:
        robots = ", ".join(f"'{name}'" for name in self) or "no robots"
        try:
            return f"<Simulation of {robots} at {self.time:g} s>"
        except RuntimeError as error:
            return f"<Simulation of {robots}: {error}>"

    def __bool__(self) -> bool:
        return True  # also without robots

    def __getitem__(self, name: str) -> SimulatedRobot:
        if name not in self:
            raise KeyError(no_robot(name, self))
        return self._robots[name]

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and name in self._robots

    def __iter__(self) -> Iterator[str]:
        return iter(self._robots)

    def __len__(self) -> int:
        return len(self._robots)

    def keys(self) -> KeysView[str]:
        """Names of the robots.

        >>> [*sim.keys()]
        ['panda']
        """
        return self._robots.keys()

    def values(self) -> ValuesView[SimulatedRobot]:
        """The robots, in the order of `robots`.

        >>> [robot.name for robot in sim.values()]
        ['panda']
        """
        return self._robots.values()

    def items(self) -> ItemsView[str, SimulatedRobot]:
        """Names and robots.

        >>> {name: robot.moving for name, robot in sim.items()}
        {'panda': False}
        """
        return self._robots.items()

    def __enter__(self) -> Simulation:
        self._native.require_open()
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def close(self) -> None:
        """Ends the simulation: all further calls raise RuntimeError, and so does a step() of another thread,
        which ends within a tick. Clients lose their robots.

        >>> pyfranka.sim.Simulation().close()
        """
        self._native.close()

    def serve(
        self,
        ip: str,
        robot: str | None = None,
        pace: str = "lockstep",
        patience: float | str = 30.0,
        wait: str = "auto",
    ) -> None:
        """Puts a robot (the only one) on the network at an address of this machine: clients connect to it as
        to a real one, and time passes in step() alone.

        pace: "lockstep", a tick waits for the answer of a client in motion, or "realtime", ticks follow the
        clock. patience: after so many seconds without an answer in lock-step a client counts as lost;
        "forever": never. wait: how it is waited for: "auto", "spin" (without sleep, for a processor of its
        own) or "block"; results do not depend on it. These are those of the first call. Ctrl-C ends a wait:
        that tick proceeds without the answer. A robot moves either for a client or for command(); the second
        one is refused. While the program does other work, a thread keeps the connections alive. Why a
        connection is ended, and collisions, are warnings of the logger "pyfranka.sim".

        Raises ValueError, KeyError; RuntimeError where the address cannot be used.

        >>> served = pyfranka.sim.Simulation()
        >>> served.serve("127.0.33.7")
        >>> pyfranka.Robot("127.0.33.7", pyfranka.RealtimeConfig.Ignore).server_version
        5
        >>> served.close()
        """
        if robot is None and len(self) != 1:
            raise ValueError(f"Which robot? There are: {', '.join(self) or 'none'}.")
        name = self[next(iter(self)) if robot is None else robot].name
        if text(pace, "pace") not in ("lockstep", "realtime"):
            raise ValueError(f"pace is 'lockstep' or 'realtime', not '{pace}'.")
        if isinstance(patience, str) and patience != "forever":
            raise ValueError(f"patience is a number of seconds or 'forever', not '{patience}'.")
        self._native.serve(
            name, ip, pace == "realtime", None if isinstance(patience, str) else patience, wait
        )
        if self._attendant is None:
            self._attendant = threading.Thread(
                target=_attend, args=(weakref.ref(self),), name="pyfranka.sim clients", daemon=True
            )
            self._attendant.start()

    @property
    def ticks(self) -> int:
        """Milliseconds since the start or the last reset."""
        return int(self._native.ticks())

    @property
    def time(self) -> float:
        """Simulated time since the start or the last reset [s]."""
        return 1e-3 * self.ticks

    def step(self, ticks: int = 1) -> None:
        """Advances by so many milliseconds; other Python threads run meanwhile. Raises RuntimeError once the
        physics has diverged, which reset() ends, and once another thread has closed the simulation. Warns
        once (RuntimeWarning) when there are more contacts than the limit (nconmax).

        >>> sim.step(10)
        >>> sim.ticks
        10
        """
        self._native.step(ticks)

    def reset(
        self,
        q: ArrayLike | str | Mapping[str, ArrayLike | str] | None = None,
        objects: Mapping[str, ArrayLike] | None = None,
        seed: int | None = None,
    ) -> None:
        """Resets the world to its beginning; the robots are idle, at rest and without errors.

        q: joint positions, 7 [rad], or "random" (within the limits, free of contacts), of all robots or by
        name. objects: body name -> x, y, z [m] and, optionally, the quaternion w, x, y, z. seed: of the
        random numbers from now on; without one, their sequence goes on.

        Random are the poses alone: noise and everything else that `realism` draws come from the seed of
        the simulation and begin again with each reset.

        Raises ValueError, TypeError, KeyError; RuntimeError where an object cannot be moved or no random pose
        is free. Nothing has changed then.

        >>> sim.reset(q="random", objects={"stone": [0.0, 0.2, 0.5]}, seed=7)
        >>> sim.ticks
        0
        """
        self._carry_out(self._plan(q, objects, seed))

    def _plan(
        self,
        q: ArrayLike | str | Mapping[str, ArrayLike | str] | None,
        objects: Mapping[str, ArrayLike] | None,
        seed: int | None = None,
    ) -> _Reset:
        """The arguments of reset(), checked."""
        places = {
            body: self._checked_place(body, pose)
            for body, pose in mapping(objects, "objects", "poses by the names of bodies").items()
        }
        given = q if isinstance(q, Mapping) else {name: q for name in self if q is not None}
        poses = {name: self._checked_pose(self[name], pose) for name, pose in given.items()}
        return _Reset(poses, places, None if seed is None else seed_of(seed))

    def _carry_out(self, plan: _Reset) -> None:
        may_fail = any(pose is None for pose in plan.poses.values()) and not self._native.stopped()
        before = (self.snapshot(), copy.deepcopy(self._random)) if may_fail else None
        try:
            self._native.reset()
            if plan.seed is not None:
                self._random = numpy.random.default_rng(plan.seed)
            for body, (position, orientation) in plan.places.items():
                self.place_body(body, position, orientation)
            for name, pose in plan.poses.items():
                if pose is None:
                    self._place_randomly(self[name])
                else:
                    self[name]._native.place(pose)
        except BaseException:
            if before:
                self.restore(before[0])
                self._random = before[1]
            raise

    def _checked_place(self, body: str, pose: ArrayLike) -> tuple[Array, Array]:
        values = numbers(pose, f"The pose of '{text(body, 'The name of a body')}'", 3, 7)
        position, orientation = values[:3], values[3:] if values.size == 7 else numpy.array(NO_TURN)
        self._native.check_body_pose(body, position, orientation)
        return position, orientation

    def _checked_pose(self, robot: SimulatedRobot, q: ArrayLike | str) -> Array | None:
        """None for a random pose."""
        if isinstance(q, str):
            if q != "random":
                raise ValueError(f"q is 7 numbers or 'random', not '{q}'.")
            return None
        values = numbers(q, "q", 7)
        robot._native.check_positions(values)
        return values

    def _place_randomly(self, robot: SimulatedRobot) -> None:
        before = self.snapshot()
        for _ in range(TRIES):
            q = self._random.uniform(*robot.limits)
            robot._native.place(q)
            self._native.try_out(TRIAL)
            state = robot.live_state
            free = not state.current_errors and numpy.abs(state.q - q).max() < MOVED
            free = free and not self._touches(robot)
            self.restore(before)
            if free:
                robot._native.place(q)
                return
        raise RuntimeError(f"No random pose of '{robot.name}' is free of contacts ({TRIES} tries).")

    def _touches(self, robot: SimulatedRobot) -> bool:
        own = f"{robot.name}_"
        touched = any(c.body1.startswith(own) or c.body2.startswith(own) for c in self.contacts())
        return touched or bool(self._native.overlaps(robot.name))

    def snapshot(self) -> Snapshot:
        """The present state of the world and of its robots, with motions, commands, hands and settings, for
        restore() here or in a simulation with an equal world and equal robots. The random numbers of reset()
        are not part of it. RuntimeError once the physics has diverged.

        >>> before = sim.snapshot()
        >>> sim.step(10)
        >>> sim.restore(before)
        """
        return self._native.snapshot()

    def restore(self, snapshot: Snapshot) -> None:
        """Returns to a snapshot; with the same commands, what follows is the same to the last bit. A robot
        that clients on the network use is idle instead. Commands of hands that were given since are
        interrupted.

        Raises RuntimeError for a snapshot of another world or other robots, and nothing has changed.

        >>> before = sim.snapshot()
        >>> sim.step(10)
        >>> sim.restore(before)
        >>> sim.ticks
        0
        """
        self._native.restore(snapshot)

    def state_hash(self) -> int:
        """Hash of the world's state: bodies, joints and what acts on them.

        >>> before = sim.state_hash()
        >>> sim.step()
        >>> sim.state_hash() == before
        False
        """
        return int(self._native.hash())

    def bodies(self) -> list[str]:
        """Names of all bodies, links included.

        >>> "stone" in sim.bodies()
        True
        """
        return list(self._native.bodies())

    def body_pose(self, body: str) -> tuple[Array, Array]:
        """Position [m] and quaternion w, x, y, z of a body in the world.

        >>> position, orientation = sim.body_pose("stone")
        >>> position.shape, orientation.shape
        ((3,), (4,))
        """
        pose: tuple[Array, Array] = self._native.body_pose(body)
        return pose

    def place_body(self, body: str, position: ArrayLike, orientation: ArrayLike = NO_TURN) -> None:
        """Puts a free body to a position [m] and a quaternion w, x, y, z, at rest.

        >>> sim.place_body("stone", [0.0, 0.2, 0.5])
        >>> sim.body_pose("stone")[0].tolist()
        [0.0, 0.2, 0.5]
        """
        self._native.place_body(body, position, orientation)

    def push(self, body: str, force: ArrayLike, torque: ArrayLike = (0.0, 0.0, 0.0), ticks: int = 1) -> None:
        """A force [N] and a torque [Nm] at a body's origin, world axes, at most 1000 along each, for so many
        milliseconds from now.

        >>> sim.push("stone", [0.0, 0.0, 1.0], ticks=100)
        >>> sim.step(100)
        """
        self._native.push(body, force, torque, ticks)

    def contacts(self) -> list[Contact]:
        """The present contacts.

        >>> sim.step(500)  # the stone comes to rest
        >>> "stone" in {contact.body2 for contact in sim.contacts()}
        True
        """
        return [Contact(*contact) for contact in self._native.contacts()]

    def cameras(self) -> list[str]:
        """Names of the world's cameras.

        >>> sim.cameras()  # this world has none
        []
        """
        return list(self._native.cameras())

    def render(self, camera: str = "", width: int = 640, height: int = 480) -> Picture:
        """A picture of a camera; without a name, of a view of the whole world. Needs no display.

        Any thread may draw; those that draw at once, of several simulations, take turns. Raises RuntimeError
        in a process that was forked after a picture was drawn.

        >>> sim.render(width=64, height=48).rgb.shape
        (48, 64, 3)
        """
        return Picture(*self._native.render(camera, width, height))

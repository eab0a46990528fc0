# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A world with robots, stepped by the program."""

from __future__ import annotations

import threading
import time
import typing
import warnings
import weakref
from collections.abc import Mapping, Sequence

import numpy
from _pyfranka import _sim
from _pyfranka._sim import Snapshot
from numpy.typing import ArrayLike, NDArray

from .robot import Array, Robot
from .setups import FR3, Panda, _Setup

NO_TURN = (1.0, 0.0, 0.0, 0.0)
ATTENTION = 0.02  # [s] between looks at the network (chosen here)
TRIES = 1000  # random poses before giving up (chosen here)
TRIAL = 20  # ticks after which a pose has shown what it touches (chosen here)
MOVED = 1e-3  # [rad] by then, of an arm that was pushed away (chosen here)


class Contact(typing.NamedTuple):
    """Where two bodies touch: names, position in the world [m], force on the second one, world axes [N]."""

    body1: str
    body2: str
    position: Array
    force: Array


class Picture(typing.NamedTuple):
    """rgb: height x width x 3. depth along the viewing axis [m], height x width; None for the free camera."""

    rgb: NDArray[numpy.uint8]
    depth: NDArray[numpy.float32] | None


def _attend(simulation: weakref.ref) -> None:
    """Serves clients until the simulation is closed or forgotten."""
    while (served := simulation()) is not None and served._native.attend():
        del served
        time.sleep(ATTENTION)


class Simulation(Mapping):
    """A world with robots, stepped by the program. `sim["panda"]` is a Robot.

    world: an MJCF or SDF file, or the name of one that comes along (stone.xml); empty: an empty world.
    robots: Panda and FR3. seed: of all randomness; the same seed and the same calls give the same bits.

    Raises RuntimeError or ValueError with a sentence for a world or a robot that cannot be used.
    """

    def __init__(self, world: str = "", robots: Sequence[_Setup] | None = None, seed: int = 1):
        robots, taken = [Panda()] if robots is None else robots, set()
        for robot in robots:
            if not isinstance(robot, (Panda, FR3)):
                raise TypeError(f"robots are Panda(...) and FR3(...), not {type(robot).__name__}.")
        named = [robot._named(taken) for robot in robots]
        setups = [robot._seeded(seed + i) for i, robot in enumerate(named)]
        self._random = numpy.random.default_rng(seed)
        self._attendant: threading.Thread | None = None
        self._native = _sim.Simulation(world, [setup._native() for setup in setups])
        self._robots = {setup.name: Robot(self._native.robot(setup.name), setup) for setup in setups}
        for name in self:
            if overlaps := self._native.overlaps(name):
                warnings.warn(f"{overlaps} Give it another base.", stacklevel=2)

    def __getitem__(self, name: str) -> Robot:
        if name not in self._robots:
            raise KeyError(f"There is no robot '{name}'; there are: {', '.join(self._robots)}.")
        return self._robots[name]

    def __iter__(self):
        return iter(self._robots)

    def __len__(self) -> int:
        return len(self._robots)

    def __enter__(self) -> Simulation:
        return self

    def __exit__(self, *error) -> None:
        self.close()

    def close(self) -> None:
        """Ends the simulation: all further calls raise RuntimeError. Clients lose their robots."""
        self._native.close()

    def serve(
        self, ip: str, robot: str | None = None, pace: str = "lockstep", patience: float = 30.0
    ) -> None:
        """Puts a robot (the only one) on the network at an address of this machine: clients connect to it as
        to a real one, and time passes in step() alone.

        pace: "lockstep", a tick waits for the answer of a client in motion, or "realtime", ticks follow the
        clock. patience: after so many seconds without an answer in lock-step a client counts as lost. Both
        are those of the first call. A robot moves either for a client or for command(); the second one is
        refused. While the program does other work, a thread keeps the connections alive.

        Raises ValueError, KeyError; RuntimeError where the address cannot be used.
        """
        if robot is None and len(self) != 1:
            raise ValueError(f"Which robot? There are: {', '.join(self) or 'none'}.")
        name = self[next(iter(self)) if robot is None else robot].name
        if pace not in ("lockstep", "realtime"):
            raise ValueError(f"pace is 'lockstep' or 'realtime', not '{pace}'.")
        self._native.serve(name, ip, pace == "realtime", patience)
        if self._attendant is None:
            self._attendant = threading.Thread(
                target=_attend, args=(weakref.ref(self),), name="pyfranka.sim clients", daemon=True
            )
            self._attendant.start()

    @property
    def ticks(self) -> int:
        """Milliseconds since the start or the last reset."""
        return self._native.ticks()

    @property
    def time(self) -> float:
        """The same [s]."""
        return 1e-3 * self.ticks

    def step(self, ticks: int = 1) -> None:
        """Advances by so many milliseconds; other Python threads run meanwhile. Raises RuntimeError once the
        physics has diverged; reset() ends that."""
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

        Raises ValueError, KeyError, and nothing has changed; RuntimeError where an object cannot be moved or
        no random pose is free.
        """
        places = {body: self._checked_place(body, pose) for body, pose in (objects or {}).items()}
        given = q if isinstance(q, Mapping) else {name: q for name in self if q is not None}
        poses = {name: self._checked_pose(self[name], pose) for name, pose in given.items()}
        self._native.reset()
        if seed is not None:
            self._random = numpy.random.default_rng(seed)
        for body, (position, orientation) in places.items():
            self.place_body(body, position, orientation)
        for name, pose in poses.items():
            if pose is None:
                self._place_randomly(self[name])
            else:
                self[name]._native.place(pose)

    def _checked_place(self, body: str, pose: ArrayLike) -> tuple[Array, Array]:
        values = numpy.asarray(pose, dtype=float).ravel()
        if body not in self.bodies():
            raise ValueError(f"There is no body '{body}' in the world.")
        if values.size not in (3, 7) or not numpy.isfinite(values).all():
            raise ValueError(f"The pose of '{body}' is 3 or 7 finite numbers: x, y, z, and w, x, y, z.")
        return values[:3], values[3:] if values.size == 7 else numpy.array(NO_TURN)

    def _checked_pose(self, robot: Robot, q: ArrayLike | str) -> Array | None:
        """None for a random pose."""
        if isinstance(q, str):
            if q != "random":
                raise ValueError(f"q is 7 numbers or 'random', not '{q}'.")
            return None
        values = numpy.asarray(q, dtype=float).ravel()
        robot._native.check_positions(values)
        return values

    def _place_randomly(self, robot: Robot) -> None:
        before = self.snapshot()
        for _ in range(TRIES):
            q = self._random.uniform(*robot.limits)
            robot._native.place(q)
            self.step(TRIAL)
            free = not robot.state.current_errors and numpy.abs(robot.state.q - q).max() < MOVED
            free = free and not self._touches(robot)
            self.restore(before)
            if free:
                robot._native.place(q)
                return
        raise RuntimeError(f"No random pose of '{robot.name}' is free of contacts ({TRIES} tries).")

    def _touches(self, robot: Robot) -> bool:
        own = f"{robot.name}_"
        touched = any(c.body1.startswith(own) or c.body2.startswith(own) for c in self.contacts())
        return touched or bool(self._native.overlaps(robot.name))

    def snapshot(self) -> Snapshot:
        """The present state of the world, for restore()."""
        return self._native.snapshot()

    def restore(self, snapshot: Snapshot) -> None:
        """Returns to a snapshot. The robots hold their poses in it, idle; commands in transit are lost."""
        self._native.restore(snapshot)

    def hash(self) -> int:
        """Hash of the world's state: bodies, joints and what acts on them."""
        return self._native.hash()

    def bodies(self) -> list[str]:
        """Names of all bodies, links included."""
        return self._native.bodies()

    def body_pose(self, body: str) -> tuple[Array, Array]:
        """Position [m] and quaternion w, x, y, z of a body in the world."""
        return self._native.body_pose(body)

    def place_body(self, body: str, position: ArrayLike, orientation: ArrayLike = NO_TURN) -> None:
        """Puts a free body to a position [m] and a quaternion w, x, y, z, at rest."""
        self._native.place_body(body, position, orientation)

    def push(self, body: str, force: ArrayLike, torque: ArrayLike = (0.0, 0.0, 0.0), ticks: int = 1) -> None:
        """A force [N] and a torque [Nm] at a body's origin, world axes, for so many milliseconds from now."""
        self._native.push(body, force, torque, ticks)

    def contacts(self) -> list[Contact]:
        """Where bodies touch now."""
        return [Contact(*contact) for contact in self._native.contacts()]

    def cameras(self) -> list[str]:
        """Names of the world's cameras."""
        return self._native.cameras()

    def render(self, camera: str = "", width: int = 640, height: int = 480) -> Picture:
        """A picture of a camera; without a name, of a view of the whole world. Needs no display."""
        return Picture(*self._native.render(camera, width, height))

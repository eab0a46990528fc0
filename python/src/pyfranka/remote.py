# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The control interface of a robot that franka_sim serves, which represents the operator beside it.

    from pyfranka.remote import Remote

    remote = Remote("127.0.0.1")
    remote.set_user_stop(True)
    print(remote.state().mode)

Each line of the interface (docs/franka_sim.md) is a method. It needs sockets and numpy only.
"""

from __future__ import annotations

import base64
import json
import re
import time
import typing
import warnings
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy
from numpy.typing import ArrayLike, NDArray

from pyfranka import _remote_words as words
from pyfranka._remote_connection import PAUSE, SharedConnection, left
from pyfranka.refusals import split_refusal
from pyfranka.robot_report import Report, report_of

__all__ = ["PORT", "LineRefused", "Remote", "RemoteMesh", "RemoteScene", "RemoteShape", "RemoteState"]

Array = NDArray[numpy.float64]
# The port of the control interface.
PORT = 1340
NO_TURN = (1.0, 0.0, 0.0, 0.0)
ZERO = (0.0, 0.0, 0.0)
NO_INERTIA = (0.0,) * 9
# Chosen here: `hash` and `wait` may take 10 s of simulated time on a busy machine.
TIME_LIMIT = 60.0  # [s]
# The last request of wait() may take this long beyond the limit: else it would have no time for its answer.
MIN_ANSWER_TIME = 1.0  # [s] (chosen here)
STATE = re.compile(
    r"(?P<mode>.+?), (?:client of protocol (?P<protocol>\d+)|no client), errors (?P<errors>.*)"
    r", q(?P<q>(?: \S+){7})"
    r"(?:; (?P<fault>.*))?"
)
ERROR = re.compile(r"(?P<name>\w+)(?: \((?P<detail>[^()]*)\))?")


class LineRefused(RuntimeError):
    """The robot has refused a line; the text is its own sentence, and nothing has changed."""

    @property
    def code(self) -> str:
        """The rule that refuses it, of pyfranka.refusals, such as "BrakesClosed"; empty for other errors."""
        return split_refusal(str(self))[0]


@dataclass(frozen=True, eq=False)
class RemoteState:
    """The answer to the line `state`.

    mode: such as "Idle", "Move", "Reflex", "User stopped", "Guiding", "Other". protocol: version of the
    connected client, 0 without one. errors: present errors with their details, which may be empty.
    q: joint positions, 7 [rad]. fault: why the whole world stands still; empty while it does not.

    >>> remote.state().mode
    'Idle'
    """

    mode: str
    protocol: int
    errors: dict[str, str]
    q: Array
    fault: str


@dataclass(frozen=True, eq=False)
class RemoteShape:
    """A shape to draw. body: its index in RemoteScene.bodies. kind: "box", "sphere", "capsule", "cylinder",
    "ellipsoid", "plane" or "mesh". size: half sizes as in MuJoCo, 3 [m]. pose: in the body, position [m] and
    quaternion w, x, y, z. color: red, green, blue, opacity, 0 to 1. mesh: its name, empty without one.

    >>> remote.scene().shapes[0].pose.shape
    (7,)
    """

    body: int
    kind: str
    size: Array
    pose: Array
    color: Array
    mesh: str


@dataclass(frozen=True)
class RemoteScene:
    """The world to draw. bodies: their names, links of robots included; some may be empty. shapes: those of
    all bodies. robots: arm_id and type ("panda" or "fr3") of each.

    >>> remote.scene().robots["panda"]
    'panda'
    """

    bodies: list[str]
    shapes: list[RemoteShape]
    robots: dict[str, str]


@dataclass(frozen=True, eq=False)
class RemoteMesh:
    """Triangles in the frame of each shape that has them. vertices: n x 3 [m]. faces: n x 3 indices.

    >>> names = [shape.mesh for shape in remote.scene().shapes if shape.mesh]
    >>> [remote.mesh(name).faces.shape[1] for name in names[:1]] in ([3], [])
    True
    """

    vertices: NDArray[numpy.float32]
    faces: NDArray[numpy.uint32]


class Remote:
    """The control interface of one robot. Each robot of one franka_sim has its own, at its own address; lines
    about the world (push, place, where, time, step, wait, reset, quit) concern all of them.

    address, port: where the robot is. timeout: limit of each call [s], unless the call names another one.

    A method returns after its line has taken effect and states that show it were sent. It raises
    LineRefused with the robot's sentence; ValueError or TypeError for what cannot be written as a line;
    ConnectionError where no robot is or where it goes away; TimeoutError where no answer comes in time. After
    the last two the line may have taken effect. In a motion in lock-step the effect is in the next tick.

    The robot serves eight clients at a time and executes their lines in the order of arrival. By itself each
    call is a connection of its own; while eight others are connected, it waits within its limit. As a context
    manager a Remote keeps one connection, which saves time and keeps its place. Thread-safe. A forked
    process, a copy and a pickle have connections of their own.

    >>> remote = pyfranka.sim.Remote("172.16.0.2")
    >>> remote.step(10)
    >>> remote.state().mode
    'Idle'
    """

    def __init__(self, address: str, port: int = PORT, timeout: float = TIME_LIMIT):
        if not address or not isinstance(address, str):
            raise ValueError("Give the address of the robot, such as 127.0.0.1.")
        port, self.timeout = words.whole(port, "port"), words.seconds(timeout)
        if not 1 <= port <= 65535:
            raise ValueError(f"port must be 1 to 65535, not {port}.")
        self._connection = SharedConnection(address, port)

    def __reduce__(self) -> tuple[type[Remote], tuple[str, int, float]]:
        return type(self), (self.address, self.port, self.timeout)

    def __repr__(self) -> str:
        return f"Remote({self.address!r}, {self.port})"

    @property
    def address(self) -> str:
        """Where the robot is.

        >>> remote.address
        '172.16.0.2'
        """
        return self._connection.address

    @property
    def port(self) -> int:
        """The port of its control interface.

        >>> remote.port
        1340
        """
        return self._connection.port

    def __enter__(self) -> Remote:
        with self._connection.keep(self.timeout):
            self.send("time")  # a client that has sent a line is not replaced by another one
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def close(self) -> None:
        """Ends the connection that the context manager holds; the robot stays.

        >>> with pyfranka.sim.Remote("172.16.0.2") as kept:
        ...     kept.close()
        """
        self._connection.close()

    def send(self, line: str, timeout: float | None = None) -> str:
        """Sends a line as it stands, without its end. Returns what follows `ok`, or an empty string.

        >>> float(remote.send("time")) <= remote.time
        True
        """
        if not isinstance(line, str):
            raise TypeError(f"A line is a text, not {line!r}.")
        if "\n" in line:
            raise ValueError("Send one line at a time, without its end.")
        try:
            line.encode()
        except UnicodeEncodeError:
            raise ValueError(f"The line {line!r} cannot be sent as UTF-8.") from None
        limit = self.timeout if timeout is None else words.seconds(timeout)
        answer = self._connection.exchange(line, limit)
        word, _, value = answer.partition(" ")
        if word == "ok":
            return value
        if word == "error:":
            raise LineRefused(value)
        raise ConnectionError(
            f"What answers at {self._connection.place} is not a control interface of franka_sim: "
            f"'{answer[:80]}'."
        )

    def commands(self, timeout: float | None = None) -> list[str]:
        """The lines that this robot knows, with their words.

        >>> "time" in remote.commands()
        True
        """
        return self.send("help", timeout).split("; ")

    # ---- the robot ---------------------------------------------------------------------------------------

    def set_user_stop(self, pressed: bool, timeout: float | None = None) -> None:
        """Presses or releases the user stop, which aborts a motion.

        >>> remote.set_user_stop(True)
        >>> remote.state().mode
        'User stopped'
        >>> remote.set_user_stop(False)
        """
        self.send(f"user_stop {words.switch(pressed, 'pressed')}", timeout)

    def set_guiding(self, active: bool, timeout: float | None = None) -> None:
        """Begins or ends guiding by hand.

        >>> remote.set_guiding(True)
        >>> remote.set_guiding(False)
        """
        self.send(f"guiding {words.switch(active, 'active')}", timeout)

    def close_brakes(self, timeout: float | None = None) -> None:
        """Closes the brakes, which ends a motion.

        >>> remote.close_brakes()
        >>> remote.open_brakes()
        >>> remote.wait().mode
        'Idle'
        """
        self.send("brakes close", timeout)

    def open_brakes(self, timeout: float | None = None) -> None:
        """Opens the brakes, which takes a while: wait() returns when they are open.

        >>> remote.open_brakes()
        >>> remote.wait().mode
        'Idle'
        """
        self.send("brakes open", timeout)

    def activate_fci(self, timeout: float | None = None) -> None:
        """Clients may connect.

        >>> remote.activate_fci()
        """
        self.send("fci on", timeout)

    def deactivate_fci(self, timeout: float | None = None) -> None:
        """Clients may not connect: a motion is aborted and the client disconnected.

        >>> with FrankaSim("fr3") as server:
        ...     server.robot.remote.deactivate_fci()
        """
        self.send("fci off", timeout)

    def lock_joints(self, timeout: float | None = None) -> None:
        """Closes the brakes with Desk's rules; returns when they have closed.

        >>> with FrankaSim("panda", start="locked") as server:
        ...     server.robot.remote.unlock_joints()
        ...     server.robot.remote.lock_joints()
        """
        self.send("joints lock", timeout)

    def unlock_joints(self, timeout: float | None = None) -> None:
        """Opens the brakes, joint by joint with Desk's rules; returns when they are open.

        >>> with FrankaSim("fr3", start="locked") as server:
        ...     server.robot.remote.unlock_joints()
        """
        self.send("joints unlock", timeout)

    def operating_mode(
        self, mode: typing.Literal["execution", "programming"], timeout: float | None = None
    ) -> None:
        """Of an FR3; programming ends the FCI.

        >>> with FrankaSim("fr3", start="locked") as server:
        ...     server.robot.remote.operating_mode("programming")
        """
        self.send(f"operating_mode {words.word(mode, 'mode')}", timeout)

    def set_input(
        self,
        name: typing.Literal["x31", "x32", "x33", "x4", "guiding"],
        pressed: bool,
        timeout: float | None = None,
    ) -> None:
        """Presses or releases a stop, the activation or enabling device (x4) or the guiding button.

        >>> server["fr3"].remote.set_input("guiding", True)
        >>> server["fr3"].remote.set_input("guiding", False)
        """
        self.send(f"input {words.word(name, 'name')} {words.switch(pressed, 'pressed')}", timeout)

    def button(self, name: str, pressed: bool, timeout: float | None = None) -> None:
        """Presses or releases a button of the Pilot: circle, cross, check, up, down, left or right.

        >>> remote.button("circle", True)
        >>> remote.button("circle", False)
        """
        self.send(f"button {words.word(name, 'name')} {words.switch(pressed, 'pressed')}", timeout)

    def guiding_mode(
        self,
        mode: typing.Literal["free", "translation", "rotation", "user"],
        axes: Sequence[bool] = (),
        timeout: float | None = None,
    ) -> None:
        """The directions in which the arm can be guided. axes: only for user; along and about x, y, z of K,
        and the elbow, 7.

        >>> remote.guiding_mode("free")
        """
        if not isinstance(axes, Iterable):
            raise TypeError(f"The axes are a list, each True or False, not {axes!r}.")
        self.send(
            " ".join(
                ["guiding_mode", words.word(mode, "mode"), *(words.switch(each, "axes") for each in axes)]
            ),
            timeout,
        )

    def navigation(self, user: typing.Literal["desk", "robot"], timeout: float | None = None) -> None:
        """Target of the Pilot's arrow keys: Desk or the robot.

        >>> remote.navigation("desk")
        """
        self.send(f"navigation {words.word(user, 'user')}", timeout)

    def self_test(self, due: float | None = None, timeout: float | None = None) -> None:
        """Starts the self-test; with `due`, sets only the time until it is overdue [s].

        >>> remote.self_test(due=86400.0)
        """
        self.send(
            "self_test" if due is None else words.line("self_test due", words.number(due, "due")), timeout
        )

    def acknowledge(self, error: str, timeout: float | None = None) -> None:
        """Acknowledges an error of the safety controller, such as td2Timeout.

        >>> with FrankaSim("fr3", start="locked") as server:
        ...     server.robot.remote.inject("td2Timeout", True)
        ...     server.robot.remote.acknowledge("td2Timeout")
        """
        self.send(f"acknowledge {words.word(error, 'error')}", timeout)

    def inject(self, error: str, active: bool, joint: int = 0, timeout: float | None = None) -> None:
        """Lets the safety controller have an error, or not. joint: 1 to 7, for those of a joint.

        >>> with FrankaSim("fr3", start="locked") as server:
        ...     server.robot.remote.inject("jointLimitViolation", True, joint=2)
        """
        parts = [
            words.word(error, "error"),
            *([str(words.whole(joint, "joint"))] if joint != 0 else []),
        ]
        self.send(" ".join(["inject", *parts, words.switch(active, "active")]), timeout)

    def recover(self, timeout: float | None = None) -> None:
        """Automatic error recovery; returns at its end.

        >>> if remote.state().mode == "Reflex":
        ...     remote.recover()
        """
        self.send("recover", timeout)

    def move(
        self,
        target: ArrayLike | typing.Literal["pack", "stop"],
        speed: float = 0.3,
        timeout: float | None = None,
    ) -> None:
        """A motion of Desk, which needs no client: to joint positions, 7 [rad], at a share of the velocity
        limits, above 0 and at most 1; to the pose for packing; or stops one. Returns at its end.

        >>> remote.move([0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785], speed=0.3)
        """
        if isinstance(target, str):
            self.send(f"move {words.word(target, 'target')}", timeout)
        else:
            line = words.line("move", words.numbers(target, 7, "target"), words.number(speed, "speed"))
            if not 0.0 < speed <= 1.0:
                raise ValueError(
                    f"speed is a share of the velocity limits, above 0 and at most 1, not {speed}."
                )
            self.send(line, timeout)

    def end_effector(
        self,
        mass: float,
        center: ArrayLike,
        inertia: ArrayLike,
        F_T_NE: ArrayLike,
        timeout: float | None = None,
    ) -> None:
        """The end effector as it is set in Desk: m_ee [kg], F_x_Cee 3 [m], I_ee 9 [kg m^2], F_T_NE 4x4,
        or its 16 numbers column by column.

        >>> inertia = numpy.diag([0.001, 0.0025, 0.0017])
        >>> remote.end_effector(0.73, (-0.01, 0.0, 0.03), inertia, numpy.eye(4))
        """
        parts = [words.numbers(center, 3, "center"), words.matrix(inertia, 3, "inertia")]
        frame = words.matrix(F_T_NE, 4, "F_T_NE")
        warning = self.send(words.line("end_effector", words.number(mass, "mass"), *parts, frame), timeout)
        if warning:
            warnings.warn(warning, RuntimeWarning, stacklevel=2)

    def set_end_effector_power(self, on: bool, timeout: float | None = None) -> None:
        """Off: the hand is not reachable.

        >>> server["fr3"].remote.set_end_effector_power(True)
        """
        self.send(f"end_effector_power {words.switch(on, 'on')}", timeout)

    def set_power(self, on: bool, timeout: float | None = None) -> None:
        """Off: the robot is not reachable. On: it starts, with Desk's rules locked.

        >>> with FrankaSim("fr3") as server:
        ...     server.robot.remote.set_power(False)
        """
        self.send(f"power {words.switch(on, 'on')}", timeout)

    def timing(
        self, what: typing.Literal["brakes", "self_test"], seconds: float, timeout: float | None = None
    ) -> None:
        """Sets the duration of opening all brakes, or of the self-test.

        >>> remote.timing("brakes", 1.0)
        """
        self.send(words.line(f"timing {words.word(what, 'what')}", words.number(seconds, "seconds")), timeout)

    def report(self, timeout: float | None = None) -> Report:
        """Everything of the robot.

        >>> remote.report().brakes_open
        True
        """
        return report_of(self.send("report", timeout))

    def set_load(
        self,
        mass: float,
        F_x_Cload: ArrayLike = ZERO,
        load_inertia: ArrayLike = NO_INERTIA,
        timeout: float | None = None,
    ) -> None:
        """The load that the robot assumes: mass [kg], center of mass in F, 3 [m], inertia, 3x3 or 9 numbers
        column by column [kg m^2].

        >>> remote.set_load(0.5, (0.0, 0.0, 0.05), 0.001 * numpy.eye(3))
        >>> remote.set_load(0.0)
        """
        parts = [words.numbers(F_x_Cload, 3, "F_x_Cload"), words.matrix(load_inertia, 3, "load_inertia")]
        self.send(words.line("load", words.number(mass, "mass"), *parts), timeout)

    def wall(
        self,
        number: int,
        center: ArrayLike,
        edges: ArrayLike,
        orientation: ArrayLike = NO_TURN,
        timeout: float | None = None,
    ) -> None:
        """Sets the virtual wall of that number, 0 to 7: a box. center: 3 [m], edges: 3 [m], orientation:
        quaternion w, x, y, z, all in the robot's base frame.

        >>> remote.wall(3, center=(2.0, 0.0, 0.5), edges=(0.1, 2.0, 1.0))
        >>> remote.remove_wall(3)
        """
        parts = [words.numbers(center, 3, "center"), words.numbers(edges, 3, "edges")]
        parts.append(words.numbers(orientation, 4, "orientation"))
        self.send(words.line(f"wall {words.whole(number, 'number')}", *parts), timeout)

    def remove_wall(self, number: int, timeout: float | None = None) -> None:
        """Removes the virtual wall of that number, 0 to 7.

        >>> remote.wall(3, center=(2.0, 0.0, 0.5), edges=(0.1, 2.0, 1.0))
        >>> remote.remove_wall(3)
        """
        self.send(f"wall {words.whole(number, 'number')} off", timeout)

    def part(self, present: bool, timeout: float | None = None) -> None:
        """Whether a part covers the cup of the vacuum gripper.

        >>> server["vacuum"].remote.part(False)
        """
        self.send(f"part {words.switch(present, 'present')}", timeout)

    def pump(
        self, health: typing.Literal["green", "yellow", "orange", "red"], timeout: float | None = None
    ) -> None:
        """Health of the vacuum gripper's pump; a red one does not work.

        >>> server["vacuum"].remote.pump("green")
        """
        self.send(f"pump {words.word(health, 'health')}", timeout)

    def hand_homing(self, timeout: float | None = None) -> None:
        """Closes and opens the Franka hand fully; returns when it has done so. LineRefused if it fails.

        >>> remote.hand_homing()
        """
        self.send("hand homing", timeout)

    def hand_move(self, width: float, speed: float = 0.1, timeout: float | None = None) -> None:
        """Moves the fingers to a width [m] at a speed [m/s]; returns when they are there. LineRefused if an
        object blocks them.

        >>> remote.hand_move(width=0.04, speed=0.1)
        """
        self.send(
            words.line("hand move", words.number(width, "width"), words.number(speed, "speed")), timeout
        )

    def hand_grasp(self, width: float, speed: float, force: float, timeout: float | None = None) -> None:
        """Grasps an object of this width [m], within 5 mm, with a force [N]; returns when it is held.
        LineRefused if it is not.

        >>> remote.hand_grasp(width=0.03, speed=0.1, force=20.0)  # there is nothing to hold
        Traceback (most recent call last):
        pyfranka.remote.LineRefused: ...
        """
        self.send(
            words.line(
                "hand grasp",
                words.number(width, "width"),
                words.number(speed, "speed"),
                words.number(force, "force"),
            ),
            timeout,
        )

    def hand_stop(self, timeout: float | None = None) -> None:
        """Ends the hand's command and releases its force.

        >>> remote.hand_stop()
        """
        self.send("hand stop", timeout)

    def state(self, timeout: float | None = None) -> RemoteState:
        """Mode, client, errors and joints.

        >>> remote.state().q.shape
        (7,)
        """
        text = self.send("state", timeout)
        match = STATE.fullmatch(text)
        if not match:
            raise ConnectionError(
                f"The state of the robot at {self._connection.place} cannot be read: '{text}'."
            )
        errors = {} if match["errors"] == "none" else dict(ERROR.findall(match["errors"]))
        q = numpy.array(match["q"].split(), dtype=float)
        return RemoteState(match["mode"], int(match["protocol"] or 0), errors, q, match["fault"] or "")

    def state_hash(self, timeout: float | None = None) -> int:
        """Hash of all states since the first command, as pyfranka.sim.SimulatedRobot.state_hash(). In
        lock-step it waits until no motion runs and the world is at rest, at most 10 s of its time.

        >>> remote.state_hash() == remote.state_hash()
        True
        """
        return int(self.send("hash", timeout), 16)

    # ---- the link to the client --------------------------------------------------------------------------

    def loss(self, probability: float, seed: int = 0, timeout: float | None = None) -> None:
        """Loses commands with this probability; the same seed, from 0 to 2^64 - 1, loses the same ones.

        >>> remote.loss(0.01, seed=5)
        >>> remote.loss(0.0)
        """
        self.send(
            words.line("loss", words.number(probability, "probability")) + f" {words.whole(seed, 'seed')}",
            timeout,
        )

    def lose(self, commands: int, timeout: float | None = None) -> None:
        """Loses the next commands, so many.

        >>> remote.lose(2)
        """
        self.send(f"lose {words.whole(commands, 'commands')}", timeout)

    def delay(self, ticks: int, timeout: float | None = None) -> None:
        """Lets commands arrive 0 to 20 ticks [ms] later.

        >>> remote.delay(5)
        >>> remote.delay(0)
        """
        self.send(f"delay {words.whole(ticks, 'ticks')}", timeout)

    # ---- the world ---------------------------------------------------------------------------------------

    def push(
        self,
        body: str,
        force: ArrayLike,
        torque: ArrayLike = ZERO,
        ticks: int = 1,
        timeout: float | None = None,
    ) -> None:
        """A force, 3 [N], and a torque, 3 [Nm], at a body's origin, world axes, for so many milliseconds from
        now. Returns when it has begun; wait() or step() let it end.

        >>> remote.push("stone", (0.0, 0.0, 1.0), ticks=10)
        >>> remote.step(10)
        """
        parts = [words.numbers(force, 3, "force"), words.numbers(torque, 3, "torque")]
        line = words.line(f"push {words.word(body, 'body')}", *parts)
        self.send(f"{line} {words.whole(ticks, 'ticks')}", timeout)

    def place_body(
        self, body: str, position: ArrayLike, orientation: ArrayLike = NO_TURN, timeout: float | None = None
    ) -> None:
        """Puts a free body to a position, 3 [m], and a quaternion w, x, y, z of the world, at rest.

        >>> remote.place_body("stone", (0.0, 0.3, 0.5))
        >>> round(float(remote.body_position("stone")[1]), 1)
        0.3
        """
        pose = [words.numbers(position, 3, "position"), words.numbers(orientation, 4, "orientation")]
        self.send(words.line(f"place {words.word(body, 'body')}", *pose), timeout)

    def body_position(self, body: str, timeout: float | None = None) -> Array:
        """Position of a body in the world, 3 [m].

        >>> remote.body_position("stone").shape
        (3,)
        """
        return numpy.array(self.send(f"where {words.word(body, 'body')}", timeout).split(), float)

    def scene(self, timeout: float | None = None) -> RemoteScene:
        """Bodies and shapes of the world, for programs that draw it. The first call may take seconds.

        >>> "stone" in remote.scene().bodies
        True
        """
        answer = json.loads(self.send("scene", timeout))
        shapes = [
            RemoteShape(
                shape["body"],
                shape["kind"],
                numpy.array(shape["size"], float),
                numpy.array(shape["pose"], float),
                numpy.array(shape["color"], float),
                shape["mesh"],
            )
            for shape in answer["shapes"]
        ]
        robots = {robot["arm_id"]: robot["type"] for robot in answer["robots"]}
        return RemoteScene([body["name"] for body in answer["bodies"]], shapes, robots)

    def mesh(self, name: str, timeout: float | None = None) -> RemoteMesh:
        """The triangles of a mesh that a shape of the scene names; read in parts, one line each.

        >>> names = {shape.mesh for shape in remote.scene().shapes if shape.mesh}
        >>> all(len(remote.mesh(name).faces) for name in names)
        True
        """
        data, offset = b"", 0
        while offset is not None:
            answer = json.loads(self.send(f"mesh {words.word(name, 'name')} {offset}", timeout))
            data += base64.b64decode(answer["data"])
            offset = answer["next"]
        end = 12 * answer["vertices"]  # [bytes]: three numbers of four bytes each
        vertices = numpy.frombuffer(data[:end], "<f4").reshape(-1, 3)
        return RemoteMesh(vertices, numpy.frombuffer(data[end:], "<u4").reshape(-1, 3))

    def poses(self, timeout: float | None = None) -> Array:
        """Position [m] and quaternion w, x, y, z of each body of the scene, in its order: n x 7.

        >>> remote.poses().shape == (len(remote.scene().bodies), 7)
        True
        """
        return numpy.array(json.loads(self.send("poses", timeout)), float)

    @property
    def time(self) -> float:
        """Simulated time since the start or the last reset [s], as Simulation.time; asks the robot."""
        return float(self.send("time"))

    def step(self, ticks: int = 1, timeout: float | None = None) -> None:
        """Returns when so many milliseconds of simulated time have passed.

        In lock-step it first waits until the world is at rest, then lets it run for exactly this time, and
        longer only if an arm moves at its end; within a motion the client makes time pass. The default limit
        is longer by the time itself.

        >>> before = remote.time
        >>> remote.step(100)
        >>> round(1000 * (remote.time - before)) >= 100
        True
        """
        ticks = words.whole(ticks, "ticks")
        # The robot refuses more than that.
        duration = 1e-3 * min(max(0, ticks), 1 << 32)
        self.send(f"step {ticks}", self.timeout + duration if timeout is None else timeout)

    def wait(
        self, condition: Callable[[RemoteState], bool] | None = None, timeout: float | None = None
    ) -> RemoteState:
        """Returns the state once the world is at rest: no motion runs, no arm stops or recovers, no hand
        works, and in lock-step time stands still. With a condition: once that is true.

        Raises LineRefused if, in lock-step, the world has not come to rest within 10 s of its time.

        >>> remote.wait().mode
        'Idle'
        """
        if condition is not None and not callable(condition):
            raise TypeError(f"The condition is a function of a RemoteState, not {condition!r}.")
        limit = self.timeout if timeout is None else words.seconds(timeout)
        deadline = time.monotonic() + limit
        least = min(limit, MIN_ANSWER_TIME)
        if condition is None:
            self.send("wait", limit)
            return self.state(max(least, left(deadline)))
        while not condition(state := self.state(max(least, left(deadline)))):
            if time.monotonic() + PAUSE > deadline:
                raise TimeoutError(
                    f"The robot at {self._connection.place} has not come to the awaited state within "
                    f"{limit:g} s: {state}."
                )
            time.sleep(PAUSE)
        return state

    def reset(self, timeout: float | None = None) -> None:
        """Sets the world to its initial state, for all robots; refused within motions. Modes, errors and
        settings stay.

        >>> remote.reset()
        """
        self.send("reset", timeout)

    def quit(self, timeout: float | None = None) -> None:
        """Ends the program, with all its robots; returns when nothing listens there.

        >>> with FrankaSim("fr3") as server:
        ...     server.robot.remote.quit()
        """
        limit = self.timeout if timeout is None else words.seconds(timeout)
        deadline = time.monotonic() + limit
        self.send("quit", limit)
        self.close()
        while self._connection.robot_listens(deadline):
            if time.monotonic() > deadline:
                raise TimeoutError(
                    f"franka_sim at {self._connection.place} has not ended within {limit:g} s."
                )
            time.sleep(PAUSE)

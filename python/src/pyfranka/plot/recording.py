# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""States and commands of a robot over time, a row a state."""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

import pyfranka
from pyfranka.sim import arguments

Array = NDArray[np.floating[Any]]

PANDA, FR3 = 5, 10  # protocol versions whose limits a robot of a known kind gets
KINDS = {"panda": PANDA, "fr3": FR3}
TICK = 1e-3  # [s] of the robot's clock

# Fields of a state, and their sizes. Matrices are column-major.
FIELDS = {
    "q": 7,
    "q_d": 7,
    "dq": 7,
    "dq_d": 7,
    "ddq_d": 7,
    "theta": 7,
    "dtheta": 7,
    "tau_J": 7,
    "tau_J_d": 7,
    "dtau_J": 7,
    "tau_ext_hat_filtered": 7,
    "O_T_EE": 16,
    "O_T_EE_d": 16,
    "O_T_EE_c": 16,
    "O_dP_EE_d": 6,
    "O_dP_EE_c": 6,
    "O_ddP_EE_c": 6,
    "O_F_ext_hat_K": 6,
    "K_F_ext_hat_K": 6,
    "elbow": 2,
    "elbow_d": 2,
    "elbow_c": 2,
    "joint_contact": 7,
    "joint_collision": 7,
    "cartesian_contact": 6,
    "cartesian_collision": 6,
    "control_command_success_rate": 1,
}
# Commands in a motion log: the name in its columns, the attribute of a Record, the size.
COMMANDS = {
    "cmd.q_d": ("q_c", 7),
    "cmd.dq_d": ("dq_c", 7),
    "cmd.O_T_EE_d": ("O_T_EE_c", 16),
    "cmd.O_dP_EE_d": ("O_dP_EE_c", 6),
    "cmd.tau_J_d": ("tau_J_d", 7),
}
MAX_STATES = 2_000_000  # states in memory: half an hour at 1 kHz (chosen here)


class BadInput(ValueError):
    """The input cannot be plotted; the text is a sentence."""


@dataclass
class Recording:
    """States of one robot, oldest first. Commands stand in the row of the state that they answer.

    >>> recording = pyfranka.plot.of_log(error.log, version=5)
    >>> len(recording) == len(error.log)
    True
    """

    name: str  #: of the robot, its topic or its file
    time: Array  #: [s] of the robot
    values: dict[str, Array]  #: one array a field, (rows, size)
    modes: list[int] = field(default_factory=list)  #: pyfranka.RobotMode, a row a state; may be empty
    errors: list[tuple[float, tuple[str, ...]]] = field(default_factory=list)  #: [s], the errors from then on
    version: int = 0  #: protocol version, for the limits; 0: not known

    def __len__(self) -> int:
        return len(self.time)

    @property
    def limits(self) -> pyfranka.ArmLimits | None:
        """The limits of this robot; None if its kind is not known."""
        return pyfranka.ArmLimits(self.version) if self.version else None


@dataclass
class Abort:
    """Why a motion ended: the text of its exception, and the errors in it.

    >>> abort = pyfranka.plot.Abort.of_text(str(error))
    """

    text: str
    errors: tuple[str, ...]

    @classmethod
    def of_text(cls, text: str) -> Abort:
        """Finds the names of errors in a text such as that of a ControlException.

        Raises TypeError for anything else.

        >>> pyfranka.plot.Abort.of_text("The motion was aborted: joint_reflex.").errors
        ('joint_reflex',)
        """
        reason = arguments.text(text, "text").strip()
        return cls(reason, tuple(name for name in ERRORS if re.search(rf"\b{name}\b", reason)))


def _error_names() -> tuple[str, ...]:
    """Names as logs have them; two differ from the attributes."""
    names = [name for name in vars(pyfranka.Errors) if not name.startswith("_")]
    frame = "cartesian_position_motion_generator_invalid_frame"
    other = {frame: f"{frame}_flag", "tau_j_range_violation": "tau_J_range_violation"}
    return tuple(other.get(name, name) for name in names)


ERRORS = _error_names()


def kind_of(name: str) -> int:
    """The protocol version for limits, by a robot's name such as panda or left_fr3; 0 if it has neither."""
    found = [
        version for kind, version in KINDS.items() if re.search(rf"(?<![a-z]){kind}(?![a-z])", name.lower())
    ]
    return found[0] if len(set(found)) == 1 else 0


def errors_of(state: Any) -> tuple[str, ...]:
    """The names of a state's current errors, of pyfranka or of ROS."""
    errors = state.current_errors
    if hasattr(errors, "__slots__"):
        return tuple(name for name in errors.__slots__ if getattr(errors, name) is True)
    return tuple(re.findall(r'"(\w+)"', str(errors))) if errors else ()


class Collector:
    """Collects states as they come. One thread adds, another one may call recording().

    >>> collector = pyfranka.plot.Collector("robot")
    >>> robot.read(lambda state: collector.add(state) or state.time < 0.0)
    >>> len(collector.recording())
    1
    """

    def __init__(self, name: str, version: int = 0, most: int = MAX_STATES, fields: Iterable[str] = FIELDS):
        self.name, self.version = name, version
        self._fields = tuple(fields)
        self._rows: deque[tuple[float, int, tuple[str, ...], list[Array]]] = deque(maxlen=most)

    def __repr__(self) -> str:
        return f"<Collector of {self.name!r}: {len(self._rows)} states>"

    def add(self, state: Any, time: float | None = None) -> None:
        """Adds a state of pyfranka or a franka_msgs/FrankaState. time: its own if not given [s].

        Raises TypeError for another object.

        >>> pyfranka.plot.Collector("robot").add(robot.read_once())
        """
        if not hasattr(state, "robot_mode"):
            raise TypeError(f"state must be a RobotState, not {state!r}.")
        self._rows.append(
            (
                float(state.time) if time is None else time,
                int(state.robot_mode),
                errors_of(state),
                [np.asarray(getattr(state, name), float).flatten(order="F") for name in self._fields],
            )
        )

    def __len__(self) -> int:
        return len(self._rows)

    def recording(self, seconds: float = 0.0) -> Recording:
        """The collected states, or their last seconds. Raises BadInput if there is nothing.

        >>> collector = pyfranka.plot.Collector("robot", version=robot.server_version)
        >>> collector.add(robot.read_once())
        >>> len(collector.recording().time)
        1
        """
        rows = list(self._rows)
        if not rows:
            raise BadInput(f"{self.name} has no state of a robot.")
        # A robot that was started again counts from 0.
        begin = max((i for i in range(1, len(rows)) if rows[i][0] < rows[i - 1][0]), default=0)
        if seconds:
            begin = max(begin, next(i for i, row in enumerate(rows) if row[0] >= rows[-1][0] - seconds))
        rows = rows[begin:]
        time = np.array([row[0] for row in rows])
        columns = zip(*(row[3] for row in rows))
        changes = [
            (row[0], row[2])
            for before, row in zip([None, *rows], rows)
            if (before[2] if before else ()) != row[2]
        ]
        values = {name: np.array(column) for name, column in zip(self._fields, columns)}
        return Recording(self.name, time, values, [row[1] for row in rows], changes, self.version)


def of_log(log: Sequence[pyfranka.Record], version: int = 0, name: str = "motion") -> Recording:
    """The log of a ControlException. version: of the robot, for its limits.

    Raises BadInput if it is empty, TypeError for other lists.

    >>> pyfranka.plot.of_log(error.log, version=5).limits.dq.shape
    (7,)
    """
    log = arguments.items(log, "log", "records, that of a ControlException")
    if not log:
        raise BadInput("The exception has no log: pyfranka.Robot's log_size was 0, or no motion had begun.")
    collector = Collector(name, version)
    for record in log:
        if not isinstance(record, pyfranka.Record):
            raise TypeError(f"log must be a list of records, that of a ControlException, not of {record!r}.")
        collector.add(record.state)
    recording = collector.recording()
    rows = log[-len(recording) :]
    for column, (attribute, _) in COMMANDS.items():
        values = [np.asarray(getattr(record, attribute)).flatten(order="F") for record in rows]
        recording.values[column] = answering(np.array(values))
    # The last state belongs to the abort; no command answers it.
    recording.errors = [(recording.time[-1], errors) for _, errors in recording.errors[-1:]]
    return recording


def answering(commands: Array) -> Array:
    """Moves commands from the record that holds them to that of the state they answered. NaN: no command."""
    moved = np.full_like(commands, np.nan)
    moved[:-1] = commands[1:]
    if not np.any(commands):
        moved[:] = np.nan
    return moved

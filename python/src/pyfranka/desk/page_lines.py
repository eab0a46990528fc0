# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The lines of the control interface that the page may send, and the permissions they need."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from pyfranka.desk.errors import bad_request

MAX_PUSH_TIME = 1000  # [ms] (chosen here: a push ends soon after its page has closed)
MAX_PUSH_FORCE = 200.0  # [N] of each component (chosen here)
NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,63}")
BODY = re.compile(r"[^\s\x00-\x1f\x7f\ud800-\udfff]{1,200}")
TIME = re.compile(r"[0-9]{1,4}")


@dataclass(frozen=True)
class Line:
    """A line in the words of docs/franka_sim.md: fixed words, alternatives (on|off), and words of the kinds
    below in capitals, which may be repeated (NUMBER*7).

    control: only the user who has control may send it. Inputs of the operator need none: stops, buttons,
    pushes, faults. urgent: other lines do not delay it.
    """

    pattern: str
    control: bool = True
    urgent: bool = False

    def words(self) -> list[str]:
        """The pattern with repetitions written out."""
        written = []
        for word in self.pattern.split():
            kind, _, count = word.partition("*")
            written += [kind] * int(count or 1)
        return written

    def match(self, words: Sequence[str]) -> list[str] | None:
        """The words as they are sent, or None if they are not of this pattern."""
        pattern = self.words()
        if len(pattern) != len(words):
            return None
        checked = [_checked(kind, word) for kind, word in zip(pattern, words)]
        return None if None in checked else [word for word in checked if word is not None]


LINES = [
    Line("joints unlock"),
    Line("joints lock", control=False, urgent=True),
    Line("fci on"),
    Line("fci off", urgent=True),
    Line("operating_mode execution|programming"),
    Line("user_stop on|off", control=False, urgent=True),
    Line("input x31|x32|x33|x4|guiding on|off", control=False, urgent=True),
    Line("button circle|cross|check|up|down|left|right on|off", control=False, urgent=True),
    Line("guiding on|off"),
    Line("guiding_mode free|translation|rotation"),
    Line("guiding_mode user SWITCH*7"),
    Line("navigation desk|robot"),
    Line("self_test"),
    Line("acknowledge NAME"),
    Line("recover"),
    Line("hand homing"),
    Line("hand stop", control=False, urgent=True),
    Line("hand move NUMBER*2"),
    Line("hand grasp NUMBER*3"),
    Line("end_effector NUMBER*29"),
    Line("end_effector_power on|off"),
    Line("move pack"),
    Line("move stop", control=False, urgent=True),
    Line("move NUMBER*7"),
    Line("move NUMBER*8"),
    Line("power off"),
    Line("power on", control=False),
    Line("inject NAME on|off", control=False),
    Line("inject NAME JOINT on|off", control=False),
    Line("push BODY FORCE*3 MILLISECONDS", control=False),
]


def line_of(action: object, words: object) -> tuple[Line, str]:
    """The pattern and the text of a line. Raises DeskError (400) for anything else."""
    if not isinstance(action, str) or not isinstance(words, list):
        raise bad_request("A command needs the text 'action' and the list 'words'.")
    if not all(isinstance(word, str) for word in words):
        raise bad_request("The words of a command must be texts.")
    for line in LINES:
        matched = line.match([action, *words])
        if matched is not None:
            return line, " ".join(matched)
    raise bad_request(f"The page has no command '{action[:40]}' with these words.")


def _checked(kind: str, word: str) -> str | None:
    check = KINDS.get(kind)
    if check is not None:
        return check(word)
    return word if word in kind.split("|") else None


def _number(word: str) -> str | None:
    try:
        number = float(word)
    except ValueError:
        return None
    return repr(number) if math.isfinite(number) and len(word) <= 40 else None


def _force(word: str) -> str | None:
    number = _number(word)
    return number if number is not None and abs(float(number)) <= MAX_PUSH_FORCE else None


def _milliseconds(word: str) -> str | None:
    return word if TIME.fullmatch(word) and 1 <= int(word) <= MAX_PUSH_TIME else None


KINDS: dict[str, Callable[[str], str | None]] = {
    "NUMBER": _number,
    "FORCE": _force,
    "MILLISECONDS": _milliseconds,
    "NAME": lambda word: word if NAME.fullmatch(word) else None,
    "BODY": lambda word: word if BODY.fullmatch(word) else None,
    "JOINT": lambda word: word if word in set("1234567") else None,
    "SWITCH": lambda word: word if word in {"on", "off"} else None,
}

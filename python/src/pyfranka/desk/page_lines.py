# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The lines of the control interface that the page may send, and the permissions they need.

Both are rows of the robot's own table of commands, the answer to its line `help json`.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from pyfranka.desk.errors import bad_request

# Largest absolute values of a push that the page sends (chosen here: it ends soon after its page has closed).
MAX_PUSH_TIME = 1000  # [ms]
PUSH_LIMITS = {"N": 200.0, "Nm": 50.0}  # by unit
TEXT = re.compile(r"[^\s\x00-\x1f\x7f\ud800-\udfff]{1,200}")
INTEGER = re.compile(r"[0-9]{1,20}")


@dataclass(frozen=True)
class PageLine:
    """A line that the page may send.

    name: its first words. arguments: as in the robot's table. control: only the user who has control may
    send it. urgent: other lines do not delay it.
    """

    name: tuple[str, ...]
    arguments: tuple[dict[str, Any], ...]
    control: bool
    urgent: bool

    def match(self, words: Sequence[str]) -> str | None:
        """The line as it is sent, or None if the words are not one of this kind."""
        if tuple(words[: len(self.name)]) != self.name:
            return None
        given = words[len(self.name) :]
        for optional in (False, True):
            kinds = [
                argument
                for argument in self.arguments
                for _ in range(argument["count"])
                if optional or not argument["optional"]
            ]
            if len(kinds) == len(given):
                checked = [self._checked(kind, word) for kind, word in zip(kinds, given)]
                return None if None in checked else " ".join([*self.name, *filter(None, checked)])
        return None

    def _checked(self, argument: dict[str, Any], word: str) -> str | None:
        kind = argument["kind"]
        if kind == "choice":
            return word if word in argument["choices"] else None
        if kind == "text":
            return word if TEXT.fullmatch(word) else None
        if kind == "integer":
            limit = min(argument["max"], MAX_PUSH_TIME) if self.name == ("push",) else argument["max"]
            good = INTEGER.fullmatch(word) and argument["min"] <= int(word) <= limit
            return word if good else None
        try:
            number = float(word) if len(word) <= 40 else math.nan
        except ValueError:
            return None
        limit = PUSH_LIMITS.get(argument["unit"], math.inf) if self.name == ("push",) else math.inf
        return repr(number) if math.isfinite(number) and abs(number) <= limit else None


@lru_cache(maxsize=16)
def page_lines(commands: str) -> tuple[PageLine, ...]:
    """The lines of a robot's table of commands (JSON) that the page may send."""
    return tuple(
        PageLine(tuple(row["name"].split()), tuple(row["arguments"]), row["control"], row["urgent"])
        for row in json.loads(commands)
        if row["page"]
    )


def line_of(commands: str, action: object, words: object) -> tuple[PageLine, str]:
    """The row and the text of a line. commands: the robot's table. Raises DeskError (400) for a line that is
    not in it, or that the page may not send."""
    if not isinstance(action, str) or not isinstance(words, list):
        raise bad_request("A command needs the text 'action' and the list 'words'.")
    if not all(isinstance(word, str) for word in words):
        raise bad_request("The words of a command must be texts.")
    for line in page_lines(commands):
        text = line.match([action, *words])
        if text is not None:
            return line, text
    raise bad_request(f"The page has no command '{action[:40]}' with these words.")

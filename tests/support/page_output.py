# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Programs in Python of a page, and what the block of text behind each of them shows of their output."""

import re
import typing
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
PROGRAM = re.compile(r"^```python\n(.*?)^```\n(?:\n*```text\n(.*?)^```\n)?", re.M | re.S)
OUTPUT = re.compile(r"[^\s\[\]]+")  # words and numbers, also of numpy's arrays


class Example(typing.NamedTuple):
    """A program: its page, the line of its fence, its text, and the output that the page shows (or "")."""

    page: str
    line: int
    code: str
    output: str

    def run(self, address: str = "127.0.0.1", **names: object) -> None:
        """Runs it as a script does, with names that it does not define, and with another robot's address."""
        code = self.code.replace("127.0.0.1", address)
        exec(compile(code, f"{self.page}:{self.line}", "exec"), {"__name__": "__main__", **names})

    def check(self, printed: str, tolerance: float = 0.0) -> None:
        """Raises AssertionError unless the program has printed what the page shows: the same words, and the
        same numbers up to a tolerance."""
        expected, given = OUTPUT.findall(self.output), OUTPUT.findall(printed)
        same = len(expected) == len(given) and all(
            is_same(one, other, tolerance) for one, other in zip(expected, given, strict=True)
        )
        assert same, f"{self.page}:{self.line} shows\n{self.output}\nand its program has printed\n{printed}"


def is_same(shown: str, printed: str, tolerance: float) -> bool:
    try:
        return abs(float(shown) - float(printed)) <= tolerance
    except ValueError:
        return shown == printed


def examples_in(text: str, page: str) -> list[Example]:
    return [
        Example(page, text.count("\n", 0, found.start()) + 1, found[1], found[2] or "")
        for found in PROGRAM.finditer(text)
    ]


def examples(page: str, heading: str = "") -> list[Example]:
    """Those of a page of docs/, or of one of its sections."""
    found = examples_in((TOP / "docs" / page).read_text(encoding="utf-8"), f"docs/{page}")
    if not heading:
        return found
    lines = (TOP / "docs" / page).read_text(encoding="utf-8").splitlines()
    begin = lines.index(heading) + 1
    end = next((i for i, line in enumerate(lines[begin:], begin + 1) if line.startswith("## ")), len(lines))
    return [each for each in found if begin < each.line <= end]

# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Counts tests from the result files of gtest, rostest and pytest, and judges the reasons of skips."""

import re
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass, field
from pathlib import Path

# A test may be skipped for these reasons only (CONTRIBUTING.md, "Skipped tests").
LONG_FORM = "./franka test --long"
ALLOWED = (
    re.compile(re.escape(LONG_FORM)),
    re.compile(r"\w (is|are) not installed\b"),  # names what is missing, and ./franka install brings it
    re.compile(r"^PyPI has no wheel of \S+"),  # no command can install it
)


def is_allowed(reason: str) -> bool:
    """Whether a reason names a missing package or the long form."""
    return any(pattern.search(reason) for pattern in ALLOWED)


def reason_of(skip: ElementTree.Element | None) -> str:
    """The reason that a test gives for its skip."""
    message = "" if skip is None else skip.get("message", "")
    if message == "collection skipped":  # of a whole file: pytest puts place and reason into the text
        message = (re.search(r"Skipped: (.*?)['\"]\)", skip.text or "") or [message] * 2)[1]
    lines = [line.strip() for line in message.splitlines()]
    # gtest begins with file and line.
    return " ".join(line for line in lines if line and not re.fullmatch(r"\S+:\d+", line)) or "no reason"


@dataclass
class Tally:
    """Counts from the result files."""

    passed: int = 0
    failed: list[str] = field(default_factory=list)
    skipped: dict[str, list[str]] = field(default_factory=dict)  # reason: tests

    def add(self, path: Path, only_failures: bool = False) -> None:
        try:
            root = ElementTree.parse(path).getroot()
        except ElementTree.ParseError as error:
            self.failed.append(f"{path.stem}: the result file is broken ({error})")
            return
        for case in root.iter("testcase"):
            name = f"{path.parent.name}: {case.get('classname', '')}.{case.get('name', '')}"
            skip = case.find("skipped")
            if case.find("failure") is not None or case.find("error") is not None:
                self.failed.append(name)
            elif only_failures:
                continue
            elif skip is not None or case.get("status") == "notrun":
                self._skip(name, reason_of(skip))
            else:
                self.passed += 1

    def _skip(self, name: str, reason: str) -> None:
        self.skipped.setdefault(reason, []).append(name)
        if not is_allowed(reason):
            self.failed.append(f"{name} is skipped for a reason that is not allowed: {reason}")

    def table_of_skips(self) -> list[str]:
        """Lines: how many tests are skipped for each reason, and the first of them."""
        if not self.skipped:
            return []
        rows = sorted(self.skipped.items(), key=lambda row: (-len(row[1]), row[0]))
        width = max(len(reason) for reason in self.skipped)
        lines = [f"{sum(map(len, self.skipped.values()))} skipped:"]
        return lines + [f"{len(tests):5}  {reason:{width}}  {tests[0]}" for reason, tests in rows]

# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Reads the result files of gtest, rostest and pytest, counts their cases and judges the reasons of skips."""

import os
import re
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass, field
from pathlib import Path

# All reasons for which a test may be skipped, and whether under CI=true, too; the long form skips nothing.
REASONS = {
    re.compile(r": \./franka test --(long|realtime)$"): True,
    re.compile(
        r"\w (is|are) not installed\b"
    ): False,  # names what is missing, and ./franka install brings it
    re.compile(r"^PyPI has no wheel of \S+"): True,  # no command can install it
}


def is_allowed(reason: str) -> bool:
    """Whether a test may be skipped for a reason in this form of the tests."""
    if os.environ.get("FRANKA_TEST_LONG") == "1":
        return False
    in_ci = os.environ.get("CI") == "true"
    return any(pattern.search(reason) and (allowed or not in_ci) for pattern, allowed in REASONS.items())


def reason_of(skip: ElementTree.Element | None) -> str:
    """The reason that a test gives for its skip."""
    message = "" if skip is None else skip.get("message", "")
    if message == "collection skipped":  # of a whole file: pytest puts place and reason into the text
        message = (re.search(r"Skipped: (.*?)['\"]\)", skip.text or "") or [message] * 2)[1]
    lines = [line.strip() for line in message.splitlines()]
    # gtest begins with file and line.
    return " ".join(line for line in lines if line and not re.fullmatch(r"\S+:\d+", line)) or "no reason"


# In the text of a failure: more than an assertion has failed, and running again would hide a race.
DIED = re.compile(
    r"\b(Address|Thread|Leak|Memory|UndefinedBehavior)Sanitizer\b|\bruntime error: "
    r"|\bSIG(SEGV|ABRT|BUS|FPE|ILL)\b|\bSegmentation fault\b|\bcore dumped\b|\bTimeout >\d"
)


@dataclass
class Case:
    """A test of a result file. `reason` is that of a skip."""

    name: str
    verdict: str  # passed, failed, skipped
    seconds: float = 0.0
    reason: str = ""
    parts: tuple[str, str] = ("", "")  # its names of class and test in the file
    by_assertion: bool = True  # if it failed: not by the death or the time limit of a program


def died(name: str) -> Case:
    """A failure that does not run again."""
    return Case(name, "failed", by_assertion=False)


def cases_of(path: Path) -> list[Case]:
    """The cases of a result file. A file that is missing or broken is a failed case: its program has died."""
    try:
        root = ElementTree.parse(path).getroot()
    except FileNotFoundError:
        return [died(f"{path.parent.name}: {path.stem}: its program left no results")]
    except ElementTree.ParseError as error:
        return [died(f"{path.parent.name}: {path.stem}: the result file is broken ({error})")]
    cases = []
    for element in root.iter("testcase"):
        parts = element.get("classname", ""), element.get("name", "")
        name, skip = f"{path.parent.name}: {'.'.join(parts)}", element.find("skipped")
        seconds, reason = float(element.get("time") or 0), ""
        by_assertion = True
        if failures := element.findall("failure") + element.findall("error"):
            verdict = "failed"
            texts = [f"{each.get('message', '')}\n{each.text or ''}" for each in failures]
            by_assertion = not any(DIED.search(text) for text in texts)
        elif skip is not None or element.get("status") == "notrun":
            verdict, reason = "skipped", reason_of(skip)
            if not is_allowed(reason):
                verdict = "failed"
                name = f"{name} is skipped for a reason that is not allowed: {reason}"
        else:
            verdict = "passed"
        cases.append(Case(name, verdict, seconds, reason, parts, by_assertion))
    return cases


@dataclass
class Tally:
    """The verdicts of a run."""

    cases: list[Case] = field(default_factory=list)
    flaky: list[str] = field(default_factory=list)  # failed, and passed when they ran once more, alone

    @property
    def passed(self) -> int:
        return sum(case.verdict == "passed" for case in self.cases)

    @property
    def failed(self) -> list[str]:
        return [case.name for case in self.cases if case.verdict == "failed"]

    def lines(self) -> list[str]:
        """What a run ends with: failed and flaky cases, the reasons of skips, the counts."""
        lines = [f"FAILED {name}" for name in self.failed] + [f"FLAKY {name}" for name in self.flaky]
        return [*lines, *self.table_of_skips(), f"{self.passed} passed, {len(self.failed)} failed"]

    def table_of_skips(self) -> list[str]:
        """Lines: how many tests are skipped for each reason, and the first of them."""
        skipped: dict[str, list[str]] = {}
        for case in self.cases:
            if case.verdict == "skipped":
                skipped.setdefault(case.reason, []).append(case.name)
        if not skipped:
            return []
        rows = sorted(skipped.items(), key=lambda row: (-len(row[1]), row[0]))
        width = max(map(len, skipped))
        lines = [f"{sum(map(len, skipped.values()))} skipped:"]
        return lines + [f"{len(tests):5}  {reason:{width}}  {tests[0]}" for reason, tests in rows]

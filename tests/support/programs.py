# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The programs of tests: gtests and rostests as CTest knows them, and the files of pytest.

Each runs in processes of its own and leaves result files. What leaves none, or ends with an error that no
case explains, is a failed case itself.
"""

import json
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass, replace
from pathlib import Path
from subprocess import PIPE, STDOUT

from tally import Case, cases_of, died

TOP = Path(__file__).resolve().parents[2]
PYTEST_LIMIT = 900  # [s] of a case; pytest then says where it was
# [s] of a registered test: longer than the rostests' own limits together, so that those speak first.
CTEST_LIMIT = 1200


@dataclass(frozen=True)
class Registered:
    """A gtest or rostest. `results` is written by gtest, or by rostest about the programs that it started."""

    name: str
    results: Path

    def cases(self, ended_well: bool) -> list[Case]:
        cases = cases_of(self.results)
        if self.results.name.startswith("rostest-"):
            # Its cases are the tests of the launch file, each with a result file of its own. One that failed
            # here says that a node died or that a test did not end.
            about, cases = cases, []
            for case in about:
                if case.verdict == "failed":
                    cases.append(replace(case, by_assertion=False))
                else:
                    name = case.parts[1].removeprefix("test")
                    cases += cases_of(self.results.with_name(f"rosunit-{name}.xml"))
        if not ended_well and not any(case.verdict == "failed" for case in cases):
            cases.append(died(f"{self.name}: it did not end well, see its output"))
        return cases


def registered(build: Path, pattern: str) -> list[Registered]:
    """Of a build folder."""
    command = ["ctest", "--show-only=json-v1", "-R", pattern]
    listed = json.loads(subprocess.check_output(command, cwd=build, text=True))
    found = []
    for test in listed["tests"]:
        (results,) = [word for word in test.get("command", []) if word.endswith(".xml") and " " not in word]
        found.append(Registered(test["name"], Path(results)))
    return found


def run_registered(build: Path, tests: list[Registered], workers: int) -> dict[Registered, list[Case]]:
    """Runs them by CTest, so many at a time."""
    if not tests:
        return {}
    summary = build / "ctest.xml"
    summary.unlink(missing_ok=True)
    for test in tests:
        test.results.unlink(missing_ok=True)
    names = "|".join(re.escape(test.name) for test in tests)
    command = ["ctest", "-R", f"^({names})$", f"-j{workers}", "--timeout", str(CTEST_LIMIT)]
    command += ["--output-on-failure", "--output-junit", str(summary)]
    subprocess.run(command, cwd=build, check=False)
    try:
        elements = ElementTree.parse(summary).getroot().iter("testcase")
        well = {element.get("name") for element in elements if element.get("status") == "run"}
    except (FileNotFoundError, ElementTree.ParseError):
        well = set()
    return {test: test.cases(test.name in well) for test in tests}


def run_pytest(path: Path, results: Path, node_ids: list[str] | None = None) -> list[Case]:
    """Runs a file, or some of its cases. Prints the output if one failed, otherwise the number of tests."""
    results.unlink(missing_ok=True)
    command = [sys.executable, "-m", "pytest", "-q", f"--timeout={PYTEST_LIMIT}", f"--junitxml={results}"]
    command += node_ids or [str(path)]
    if "hypothesis" not in path.read_text(encoding="utf-8"):
        command += ["-p", "no:hypothesispytest"]  # it takes seconds to import
    result = subprocess.run(command, cwd=TOP, text=True, errors="replace", stdout=PIPE, stderr=STDOUT)
    output, cases = result.stdout.rstrip(), cases_of(results)
    if result.returncode not in (0, 1):
        cases.append(died(f"{path.name}: pytest ended with status {result.returncode}, see its output"))
    if result.returncode or any(case.verdict == "failed" for case in cases):
        print(f"{output}\n-- {path.name}: status {result.returncode}", flush=True)
    else:
        lines = output.splitlines() or ["pytest printed nothing"]
        print(f"{path.name}: {lines[-1]}", flush=True)
    return cases


def node_ids(path: Path, cases: list[Case]) -> list[str]:
    """The words by which pytest runs cases of a file; none if one is not a test, and the file has to run."""
    module = ".".join(path.relative_to(TOP).with_suffix("").parts)
    found = []
    for case in cases:
        of_class, name = case.parts
        if of_class != module and not of_class.startswith(f"{module}."):
            return []
        inside = of_class.removeprefix(module).strip(".").split(".")
        found.append("::".join(filter(None, [str(path), *inside, name])))
    return found

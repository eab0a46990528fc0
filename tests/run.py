#!/usr/bin/env python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Runs every test of the built workspace and ends with one line, `N passed, N failed`.

In this order: style, compiler warnings, gtest and rostest (as many at a time as there are processors), and
pytest (`test/test_*.py` of each package, then `tests/`). Cases are counted from the result files, since
catkin's own summary counts some twice. Called by `./franka test`, which provides the environment.
"""

import argparse
import os
import shutil
import subprocess
import sys
import time
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass, field
from pathlib import Path

TOP = Path(__file__).resolve().parent.parent
SOURCE = TOP / "catkin_ws" / "src"
BUILD = TOP / "catkin_ws" / "build"
RESULTS = BUILD / "test_results"
PYTEST_RESULTS = TOP / "out" / "pytest"


@dataclass
class Tally:
    """Counts from the result files."""

    passed: int = 0
    failed: list[str] = field(default_factory=list)
    skipped: int = 0

    def add(self, path: Path, only_failures: bool = False) -> None:
        try:
            root = ElementTree.parse(path).getroot()
        except ElementTree.ParseError as error:
            self.failed.append(f"{path.stem}: the result file is broken ({error})")
            return
        for case in root.iter("testcase"):
            name = f"{path.parent.name}: {case.get('classname', '')}.{case.get('name', '')}"
            if case.find("failure") is not None or case.find("error") is not None:
                self.failed.append(name)
            elif only_failures:
                continue
            elif case.find("skipped") is not None or case.get("status") == "notrun":
                self.skipped += 1
            else:
                self.passed += 1


def packages() -> dict[str, Path]:
    found = {path.parent.name: path.parent for path in sorted(SOURCE.glob("**/package.xml"))}
    # A glob does not follow the link that brings this one into the workspace.
    found["pyfranka"] = TOP / "python"
    return found


def run(title: str, command: list[str], **options) -> int:
    print(f"\n== {title}", flush=True)
    begin = time.monotonic()
    code = subprocess.run(command, **options).returncode
    print(f"== {title}: {time.monotonic() - begin:.0f} s", flush=True)
    return code


def run_ctest(kind: str, names: list[str]) -> None:
    pattern = f"_ctest_({'|'.join(names)})_{kind}" if names else f"_ctest_.*_{kind}"
    command = ["ctest", "-R", pattern, f"-j{os.cpu_count() or 2}", "--timeout", "600", "--output-on-failure"]
    run(kind, command, cwd=BUILD)


def run_pytest(title: str, paths: list[Path], long: bool) -> int:
    if not paths:
        return 0
    command = [sys.executable, "-m", "pytest", "-q", "-rs", "--durations=8"]
    command += [f"--junitxml={PYTEST_RESULTS / (title.replace(' ', '-') + '.xml')}"]
    command += ["--timeout=900"] + (["--long"] if long else []) + [str(path) for path in paths]
    return run(f"pytest {title}", command, cwd=TOP)


def main() -> int:
    parser = argparse.ArgumentParser(prog="./franka test")
    parser.add_argument("packages", nargs="*", help="only these packages; `tests` is the end-to-end folder")
    parser.add_argument("--long", action="store_true", help="long forms of soaks, sweeps and style checks")
    arguments = parser.parse_args()
    known = packages()
    unknown = [name for name in arguments.packages if name not in known and name != "tests"]
    if unknown:
        print(
            f"There is no package {', '.join(unknown)}. There are: tests, {', '.join(known)}.",
            file=sys.stderr,
        )
        return 2
    selected = [name for name in arguments.packages if name != "tests"]
    end_to_end = not arguments.packages or "tests" in arguments.packages
    if arguments.long:
        os.environ["FRANKA_TEST_LONG"] = "1"
    for folder in (RESULTS, PYTEST_RESULTS):
        shutil.rmtree(folder, ignore_errors=True)
    PYTEST_RESULTS.mkdir(parents=True)

    style = [sys.executable, str(TOP / "tests" / "style.py")] + (["--long"] if arguments.long else [])
    style_failed = not arguments.packages and run("style", style)
    compiler_warnings = [sys.executable, str(TOP / "tests" / "compiler_warnings.py")]
    warned = not arguments.packages and run("compiler warnings", compiler_warnings)
    pytest_broken = 0
    if selected or not arguments.packages:
        run_ctest("gtest", selected)
        run_ctest("rostest", selected)
        tests = [
            p
            for n, folder in known.items()
            if not selected or n in selected
            for p in sorted(folder.glob("test/**/test_*.py"))
        ]
        pytest_broken |= run_pytest("packages", tests, arguments.long) > 1
    if end_to_end:
        pytest_broken |= (
            run_pytest("end to end", sorted((TOP / "tests").glob("test_*.py")), arguments.long) > 1
        )

    tally = Tally()
    for path in sorted(RESULTS.glob("**/*.xml")):
        # A rostest writes its cases to rosunit-*.xml; its own file repeats them as one, and reports if a
        # node died or a test never ended.
        tally.add(path, only_failures=path.name.startswith("rostest-"))
    for path in sorted(PYTEST_RESULTS.glob("*.xml")):
        tally.add(path)
    if style_failed:
        tally.failed.append("style: see above")
    if warned:
        tally.failed.append("compiler warnings: see above")
    if pytest_broken:
        tally.failed.append("pytest could not run everything: see above")
    print()
    for name in tally.failed:
        print(f"FAILED {name}")
    if tally.skipped:
        print(f"{tally.skipped} skipped")
    print(f"{tally.passed} passed, {len(tally.failed)} failed")
    return 1 if tally.failed or not tally.passed else 0


if __name__ == "__main__":
    sys.exit(main())

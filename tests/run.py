#!/usr/bin/env python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Runs every test of the built workspace and ends with one line, `N passed, N failed`.

In this order: style, compiler warnings, gtest, rostest, and pytest (`tests/test_*.py`, `test/test_*.py` of
packages), three programs at a time on two processors. Each file of pytest has a process of its own, because
rospy can be initialised once in a process. Cases are counted from the result files, since catkin's own
summary counts some twice. A table lists the reasons of skipped tests; the run fails if a reason names neither
a missing package nor the long form. Called by `./franka test`, which provides the environment.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from subprocess import PIPE, STDOUT

TOP = Path(__file__).resolve().parent.parent
sys.path.append(str(TOP / "tests" / "support"))
from tally import Tally  # noqa: E402

SOURCE = TOP / "catkin_ws" / "src"
BUILD = TOP / "catkin_ws" / "build"
RESULTS = BUILD / "test_results"
PYTEST_RESULTS = TOP / "out" / "pytest"
# Programs of rostest and pytest at a time: they sleep for 42 % of their time (measured on two processors).
WORKERS = round(1.5 * (os.cpu_count() or 2))


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


def run_ctest(kind: str, names: list[str], workers: int) -> None:
    pattern = f"_ctest_({'|'.join(names)})_{kind}" if names else f"_ctest_.*_{kind}"
    command = ["ctest", "-R", pattern, f"-j{workers}", "--timeout", "600", "--output-on-failure"]
    run(kind, command, cwd=BUILD)


# Files whose tests count lost milliseconds, or change what other tests use, say so in this line.
ALONE = re.compile(r"^pytestmark = .*pytest\.mark\.alone", re.MULTILINE)


def run_pytest_file(path: Path, long: bool) -> bool:
    """Prints the output if a test failed, otherwise the number of tests.

    @returns whether pytest could run the file
    """
    name = ".".join(path.relative_to(TOP).with_suffix("").parts)
    command = [sys.executable, "-m", "pytest", "-q", "--timeout=900", str(path)]
    command += [f"--junitxml={PYTEST_RESULTS / name}.xml"] + (["--long"] if long else [])
    if "hypothesis" not in path.read_text(encoding="utf-8"):
        command += ["-p", "no:hypothesispytest"]  # it takes seconds to import
    result = subprocess.run(command, cwd=TOP, text=True, errors="replace", stdout=PIPE, stderr=STDOUT)
    output = result.stdout.rstrip()
    lines = output.splitlines() or ["pytest printed nothing"]
    if result.returncode:
        print(f"{output}\n-- {path.relative_to(TOP)}: status {result.returncode}", flush=True)
    else:
        print(f"{path.relative_to(TOP)}: {lines[-1]}", flush=True)
    return result.returncode in (0, 1)


def run_pytest(paths: list[Path], long: bool) -> bool:
    """@returns whether pytest could run all files"""
    print("\n== pytest", flush=True)
    begin = time.monotonic()
    alone = [path for path in paths if ALONE.search(path.read_text(encoding="utf-8"))]
    together = [path for path in paths if path not in alone]
    with ThreadPoolExecutor(WORKERS) as pool:
        ran = list(pool.map(lambda path: run_pytest_file(path, long), together))
    ran += [run_pytest_file(path, long) for path in alone]
    print(f"== pytest: {time.monotonic() - begin:.0f} s", flush=True)
    return all(ran)


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
    files = []
    if selected or not arguments.packages:
        run_ctest("gtest", selected, os.cpu_count() or 2)
        run_ctest("rostest", selected, WORKERS)
    if end_to_end:  # first, as they take longest
        files += sorted((TOP / "tests").glob("test_*.py"))
    for name, folder in known.items():
        if name in selected or not arguments.packages:
            files += sorted(folder.glob("test/**/test_*.py"))
    pytest_broken = not run_pytest(files, arguments.long)

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
    for line in tally.table_of_skips():
        print(line)
    print(f"{tally.passed} passed, {len(tally.failed)} failed")
    return 1 if tally.failed or not tally.passed else 0


if __name__ == "__main__":
    sys.exit(main())

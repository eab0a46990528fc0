#!/usr/bin/env python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Runs every test of the built workspace and ends with one line, `N passed, N failed`.

In this order: style and compiler warnings, which end the run if they fail; gtest, rostest and pytest
(`tests/test_*.py`, `test/test_*.py` of packages), four programs at a time on two processors. Each file of
pytest has a process of its own. Cases whose assertion failed run once more at the end, alone: those that pass
then are flaky, and make the run red only if one of the nine runs before has them, too. A program that died,
hung or left no results is red at once. But for the long form all have a network of their own, the loopback
only. Each case is added to out/test-history.jsonl. A table lists the reasons of skipped tests; the run fails
for a reason that is not allowed. Called by `./franka test`, which provides the environment.

`--realtime` runs only the cases whose subject is the wall clock, one program at a time: tests of pytest with
the mark `realtime`, and gtests whose names end with OnWallClock. `--long` runs every case, in processes whose
C library has a decimal comma.
"""

import argparse
import ctypes
import json
import os
import re
import resource
import shutil
import subprocess
import sys
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path

TOP = Path(__file__).resolve().parent.parent
sys.path.append(str(TOP / "tests" / "support"))
import decimal_comma  # noqa: E402
import own_network  # noqa: E402
from programs import node_ids, registered, run_pytest, run_registered  # noqa: E402
from tally import Case, Tally  # noqa: E402

SOURCE = TOP / "catkin_ws" / "src"
BUILD = TOP / "catkin_ws" / "build"
RESULTS = BUILD / "test_results"
PYTEST_RESULTS = TOP / "out" / "pytest"
HISTORY = TOP / "out" / "test-history.jsonl"
# Programs of rostest and pytest at a time. They sleep for half of their time: with three of them, two
# processors were idle for 15 % (measured).
WORKERS = 2 * (os.cpu_count() or 2)
STRIDE = 7
RECENT = 10  # runs of the history, with this one, in two of which a case may not be flaky
KEPT = 50  # runs of the history (chosen here): one takes less than a megabyte
AGAIN = 30  # cases that failed: if there are more, it is the product, and none runs again (chosen here)


def refuse_realtime_priorities() -> None:
    """To this program and all that it starts: a thread of that priority that does not sleep leaves the other
    tests no processor."""
    resource.setrlimit(resource.RLIMIT_RTPRIO, (0, 0))
    if os.geteuid() == 0:
        cap_bset_drop, cap_sys_nice = 24, 23  # linux/prctl.h, linux/capability.h
        ctypes.CDLL(None).prctl(cap_bset_drop, cap_sys_nice, 0, 0, 0)


def packages() -> dict[str, Path]:
    found = {path.parent.name: path.parent for path in sorted(SOURCE.glob("**/package.xml"))}
    # A glob does not follow the link that brings this one into the workspace.
    found["pyfranka"] = TOP / "python"
    return found


@contextmanager
def stage(title: str):
    """Prints the title, and the duration at the end."""
    print(f"\n== {title}", flush=True)
    begin = time.monotonic()
    yield
    print(f"== {title}: {time.monotonic() - begin:.0f} s", flush=True)


def fails(title: str, command: list[str]) -> bool:
    with stage(title):
        return subprocess.run(command, check=False).returncode != 0


# Files whose tests change what other tests use say so with this mark, alone or in a list.
ALONE = re.compile(r"^pytestmark = (\[[^\]]*)?pytest\.mark\.alone\b", re.MULTILINE)
REALTIME = re.compile(r"pytest\.mark\.realtime")
REALTIME_GTESTS = "*OnWallClock*"


def results_of(path: Path) -> Path:
    return PYTEST_RESULTS / f"{'.'.join(path.relative_to(TOP).with_suffix('').parts)}.xml"


def run_all(tests: list, files: list[Path], workers: int = WORKERS) -> dict:
    """The cases of each registered test and of each file of pytest."""
    cases = {}
    for kind, most in (("gtest", os.cpu_count() or 2), ("rostest", WORKERS)):
        with stage(kind):
            chosen = [test for test in tests if f"_{kind}_" in test.name]
            cases |= run_registered(BUILD, chosen, min(workers, most))
    with stage("pytest"):
        alone = [path for path in files if ALONE.search(path.read_text(encoding="utf-8"))]
        together = [path for path in files if path not in alone]
        with ThreadPoolExecutor(workers) as pool:
            ran = list(pool.map(lambda path: run_pytest(path, results_of(path)), together))
        ran += [run_pytest(path, results_of(path)) for path in alone]
        cases |= dict(zip(together + alone, ran))
    return cases


def run_again(cases: dict) -> list[str]:
    """Runs the cases that failed once more, one program at a time, and replaces their verdicts.

    @returns the names of those that passed now
    """
    broken = {
        program: failed
        for program, found in cases.items()
        if (failed := [case for case in found if case.verdict == "failed"])
        and all(case.by_assertion for case in failed)
    }
    count, flaky = sum(map(len, broken.values())), []
    if not broken:
        return []
    if count > AGAIN:
        print(f"\n{count} cases failed, more than {AGAIN}: they do not run again")
        return []
    with stage("again"):
        for program, failed in broken.items():
            if isinstance(program, Path):
                file = results_of(program).with_suffix(".again.xml")
                second = run_pytest(program, file, node_ids(program, failed))
            else:
                second = run_registered(BUILD, [program], 1)[program]
            verdicts = {case.name: case.verdict for case in second}
            passed = all(verdicts.get(case.name) == "passed" for case in failed)
            if passed and "failed" not in verdicts.values():
                flaky += [case.name for case in failed]
                others = [case for case in cases[program] if case not in failed and case.name not in verdicts]
                cases[program] = others + second
    return flaky


def history() -> list[dict]:
    """The lines of earlier runs."""
    if not HISTORY.exists():
        return []
    return [json.loads(line) for line in HISTORY.read_text(encoding="utf-8").splitlines()]


def often_flaky(flaky: list[str]) -> list[str]:
    """Those that were flaky in a recent run, too."""
    lines = history()
    recent = sorted({line["run"] for line in lines})[1 - RECENT :]
    before = {line["case"] for line in lines if line["verdict"] == "flaky" and line["run"] in recent}
    return [name for name in flaky if name in before]


def write_history(tally: Tally) -> None:
    """Adds a line a case; `load` is the machine's average of five minutes at the end of the run."""
    now, load = round(time.time()), os.getloadavg()[1]
    lines = history()
    recent = sorted({line["run"] for line in lines})[1 - KEPT :]
    lines = [line for line in lines if line["run"] in recent]
    for case in tally.cases:
        verdict = "flaky" if case.name in tally.flaky else case.verdict
        lines.append(
            {"run": now, "case": case.name, "verdict": verdict, "seconds": case.seconds, "load": load}
        )
    written = HISTORY.with_suffix(".new")
    written.write_text("".join(json.dumps(line) + "\n" for line in lines), encoding="utf-8")
    written.replace(HISTORY)  # a run that is killed meanwhile leaves the earlier history


def print_history() -> int:
    """The slowest cases of the last run, and those that were ever flaky or failed."""
    lines = history()
    if not lines:
        print("There is no history: run ./franka test.", file=sys.stderr)
        return 2
    runs = Counter(line["run"] for line in lines)
    last = [line for line in lines if line["run"] == max(runs)]
    print("The slowest cases of the last run [s]:")
    for line in sorted(last, key=lambda line: -line["seconds"])[:20]:
        print(f"{line['seconds']:8.1f}  {line['case']}")
    print(f"Flaky or failed in {len(runs)} runs:")
    for (case, verdict), count in Counter(
        (line["case"], line["verdict"]) for line in lines if line["verdict"] in ("flaky", "failed")
    ).most_common():
        print(f"{count:8}  {verdict:6}  {case}")
    return 0


def main() -> int:
    parser = argparse.ArgumentParser(prog="./franka test")
    parser.add_argument("packages", nargs="*", help="only these packages; `tests` is the end-to-end folder")
    parser.add_argument("--long", action="store_true", help="every case, in its long form")
    parser.add_argument("--realtime", action="store_true", help="only cases whose subject is the wall clock")
    parser.add_argument("--history", action="store_true", help="slow and flaky cases of earlier runs")
    arguments = parser.parse_args()
    if arguments.history:
        return print_history()
    known = packages()
    unknown = [name for name in arguments.packages if name not in known and name != "tests"]
    if unknown:
        print(
            f"There is no package {', '.join(unknown)}. There are: tests, {', '.join(known)}.",
            file=sys.stderr,
        )
        return 2
    if not arguments.long and (reason := own_network.enter()):
        print(f"\nThe tests use this machine's network, as they could not have one of their own: {reason}")
    selected = [name for name in arguments.packages if name != "tests"]
    end_to_end = not arguments.packages or "tests" in arguments.packages
    realtime = arguments.realtime and not arguments.long
    if arguments.long:
        os.environ["FRANKA_TEST_LONG"] = "1"
    if arguments.long or realtime:
        os.environ["FRANKA_TEST_REALTIME"] = "1"
    if not arguments.long and not realtime:
        refuse_realtime_priorities()
    # Where it is allowed, a thread that has commanded a robot has the highest priority, and so has what it
    # starts. The threads of OpenBLAS wait for each other without sleep: two such tests never ended.
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    if not arguments.long:
        os.environ["GTEST_FILTER"] = REALTIME_GTESTS if realtime else f"-{REALTIME_GTESTS}"
    for folder in (RESULTS, PYTEST_RESULTS):
        shutil.rmtree(folder, ignore_errors=True)
    PYTEST_RESULTS.mkdir(parents=True)

    skipped = []
    if not arguments.packages and not realtime:
        skips = PYTEST_RESULTS / "style"
        style = [sys.executable, str(TOP / "tests" / "style.py"), f"--skips={skips}"]
        style += ["--long"] if arguments.long else []
        warnings = [sys.executable, str(TOP / "tests" / "compiler_warnings.py")]
        broken = [
            Case(f"{title}: see above", "failed")
            for title, command in (("style", style), ("compiler warnings", warnings))
            if fails(title, command)
        ]
        if broken:
            print("\n".join(Tally(broken).lines()))
            return 1
        if skips.exists():
            lines = [line.split("\t") for line in skips.read_text(encoding="utf-8").splitlines()]
            skipped = [Case(f"style: {name}", "skipped", reason=reason) for name, reason in lines]
    tests, files = [], []
    if selected or not arguments.packages:
        kinds = "gtest" if realtime else "gtest|rostest"
        tests = registered(BUILD, f"_ctest_({'|'.join(selected) or '.*'})_({kinds})_")
    if end_to_end:  # first, as they take longest
        named = sorted((TOP / "tests").glob("test_*.py"))
        # Neighbors wait for the same thing to be built, such as the site's pages: they do not run together.
        files += [path for first in range(STRIDE) for path in named[first::STRIDE]]
    for name, folder in known.items():
        if name in selected or not arguments.packages:
            files += sorted(folder.glob("test/**/test_*.py"))

    if realtime:
        files = [path for path in files if REALTIME.search(path.read_text(encoding="utf-8"))]
    if arguments.long:
        os.environ.update(decimal_comma.environment())
    cases = run_all(tests, files, 1 if realtime else WORKERS)
    flaky = run_again(cases)
    tally = Tally([*skipped, *(case for found in cases.values() for case in found)], flaky)
    tally.cases += [
        Case(f"{name} was flaky in two of the last {RECENT} runs", "failed") for name in often_flaky(flaky)
    ]
    write_history(tally)
    print()
    print("\n".join(tally.lines()))
    return 1 if tally.failed or not tally.passed else 0


if __name__ == "__main__":
    sys.exit(main())
